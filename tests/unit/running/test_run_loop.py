"""The run loop on a simulation that knows no mechanics: what is written, whatever happens."""

import errno
from types import SimpleNamespace

import h5py
import numpy as np
import pytest

import carom
from carom import CertificateError, ConvergenceError, InputError, Result, StorageError
from carom.running.run import drive
from stand_in import FallingSimulation


@pytest.fixture
def scenario(scenario):
    return scenario.with_overrides(["output.fields_every=0.25"])


def frames(directory):
    with h5py.File(directory / "fields.vtkhdf", "r") as file:
        return file["VTKHDF/Steps/Values"][:].tolist()


@pytest.mark.usefixtures("pictures")
def test_completed_run_writes_everything(scenario, tmp_path):
    out = tmp_path / "new" / "results"
    seen = []
    result = drive(FallingSimulation(scenario), scenario, out, progress=seen.append)

    assert sorted(file.name for file in out.iterdir()) == [
        "case.toml",
        "end_state.h5",
        "energy.png",
        "fields.vtkhdf",
        "history.csv",
        "ledger.csv",
        "summary.json",
        "surface.vtkhdf",
        "track-tip.png",
    ]
    assert result.summary["status"] == "completed"
    assert result.summary["title"] == "Box"
    assert result.summary["steps"] == 100
    assert result.summary["min_gap"] is None
    assert result.summary["wall_s_per_step"] == result.summary["wall_s"] / 100
    assert "reason" not in result.summary
    np.testing.assert_allclose(result.history["time"], np.arange(101) * 0.01)
    np.testing.assert_allclose(frames(out), [0.0, 0.25, 0.5, 0.75, 1.0])
    assert result.scenario == scenario
    assert [progress.step for progress in seen] == sorted(progress.step for progress in seen)
    assert (seen[0].step, seen[-1].step, seen[-1].steps) == (0, 100, 100)
    assert len(seen) > 30
    assert "completed, 100 steps, t = 1 s" in repr(result)


def test_the_last_frame_is_the_end_even_off_the_beat(scenario, tmp_path):
    scenario = scenario.with_overrides(["output.fields_every=0.3"])
    drive(FallingSimulation(scenario), scenario, tmp_path)
    np.testing.assert_allclose(frames(tmp_path), [0.0, 0.3, 0.6, 0.9, 1.0])


@pytest.mark.usefixtures("pictures")
@pytest.mark.parametrize(
    ("stop", "status", "reason"),
    [
        (ConvergenceError("step 60 failed at t = 0.6 s", {"step": 60}), "failed", "step 60 failed"),
        (KeyboardInterrupt(), "interrupted", "Ctrl-C at t = 0.6 s"),
    ],
)
def test_a_run_that_stops_keeps_what_it_has(scenario, tmp_path, stop, status, reason):
    simulation = FallingSimulation(scenario, stop_at=0.6, stop=stop)
    with pytest.raises(type(stop)):
        drive(simulation, scenario, tmp_path)
    result = Result.open(tmp_path)
    assert result.summary["status"] == status
    assert result.summary["reason"].startswith(reason)
    assert result.summary["end_time"] == pytest.approx(0.6)
    assert result.history["time"][-1] == pytest.approx(0.6)
    np.testing.assert_allclose(frames(tmp_path), [0.0, 0.25, 0.5, 0.6])
    assert (tmp_path / "energy.png").exists()


def test_a_contact_problem_that_failed_is_kept_until_the_next_run(scenario, tmp_path):
    problem = carom.friction.Problem(2.0 * np.eye(2), [[-1.0, 0.5]], 0.2)
    error = ConvergenceError("step 60 failed", {}, problem=problem, guess=np.array([[0.5, 0.1]]))
    out = tmp_path / "my results"
    with pytest.raises(ConvergenceError) as caught:
        drive(FallingSimulation(scenario, stop_at=0.6, stop=error), scenario, out)
    assert caught.value is error
    file = out / "failed_contact_problem.hdf5"
    reason = Result.open(out).summary["reason"]
    assert reason == str(error)
    assert reason == (
        f"step 60 failed; the problem is in {file}, solve it again with: carom friction solve "
        f"'{file}' --warm --solver auto --tolerance 1e-12 --max-iterations 10000"
    )
    record = carom.friction.read_record(file)
    np.testing.assert_array_equal(record.problem.q, problem.q)
    np.testing.assert_array_equal(record.problem.matrix().toarray(), 2.0 * np.eye(2))
    np.testing.assert_array_equal(record.guesses[0].reactions, [[0.5, 0.1]])
    assert (record.title, record.description) == ("Box", "step 60 failed")
    drive(FallingSimulation(scenario), scenario, out, force=True)
    assert not file.exists()


