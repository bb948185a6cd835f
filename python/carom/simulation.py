"""Running a scenario."""

from __future__ import annotations

import json
import math
import re
import shlex
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from carom._carom import Simulation
from carom.contact import FrictionSolver
from carom.errors import CertificateError, ConvergenceError
from carom.leaps import refuse_leaps
from carom.mesh import MeshFile
from carom.mesh_file import MeshArrays, read_body_mesh, read_surface
from carom.obstacle import RigidSurface
from carom.recorder import Recorder
from carom.result import Result
from carom.scenario import Scenario

SLICE = 0.1
"""Wall time after which native stepping returns to show its progress [s]."""


@dataclass(frozen=True)
class Progress:
    """How far a run has come.

    Parameters
    ----------
    step, steps
        Steps done and to do.
    time, end_time
        Time reached and to reach [s].
    contacts
        Active contacts.
    kinetic, strain, total
        Energies [J].
    friction
        Energy dissipated by friction so far [J].
    """

    step: int
    steps: int
    time: float
    end_time: float
    contacts: int
    kinetic: float
    strain: float
    total: float
    friction: float


Observer = Callable[[Progress], None]
"""What is called with the progress of a run, every tenth of a second or so."""


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
    scenario: Scenario, *, out: str | Path | None = None, observer: Observer | None = None
) -> Result:
    """Run a scenario and write its results.

    Parameters
    ----------
    scenario
        What to run.
    out
        Results directory; by default one in ``results/`` that is named after the title. Results
        of an earlier run in it are replaced.
    observer
        Called with the `Progress` of the run.

    Raises
    ------
    InputError
        The scenario cannot be run; nothing is written.
    ConvergenceError
        A step failed; the results up to it are written, with the status ``"failed"``. If it was
        the contact problem, that is written too, and the message names the command that solves it
        again on its own.
    CertificateError
        A step was further from Coulomb's law than `Contact.certificate_tolerance` allows; the
        results are written, with the status ``"uncertified"``.
    KeyboardInterrupt
        Ctrl-C; the results up to it are written, with the status ``"interrupted"``.
    """
    simulation = build(scenario)
    directory = Path("results") / _slug(scenario.title) if out is None else Path(out)
    return drive(simulation, scenario, directory, observer)


def drive(
    simulation: Simulation, scenario: Scenario, directory: Path, observer: Observer | None
) -> Result:
    """Take a simulation to its end, recording as it goes."""
    recorder = Recorder(directory, scenario, simulation)

    def report() -> None:
        recorder.history()
        if observer is not None:
            observer(
                Progress(
                    steps=simulation.steps,
                    end_time=scenario.analysis.end_time,
                    **simulation.progress(),
                )
            )

    try:
        recorder.frame()
        report()
        for time in _frame_times(scenario):
            while not simulation.advance(time, SLICE):
                report()
            recorder.frame()
            report()
    except ConvergenceError as error:
        if error.problem is not None:
            file = recorder.failed_problem(error.problem, guess=error.guess, reason=str(error))
            error.args = (f"{error}; {_replay(file, scenario.contact.solver)}",)
        recorder.close(status="failed", reason=str(error))
        raise
    except KeyboardInterrupt:
        recorder.close(status="interrupted", reason=f"Ctrl-C at t = {simulation.time:g} s")
        raise
    if (reason := _violation(simulation)) is not None:
        recorder.close(status="uncertified", reason=reason)
        raise CertificateError(reason)
    return recorder.close(status="completed")


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


def _frame_times(scenario: Scenario) -> Iterator[float]:
    """Yield the times of the frames after the first; the last is the end of the run [s]."""
    end = scenario.analysis.end_time
    every = scenario.output.resolved(scenario.analysis).fields_every or end
    frames = math.ceil(end / every * (1 - 1e-9))  # no frame for a rest that is only round-off
    for frame in range(1, frames):
        yield frame * every
    yield end


def _slug(title: str) -> str:
    """Return a title as a directory name."""
    return re.sub(r"\W+", "-", title.lower()).strip("-") or "run"
