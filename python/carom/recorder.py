"""The files of one run, written while it goes."""

from __future__ import annotations

from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING

from carom import _carom
from carom.interrupt import uninterrupted
from carom.io import layout
from carom.io.audit import AuditWriter
from carom.io.history import HistoryWriter
from carom.io.ledger import LedgerWriter
from carom.io.summary import write_summary
from carom.io.vtkhdf import SURFACE_CELL_FIELDS, SURFACE_POINT_FIELDS, FieldsWriter
from carom.plot import draw
from carom.report import write_report
from carom.result import Result
from carom.scenario import Scenario

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from carom.friction import Problem


class Recorder:
    """Writes the results directory of one run, in place of those of an earlier one.

    Ctrl-C waits until what is being written is whole.

    Parameters
    ----------
    directory
        Directory to write, made if need be.
    scenario
        What is run.
    simulation
        The simulation to record, at its start.
    """

    def __init__(self, directory: Path, scenario: Scenario, simulation: _carom.Simulation) -> None:
        directory.mkdir(parents=True, exist_ok=True)
        layout.clear(directory)
        (directory / layout.CASE).write_text(scenario.to_toml(complete=True), encoding="utf-8")
        self._directory = directory
        self._title = scenario.title
        self._simulation = simulation
        self._history = HistoryWriter(directory / layout.HISTORY, simulation.history_columns())
        self._ledger = LedgerWriter(directory / layout.LEDGER, simulation.ledger_entries())
        self._fields = FieldsWriter(directory / layout.FIELDS, simulation.mesh())
        self._surface = FieldsWriter(
            directory / layout.SURFACE,
            simulation.surface(),
            point_fields=SURFACE_POINT_FIELDS,
            cell_fields=SURFACE_CELL_FIELDS,
        )
        self._audit = AuditWriter(directory / layout.AUDIT) if scenario.output.audit else None
        self._reports = scenario.output.report
        self._start = perf_counter()
        self._last_frame: float | None = None

    @uninterrupted()
    def history(self) -> None:
        """Write the rows recorded since the last call."""
        self._history.append(self._simulation.take_history())
        self._ledger.append(self._simulation.take_ledger())

    @uninterrupted()
    def frame(self) -> None:
        """Write the fields of the current state, once, and the step that led to it."""
        self._frame(with_step=True)

    def _frame(self, *, with_step: bool) -> None:
        time = self._simulation.time
        if time == self._last_frame:
            return
        self._fields.append(time, self._simulation.fields())
        self._surface.append(time, self._simulation.surface_fields())
        self._last_frame = time
        if self._audit is not None and with_step:
            step = self._simulation.last_step()
            if step is not None:
                self._audit.append(step)

    @uninterrupted()
    def failed_problem(
        self, problem: Problem, *, guess: NDArray[np.float64] | None, reason: str
    ) -> Path:
        """Write the contact problem that a step could not solve, as an FCLIB file; return which."""
        from carom.friction import write  # noqa: PLC0415 (SciPy, which most runs do without)

        path = self._directory / layout.FAILED_PROBLEM
        write(problem, path, guess=guess, title=self._title, description=reason)
        return path

    @uninterrupted()
    def close(self, *, status: str, reason: str | None = None) -> Result:
        """Write the last state, the summary, the plots, and the report if the case wants one.

        Parameters
        ----------
        status
            ``"completed"``, ``"uncertified"``, ``"failed"`` or ``"interrupted"``.
        reason
            Why the run stopped before its end.
        """
        wall = perf_counter() - self._start
        self._simulation.finish()
        self.history()
        # A step that failed has overwritten the start of the last good one.
        self._frame(with_step=status != "failed")
        native = self._simulation.summary()
        summary = {
            "status": status,
            **({"reason": reason} if reason else {}),
            "title": self._title,
            "version": _carom.__version__,
            **native,
            "wall_s": wall,
            "wall_s_per_step": wall / max(native["steps"], 1),
        }
        write_summary(self._directory / layout.SUMMARY, summary)
        result = Result.open(self._directory)
        draw(result)
        if self._reports:
            write_report(self._directory)
        return result
