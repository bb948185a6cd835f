import json
import subprocess
import sys

import numpy as np
import pytest

from carom import InputError, _carom, cli
from carom.friction import SOLVERS, GlobalProblem, Problem, read, read_record, solve, write
from carom.friction.bench import Siconos


@pytest.fixture
def command(capsys):
    """Run ``carom friction``; return exit status, stdout and stderr."""

    def run(*arguments):
        with pytest.raises(SystemExit) as caught:
            cli.app(["friction", *map(str, arguments)], prog_name="carom")
        captured = capsys.readouterr()
        return caught.value.code or 0, captured.out, captured.err

    return run


@pytest.fixture
def file(tmp_path, problem):
    write(problem, tmp_path / "grains.hdf5", guess=np.zeros_like(problem.q), title="Grains")
    return tmp_path / "grains.hdf5"


def test_solve_prints_what_it_measured_anew(command, file, problem):
    status, out, err = command("solve", file, "--json")
    assert (status, err) == (0, "")
    found, expected = json.loads(out), solve(problem)
    measured = problem.measure(expected.reactions)
    assert 0.0 < found.pop("cpu_s") < 10.0
    assert found == {
        "file": str(file),
        "contacts": 12,
        "dimension": 3,
        "solver": SOLVERS[0],
        "solved_by": expected.solver,
        "status": "solved",
        "residual": measured.residual,
        "natural_residual": measured.natural_residual,
        "certificate_joule": measured.certificate,
        "iterations": expected.iterations,
    }


def test_solve_prints_a_table(command, file):
    status, out, _ = command("solve", file)
    assert status == 0
    for word in ("Grains", "12 in 3D", "solved", "certificate"):
        assert word in out


def test_solve_keeps_the_answer(command, tmp_path, file):
    assert command("solve", file, "--out", tmp_path / "answer.hdf5")[0] == 0
    record = read_record(tmp_path / "answer.hdf5")
    assert (record.title, len(record.guesses)) == ("Grains", 1)
    assert record.problem.measure(record.solution.reactions).decisive <= 1e-8


def test_solve_starts_from_the_guess_if_asked(command, tmp_path, problem):
    answer = solve(problem)
    write(problem, tmp_path / "warm.hdf5", guess=answer)
    cold = json.loads(command("solve", tmp_path / "warm.hdf5", "--json")[1])
    warm = json.loads(command("solve", tmp_path / "warm.hdf5", "--json", "--warm")[1])
    assert (cold["iterations"], warm["iterations"]) == (answer.iterations, 0)
    write(problem, tmp_path / "without.hdf5")
    status, _, err = command("solve", tmp_path / "without.hdf5", "--warm")
    assert (status, "has no guess to start from" in err) == (2, True)


@pytest.mark.parametrize("options", [["--max-iterations", "1"], ["--time-limit", "0"]])
def test_an_answer_that_is_none_is_status_3(command, file, options):
    status, out, _ = command("solve", file, "--json", "--tolerance", "1e-14", *options)
    assert status == 3
    assert json.loads(out)["status"] in {"iteration-limit", "time-limit"}


def test_a_false_success_is_refuted(command, file, monkeypatch):
    def boast(problem, reactions, **options):
        return found(problem, reactions + 1.0, **options | {"max_iterations": 0}) | {
            "status": "solved"
        }

    found = _carom.solve_friction
    monkeypatch.setattr(_carom, "solve_friction", boast)
    status, out, _ = command("solve", file, "--json")
    assert (status, json.loads(out)["status"]) == (3, "refuted")


def test_what_is_not_finite_is_null(command, file, monkeypatch):
    found = _carom.solve_friction
    monkeypatch.setattr(
        _carom,
        "solve_friction",
        lambda *given, **options: (
            found(*given, **options) | {"reactions": np.full((12, 3), np.inf), "status": "diverged"}
        ),
    )
    status, out, _ = command("solve", file, "--json")
    assert (status, json.loads(out)["residual"]) == (3, None)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--solver", "newton"], "solver = 'newton': "),
        (["--tolerance", "0"], "tolerance = 0: must be greater than 0"),
        (["--out", "answer.csv"], "answer.csv: the suffix says the format"),
        (["--out", "answer.dat"], "answer.dat: the suffix says the format"),
    ],
)
def test_bad_input_is_one_line_and_status_2(command, file, monkeypatch, arguments, message):
    monkeypatch.chdir(file.parent)
    status, out, err = command("solve", file, *arguments)
    assert (status, out, err.count("\n")) == (2, "", 1)
    assert err.startswith(f"error: {message}")
    assert list(file.parent.iterdir()) == [file]


@pytest.mark.parametrize(
    ("words", "there"),
    [
        (("solve", "grains.hdf5", "--out", "answer.h5"), "answer.h5"),
        (("convert", "grains.hdf5", "copy.dat"), "copy.dat"),
        (("convert", "grains.hdf5", "grains.hdf5"), "grains.hdf5"),
        (("bench", ".", "--solvers", "auto", "--out", "tables"), "tables/table.csv"),
    ],
)
def test_a_file_that_is_there_is_replaced_with_force_only(command, file, monkeypatch, words, there):
    monkeypatch.chdir(file.parent)
    place = file.parent / there
    place.parent.mkdir(exist_ok=True)
    if place != file:
        place.write_text("mine")
    before = place.read_bytes()
    with monkeypatch.context() as patch:
        patch.setattr(_carom, "solve_friction", None)  # nothing is computed
        said = command(*words)
    assert said == (2, "", f"error: {there}: is there already; give --force to replace it\n")
    assert place.read_bytes() == before
    assert {path.name for path in place.parent.iterdir()} <= {place.name, file.name}
    assert command(*words, "--force")[0] == 0
    assert place.read_bytes() != b"mine"


