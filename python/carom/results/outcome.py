"""What came out of a run, as rows for terminals and notebooks."""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rich.table import Table

from carom.display.counting import count
from carom.display.tables import Rows, add, two_columns
from carom.io import layout
from carom.results.penetration import too_deep

SHOWN_CONTACTS = 12
"""Contact events that fit a screen; `summary.json` has them all."""


def summary_table(summary: Mapping[str, Any], *, where: Path) -> Table:
    """Return what came out of a run, its contact events, and where the results are."""
    table = two_columns(summary_title(summary))
    for rows in (outcome(summary), contact_events(summary), places(where)):
        for quantity, value in rows:
            add(table, quantity, value)
        table.add_section()
    return table


def summary_title(summary: Mapping[str, Any]) -> str:
    """Return what the results of a run are headed with."""
    return summary["title"] or "Run"


def outcome(summary: Mapping[str, Any]) -> Rows:
    """Yield what came out of a run, with warnings where it is not to be trusted."""
    energy, certificate = summary["energy"], summary["certificate"]
    reason = summary.get("reason")
    yield "status", f"{summary['status']}: {reason}" if reason else summary["status"]
    yield "reached", f"{summary['end_time']:g} s in {count(summary['steps'], 'step')}"
    yield (
        "wall time",
        f"{summary['wall_s']:.2f} s, {1e3 * summary['wall_s_per_step']:.3g} ms per step "
        f"({summary['dofs']} dofs)",
    )
    yield "energy", f"{energy['initial']:.6g} J → {energy['final']:.6g} J"
    yield "friction", f"{energy['friction']:.6g} J dissipated"
    yield from _stages(summary)
    yield "largest drift", f"{energy['max_drift']:.3g} J"
    yield "largest defect", f"{energy['max_defect']:.3g} J, of the energy ledger"
    yield (
        "certificate",
        f"{certificate['max_joule']:.3g} J from Coulomb's law in any step "
        f"({certificate['tolerance_joule']:.3g} J allowed)",
    )
    if (worst := too_deep(summary)) is not None:
        yield "penetration", f"{worst['depth']:.3g} m ({worst['allowed']:.3g} m allowed)"
    if (check := summary.get("cross_check")) is not None:
        yield _cross_check(check)
    for warning in summary.get("warnings", ()):
        yield "warning", warning["message"]


def _stages(summary: Mapping[str, Any]) -> Rows:
    """Yield what came out of every stage."""
    for stage in summary.get("stages", ()):
        energy = stage["energy"]
        yield (
            f"stage {stage['name']}",
            f"until {stage['end_time']:g} s in {count(stage['steps'], 'step')}, "
            f"{energy['initial']:.6g} J → {energy['final']:.6g} J, friction "
            f"{energy['friction']:.6g} J, largest defect {energy['max_defect']:.3g} J",
        )


def contact_events(summary: Mapping[str, Any]) -> Rows:
    """Yield the first contact events of a run, as many as fit a screen."""
    contacts = summary["contacts"]
    for contact in contacts[:SHOWN_CONTACTS]:
        yield " – ".join(contact["pair"]), _contact(contact)
    if len(contacts) > SHOWN_CONTACTS:
        yield "…", f"{len(contacts) - SHOWN_CONTACTS} more contacts in summary.json"


def places(where: Path) -> Rows:
    """Yield where the results are, and how to look at them."""
    yield "results", str(where)
    report = where / layout.REPORT
    made = f"none yet: carom report {shlex.quote(str(where))}"
    yield "report", str(report) if report.exists() else made


def _cross_check(check: Mapping[str, Any]) -> tuple[str, str]:
    """Return what a second solver said."""
    problems = check["problems"]
    solvers = " and ".join(check["solvers"])
    if problems == 0:
        return "cross-check", "no contact problem to solve again"
    return (
        "cross-check",
        f"{problems} contact problems solved again by {solvers}: motions within "
        f"{check['max_difference']:.2g} ({check['explained_difference']:.2g} explained by the "
        f"tolerance), {check['max_certificate_joule']:.3g} J from Coulomb's law",
    )


def _contact(contact: Mapping[str, Any]) -> str:
    release = contact["release"]
    until = "still touching" if release is None else f"{release:.4g} s"
    return (
        f"{contact['onset']:.4g} s → {until}, peak {contact['peak_force']:.3g} N, "
        f"friction {contact['friction_work']:.3g} J"
    )
