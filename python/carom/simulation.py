"""Running a scenario."""

from __future__ import annotations

import json
import re
import shlex
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from carom._carom import Simulation
from carom.contact import FrictionSolver
from carom.errors import CertificateError, ConvergenceError, InputError, StorageError
from carom.interrupt import Terminated
from carom.io import layout
from carom.io.progress import refuse_running
from carom.leaps import refuse_leaps
from carom.mesh import MeshFile
from carom.mesh_file import MeshArrays, read_body_mesh, read_surface
from carom.obstacle import RigidSurface
from carom.progress import Observer, Pace, Progress
from carom.recorder import Recorder
from carom.restart import Notify, ended, identity, latest, refuse_other_results
from carom.result import Result
from carom.scenario import Scenario
from carom.schedule import Schedule

SLICE = 0.1
"""Wall time after which native stepping returns to show its progress [s]."""


def build(scenario: Scenario) -> Simulation:
    """Build meshes, matrices and the initial state.

    Raises
    ------
    InputError
        The scenario cannot be run, such as bodies that overlap at the start.
    """
    simulation = Simulation(_json(scenario), _meshes(scenario))
    refuse_leaps(scenario, simulation.describe())
    return simulation


def _json(scenario: Scenario) -> str:
    """Return the scenario as the native core reads it, the triangles of obstacles included."""
    data = json.loads(scenario.to_json())
    for index, obstacle in enumerate(scenario.obstacles):
        if isinstance(obstacle, RigidSurface):
            key = f"obstacles.{index}"
            surface = read_surface(obstacle.file, scale=obstacle.scale, key=key)
            data["obstacles"][index]["vertices"] = surface.points.tolist()
            data["obstacles"][index]["triangles"] = surface.triangles.tolist()
    return json.dumps(data)


def _meshes(scenario: Scenario) -> dict[str, MeshArrays]:
    """Read the meshes of the bodies that have theirs in a file."""
    return {
        body.name: read_body_mesh(
            body.mesh.file,
            body=body.mesh.body,
            scale=body.mesh.scale,
            space=scenario.dimension,
            key=f"bodies.{index}.mesh",
        )
        for index, body in enumerate(scenario.bodies)
        if isinstance(body.mesh, MeshFile)
    }


def run(
    scenario: Scenario,
    *,
    out: str | Path | None = None,
    observer: Observer | None = None,
    resume: bool = False,
    force: bool = True,
) -> Result:
    """Run a scenario and write its results.

    Parameters
    ----------
    scenario
        What to run.
    out
        Results directory; by default one in ``results/`` that is named after the title.
    observer
        Called with the `Progress` of the run.
    resume
        Whether to go on from the last checkpoint in the directory; every number is then that of a
        run that never stopped. Without one the run starts from the beginning, and where it has
        ended already its results are returned.
    force
        Whether results of an earlier run in the directory are replaced, or refused.

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
    StorageError
        The results cannot be written, as on a full disk; the last checkpoint stays.
    KeyboardInterrupt
        Ctrl-C; the results up to it are written, with the status ``"interrupted"``, and a
        checkpoint.
    """
    simulation = build(scenario)
    directory = Path("results") / _slug(scenario.title) if out is None else Path(out)
    return drive(simulation, scenario, directory, observer, resume=resume, force=force)


def _warn(line: str) -> None:
    warnings.warn(line, stacklevel=4)


def drive(
    simulation: Simulation,
    scenario: Scenario,
    directory: Path,
    observer: Observer | None,
    *,
    resume: bool = False,
    force: bool = True,
    notify: Notify = _warn,
) -> Result:
    """Take a simulation to its end, recording as it goes; see `run`.

    Parameters
    ----------
    simulation
        What `build` made of the scenario.
    notify
        Told what the user should know of a resumed run.
    """
    refuse_running(directory)
    case = identity(scenario, simulation)
    checkpoint = None
    if resume:
        if (result := ended(directory, scenario)) is not None:
            return result
        checkpoint = latest(directory, case, simulation, notify)
        if checkpoint is None:
            refuse_other_results(directory, scenario)
    elif not force and layout.has_results(directory):
        raise InputError(
            f"{directory}: has results of a run; --force replaces them, --resume goes on with a "
            "run that was stopped, or choose another --out"
        )
    frames = 0 if checkpoint is None else checkpoint.record["frames_due"]
    schedule = Schedule(scenario, time=simulation.time, frames=frames)
    with (
        _storing(directory),
        Recorder(directory, scenario, simulation, case=case, checkpoint=checkpoint) as recorder,
    ):
        _take(simulation, scenario, recorder, schedule, observer)
        if (reason := _violation(simulation)) is not None:
            recorder.close(status="uncertified", reason=reason)
            raise CertificateError(reason)
        return recorder.close(status="completed")


def _take(
    simulation: Simulation,
    scenario: Scenario,
    recorder: Recorder,
    schedule: Schedule,
    observer: Observer | None,
) -> None:
    """Go from frame to frame and from checkpoint to checkpoint to the end."""
    pace = Pace(simulation.step, simulation.steps)

    def report() -> None:
        recorder.history()
        progress = Progress(
            steps=simulation.steps,
            end_time=scenario.analysis.end_time,
            wall=recorder.wall,
            eta=pace.eta(simulation.step),
            **simulation.progress(),
        )
        recorder.progress(progress)
        if observer is not None:
            observer(progress)

    try:
        if simulation.step == 0:
            recorder.frame()
        report()
        while not schedule.has_ended:
            while not simulation.advance(schedule.next, SLICE):
                report()
                if schedule.wall_checkpoint_is_due():
                    recorder.checkpoint(frames_due=schedule.frames)
            if schedule.frame_is_due(simulation.time):
                recorder.frame()
            report()
            if schedule.checkpoint_is_due(simulation.time):
                recorder.checkpoint(frames_due=schedule.frames)
    except ConvergenceError as error:
        if error.problem is not None:
            file = recorder.failed_problem(error.problem, guess=error.guess, reason=str(error))
            error.args = (f"{error}; {_replay(file, scenario.contact.solver)}",)
        recorder.close(status="failed", reason=str(error))
        raise
    except KeyboardInterrupt as interrupt:
        if schedule.frame_is_due(simulation.time):
            recorder.frame()
        recorder.checkpoint(frames_due=schedule.frames)
        what = "SIGTERM" if isinstance(interrupt, Terminated) else "Ctrl-C"
        recorder.close(status="interrupted", reason=f"{what} at t = {simulation.time:g} s")
        raise


@contextmanager
def _storing(directory: Path) -> Iterator[None]:
    """Say of a file that could not be written how to go on."""
    try:
        yield
    except OSError as error:
        what = f"{error.filename or directory}: {error.strerror or error}"
        remedy = "make room and start again"
        if (directory / layout.CHECKPOINT).exists():
            remedy = "the last checkpoint is whole: make room and go on with --resume"
        raise StorageError(f"{what}; {remedy}") from error


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
    return (
        f"a step was {worst:.3g} J from Coulomb's law, more than the {allowed:.3g} J of "
        "contact.certificate_tolerance; take a smaller contact.solver.tolerance or "
        "analysis.newton.tolerance, or a shorter step"
    )


def _slug(title: str) -> str:
    """Return a title as a directory name."""
    return re.sub(r"\W+", "-", title.lower()).strip("-") or "run"
