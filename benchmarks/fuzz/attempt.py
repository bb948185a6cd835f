"""Handing a file to what the commands do, and judging the answer."""

from __future__ import annotations

import io
import math
import traceback
import warnings
from collections.abc import Callable
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any, TypeVar
from unittest import mock

import typer
from rich.console import Console

import carom
from carom.building.build import build
from carom.case import case_file
from carom.case.scenario import Scenario
from carom.cli.case import load
from carom.cli.failures import BAD_INPUT, NOT_CONVERGED, failures
from carom.cli.friction.problem_file import warnings_named
from carom.cli.watch import watch
from carom.friction import GlobalProblem, read_record, solve
from carom.plot import draw
from carom.report import write_report
from carom.results.result import Result, read_case
from carom.view.subject import subject

LARGE = 3_000
"""Cells above which a case is checked but not built: time goes to many cases, not to large ones."""

STEPS = 2
"""Steps that a case that can be built is run for, as far as they take `BUDGET`."""

BUDGET = 0.05
"""Wall time for them [s]."""

T = TypeVar("T")


class Defect(Exception):  # noqa: N818 (what is looked for)
    """An answer that no user should get."""


def attempt(what: Callable[[T], str], given: T) -> str:
    """Return how input was answered: what it was taken for, or ``"exit 2"`` and so on.

    Raises
    ------
    Defect
        The answer is not one line and a status of bad input, or of no convergence.
    """
    out, err = io.StringIO(), io.StringIO()
    try:
        with redirect_stdout(out), redirect_stderr(err), failures(Path("case")):
            return what(given)
    except typer.Exit as end:
        said, status = err.getvalue(), end.exit_code
        if status not in (BAD_INPUT, NOT_CONVERGED):
            raise Defect(f"exit status {status}: {said}") from end
        *before, last = said.splitlines()
        if not last.startswith("error: ") or not all(b.startswith("warning: ") for b in before):
            raise Defect(f"not one line: {said!r}") from end
        if out.getvalue():
            raise Defect(f"printed: {out.getvalue()!r}") from end
        return f"exit {status}"
    except BaseException as error:  # a panic is no Exception
        if isinstance(error, KeyboardInterrupt):
            raise
        raise Defect("".join(traceback.format_exception(error))) from error


def run_case(file: Path) -> str:
    """Read a case; if it is one and small, build it and run some steps."""
    return _run(load(file, None))


def run_tables(data: dict[str, Any]) -> str:
    """Do the same with a case that has been read already: most of the time goes to reading."""
    return _run(Scenario.from_dict(case_file.with_paths_from(Path.cwd(), data)))


def _run(scenario: Scenario) -> str:
    if _cells(scenario) > LARGE:
        return "large"
    simulation = build(scenario)
    step = scenario.analysis.time_step
    simulation.advance(min(STEPS * step, scenario.analysis.end_time), BUDGET)
    simulation.finish()
    simulation.summary()
    return "taken"


def _cells(scenario: Scenario) -> int:
    """Return about how many cells the generated meshes have, more rather than less."""
    total = 0
    for body in scenario.bodies:
        divisions = getattr(body.mesh, "divisions", 0)
        rings = getattr(body.mesh, "rings", None) or 0
        layers = getattr(body.mesh, "layers", 1)
        if isinstance(divisions, tuple):
            total += math.prod(divisions)
        else:  # an O-grid
            power = 3 if body.mesh.kind == "ball" else 2
            core = divisions**power
            total += (core + 6 * (rings or divisions) * divisions ** (power - 1)) * layers
    return total


def solve_problem(file: Path) -> str:
    """Read a contact problem and try to solve it, as ``carom friction solve`` does."""
    with warnings_named(file):
        problem = read_record(file).problem
    options = {"max_iterations": 50, "time_limit": 0.5}
    solve(problem, **options)
    return "global" if isinstance(problem, GlobalProblem) else "taken"


def build_mesh(file: Path) -> str:
    """Read a mesh as the body or, if it is a surface, as an obstacle of a case, and build that."""
    case: dict[str, Any] = {
        "dimension": 3,
        "analysis": {"kind": "dynamic", "end_time": 1e-6, "time_step": 1e-6},
        "materials": {
            "m": {"kind": "linear-elastic", "young": 1.0, "poisson": 0.3, "density": 1.0}
        },
        "bodies": [{"name": "part", "material": "m", "mesh": {"file": str(file)}}],
    }
    if file.suffix == ".stl":
        far = {"kind": "box", "corner": [9.0, 9.0, 9.0], "size": [1.0] * 3, "divisions": [1] * 3}
        case["bodies"][0]["mesh"] = far
        case["obstacles"] = [{"name": "surface", "kind": "surface", "file": str(file)}]
    simulation = build(Scenario.from_dict(case))
    simulation.advance(1e-6, BUDGET)
    return "taken"


def resume(directory: Path) -> str:
    """Go on from the checkpoint of a run that was stopped, with its own case."""
    with warnings.catch_warnings(), mock.patch("carom.plot.draw"):  # pictures take long
        warnings.simplefilter("ignore")
        carom.run(read_case(directory.parent / "stopped"), out=directory, resume=True)
    return "taken"


def _watch(directory: Path) -> None:
    try:
        watch(directory, every=0.05)
    except typer.Exit as end:
        if end.exit_code not in (0, 3, 130):  # those of how the run ended
            raise


def _view(directory: Path) -> None:
    shown = subject(directory)
    shown.positions(len(shown.frames.times) - 1)


def _print(directory: Path) -> None:
    result = Result.open(directory)
    Console(file=io.StringIO()).print(result)
    repr(result)


READERS: dict[str, Callable[[Path], object]] = {
    "audit": carom.audit,
    "plot": lambda directory: draw(Result.open(directory)),
    "report": write_report,
    "result": _print,
    "view": _view,
    "watch": _watch,
}
"""What reads results, by the name of the command."""


def read_results(given: tuple[str, Path]) -> str:
    """Read results as a command does."""
    reader, directory = given
    READERS[reader](directory)
    return "taken"
