"""The contact problems of a run: the one that failed, and what a second solver says of all."""

import shlex
from typing import get_args

import numpy as np
import pytest

import carom
from carom import cli
from carom.building.build import build
from carom.case.contact import SolverName


@pytest.fixture
def drop(box):
    """A disc that falls askew on a floor with friction, from just above it."""
    box["analysis"] = {"kind": "dynamic", "end_time": 0.1, "time_step": 1e-3}
    box["bodies"] = [{**box["bodies"][0], "velocity": [1.0, -2.0]}]
    box["bodies"][0]["mesh"] |= {"centre": [2.0, 1.01], "divisions": 6}
    box["contact"] = {"friction": 0.2, "solver": {"tolerance": 1e-12}}
    del box["output"]
    return carom.Scenario.from_dict(box)


@pytest.fixture
def stopped(drop):
    """The same with a solver that is given one sweep, where several contacts need more."""
    return drop.with_overrides(["contact.solver.max_iterations=1"])


def test_case_files_know_every_solver():
    assert set(get_args(SolverName)) == set(carom.friction.SOLVERS)


@pytest.mark.parametrize("solver", carom.friction.SOLVERS)
def test_every_solver_takes_the_drop_to_the_same_energy(drop, solver):
    energies = []
    for kind in ("gauss-seidel", solver):
        simulation = build(drop.with_overrides([f"contact.solver.kind={kind}"]))
        while not simulation.advance(1.0, 60.0):
            pass
        energies.append(simulation.summary()["energy"])
    assert energies[0]["friction"] > 1e-3
    for term in ("final", "friction"):
        assert energies[1][term] == pytest.approx(energies[0][term], rel=1e-6)


def test_a_failed_contact_problem_travels_with_the_error(stopped):
    simulation = build(stopped)
    with pytest.raises(carom.ConvergenceError) as caught:
        simulation.advance(1.0, 60.0)
    error = caught.value
    said = error.report["friction"]
    assert (said["status"], said["iterations"]) == ("iteration-limit", 1)
    assert error.problem.dimension == 2
    assert error.problem.contacts > 1
    assert error.guess.shape == error.problem.q.shape
    replay = carom.friction.solve(
        error.problem, solver="auto", tolerance=1e-12, max_iterations=1, guess=error.guess
    )
    assert (replay.status, replay.iterations) == (said["status"], said["iterations"])
    assert replay.natural_residual == said["natural_residual"] > 1e-12
    np.testing.assert_array_equal(error.problem.mu, 0.2)


def test_what_else_fails_has_no_contact_problem(drop):
    hopeless = drop.with_overrides(["analysis.newton.max_iterations=1", "bodies.0.spin=30"])
    with pytest.raises(carom.ConvergenceError, match="Newton") as caught:
        build(hopeless).advance(1.0, 60.0)
    assert caught.value.problem is None
    assert caught.value.guess is None
    assert "friction" not in caught.value.report


def test_the_command_in_the_reason_ends_as_the_step_did(stopped, tmp_path, capsys):
    with pytest.raises(carom.ConvergenceError):
        carom.run(stopped, out=tmp_path / "a b")
    reason = carom.Result.open(tmp_path / "a b").summary["reason"]
    program, *arguments = shlex.split(reason.partition("solve it again with: ")[2])
    assert program == "carom"
    for limits, statuses in (
        ([], ("iteration-limit", 3)),
        (["--max-iterations=99"], ("solved", 0)),
    ):
        with pytest.raises(SystemExit) as caught:
            cli.app([*arguments, *limits], prog_name="carom")
        assert statuses[0] in capsys.readouterr().out
        assert (caught.value.code or 0) == statuses[1]


def test_a_second_solver_agrees_and_changes_no_digit(drop, tmp_path):
    alone = carom.run(drop, out=tmp_path / "alone")
    checked = carom.run(
        drop.with_overrides(["contact.solver.cross_check=true"]), out=tmp_path / "checked"
    )
    assert alone.summary["cross_check"] is None
    said = checked.summary["cross_check"]
    assert said["problems"] > 30
    assert set(said["solvers"]) <= {"proximal", "gauss-seidel"}
    assert sum(said["solvers"].values()) == said["problems"]
    assert (said["unsolved"], said["disagreements"]) == (0, 0)
    assert said["max_difference"] < said["explained_difference"]
    for column, values in alone.history.items():
        np.testing.assert_array_equal(checked.history[column], values)
