"""One run at a time writes into a directory, which is decided before any file is touched."""

import contextlib
import json
import multiprocessing
import os
import signal
import threading
import time
from pathlib import Path

import pytest

import carom
from carom import InputError, StorageError
from carom.io.claim import claimed
from carom.system.existing import entries
from restarting import scenario, started


def quietly(directory, queue, friction, barrier, force=False):
    """Run, and wait for the other one where it is checked and nothing is written yet."""
    from carom.running import run as module

    case, whose = scenario(f"contact.friction={friction}"), module.identity

    def meet(*given):
        with contextlib.suppress(threading.BrokenBarrierError):  # where the other one is refused
            barrier.wait(timeout=2.0)
        return whose(*given)

    module.identity = meet
    try:
        result = carom.run(case, out=directory, force=force)
    except (InputError, StorageError) as error:
        queue.put((friction, str(error)))
    else:
        queue.put((friction, result.summary["status"]))


# Symptom guarded against: two runs that started into one new directory at the same instant both
# passed the check, and one answered "completed" with the results of the other.
@pytest.mark.parametrize("force", [False, True])
def test_of_two_runs_that_start_at_the_same_instant_one_is_refused(tmp_path, force):
    context, out = multiprocessing.get_context("fork"), tmp_path / "out"
    queue, barrier = context.Queue(), context.Barrier(2)
    if force:
        carom.run(scenario("analysis.end_time=0.01"), out=out)
    runs = [started(quietly, out, queue, friction, barrier, force) for friction in (0.0, 0.5)]
    said = dict(queue.get(timeout=60) for _ in runs)
    for run in runs:
        run.join()
    (winner,) = [friction for friction, what in said.items() if what == "completed"]
    (refusal,) = [what for what in said.values() if what != "completed"]
    assert refusal.startswith(f"{out}: a run is going on there")
    assert refusal.endswith("choose another --out, or follow it with carom watch")
    result = carom.Result.open(out)
    assert result.scenario.contact.friction == winner
    assert (result.history["friction"][-1] > 0.0) == (winner > 0.0)
    assert not list(out.glob("*.lock"))


# Symptom guarded against: the one that was refused was told that the directory "is a file".
def test_a_directory_that_another_run_makes_meanwhile_is_no_file(tmp_path, monkeypatch):
    def made_by_another(path):
        Path(path).mkdir()
        return True

    monkeypatch.setattr(os.path, "lexists", made_by_another)
    assert entries(tmp_path / "out") == set()


def test_two_threads_of_one_program_do_not_share_a_directory_either(tmp_path):
    def refused():
        with pytest.raises(InputError, match=r"a run is going on there; choose another --out"):
            carom.run(scenario(), out=tmp_path)

    with claimed(tmp_path):
        thread = threading.Thread(target=refused)
        thread.start()
        thread.join()
        refused()
    assert not list(tmp_path.iterdir())
    assert carom.run(scenario("analysis.end_time=0.01"), out=tmp_path).summary["steps"] == 5


def _hold(directory, ready, child):
    """Hold a directory, and fork as an observer might that has a pool of workers."""
    with claimed(directory):
        process = multiprocessing.get_context("fork").Process(target=time.sleep, args=(60,))
        process.start()
        child.value = process.pid
        ready.set()
        time.sleep(60)


def test_what_a_killed_run_held_is_free_at_once_even_if_its_children_live_on(tmp_path):
    context = multiprocessing.get_context("fork")
    ready, child = context.Event(), context.Value("i", 0)
    process = started(_hold, tmp_path, ready, child)
    assert ready.wait(timeout=30)
    with pytest.raises(InputError, match="a run is going on there"), claimed(tmp_path):
        pass
    os.kill(process.pid, signal.SIGKILL)
    process.join()
    try:
        assert (tmp_path / "run.lock").exists()
        result = carom.run(scenario("analysis.end_time=0.01"), out=tmp_path)
        assert result.summary["status"] == "completed"
        assert not (tmp_path / "run.lock").exists()
    finally:
        os.kill(child.value, signal.SIGKILL)


# Where a file system has no locks, or another machine's do not reach here, progress.json tells.
def test_a_file_system_without_locks_is_no_obstacle(tmp_path, monkeypatch):
    def none(*_):
        raise OSError(95, "Operation not supported")

    monkeypatch.setattr("fcntl.flock", none)
    assert carom.run(scenario("analysis.end_time=0.01"), out=tmp_path).summary["steps"] == 5
    news = {"pid": 1, "host": "elsewhere", "birth": "", "updated": time.time(), "progress": None}
    (tmp_path / "progress.json").write_text(json.dumps(news))
    with pytest.raises(InputError, match=r"going on there \(process 1 on elsewhere\)"):
        carom.run(scenario(), out=tmp_path, force=True)
