"""Runs that are stopped in every way and go on: what they leave is that of a run that never was."""

import copy
import multiprocessing
import os
import random
import resource
import shutil
import signal
import sys
import time
import warnings

import h5py
import pytest

import carom
from carom import InputError, StorageError
from carom.io.checkpoint import DamagedError, read_checkpoint
from carom.io.journal import changed
from restarting import CASE, assert_same_results, scenario, started

KILLS = int(os.environ.get("CAROM_KILLS", "25"))
"""How often the run is killed; `make validate` asks for more."""


@pytest.fixture(autouse=True, scope="module")
def quick():
    """Waiting for the disk takes longer than the run."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("os.fsync", lambda _: None)
        yield


@pytest.fixture(scope="module")
def reference(tmp_path_factory, quick):
    """The results of a run that nothing stops."""
    directory = tmp_path_factory.mktemp("reference") / "out"
    carom.run(scenario(), out=directory)
    return directory


def go_on(directory, *overrides):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return carom.run(scenario(*overrides), out=directory, resume=True)


def quietly(directory):
    """Run, or go on, in a process of its own."""
    sys.stderr = open(os.devnull, "w")  # noqa: PTH123, SIM115 (for the life of the process)
    go_on(directory)


def killed_after(seconds, directory):
    """Run in a process that the system kills, wherever it is, when it has computed so long.

    A clock on the wall would kill a run on a busy machine before it gets anywhere, again and again.
    """
    signal.signal(signal.SIGPROF, signal.SIG_DFL)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    quietly(directory)


def timed(directory, sender):
    """Run, and send how long it has computed [s]."""
    start = time.process_time()
    quietly(directory)
    sender.send(time.process_time() - start)


def test_a_run_that_is_killed_at_any_moment_goes_on_to_the_same_results(reference, tmp_path):
    draw = random.Random(7)
    receiver, sender = multiprocessing.Pipe(duplex=False)
    whole = started(timed, tmp_path / "whole", sender)
    duration = receiver.recv()
    whole.join()
    assert whole.exitcode == 0
    kills = runs = 0
    while kills < KILLS:
        directory = tmp_path / f"run-{runs}"
        runs += 1
        tries = 0
        while True:
            # In the mean of the first ones a fifth of the run; no run can be killed for ever.
            longest = 0.35 * 1.1**tries * duration
            process = started(killed_after, max(draw.uniform(0.0, longest), 1e-3), directory)
            process.join()
            if process.exitcode == 0:
                break
            assert process.exitcode == -signal.SIGPROF
            kills += 1
            tries += 1
        assert_same_results(directory, reference)
    assert runs < KILLS, "most runs were killed more than once"


def die_at(directory, event):
    """Run until the process has touched files in its directory so many times, and die there."""
    count = 0

    def note(name, arguments):
        nonlocal count
        kinds = ("open", "os.rename", "os.remove", "os.truncate")
        if name in kinds and str(directory) in str(arguments[0]):
            count += 1
            if count == event:
                os._exit(9)

    sys.addaudithook(note)
    quietly(directory)


def test_a_run_that_dies_between_any_two_changes_of_files_goes_on(reference, tmp_path):
    died = 0
    for event in (*range(1, 33, 4), *range(40, 160, 40)):
        directory = tmp_path / str(event)
        process = started(die_at, directory, event)
        process.join()
        died += process.exitcode == 9
        go_on(directory)
        assert_same_results(directory, reference)
        shutil.rmtree(directory)
    assert died > 8


def limited(directory, size):
    """Run where no file may grow beyond a size, as on a disk that is full [bytes]."""
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
    try:
        carom.run(scenario(), out=directory)
    except StorageError as error:
        os._exit(3 if str(directory) in str(error) else 4)


@pytest.mark.parametrize("share", [0.15, 0.4, 0.6, 0.8, 0.95])
def test_a_disk_that_is_full_leaves_a_run_that_goes_on(reference, tmp_path, share):
    sizes = [(reference / name).stat().st_size for name in ("fields.vtkhdf", "history.csv")]
    directory = tmp_path / "out"
    process = started(limited, directory, int(share * max(sizes)))
    process.join()
    assert process.exitcode == 3
    assert not (directory / "summary.json").exists()
    assert not list(directory.glob("*.journal"))
    go_on(directory)
    assert_same_results(directory, reference)


def test_no_room_for_a_checkpoint_leaves_the_last_one(tmp_path, monkeypatch):
    import carom.running.recorder

    write, count = carom.running.recorder.write_checkpoint, 0

    def no_room(directory, checkpoint):
        nonlocal count
        count += 1
        if count == 4:
            raise OSError(28, "No space left on device", str(directory / "checkpoint-fresh.h5"))
        write(directory, checkpoint)

    monkeypatch.setattr(carom.running.recorder, "write_checkpoint", no_room)
    with pytest.raises(
        StorageError,
        match=r"checkpoint-fresh\.h5: No space left on device; the last checkpoint is whole: make "
        r"room and go on with --resume",
    ):
        carom.run(scenario(), out=tmp_path)
    assert read_checkpoint(tmp_path / "checkpoint.h5").time == pytest.approx(0.06)


def interrupt_at(when):
    def observe(progress):
        if progress.time >= when:
            signal.raise_signal(signal.SIGINT)

    return observe


def stopped(directory, when=0.05):
    """Run until Ctrl-C."""
    with pytest.raises(KeyboardInterrupt):
        carom.run(scenario(), out=directory, progress=interrupt_at(when))
    return directory


def test_ctrl_c_makes_a_checkpoint_of_its_own(reference, tmp_path, monkeypatch):
    monkeypatch.setattr("carom.running.run.SLICE", 0.0)  # back after every step
    directory = stopped(tmp_path / "out", when=0.057)
    assert carom.Result.open(directory).summary["status"] == "interrupted"
    assert read_checkpoint(directory / "checkpoint.h5").time == pytest.approx(0.058)
    go_on(directory)
    assert_same_results(directory, reference)


def test_a_run_that_has_ended_is_left_alone(reference, tmp_path):
    directory = shutil.copytree(reference, tmp_path / "out")
    before = {file.name: file.stat().st_mtime_ns for file in directory.iterdir()}
    assert go_on(directory).summary["status"] == "completed"
    assert {file.name: file.stat().st_mtime_ns for file in directory.iterdir()} == before


@pytest.mark.parametrize(
    ("override", "message"),
    [
        ("analysis.time_step=1e-3", "analysis.time_step = 0.001, there it is 0.002"),
        ("contact.friction=0.4", "contact.friction = 0.4, there it is 0.3"),
        ("bodies.0.mesh.divisions=6", r"bodies.0.mesh.divisions = 6, there it is 4 \(and 1 more\)"),
    ],
)
def test_a_checkpoint_of_another_case_is_refused(tmp_path, override, message):
    directory = stopped(tmp_path)
    before = {file.name: file.read_bytes() for file in directory.iterdir()}
    with pytest.raises(InputError, match=f"is the run of another case: {message}; give that case"):
        go_on(directory, override)
    assert {file.name: file.read_bytes() for file in directory.iterdir()} == before


def test_how_often_checkpoints_are_made_may_change(tmp_path):
    directory = stopped(tmp_path)
    result = go_on(directory, "output.checkpoint_every=0.05")
    assert result.summary["status"] == "completed"


@pytest.mark.parametrize(("interval", "least", "most"), [(0.0, 10, 75), (600.0, 0, 0)])
def test_where_the_case_does_not_say_checkpoints_go_by_wall_time(
    tmp_path, monkeypatch, interval, least, most
):
    made = []
    monkeypatch.setattr("carom.running.run.SLICE", 0.0)
    monkeypatch.setattr("carom.running.schedule.WALL_INTERVAL", interval)
    monkeypatch.setattr("carom.running.recorder.write_checkpoint", lambda *_: made.append(1))
    case = copy.deepcopy(CASE)
    del case["output"]["checkpoint_every"]
    carom.run(carom.Scenario.from_dict(case), out=tmp_path)
    assert least <= len(made) <= most


def damaged(content, how):
    if how == "empty":
        return b""
    if how == "truncated":
        return content[: len(content) // 2]
    place = {"text": 20, "tables": 700, "numbers": len(content) // 2}[how]
    return content[:place] + bytes([content[place] ^ 4]) + content[place + 1 :]


@pytest.mark.parametrize("how", ["empty", "truncated", "text", "tables", "numbers"])
def test_a_damaged_checkpoint_gives_way_to_the_one_before(reference, tmp_path, how):
    directory = stopped(tmp_path / "out")
    latest, previous = (directory / f"checkpoint{end}.h5" for end in ("", "-previous"))
    latest.write_bytes(damaged(latest.read_bytes(), how))
    with pytest.raises(DamagedError):
        read_checkpoint(latest)
    with pytest.warns(UserWarning, match=r"checkpoint\.h5 .*; goes on from the checkpoint at t ="):
        carom.run(scenario(), out=directory, resume=True)
    assert_same_results(directory, reference)
    directory = stopped(tmp_path / "both")
    for file in (directory / latest.name, directory / previous.name):
        file.write_bytes(damaged(file.read_bytes(), how))
    with pytest.raises(InputError, match="and there is no other that is whole; start again with"):
        go_on(directory)


def test_any_flipped_bit_of_a_checkpoint_is_found(tmp_path):
    directory = stopped(tmp_path)
    file = directory / "checkpoint.h5"
    content = file.read_bytes()
    draw = random.Random(3)
    padding = range(content.index(b"\n") + 1, 512)
    for place in (*range(90), *(draw.randrange(len(content)) for _ in range(60))):
        if place in padding:
            continue
        file.write_bytes(
            content[:place]
            + bytes([content[place] ^ 1 << draw.randrange(8)])
            + content[place + 1 :]
        )
        with pytest.raises((DamagedError, InputError)):
            read_checkpoint(file)


def test_a_first_line_with_the_same_words_is_not_the_same(tmp_path):
    file = stopped(tmp_path) / "checkpoint.h5"
    file.write_bytes(file.read_bytes().replace(b" ", b"\t", 1))
    with pytest.raises(DamagedError, match="is damaged: its first line is another"):
        read_checkpoint(file)


@pytest.mark.parametrize("name", ["history.csv", "ledger.csv", "fields.vtkhdf", "audit.h5"])
def test_results_that_lack_what_the_checkpoint_knows_of_are_refused(tmp_path, name):
    directory = stopped(tmp_path)
    file = directory / name
    os.truncate(file, file.stat().st_size // 3)
    with pytest.raises(InputError, match=rf"{name}: .*start again with --force"):
        go_on(directory)


def test_steps_that_the_checkpoint_knows_of_must_be_there(tmp_path):
    directory = stopped(tmp_path)
    with h5py.File(directory / "audit.h5", "r+") as file:
        there = len(file["steps"])
        del file["steps"][max(file["steps"])]
    message = rf"audit\.h5: has {there - 1} frames, its checkpoint knows of {there}: results were"
    with pytest.raises(InputError, match=message):
        go_on(directory)


def test_a_checkpoint_of_another_version_is_refused(tmp_path, monkeypatch):
    directory = stopped(tmp_path)
    monkeypatch.setattr("carom.io.checkpoint.__version__", "99.0")
    message = (
        rf"was written by carom {carom.__version__}, this is 99\.0, whose numbers may differ; go"
    )
    with pytest.raises(InputError, match=message):
        go_on(directory)


def test_without_a_checkpoint_a_run_starts_from_the_beginning(reference, tmp_path):
    directory = stopped(tmp_path / "out")
    for file in directory.glob("checkpoint*"):
        file.unlink()
    go_on(directory)
    assert_same_results(directory, reference)
    assert go_on(tmp_path / "new").summary["status"] == "completed"


def test_results_are_only_replaced_by_force(reference, tmp_path):
    directory = shutil.copytree(reference, tmp_path / "out")
    with pytest.raises(InputError, match="has results of a run; --force replaces them, --resume"):
        carom.run(scenario(), out=directory, force=False)
    assert_same_results(directory, reference)


def test_no_second_run_in_the_same_directory(tmp_path):
    directory = tmp_path / "out"
    first = started(quietly, directory)
    while not (directory / "progress.json").exists():
        assert first.is_alive()
        time.sleep(0.001)
    os.kill(first.pid, signal.SIGSTOP)
    try:
        with pytest.raises(InputError, match=rf"a run is going on there \(process {first.pid} on"):
            carom.run(scenario(), out=directory)
    finally:
        os.kill(first.pid, signal.SIGCONT)
    first.join()
    assert first.exitcode == 0


def test_a_change_of_an_hdf5_file_that_fails_changes_nothing(tmp_path, monkeypatch):
    import h5py

    file = tmp_path / "a.h5"
    with h5py.File(file, "w") as out:
        out["x"] = [1, 2, 3]
    before = file.read_bytes()

    def no_room(*_):
        raise OSError(28, "No space left on device")

    with pytest.raises(RuntimeError), changed(file) as out:
        out["y"] = range(10_000)
        raise RuntimeError
    assert file.read_bytes() == before
    monkeypatch.setattr("carom.io.journal._reserve", no_room)
    with pytest.raises(OSError, match=r"No space left on device: '.*a\.h5'"), changed(file) as out:
        out["y"] = range(10_000)
    assert file.read_bytes() == before
    assert [entry.name for entry in tmp_path.iterdir()] == ["a.h5"]
    monkeypatch.undo()
    with changed(file) as out:
        out["y"] = range(10_000)
    with h5py.File(file, "r") as out:
        assert out["y"][9_999] == 9_999
        assert out["x"][()].tolist() == [1, 2, 3]
