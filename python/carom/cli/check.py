"""``carom check``."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from rich.console import Console
from rich.table import Table

from carom.building import checking
from carom.case.full_stage import FullStage
from carom.cli.case import CaseFile, Overrides, load
from carom.cli.failures import failures
from carom.display.tables import add, two_columns
from carom.errors import naming


def check(*, case: CaseFile, overrides: Overrides = None) -> None:
    """Validate a case and print what would run."""
    with failures(case):
        scenario = load(case, overrides)
        with naming(case):
            checked = checking.check(scenario)
    console = Console()
    console.print(_table(checked.description, scenario.full_stages()))
    for warning in checked.warnings:
        console.print(f"warning: {warning}", markup=False, highlight=False, soft_wrap=True)


def _table(description: Mapping[str, Any], stages: Sequence[FullStage]) -> Table:
    table = two_columns(description["title"] or "Check")
    add(table, "dofs", str(description["dofs"]))
    if len(stages) == 1:
        add(table, "steps", f"{description['steps']} of {stages[0].analysis.time_step:g} s")
    else:
        add(table, "steps", str(description["steps"]))
        for stage in stages:
            add(table, f"stage {stage.name}", _steps(stage))
    if (suggested := description["suggested_time_step"]) is not None:
        add(table, "suggested step", f"{suggested:.3g} s")
    add(table, "initial energy", f"{description['energy']:.6g} J")
    table.add_section()
    for body in description["bodies"]:
        add(
            table,
            body["name"],
            f"{body['nodes']} nodes, {body['cells']} cells, {body['dofs']} dofs, "
            f"mass {body['mass']:.6g} kg, volume {body['volume']:.6g} m³, "
            f"smallest edge {body['smallest_edge']:.3g} m, " + _waves(body),
        )
    table.add_section()
    for pair in description["pairs"]:
        add(table, " – ".join(pair["between"]), _gap(pair))
    return table


def _waves(body: Mapping[str, Any]) -> str:
    if body["is_rigid"]:
        return "rigid"
    if body["vibrations"] is not None:
        count, lowest = body["vibrations"]["count"], body["vibrations"]["lowest"]
        return f"reduced to {count} vibrations, the lowest of {lowest / (2 * math.pi):.4g} Hz"
    speeds = ", ".join(f"{of['wave_speed']:.4g}" for of in body["materials"])
    return f"wave speed {speeds} m/s, suggested Δt {body['suggested_time_step']:.3g} s"


def _steps(stage: FullStage) -> str:
    return (
        f"{stage.analysis.kind}, from {stage.start_time:g} s to {stage.end_time:g} s in steps of "
        f"{stage.analysis.time_step:g} s"
    )


def _gap(pair: Mapping[str, Any]) -> str:
    gap = pair["initial_gap"]
    at = ", ".join(f"{coordinate:.4g}" for coordinate in pair["at"])
    what = f"gap {gap:.4g} m" if gap >= 0 else f"overlap {-gap:.4g} m"
    return f"{what} at ({at}), friction {pair['friction']:g}"