@pytest.mark.usefixtures("pictures")
def test_nothing_of_an_earlier_run_survives(scenario, tmp_path):
    drive(FallingSimulation(scenario), scenario, tmp_path)
    (tmp_path / "notes.txt").write_text("mine")
    untracked = scenario.with_overrides(["output.track=[]", "analysis.end_time=0.5"])
    result = drive(FallingSimulation(untracked), untracked, tmp_path, force=True)
    assert result.summary["end_time"] == 0.5
    assert not (tmp_path / "track-tip.png").exists()
    assert (tmp_path / "notes.txt").read_text() == "mine"


def test_a_run_that_cannot_go_on_claims_no_results(scenario, tmp_path):
    drive(FallingSimulation(scenario), scenario, tmp_path)
    simulation = FallingSimulation(scenario, stop_at=0.6, stop=OSError("disk full"))
    with pytest.raises(OSError, match="disk full"):
        drive(simulation, scenario, tmp_path, force=True)
    with pytest.raises(InputError, match=r"has no summary\.json"):
        Result.open(tmp_path)
    assert carom.read_history(tmp_path / "history.csv")["time"][-1] > 0.4


@pytest.mark.parametrize(
    ("number", "remedy"),
    [(errno.ENOSPC, "make room"), (errno.EFBIG, "make room"), (errno.EIO, "see to it")],
)
def test_a_file_that_cannot_be_written_is_told_with_a_remedy_that_fits(
    scenario, tmp_path, number, remedy
):
    stop = OSError(number, "said by the system", "history.csv")
    with pytest.raises(StorageError) as caught:
        drive(FallingSimulation(scenario, stop_at=0.6, stop=stop), scenario, tmp_path)
    said = str(caught.value)
    assert said == f"history.csv: said by the system; {remedy} and start again"


# Symptom guarded against: HDF5 found a file in use, and "make room" was the advice.
@pytest.mark.parametrize(
    ("said", "remedy"),
    [
        ("Can't write data (errno = 28, error message = 'No space left on device')", "make room"),
        ("Unable to lock file (errno = 11, error message = 'in use')", "see to it"),
        ("Can't decrement id ref count", "see to it"),
    ],
)
def test_room_is_asked_for_only_where_there_is_none(scenario, tmp_path, said, remedy):
    with pytest.raises(StorageError) as caught:
        drive(FallingSimulation(scenario, stop_at=0.6, stop=OSError(said)), scenario, tmp_path)
    assert str(caught.value) == f"{tmp_path}: {said}; {remedy} and start again"


def test_hdf5_without_a_reason_on_a_full_disk(scenario, tmp_path, monkeypatch):
    full = SimpleNamespace(free=0)
    monkeypatch.setattr("carom.running.run.shutil.disk_usage", lambda _: full)
    stop = OSError("Can't decrement id ref count")
    with pytest.raises(StorageError, match="ref count; make room and start again"):
        drive(FallingSimulation(scenario, stop_at=0.6, stop=stop), scenario, tmp_path)


def test_a_run_that_leaves_coulombs_law_is_not_completed(scenario, tmp_path):
    with pytest.raises(
        CertificateError, match=r"2e-09 J from Coulomb's law, more than the 1e-09 J"
    ):
        drive(FallingSimulation(scenario, certificate=2e-9), scenario, tmp_path)
    result = Result.open(tmp_path)
    assert result.summary["status"] == "uncertified"
    assert "contact.solver.tolerance" in result.summary["reason"]
    drive(FallingSimulation(scenario, certificate=1e-9), scenario, tmp_path, force=True)
    assert Result.open(tmp_path).summary["status"] == "completed"


def test_the_ledger_of_bodies_and_pairs_reads_back(scenario, tmp_path):
    ledger = drive(FallingSimulation(scenario), scenario, tmp_path).ledger
    assert list(ledger) == ["left", "left|floor"]
    assert ledger["left"]["contact"][-1] == 6.0
    assert np.isnan(ledger["left"]["friction"]).all()
    assert ledger["left|floor"]["normal_contact"][-1] == 9.0


def test_a_missing_directory_is_named(tmp_path):
    with pytest.raises(InputError, match=r"absent: has no summary\.json"):
        Result.open(tmp_path / "absent")
