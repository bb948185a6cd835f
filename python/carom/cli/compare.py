"""``carom compare``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console

from carom.cli import complete
from carom.cli.failures import SYSTEM_FAILURE, failures
from carom.comparing.case import Change
from carom.comparing.comparison import Comparison
from carom.comparing.comparison import compare as compared
from carom.comparing.figure import comparison_figure
from carom.display.sheet import Sheet, print_whole
from carom.io.sparing import spare_file
from carom.plot.style import save

SHOWN = 12
"""Columns of the history that are told of without being asked for."""

Directory = Annotated[
    Path,
    typer.Argument(help="Results directory of `carom run`.", autocompletion=complete.results),
]


def compare(
    first: Directory,
    second: Directory,
    *,
    columns: Annotated[
        str | None,
        typer.Option(
            metavar="NAME,…",
            help="Columns of the history to tell of and draw, such as kinetic,normal_force; "
            "default those farthest apart, and in the picture the energies.",
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="Draw both over time: .png, .pdf or .svg."),
    ] = None,
    tolerance: Annotated[
        float | None,
        typer.Option(
            min=0.0,
            metavar="SHARE",
            help="Exit with 1 if a column, or one of --columns, is farther apart than this share "
            "of its largest value.",
        ),
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Replace a file that is there.")] = False,
) -> None:
    """Show two runs side by side: what differs in the case, what came of it, and curves.

    Differences of curves are those at the rows of the first; between its rows the second is linear.
    """
    console = Console()
    with failures(first):
        if out is not None:
            spare_file(out, force=force)
        both = compared(first, second)
        _ = both.case  # is read here: what is wrong with a case is told before anything is written
        asked = [name.strip() for name in columns.split(",")] if columns else None
        for name in asked or ():
            both.over_time(name)
        if out is not None:
            save(comparison_figure(both, asked), out)
    _show(console, both, asked)
    if out is not None:
        console.print(out, highlight=False, soft_wrap=True)
    apart = [one for one in both.history if asked is None or one.column in asked]
    if tolerance is not None and any(one.share > tolerance for one in apart):
        typer.echo(f"farther apart than {tolerance:g}", err=True)
        raise typer.Exit(SYSTEM_FAILURE)


def _show(console: Console, both: Comparison, asked: list[str] | None) -> None:
    """Print the three tables."""
    header = ("", str(both.first.path), str(both.second.path))
    if both.case:
        print_whole(console, Sheet(header, _rows(both.case)), title="The cases")
    else:
        console.print("The cases are the same.")
    rows = [
        (*row, _difference(change))
        for change, row in zip(both.outcome, _rows(both.outcome), strict=True)
        if (change.first, change.second) != (None, None)
    ]
    print_whole(console, Sheet((*header, "difference"), rows), title="What came of them")
    shown = [one for one in both.history if asked is None or one.column in asked]
    apart = [
        (one.column, f"{one.largest:.3g}", f"{one.share:.2g}", f"{one.time:.6g}")
        for one in (shown if asked else [one for one in shown if one.share > 0.0][:SHOWN])
    ]
    if apart:
        sheet = Sheet(("column", "largest difference", "of its largest value", "at t [s]"), apart)
        print_whole(console, sheet, title="Over time, farthest first")
    else:
        console.print("Over time they are the same to the last digit.")


def _rows(changes: tuple[Change, ...]) -> list[tuple[str, str, str]]:
    return [(change.key, _text(change.first), _text(change.second)) for change in changes]


def _text(value: Any) -> str:  # noqa: ANN401 (any JSON value)
    if value is None:
        return "–"
    return f"{value + 0.0:.8g}" if isinstance(value, float) else str(value)  # never -0


def _difference(change: Change) -> str:
    a, b = change.first, change.second
    if isinstance(a, int | float) and isinstance(b, int | float):
        return "" if a == b else f"{b - a:+.3g}"
    return ""
