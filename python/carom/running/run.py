"""Running a scenario."""

from __future__ import annotations

import errno
import math
import re
import shlex
import shutil
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, nullcontext
from functools import partial
from pathlib import Path
from time import perf_counter
from typing import Any

from carom._carom import Simulation
from carom.building.build import build
from carom.building.checking import first_doubts
from carom.building.identity import identity
from carom.case.contact import FrictionSolver
from carom.case.scenario import Scenario
from carom.errors import (
    CertificateError,
    ConvergenceError,
    InputError,
    PenetrationError,
    StorageError,
)
from carom.io import layout
from carom.io.checkpoint import Checkpoint
from carom.io.claim import claimed
from carom.mesh_file import Note
from carom.ranks.engine import Engine, engine_named, in_turn
from carom.results.doubts import Doubt, warn, written_doubts
from carom.results.penetration import depth_of, too_deep
from carom.results.result import Result
from carom.running.following import Following, Leading
from carom.running.observer import Observer, ObserverError, Observing, Stop
from carom.running.recorder import Recorder
from carom.running.restart import Notify, ended, latest, refuse_other_results
from carom.running.schedule import Schedule
from carom.running.state import State
from carom.system.interrupt import Terminated
from carom.system.progress import Pace, Progress, ShowProgress

SLICE = 0.1
"""Wall time after which native stepping returns to show its progress [s]."""


def run(
    scenario: Scenario,
    *,
    out: str | Path | None = None,
    observers: Sequence[Observer] = (),
    progress: ShowProgress | None = None,
    resume: bool = False,
    force: bool = False,
    engine: str | None = None,
) -> Result:
    """Run a scenario and write its results.

    Parameters
    ----------
    scenario
        What to run.
    out
        Results directory; by default one in ``results/`` that is named after the title.
    observers
        What looks at the run as it goes, and may raise `Stop`: the results up to there are written,
        with the status ``"stopped"``, and a checkpoint.
    progress
        Called with the `Progress` of the run every tenth of a second or so.
    resume
        Whether to go on from the last checkpoint in the directory; every number is then that of a
        run that never stopped. Without one the run starts from the beginning, and where it has
        ended already its results are returned.
    force
        Whether results of an earlier run in the directory are replaced; otherwise they are refused.
    engine
        ``"petsc"`` shares the cells of bodies among all processes that ``mpiexec`` has started with
        this script, which all call this; the first writes the results. None runs in this one.

    Raises
    ------
    InputError
        The scenario cannot be run, or not there; nothing is written.
    ConvergenceError
        A step failed; the results up to it are written, with the status ``"failed"``. If it was
        the contact problem, that is written too, and the message names the command that solves it
        again on its own.
    CertificateError
        A step was further from Coulomb's law than `Contact.certificate_tolerance` allows; the
        results are written, with the status ``"uncertified"``.
    PenetrationError
        Something was deeper in something else than `Contact.penetration_tolerance` allows; the
        results are written, with the status ``"intersecting"``.
    StorageError
        The results cannot be written, as on a full disk; the last checkpoint stays.
    KeyboardInterrupt
        Ctrl-C; the results up to it are written, with the status ``"interrupted"``, and a
        checkpoint.
    """
    notes: list[Note] = []
    ranks = None if engine is None else engine_named(engine)
    simulation = build(scenario, notes, engine=ranks)
    directory = Path("results") / _slug(scenario.title) if out is None else Path(out)
    return drive(
        simulation,
        scenario,
        directory,
        observers=observers,
        progress=progress,
        resume=resume,
        force=force,
        notes=notes,
        engine=ranks,
    )


