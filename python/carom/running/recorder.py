"""The files of one run, written while it goes."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

from typing_extensions import Self

from carom import _carom
from carom.building.materials import with_materials
from carom.case.scenario import Scenario
from carom.io import layout
from carom.io.atomic import sync, write_whole
from carom.io.audit import AuditWriter
from carom.io.checkpoint import Checkpoint, write_checkpoint, write_end_state
from carom.io.digest import digest
from carom.io.frame_queue import Frame, FrameQueue
from carom.io.frames import Frames
from carom.io.history import HistoryWriter
from carom.io.ledger import LedgerWriter
from carom.io.progress import ProgressFile
from carom.io.summary import write_summary
from carom.io.vtkhdf import SURFACE_CELL_FIELDS, SURFACE_POINT_FIELDS, FieldsWriter
from carom.results.doubts import Doubt, doubts, written_doubts
from carom.results.fields import Fields, parts
from carom.results.result import Result
from carom.results.turning import Turning
from carom.system.interrupt import uninterrupted
from carom.system.progress import Progress

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from carom.friction import Problem


class Recorder:
    """Writes the results directory of one run, in place of those of an earlier one or after it.

    Ctrl-C waits until what is being written is whole. Whenever a process is killed, the files are
    those of its last checkpoint with more behind, which a run that goes on cuts off.

    Parameters
    ----------
    directory
        Directory to write, which the run has for itself, see `carom.io.claim`.
    scenario
        What is run.
    simulation
        The simulation to record, at its start or where `checkpoint` was made.
    case
        What is run, see `carom.running.restart.identity`.
    checkpoint
        The one that the run goes on from; None if it starts.
    notify
        Told of every doubt, once: what is found at the end after the summary was written.

    Raises
    ------
    InputError
        The directory has files of others, or not the results that the checkpoint knows of.
    """

    def __init__(
        self,
        directory: Path,
        scenario: Scenario,
        simulation: _carom.Simulation,
        *,
        case: dict[str, Any],
        checkpoint: Checkpoint | None = None,
        notify: Callable[[Doubt], None],
    ) -> None:
        self._progress = ProgressFile(directory)
        self._directory = directory
        self._scenario = scenario
        self._simulation = simulation
        self._case = case
        # What a body of another code remembers is not known.
        self._goes_on = all(body.kind != "foreign" for body in scenario.bodies)
        written: dict[str, Any] = {} if checkpoint is None else checkpoint.record
        if checkpoint is None:
            layout.clear(directory)
            text = scenario.to_toml(complete=True)
            write_whole(directory / layout.CASE, text.encode())
        else:
            layout.forget_outcome(directory)
        self._history = HistoryWriter(
            directory / layout.HISTORY, simulation.history_columns(), size=written.get("history")
        )
        self._ledger = LedgerWriter(
            directory / layout.LEDGER, simulation.ledger_entry, size=written.get("ledger")
        )
        self._queue = FrameQueue(
            FieldsWriter(
                directory / layout.FIELDS,
                with_materials(simulation.mesh(), scenario),
                frames=written.get("frames"),
            ),
            FieldsWriter(
                directory / layout.SURFACE,
                simulation.surface(),
                point_fields=SURFACE_POINT_FIELDS,
                cell_fields=SURFACE_CELL_FIELDS,
                frames=written.get("frames"),
            ),
            AuditWriter(directory / layout.AUDIT, steps=written.get("steps"))
            if scenario.output.audit
            else None,
        )
        self._frames: int = written.get("frames", 0)
        self._steps: int = written.get("steps", 0)
        self._last_frame: float | None = written.get("last_frame")
        self._wall_before: float = written.get("wall", 0.0)
        self._doubts: list[Doubt] = []
        self._turning = Turning(scenario, simulation, written_doubts(written))
        self._notify = notify
        self._start = perf_counter()

    @property
    def wall(self) -> float:
        """Wall time of the run so far [s]."""
        return self._wall_before + perf_counter() - self._start

    def doubt(self, doubt: Doubt) -> None:
        """Take note of something that a user should know of, once."""
        if doubt not in self._doubts:
            self._doubts.append(doubt)
            self._notify(doubt)

    @uninterrupted()
    def progress(self, progress: Progress) -> None:
        """Let other processes know how far the run is."""
        self._queue.write_due()
        self._progress.write(progress)

    @uninterrupted()
    def checkpoint(self, *, frames_due: int) -> None:
        """Write all that it takes to go on from here.

        Parameters
        ----------
        frames_due
            Frames that were due so far, see `carom.running.schedule.Schedule`.

        Raises
        ------
        OSError
            It could not be written; the last one is as it was.
        """
        if not self._goes_on:
            return
        self.history()
        self._queue.flush()
        names = [layout.HISTORY, layout.LEDGER, layout.FIELDS, layout.SURFACE]
        for name in [*names, layout.AUDIT] if self._queue.keeps_steps else names:
            sync(self._directory / name)
        try:
            checkpoint = self._made(frames_due)
        except ValueError as error:
            what = f"no checkpoint at t = {self._simulation.time:g} s: {error}"
            self.doubt(Doubt("checkpoint-not-made", what, layout.CHECKPOINT))
            return
        write_checkpoint(self._directory, checkpoint)

    def _made(self, frames_due: int) -> Checkpoint:
        """Return the run as it is now.

        Raises
        ------
        ValueError
            That is no state to go on from.
        """
        record = {
            "history": (self._directory / layout.HISTORY).stat().st_size,
            "ledger": (self._directory / layout.LEDGER).stat().st_size,
            "frames": self._frames,
            "steps": self._steps,
            "last_frame": self._last_frame,
            "frames_due": frames_due,
            "wall": self.wall,
            "warnings": [doubt.as_summary() for doubt in self._doubts],
        }
        return Checkpoint(case=self._case, record=record, arrays=self._simulation.checkpoint())

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        try:
            self._queue.close()
        finally:
            self._progress.remove()

    @uninterrupted()
    def history(self) -> None:
        """Write the rows recorded since the last call."""
        self._history.append(self._simulation.take_history())
        self._ledger.append(self._simulation.take_ledger())

    @uninterrupted()
    def frame(self) -> None:
        """Take the fields of the current state, once, and the step that led to it, to be written.

        Raises
        ------
        OSError
            Frames could not be written, these or some before.
        """
        self._frame(with_step=True)

    def _frame(self, *, with_step: bool) -> None:
        time = self._simulation.time
        if time == self._last_frame:
            return
        frame = taken(self._simulation, with_step=with_step and self._queue.keeps_steps)
        self._queue.put(frame)
        for doubt in self._turning.look(frame.fields["displacement"], time):
            self.doubt(doubt)
        self._last_frame = time
        self._frames += 1
        self._steps += frame.step is not None

    @uninterrupted()
    def failed_problem(
        self, problem: Problem, *, guess: NDArray[np.float64] | None, reason: str
    ) -> Path:
        """Write the contact problem that a step could not solve, as an FCLIB file; return which."""
        from carom.friction import write  # noqa: PLC0415 (SciPy, which most runs do without)

        path = self._directory / layout.FAILED_PROBLEM
        write(problem, path, guess=guess, title=self._scenario.title, description=reason)
        return path

    @uninterrupted()
    def close(self, *, status: str, reason: str | None = None) -> Result:
        """Write the last state, the summary, the plots, and the report if the case wants one.

        Parameters
        ----------
        status
            ``"completed"``, ``"uncertified"``, ``"intersecting"``, ``"stopped"``, ``"failed"`` or
            ``"interrupted"``.
        reason
            Why the run stopped before its end.
        """
        wall = self.wall
        self._simulation.finish()
        self.history()
        # A step that failed has overwritten the start of the last good one.
        self._frame(with_step=status != "failed")
        self._queue.flush()
        if status == "completed" and self._goes_on:
            self._end_state()
        if self._scenario.output.modes is not None:
            self._split_over_modes(self._scenario.output.modes)
        native = self._simulation.summary()
        summary = {
            "status": status,
            **({"reason": reason} if reason else {}),
            "title": self._scenario.title,
            "version": _carom.__version__,
            **native,
            "files": {name: digest(self._directory / name) for name in layout.DIGESTED},
            "wall_s": wall,
            "wall_s_per_step": wall / max(native["steps"], 1),
        }
        found = written_doubts(native)
        found += doubts(summary, self._scenario)
        new = [doubt for doubt in dict.fromkeys(found) if doubt not in self._doubts]
        summary["warnings"] = [doubt.as_summary() for doubt in (*self._doubts, *new)]
        write_summary(self._directory / layout.SUMMARY, summary)
        result = conclude(self._directory, reports=self._scenario.output.report)
        for doubt in new:
            self._notify(doubt)
        return result

    def _split_over_modes(self, count: int) -> None:
        """Write how much of the energy each mode has, frame by frame."""
        from scipy.linalg import LinAlgError  # noqa: PLC0415 (which most runs do without)
        from scipy.sparse.linalg import ArpackError  # noqa: PLC0415

        from carom.modes.split import split  # noqa: PLC0415
        from carom.modes.table import modes_csv  # noqa: PLC0415

        frames, scenario = Frames(self._directory / layout.FIELDS), self._scenario
        whose = parts(frames, [body.name for body in scenario.bodies])
        fields = Fields(frames, whose, dimension=scenario.dimension)
        try:
            energies = split(fields, scenario, self._simulation, count)
        except (ArpackError, LinAlgError, MemoryError, RuntimeError) as error:
            what = f"modes were not found: {error}; ask for fewer, or mesh less finely"
            self.doubt(Doubt("modes-not-found", what, "output.modes", count))
            return
        write_whole(self._directory / layout.MODES, modes_csv(energies.values()).encode())

    def _end_state(self) -> None:
        """Write the state from which other cases may go on."""
        try:
            end = self._made(self._frames)
        except ValueError as error:
            what = f"no state at the end for others to go on from: {error}"
            self.doubt(Doubt("end-state-not-made", what, layout.END_STATE))
            return
        write_end_state(self._directory, end)


def taken(simulation: _carom.Simulation, *, with_step: bool) -> Frame:
    """Return the fields of the current state, and the step that led to it if it is wanted.

    Of bodies that ranks share, all of them have a part in it.
    """
    step = simulation.last_step() if with_step else None
    return Frame(simulation.time, simulation.fields(), simulation.surface_fields(), step)


def draw(result: Result) -> None:
    """Draw the pictures that every run has."""
    from carom import plot  # noqa: PLC0415 (Matplotlib takes longer to import than the rest)

    plot.draw(result)


def conclude(directory: Path, *, reports: bool) -> Result:
    """Make what is made of a run with a summary, and remove what it needs no more."""
    result = Result.open(directory)
    draw(result)
    if reports:
        from carom.report import write_report  # noqa: PLC0415 (as above)

        write_report(directory)
    if result.summary["status"] in layout.ENDED:
        for name in layout.CHECKPOINTS:
            (directory / name).unlink(missing_ok=True)
    (directory / layout.PROGRESS).unlink(missing_ok=True)
    return result
