"""The stages of a run, each with the rows of its own, as if it were a run by itself."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from carom.auditing.arrays import Array
from carom.auditing.model import AuditModel
from carom.auditing.records.files import Files
from carom.auditing.records.rows import Rows
from carom.ledger_terms import TERMS, names, terms

OF_STEPS = (
    *("contacts", "normal_force", "newton_iterations", "retried_steps", "shortest_step"),
    *("certificate", "residual", "blend", "step_defect"),
)
"""Columns that say something of the steps since the row before."""

SUMS = tuple(term.name for term in terms("run") if term.side != "stored")
"""Terms of the ledger of a run that are sums since the start."""


@dataclass(frozen=True)
class Part:
    """A stage of a run; the whole of one that has none.

    Parameters
    ----------
    model
        The model of the stage.
    rows
        Its rows, the last one of the stage before as the first. Sums are those since then.
    ledger
        The columns of bodies and pairs of these times, sums since the stage began.
    summary
        What the summary says, with what it says of the stage in place of that of the run.
    first
        Number of its first row among those of the run.
    """

    model: AuditModel
    rows: Rows
    ledger: Mapping[str, Mapping[str, Array]]
    summary: Mapping[str, Any]
    first: int

    @property
    def end(self) -> float:
        """When the last of its rows is [s]."""
        return float(self.rows.times[-1])


def parts_of(files: Files) -> list[Part]:
    """Return the stages that a run has come to."""
    models, summary, times = files.models(), files.summary, files.history["time"]
    if len(models) == 1:
        rows = Rows(models[0], files.history, summary)
        return [Part(models[0], rows, files.ledger, summary, 0)]
    found: list[Part] = []
    last = float(times[-1])
    reached = [m for m in models if m.stage.start_time < last or m is models[0]]
    for number, model in enumerate(reached):
        begins = -np.inf if number == 0 else float(np.searchsorted(times, model.stage.start_time))
        first = max(int(begins), 0) if number else 0
        after = int(np.searchsorted(times, model.stage.end_time, side="right"))
        mine = slice(first, after)
        history = {name: values[mine].copy() for name, values in files.history.items()}
        if number:
            for name in (*SUMS, "defect"):
                history[name] -= history[name][0]
            for name in OF_STEPS:
                history[name][0] = 0.0
        own = _of_stage(summary, number, is_last=model is reached[-1])
        ledger = _since(files.ledger, float(times[first]), float(times[after - 1]))
        found.append(Part(model, Rows(model, history, own), ledger, own, first))
    return found


def _of_stage(summary: Mapping[str, Any], number: int, *, is_last: bool) -> dict[str, Any]:
    """Return the summary with what it says of a stage in place of what it says of the run."""
    own = {**summary, **summary["stages"][number]}
    if not is_last:
        own["status"] = "completed"
    return own


def _since(
    ledger: Mapping[str, Mapping[str, Array]], start: float, end: float
) -> dict[str, dict[str, Array]]:
    """Return the rows of a ledger between two times [s], with sums since the first of them."""
    found = {}
    for entry, columns in ledger.items():
        times = columns["time"]
        mine = (times >= start) & (times <= end)
        if not mine.any():
            continue
        own = {name: values[mine].copy() for name, values in columns.items()}
        if own["time"][0] == start:
            for name in _SUMMED & own.keys():
                own[name] -= own[name][0]
        found[entry] = own
    return found


_SUMMED = {*(term.name for term in TERMS), *names("body"), *names("pair"), "defect"}
