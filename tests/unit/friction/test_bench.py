import csv
import json
import math

import numpy as np
import pytest

from carom import InputError
from carom.friction import Problem, bench, write
from carom.friction.bench.profile import least_times, ratios, shares
from carom.friction.bench.report import CSV, JSON, MARKDOWN


def run(case, solver, time, *, solved=True, claimed=None):
    return bench.Run(
        case=case,
        solver=solver,
        claimed=solved if claimed is None else claimed,
        solved=solved,
        status="solved" if solved else "time-limit",
        time=time,
        iterations=1,
        residual=1e-9 if solved else 1e-3,
        certificate=0.0,
    )


@pytest.fixture
def comparison():
    """Two solvers and a peer on three problems, times by hand."""
    cases = [bench.Case(name, Problem(np.eye(3), np.zeros((1, 3)), [0.1])) for name in "abc"]
    return bench.Comparison(
        cases=cases,
        runs=[
            run("a", "fast", 1e-3),
            run("a", "sure", 2e-3),
            run("b", "fast", 9.0, solved=False),
            run("b", "sure", 4e-3),
            run("c", "fast", 1e-4),
            run("c", "sure", 1e-4, solved=False, claimed=True),
        ],
        peer_runs=[
            run("a", "PEER", 4e-3),
            run("b", "PEER", math.nan, solved=False),
            run("c", "PEER", 2e-4),
        ],
        tolerance=1e-8,
        time_limit=9.0,
    )


def test_profiles_are_shares_within_factors_of_the_least_time(comparison):
    found = ratios(comparison.runs)
    assert found["fast"].tolist() == pytest.approx([1.0, 1.0, math.inf])
    assert found["sure"].tolist() == pytest.approx([1.0, 2.0, math.inf])
    assert shares(found, [1.0, 2.0])["sure"] == pytest.approx([1 / 3, 2 / 3])
    assert least_times(comparison.runs) == {"a": 1e-3, "b": 4e-3, "c": 1e-4}


def test_a_problem_that_nobody_solves_counts_against_all():
    runs = [run("a", "one", 1.0, solved=False), run("a", "two", 2.0, solved=False)]
    assert shares(ratios(runs), [1e300]) == {"one": [0.0], "two": [0.0]}


def test_speed_ups_compare_with_the_virtual_best(comparison):
    assert comparison.speed_ups("fast") == pytest.approx({"a": 4.0, "c": 2.0})
    assert comparison.speed_ups("fast", least_time=1e-3) == pytest.approx({"a": 4.0})
    assert bench.geometric_mean([4.0, 2.0, 1.0]) == pytest.approx(2.0)
    assert math.isnan(bench.geometric_mean([]))


def test_the_report_names_who_claims_what_does_not_hold(comparison):
    assert [r.solver for r in comparison.false_successes] == ["sure"]
    text = bench.markdown(comparison)
    assert "| b | 1 | 3D | time-limit | 4 |" in text
    assert "| a | 1 | 4 (PEER) | 4 | 4 |" in text
    assert "`fast` solves 2 of 3 problems, all solvers of Siconos together 2 of 3." in text
    assert "2.83 times faster than the best of them" in text
    assert "above the tolerance:\n\n- sure on c: residual 1.00e-03" in text


def test_the_report_is_written_for_people_and_for_programs(comparison, tmp_path):
    out = tmp_path / "out"
    paths = [*bench.write_report(comparison, out), bench.draw_profile(comparison, out)]
    assert sorted(path.name for path in paths) == sorted(p.name for p in out.iterdir())
    assert (out / MARKDOWN).read_text() == bench.markdown(comparison)
    runs = json.loads((out / JSON).read_text())["runs"]
    assert (len(runs), runs[7]["time"], runs[0]["time"]) == (9, None, 1e-3)
    with (out / CSV).open() as file:
        rows = list(csv.DictReader(file))
    assert (rows[3]["case"], rows[3]["solver"], float(rows[3]["time"])) == ("b", "sure", 4e-3)


def test_problems_are_found_below_the_folder_and_others_named(tmp_path, problem, global_problem):
    (tmp_path / "deep").mkdir()
    write(problem, tmp_path / "deep" / "local.dat")
    write(global_problem, tmp_path / "global.hdf5")
    (tmp_path / "broken.dat").write_text("3\n1\n0\n")
    (tmp_path / "README.md").write_text("no problem")
    cases, refused = bench.read_cases(tmp_path)
    assert [case.name for case in cases] == ["deep/local.dat", "global.hdf5"]
    assert isinstance(cases[1].problem, Problem)
    assert list(refused) == ["broken.dat"]
    assert refused["broken.dat"].startswith("line 4, word 4: the text ends")
    (tmp_path / "empty").mkdir()
    with pytest.raises(InputError, match="has no contact problem"):
        bench.read_cases(tmp_path / "empty")


def test_our_own_runs_are_timed_and_measured_anew(problem):
    case = bench.Case("grains", problem)
    found = bench.run_solver(case, "gauss-seidel", tolerance=1e-8, time_limit=5.0)
    assert (found.status, found.solved, found.false_success) == ("solved", True, False)
    assert 0.0 < found.time < 1.0
    limited = bench.run_solver(case, "gauss-seidel", tolerance=1e-300, time_limit=0.01)
    assert (limited.status, limited.solved) == ("time-limit", False)


def test_siconos_solves_the_same_problem_where_it_is_installed(problem):
    try:
        siconos = bench.Siconos.find()
    except InputError as error:
        assert "python3-siconos" in str(error)
        pytest.skip("Siconos is not installed")
    case = bench.Case("grains", problem)
    found = bench.compare(
        [case], ["gauss-seidel"], tolerance=1e-8, time_limit=10.0, siconos=siconos
    )
    assert {run.solver for run in found.peer_runs} == set(siconos.solvers(3))
    solved = [run for run in found.peer_runs if run.solved]
    assert len(solved) >= 3
    assert all(run.residual <= 1e-8 and 0.0 < run.time < 10.0 for run in solved)