def test_an_answer_needs_a_folder_to_be_in(command, file, tmp_path):
    status, _, err = command("solve", file, "--out", tmp_path / "absent" / "answer.h5")
    assert (status, err.count("\n")) == (2, 1)
    assert f"there is no directory {tmp_path / 'absent'}; make it first" in err


def test_a_file_that_is_no_problem_is_status_2(command, tmp_path):
    (tmp_path / "notes.txt").write_text("Some notes.\n")
    for name in ("notes.txt", "absent.hdf5"):
        status, out, err = command("solve", tmp_path / name)
        assert (status, out, err.count("\n")) == (2, "", 1)
        assert err.startswith(f"error: {tmp_path / name}: ")


def test_an_asymmetry_is_warned_of_in_one_line(command, tmp_path):
    path = tmp_path / "rough.dat"
    path.write_text("2\n1\n0\n2\n2\n2 2\n1 0.1 0.101 1\n-1 0.2\n0.3\n")
    status, _, err = command("solve", path)
    assert status == 0
    assert err == (
        f"warning: {path}: W is asymmetric by 0.001 of its largest entry (at [0, 1]); "
        "(W + Wᵀ)/2 is solved instead\n"
    )


def test_convert_keeps_the_problem_and_what_is_known_of_it(command, tmp_path, file, problem):
    for name in ("a.dat", "b.h5"):
        assert command("convert", file, tmp_path / name) == (0, "", "")
        found = read(tmp_path / name)
        assert np.array_equal(found.blocks, problem.blocks)
    record = read_record(tmp_path / "b.h5")
    assert (record.title, len(record.guesses)) == ("Grains", 1)


def test_convert_condenses(command, tmp_path, global_problem, problem):
    write(global_problem, tmp_path / "global.hdf5", solution=np.ones_like(global_problem.b))
    assert command("convert", tmp_path / "global.hdf5", tmp_path / "copy.dat")[0] == 0
    assert isinstance(read(tmp_path / "copy.dat"), GlobalProblem)
    assert command("convert", tmp_path / "copy.dat", tmp_path / "local.h5", "--condense")[0] == 0
    local = read(tmp_path / "local.h5")
    assert isinstance(local, Problem)
    assert local.matrix().toarray() == pytest.approx(problem.matrix().toarray(), abs=1e-12)
    status, _, err = command("convert", tmp_path / "local.h5", tmp_path / "x.h5", "--condense")
    assert (status, "is in local form already" in err) == (2, True)
    assert not (tmp_path / "x.h5").exists()


def test_a_global_problem_is_solved_by_its_file(command, tmp_path, global_problem):
    write(global_problem, tmp_path / "global.hdf5")
    status, out, _ = command(
        "solve", tmp_path / "global.hdf5", "--json", "--out", tmp_path / "answer.h5"
    )
    assert (status, json.loads(out)["status"]) == (0, "solved")
    velocities = read_record(tmp_path / "answer.h5").solution.velocities
    assert velocities.shape == (global_problem.dofs,)


def test_bench_compares_and_writes_its_report(command, tmp_path, file):
    out = tmp_path / "report"
    status, printed, err = command(
        "bench", tmp_path, "--solvers", "gauss-seidel, uzawa", "--time-limit", "2", "--out", out
    )
    assert status == 0
    assert "grains.hdf5" in printed
    assert "grains.hdf5: uzawa: " in err
    assert {path.name for path in out.iterdir()} == {
        "table.md",
        "table.csv",
        "table.json",
        "profile.png",
    }


def test_bench_names_what_it_leaves_out(command, tmp_path, file):
    (tmp_path / "broken.h5").write_bytes(file.read_bytes()[:3000])
    status, _, err = command("bench", tmp_path, "--solvers", "gauss-seidel")
    assert status == 0
    assert "warning: broken.h5: left out: is no readable HDF5 file" in err


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["absent"], "absent: is no folder"),
        (["."], ".: has no contact problem"),
        ([".", "--solvers", "gaus-seidel"], "--solvers gaus-seidel: did you mean"),
        ([".", "--against", "lmgc90"], "--against lmgc90: known: siconos"),
    ],
)
def test_bench_refuses_bad_input(command, tmp_path, monkeypatch, arguments, message):
    monkeypatch.chdir(tmp_path)
    status, out, err = command("bench", *arguments)
    assert (status, out) == (2, "")
    assert err.startswith(f"error: {message}")


def test_bench_says_how_to_get_siconos(command, tmp_path, file, monkeypatch):
    monkeypatch.setattr(sys, "executable", "/bin/false")
    monkeypatch.setattr(
        subprocess, "run", lambda *given, **options: subprocess.CompletedProcess(given, 1)
    )
    with pytest.raises(InputError, match="python3-siconos"):
        Siconos.find()
    status, _, err = command("bench", tmp_path, "--against", "siconos")
    assert (status, "install python3-siconos" in err) == (2, True)


def test_scipy_is_imported_for_these_commands_alone():
    code = "import sys, carom.cli; sys.exit('scipy.sparse' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