def drive(
    simulation: Simulation,
    scenario: Scenario,
    directory: Path,
    *,
    observers: Sequence[Observer] = (),
    progress: ShowProgress | None = None,
    resume: bool = False,
    force: bool = False,
    notes: Sequence[Note] = (),
    notify: Notify = warn,
    engine: Engine | None = None,
) -> Result:
    """Take a simulation to its end, recording as it goes; see `run`.

    Parameters
    ----------
    simulation
        What `build` made of the scenario.
    notes
        What `build` did to meshes.
    notify
        Told of every doubt as it arises, see `carom.results.doubts`; of those that the results give
        rise to after they are written.
    engine
        The ranks that share the bodies of the simulation; the first of them writes.
    """
    is_foreign = any(body.kind == "foreign" for body in scenario.bodies)
    if resume and is_foreign:
        raise InputError(
            "resume: a run with a body of another code does not go on where it stopped, as no file "
            "holds its law; start again with force=True"
        )
    leads = engine is None or engine.rank == 0
    # The others look at the directory before the first rank makes it, or once it has.
    wait = engine.wait if engine is not None else lambda: None
    wait()
    with _storing(directory), claimed(directory) if leads else nullcontext():
        wait()
        has_results = layout.has_results(directory)
        case = identity(scenario, simulation)
        checkpoint = None
        noted: list[Doubt] = []
        if resume:
            result = in_turn(engine, lambda: ended(directory, scenario))
            if result is not None:
                for doubt in written_doubts(result.summary):
                    notify(doubt)
                return result
            checkpoint = latest(directory, case, simulation, noted.append)
            if checkpoint is None:
                refuse_other_results(directory, scenario)
        elif has_results and not force:
            raise InputError(
                f"{directory}: has results of a run; --force replaces them, --resume goes on with "
                "a run that was stopped (force=True, resume=True in Python), or choose another "
                "--out"
            )
        frames = 0 if checkpoint is None else checkpoint.record["frames_due"]
        schedule = Schedule(scenario, time=simulation.time, frames=frames)
        observing = Observing(observers, State(scenario, simulation)) if observers else None
        wait()
        with _recorder(
            directory,
            scenario,
            simulation,
            case=case,
            checkpoint=checkpoint,
            notify=notify,
            engine=engine,
        ) as recorder:
            before = [] if checkpoint is None else written_doubts(checkpoint.record)
            first = first_doubts(scenario, simulation.describe(), notes)
            for doubt in (*before, *first, *noted):
                recorder.doubt(doubt)
            wish = _take(
                simulation,
                scenario,
                recorder,
                schedule,
                observing=observing,
                progress=progress,
                engine=engine,
            )
            if (reason := _violation(simulation)) is not None:
                recorder.close(status="uncertified", reason=reason)
                raise CertificateError(reason)
            if (reason := _intersection(simulation, scenario)) is not None:
                recorder.close(status="intersecting", reason=reason)
                raise PenetrationError(reason)
            if wish is not None and not schedule.has_ended:
                return recorder.close(
                    status="stopped", reason=f"{wish} at t = {simulation.time:g} s"
                )
            return recorder.close(status="completed")


def _recorder(
    directory: Path,
    scenario: Scenario,
    simulation: Simulation,
    *,
    case: dict[str, Any],
    checkpoint: Checkpoint | None,
    notify: Notify,
    engine: Engine | None,
) -> Recorder | Following:
    """Return what writes the results, or follows the rank that does."""
    if engine is not None and engine.rank > 0:
        return Following(
            directory,
            simulation,
            engine,
            keeps_steps=scenario.output.audit,
            last_frame=None if checkpoint is None else checkpoint.record["last_frame"],
        )
    writer = Recorder if engine is None else partial(Leading, engine=engine)
    return writer(directory, scenario, simulation, case=case, checkpoint=checkpoint, notify=notify)


class _Reporter:
    """Tells of a run how far it is: in its history, to other processes, to whoever asked."""

    def __init__(
        self,
        simulation: Simulation,
        recorder: Recorder | Following,
        *,
        end_time: float,
        progress: ShowProgress | None,
    ) -> None:
        self._simulation, self._recorder = simulation, recorder
        self._end_time, self._progress = end_time, progress
        self._pace = Pace(simulation.step, simulation.steps)
        self._last = -math.inf

    @property
    def is_due(self) -> bool:
        """Whether nothing was told for a while."""
        return perf_counter() - self._last >= SLICE

    def report(self) -> None:
        simulation = self._simulation
        self._recorder.history()
        now = Progress(
            steps=simulation.steps,
            end_time=self._end_time,
            wall=self._recorder.wall,
            eta=self._pace.eta(simulation.step),
            **simulation.progress(),
        )
        self._recorder.progress(now)
        if self._progress is not None:
            try:
                self._progress(now)
            except Stop:
                raise
            except Exception as error:  # as of an observer: what there is of the run is kept
                raise ObserverError(error) from error
        self._last = perf_counter()


