"""The table of a study: a row for every run."""

from __future__ import annotations

import csv
import json
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

from carom.errors import InputError
from carom.io.layout import CASE
from carom.system.existing import entries, refuse_foreign

TABLE, PICTURE = "sweep.csv", "sweep.png"
"""Files of a study beside the folders of its runs."""

FIGURES = (
    "energy_initial",
    "energy_final",
    "friction",
    "plastic",
    "max_defect",
    "contacts",
    "first_touch",
    "contact_time",
    "peak_force",
    "restitution",
    "tangential_restitution",
    "min_gap",
    "steps",
    "wall_s",
    "warnings",
)
"""Columns: energies [J], contact events, times [s], force [N], coefficients of the first impact,
gap [m], codes of warnings."""

COEFFICIENTS = ("restitution", "tangential_restitution")
"""Those of them that are of the first impact that has them."""

TITLES = {
    "energy_initial": "initial energy [J]",
    "energy_final": "final energy [J]",
    "friction": "friction work [J]",
    "plastic": "plastic work [J]",
    "max_defect": "largest defect [J]",
    "contacts": "contact events",
    "first_touch": "first touch [s]",
    "contact_time": "contact time [s]",
    "peak_force": "peak force [N]",
    "restitution": "restitution of the first impact",
    "tangential_restitution": "tangential restitution of the first impact",
    "min_gap": "smallest gap [m]",
    "steps": "steps",
    "wall_s": "wall time [s]",
    "warnings": "warnings",
}
"""What figures are called where people read them: friction is also what studies vary."""

SHOWN = ("energy_final", "friction", "contact_time", "peak_force")
"""Those that fit a screen."""


def row(values: Mapping[str, Any], summary: Mapping[str, Any]) -> dict[str, Any]:
    """Return the row of a run; figures that it has none of are None."""
    energy = summary.get("energy", {})
    events = summary.get("contacts", [])
    end = summary.get("end_time")
    figures = {
        "energy_initial": energy.get("initial"),
        "energy_final": energy.get("final"),
        "friction": energy.get("friction"),
        "plastic": energy.get("plastic"),
        "max_defect": energy.get("max_defect"),
        "contacts": len(events) if "contacts" in summary else None,
        "first_touch": min((e["onset"] for e in events), default=None),
        "contact_time": sum(
            (end if e["release"] is None else e["release"]) - e["onset"] for e in events
        )
        if "contacts" in summary
        else None,
        "peak_force": max((e["peak_force"] for e in events), default=None),
        **{name: _of_first_impact(events, name) for name in COEFFICIENTS},
        "min_gap": summary.get("min_gap"),
        "steps": summary.get("steps"),
        "wall_s": summary.get("wall_s"),
        "warnings": " ".join(dict.fromkeys(one["code"] for one in summary.get("warnings", ()))),
    }
    status = {"status": summary["status"], "reason": summary.get("reason", "")}
    return {**values, **status, **figures}


def _of_first_impact(events: Sequence[Mapping[str, Any]], name: str) -> float | None:
    """Return a coefficient of the first contact event that has it."""
    found = (impact[name] for event in events if (impact := event.get("impact")))
    return next((value for value in found if value is not None), None)


def spare_other_study(path: Path, keys: Sequence[str]) -> None:
    """Refuse to replace a table that varies something else.

    Raises
    ------
    InputError
        There is such a table.
    """
    if not path.is_file():
        return
    with path.open(encoding="utf-8", errors="replace", newline="") as file:
        columns = next(csv.reader(file), [])
    if columns[: len(keys) + 1] != [*keys, "status"]:
        raise InputError(
            f"{path}: is of another study; choose another --out, or replace it by --force"
        )


def spare_files_of_others(table: Path, folders: Collection[str]) -> None:
    """Refuse a directory that is not of a study and has something in it.

    Parameters
    ----------
    table
        The table of the study, written when its runs have ended.
    folders
        Names of the folders of the runs.

    Raises
    ------
    InputError
        There is something, or there can be no such directory.
    """
    directory = table.parent
    there = entries(directory)
    if table.name not in there:
        mine = {name for name in there if name in folders or (directory / name / CASE).is_file()}
        refuse_foreign(directory, there - mine - {_partial(table).name}, of="a study")


def _partial(table: Path) -> Path:
    return table.with_suffix(".tmp")


def write_table(path: Path, rows: Sequence[Mapping[str, Any]]) -> None:
    """Write the rows as CSV, whole or not at all."""
    partial = _partial(path)
    with partial.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, fieldnames=list(rows[0]))
        writer.writeheader()
        for one in rows:
            writer.writerow({key: _cell(value) for key, value in one.items()})
    partial.replace(path)


def shown_cells(
    keys: Sequence[str], rows: Sequence[Mapping[str, Any]]
) -> tuple[list[str], list[list[str]]]:
    """Return header and cells for people: keys in full, status, the figures that fit, warnings."""
    warned = ["warnings"] if any(one["warnings"] for one in rows) else []
    cells = [
        [
            *(_cell(one[key]) for key in keys),
            str(one["status"]),
            *("" if one[name] is None else f"{one[name]:.4g}" for name in SHOWN),
            *(str(one[name]) for name in warned),
        ]
        for one in rows
    ]
    return [*keys, "status", *(TITLES[name] for name in SHOWN), *warned], cells


def _cell(value: object) -> str:
    if value is None:
        return ""
    return value if isinstance(value, str) else json.dumps(value, default=str)
