"""The curves over time: the panels of the page, and everything else that was recorded."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from carom.io.ledger import COLUMNS
from carom.ledger_terms import terms
from carom.report.codec import pack
from carom.report.source import Columns, Source

ROWS = 8_000
"""Rows of history that the page takes; of more, evenly spaced ones."""

_TERMS = (
    ("total", "total", "ink"),
    *((term.name, term.label, term.colour) for term in terms("run")),
)
"""Terms of the ledger: column, label and colour."""

_UNITS = {
    **dict.fromkeys((*(column for column, _, _ in _TERMS), "defect", "step_defect"), "J"),
    "certificate": "J",
    "momentum": "kg m/s",
    "angular_momentum": "kg m²/s",
    **dict.fromkeys(("x", "y", "z", "u", "min_gap", "penetration", "length"), "m"),
    **dict.fromkeys(("v", "vmid"), "m/s"),
    "spin": "rad/s",
    **dict.fromkeys(("translation", "rotation", "vibration"), "J"),
    **dict.fromkeys(("force", "normal_force"), "N"),
    "shortest_step": "s",
}
"""Units of columns, whatever their owner and axis; what has none is a number."""

_ALWAYS = frozenset({"total", "kinetic", "strain"})


@dataclass(frozen=True)
class _Panel:
    id: str
    title: str
    unit: str
    curves: tuple[tuple[str, str, str], ...]
    log: bool = False
    tall: bool = False
    steps: bool = False
    when: str = ""
    """Column without which there is nothing to show."""


_PANELS = (
    _Panel("energy", "Energy", "J", _TERMS, tall=True),
    _Panel(
        "defect",
        "Energy that the ledger does not explain",
        "J",
        (("defect", "defect", "red"), ("step_defect", "worst step", "grey")),
    ),
    _Panel(
        "motion",
        "How bodies move as a whole, and in themselves",
        "J",
        (
            ("translation", "translation", "blue"),
            ("rotation", "rotation", "green"),
            ("vibration", "vibration", "orange"),
            ("strain", "strain", "purple"),
        ),
        when="translation",
    ),
    _Panel("force", "Normal force, all contacts", "N", (("normal_force", "normal force", "blue"),)),
    _Panel(
        "convergence",
        "Convergence",
        "",
        (
            ("newton_iterations", "Newton iterations per step", "purple"),
            ("contacts", "active contacts", "sky"),
            ("retried_steps", "steps retried in halves", "red"),
        ),
        steps=True,
    ),
    _Panel(
        "step",
        "Length of the steps: halved where they fail, and grown again",
        "s",
        (("shortest_step", "shortest step", "orange"),),
        log=True,
        steps=True,
        when="retried_steps",
    ),
    _Panel(
        "certificate",
        "Certificate: distance from Coulomb’s law",
        "J",
        (("certificate", "of the worst step", "green"),),
        log=True,
    ),
)


def curves(source: Source) -> dict[str, Any]:
    """Return columns, panels and what else can be shown, as plain data for JSON."""
    history = {name: values for name, values in source.history.items() if len(values)}
    if not history:
        nothing: dict[str, Any] = {"columns": {}, "panels": [], "groups": [], "ledgers": []}
        return {"rows": 0, "recorded": 0, "units": {}, **nothing}
    recorded = len(history["time"])
    taken = _evenly(recorded, ROWS)
    return {
        "rows": len(taken),
        "recorded": recorded,
        "columns": {name: pack(values[taken], "f8") for name, values in history.items()},
        "units": {name: _unit(name) for name in history},
        "panels": [_panel(panel, history, source) for panel in _PANELS if _has(panel, history)],
        "groups": _groups(history),
        "ledgers": [
            {"entry": entry, **_ledger(columns)}
            for entry, columns in source.ledger.items()
            if len(columns["time"])
        ],
    }


def _evenly(count: int, most: int) -> np.ndarray[Any, np.dtype[np.int64]]:
    return np.unique(np.rint(np.linspace(0, count - 1, min(count, most))).astype(np.int64))


def _has(panel: _Panel, history: Columns) -> bool:
    if panel.when and not np.any(history.get(panel.when, 0.0)):
        return False
    return bool(_stated(panel.curves, history))


def _stated(
    stated: Iterable[tuple[str, str, str]], columns: Mapping[str, Any]
) -> list[dict[str, str]]:
    """Return the curves that have anything to show."""
    return [
        {"column": column, "label": label, "colour": colour}
        for column, label, colour in stated
        if column in columns and (column in _ALWAYS or np.nan_to_num(columns[column]).any())
    ]


def _panel(panel: _Panel, history: Columns, source: Source) -> dict[str, Any]:
    limit = source.summary.get("certificate", {}).get("tolerance_joule")
    return {
        "id": panel.id,
        "title": panel.title,
        "unit": panel.unit,
        "log": panel.log,
        "tall": panel.tall,
        "steps": panel.steps,
        "limit": limit if panel.id == "certificate" else None,
        "curves": _stated(panel.curves, history),
    }


def _groups(history: Columns) -> list[dict[str, Any]]:
    """Return the columns in groups: those of the run, then of every body, point and support."""
    groups: dict[str, list[str]] = {}
    for column in history:
        if column != "time":
            owner, _, quantity = column.rpartition(".")
            groups.setdefault(owner if quantity else "", []).append(column)
    return [{"title": owner or "whole run", "columns": names} for owner, names in groups.items()]


def _unit(column: str) -> str:
    """Return the unit of a column, such as m/s of ``left.v_x``."""
    quantity = column.rpartition(".")[2]
    return _UNITS.get(re.sub("_[xyz]$", "", quantity), "")


def _ledger(columns: Columns) -> dict[str, Any]:
    """Return the energy terms of a body or pair that are not zero or missing throughout."""
    taken = _evenly(len(columns["time"]), ROWS // 4)
    told = [
        name
        for name in COLUMNS
        if name not in ("time", "entry") and np.nan_to_num(columns[name]).any()
    ]
    return {
        "time": pack(columns["time"][taken], "f8"),
        "columns": {name: pack(columns[name][taken], "f4") for name in told},
    }