def _take(
    simulation: Simulation,
    scenario: Scenario,
    recorder: Recorder | Following,
    schedule: Schedule,
    *,
    observing: Observing | None,
    progress: ShowProgress | None,
    engine: Engine | None,
) -> Stop | None:
    """Go to the end or until an observer wants to stop, and keep what there is if that fails."""

    def keep() -> None:
        """Write all that it takes to go on from here."""
        if schedule.frame_is_due(simulation.time):
            recorder.frame()
        recorder.checkpoint(frames_due=schedule.frames)

    reporter = _Reporter(simulation, recorder, end_time=scenario.end_time, progress=progress)
    try:
        with nullcontext() if engine is None else engine.listening():
            _go(simulation, recorder, schedule, reporter, observing=observing, engine=engine)
    except ConvergenceError as error:
        if error.problem is not None:
            file = recorder.failed_problem(error.problem, guess=error.guess, reason=str(error))
            error.args = (f"{error}; {_replay(file, scenario.contact.solver)}",)
        recorder.close(status="failed", reason=str(error))
        raise
    except KeyboardInterrupt as interrupt:
        keep()
        what = "SIGTERM" if isinstance(interrupt, Terminated) else "Ctrl-C"
        recorder.close(status="interrupted", reason=f"{what} at t = {simulation.time:g} s")
        raise
    except ObserverError as failure:
        keep()
        raised = failure.error
        what = f"an observer raised {type(raised).__name__} at t = {simulation.time:g} s: {raised}"
        recorder.close(status="interrupted", reason=what)
        raise
    except Stop as stop:
        keep()
        return stop
    return None


def _go(
    simulation: Simulation,
    recorder: Recorder | Following,
    schedule: Schedule,
    reporter: _Reporter,
    *,
    observing: Observing | None,
    engine: Engine | None,
) -> None:
    """Go from frame to frame, from checkpoint to checkpoint and from look to look to the end."""
    if simulation.step == 0:
        recorder.frame()
        if observing is not None:
            observing.look(starts=True)
    reporter.report()
    while not schedule.has_ended:
        until = schedule.next if observing is None else min(schedule.next, observing.next)
        # Ranks stop to look at one another after the same steps, and not after the same time.
        is_reached = simulation.advance(until, SLICE if engine is None else 0.0)
        if engine is not None:
            engine.look()
        has_frame = schedule.frame_is_due(simulation.time)
        if has_frame:
            recorder.frame()
        if observing is not None:
            observing.look()
        if has_frame or not is_reached or reporter.is_due:
            reporter.report()
        if schedule.checkpoint_is_due(simulation.time) or schedule.wall_checkpoint_is_due():
            recorder.checkpoint(frames_due=schedule.frames)


_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
"""Numbers of errors of a file for which there is no room."""

_LITTLE = 2**20
"""Room on a disk that is as good as full [bytes]."""


@contextmanager
def _storing(directory: Path) -> Iterator[None]:
    """Say of a file that could not be written how to go on; those of observers are their own."""
    try:
        yield
    except ObserverError as failure:
        raise failure.error from failure.error.__cause__
    except OSError as error:
        what = f"{error.filename or directory}: {error.strerror or error}"
        mend = "make room" if _is_full(error, directory) else "see to it"
        remedy = f"{mend} and start again"
        if (directory / layout.CHECKPOINT).exists():
            remedy = f"the last checkpoint is whole: {mend} and go on with --resume"
        raise StorageError(f"{what}; {remedy}") from error


def _is_full(error: OSError, directory: Path) -> bool:
    """Return whether there is no room for a file; HDF5 gives no number with some of its errors."""
    if error.errno is not None:
        return error.errno in _FULL
    if (number := re.search(r"errno = (\d+)", str(error))) is not None:
        return int(number[1]) in _FULL
    return shutil.disk_usage(directory).free < _LITTLE


def _replay(file: Path, solver: FrictionSolver) -> str:
    """Return where a contact problem is and how to solve it again."""
    return (
        f"the problem is in {file}, solve it again with: carom friction solve "
        f"{shlex.quote(str(file))} --warm --solver {solver.kind} "
        f"--tolerance {solver.tolerance!r} --max-iterations {solver.max_iterations}"
    )


def _violation(simulation: Simulation) -> str | None:
    """Return why a run is not certified, if it is not."""
    certificate = simulation.summary()["certificate"]
    worst, allowed = certificate["max_joule"], certificate["tolerance_joule"]
    if worst <= allowed:
        return None
    by_solver = certificate["solver_joule"] >= 0.5 * worst
    remedy = "contact.solver.tolerance" if by_solver else "analysis.newton.tolerance"
    return (
        f"a step was {worst:.3g} J from Coulomb's law, more than the {allowed:.3g} J of "
        f"contact.certificate_tolerance; take a smaller {remedy}"
    )


def _intersection(simulation: Simulation, scenario: Scenario) -> str | None:
    """Return who went into whom, if somebody went deeper than is allowed."""
    worst = too_deep(simulation.summary())
    return None if worst is None else depth_of(worst, scenario)


def _slug(title: str) -> str:
    """Return a title as a directory name."""
    return re.sub(r"\W+", "-", title.lower()).strip("-") or "run"
