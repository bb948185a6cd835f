"""``carom tour``."""

from __future__ import annotations

import os
import sys
import webbrowser
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.table import Table

from carom.building.build import build
from carom.case.scenario import Scenario
from carom.cli.failures import failures
from carom.cli.progress import shown_progress
from carom.errors import InputError
from carom.io import layout
from carom.new.template import place, template
from carom.plot.flow import Flow, Share, flow
from carom.report import write_report
from carom.results.result import Result
from carom.running.run import drive
from carom.system.existing import entries, make
from carom.system.interrupt import terminable

CASE = "two-bodies"
"""The template that is shown: some seconds, friction, spin, and vibrations that stay."""

BAR = 16
"""Width of the bar of all energy [characters]."""

EIGHTHS = " ▏▎▍▌▋▊▉█"
"""Blocks of a character, by how many eighths of it they fill."""

NEXT = (
    ("carom picture {run} --what energy --out energy.pdf", "the books as a picture for a paper"),
    ("carom audit {run}", "check the results by code that shares nothing with the solver"),
    (
        "carom run {case} --set contact.friction=0 --out {folder}/smooth",
        "the same without friction",
    ),
    ("carom compare {run} {folder}/smooth", "what that changed"),
    ("carom new", "templates of your own cases"),
)
"""Commands to go on with, and what they do."""


def tour(
    *,
    out: Annotated[
        Path, typer.Option(metavar="DIR", help="New directory for the case and its results.")
    ] = Path("carom-tour"),
    browser: Annotated[
        bool,
        typer.Option(help="Open the report in a browser, if there are a browser and a person."),
    ] = True,
) -> None:
    """Show in a minute what carom does: run an impact, say where its energy went, open its page."""
    console = Console()

    def tell(text: str = "") -> None:
        console.print(text, markup=False, highlight=False)

    case, run = out / f"{CASE}.toml", out / "run"
    with failures(out), terminable():
        if entries(out):
            raise InputError(f"{out}: has files already; name a new directory with --out")
        make(out)
        place(template(CASE), case)
        tell("Two rubber discs hit each other off their centres. This is the case, in SI units:")
        tell(f"{case}\n")
        scenario = Scenario.from_toml(case)
        with shown_progress(console) as progress:
            result = drive(build(scenario), scenario, run, progress=progress)
        report = write_report(run)
        _show_books(console, result)
        tell(f"\nThe page {report}")
        tell("has the discs in motion, all curves and all numbers; the rest is beside it:")
        tell(f"{layout.HISTORY}, {layout.SUMMARY}, and {layout.FIELDS} for ParaView.")
        if (
            browser
            and _can_open(console, os.environ)
            and webbrowser.open(report.resolve().as_uri())
        ):
            tell("It opens in your browser.")
        _show_what_is_next(console, {"case": str(case), "run": str(run), "folder": str(out)})


def _can_open(console: Console, environment: Mapping[str, str]) -> bool:
    """Tell whether somebody is there to look at a page: no script, no server without a display."""
    if not (console.is_terminal and sys.stdin.isatty()) or "CI" in environment:
        return False
    try:
        chosen = webbrowser.get()
    except webbrowser.Error:
        return False
    # Those that draw in the terminal would take it away.
    return not isinstance(chosen, webbrowser.GenericBrowser) or isinstance(
        chosen, webbrowser.BackgroundBrowser
    )


def _show_books(console: Console, result: Result) -> None:
    books = flow(result.history, result.ledger)
    table = Table(box=None, show_header=False, pad_edge=False)
    for _ in range(4):
        table.add_column(no_wrap=True)
    for title, side in (("The energy came from", books.sources), ("It went to", books.sinks)):
        table.add_row()
        table.add_row(title, style="bold")
        for share in side:
            joule = f"{share.joule:.4g} J"
            table.add_row(f"  {share.label}", _bar(books, share), joule, books.fraction(share))
    console.print(table)
    missed = result.summary["energy"]["max_defect"]
    console.print(
        "\nEvery term has a definition of its own, and none is a remainder:", style="bold"
    )
    console.print(f"at most {missed:.1e} J of the books stay unexplained.", highlight=False)


def _bar(books: Flow, share: Share) -> str:
    whole, part = divmod(round(8 * BAR * share.joule / books.total), 8)
    return (EIGHTHS[8] * whole + EIGHTHS[part]).rstrip()


def _show_what_is_next(console: Console, names: Mapping[str, str]) -> None:
    console.print("\nGo on with", style="bold")
    for words, what in NEXT:
        console.print(f"  {words.format(**names)}", highlight=False, markup=False, soft_wrap=True)
        console.print(f"      {what}", style="dim", highlight=False)
