"""``carom run --resume``, ``--force`` and ``carom watch``, as a user would meet them."""

import io
import json
import signal
import subprocess
import sys
import time

import pytest
from rich.console import Console
from test_cli import in_process

import carom
from carom.cli.progress import shown_progress
from carom.system.progress import Progress
from restarting import assert_same_results, scenario

COMMAND = [sys.executable, "-c", "from carom.cli import main; main()"]


@pytest.fixture
def case(tmp_path):
    """A case of so many steps that a test can do something meanwhile."""
    file = tmp_path / "discs.toml"
    file.write_text(scenario("analysis.end_time=20", "output.fields_every=1").to_toml())
    return file


@pytest.fixture
def short(tmp_path):
    file = tmp_path / "short.toml"
    file.write_text(scenario().to_toml())
    return file


def started(case, out, *options):
    process = subprocess.Popen(
        [*COMMAND, "run", str(case), "--out", str(out), *options],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )
    deadline = time.monotonic() + 60
    while not (out / "checkpoint.h5").exists() and time.monotonic() < deadline:
        time.sleep(0.02)
    return process


def test_sigterm_makes_a_checkpoint_and_resume_goes_on(case, tmp_path, capsys):
    out = tmp_path / "out"
    process = started(case, out)
    process.terminate()
    _, err = process.communicate(timeout=60)
    assert process.returncode == 143
    assert err == f"{case}: stopped by SIGTERM\n"
    summary = carom.Result.open(out).summary
    assert summary["status"] == "interrupted"
    assert summary["reason"].startswith("SIGTERM at t = ")
    assert sorted(p.name for p in out.glob("checkpoint*")) in (
        ["checkpoint-previous.h5", "checkpoint.h5"],
        ["checkpoint.h5"],
    )
    # The rest would take long; this changes how often there are checkpoints, and nothing else.
    status, _, err = in_process(capsys, "run", case, "--out", out, "--resume", "--set", "title=no")
    assert status == 2
    assert err.startswith(f"error: {out} is the run of another case: title = ")


def test_a_killed_run_goes_on_and_an_ended_one_does_not(short, tmp_path, capsys):
    whole, out = tmp_path / "whole", tmp_path / "out"
    assert in_process(capsys, "run", short, "--out", whole)[0] == 0
    process = started(short, out)
    process.kill()
    process.communicate(timeout=60)
    status, text, err = in_process(capsys, "run", short, "--out", out, "--resume")
    assert (status, err) == (0, "")
    assert_same_results(out, whole)
    before = {file.name: file.stat().st_mtime_ns for file in out.iterdir()}
    status, text, err = in_process(capsys, "run", short, "--out", out, "--resume")
    assert (status, err) == (0, "")
    assert text == f"{out}: the run has ended (completed); nothing to go on with\n"
    assert {file.name: file.stat().st_mtime_ns for file in out.iterdir()} == before


def test_results_are_refused_without_force(short, tmp_path, capsys):
    out = tmp_path / "out"
    assert in_process(capsys, "run", short, "--out", out, "--quiet")[0] == 0
    before = {file.name: file.stat().st_mtime_ns for file in tmp_path.rglob("*") if file.is_file()}
    status, text, err = in_process(capsys, "run", short, "--out", out)
    assert (status, text) == (2, "")
    assert err.startswith(f"error: {out}: has results of a run; --force replaces them, --resume")
    assert err.count("\n") == 1
    status, text, err = in_process(capsys, "run", short, "--out", out, "--force", "--resume")
    assert (status, text) == (2, "")
    assert "give one of them" in err
    after = {file.name: file.stat().st_mtime_ns for file in tmp_path.rglob("*") if file.is_file()}
    assert after == before, "nothing was written, in the directory or beside it"
    assert in_process(capsys, "run", short, "--out", out, "--force", "--quiet")[0] == 0


SPY = """
import os, sys
from carom.cli import main

def note(name, arguments):
    if name == "open" and isinstance(arguments[2], int) and isinstance(arguments[0], str):
        if arguments[2] & (os.O_WRONLY | os.O_RDWR | os.O_CREAT):
            print(os.path.abspath(arguments[0]), file=sys.stderr)
    elif name in ("os.mkdir", "os.rename", "os.remove", "os.truncate"):
        print(os.path.abspath(os.fsdecode(arguments[0])), file=sys.stderr)

sys.addaudithook(note)
main()
"""
"""Prints all that a command changes."""


def test_a_run_writes_nothing_outside_its_directory(short, tmp_path):
    work, out = tmp_path / "work", tmp_path / "out"
    work.mkdir()
    done = subprocess.run(
        [sys.executable, "-B", "-c", SPY, "run", short, "--out", out, "--quiet"],
        capture_output=True,
        text=True,
        cwd=work,
        check=True,
    )
    changed = [path for path in done.stderr.splitlines() if not path.startswith("/dev/")]
    assert len(changed) > 50
    # Matplotlib keeps a list of fonts for all programs.
    assert [path for path in changed if not path.startswith(str(out))] == [
        path for path in changed if "matplotlib" in path
    ]
    assert not list(work.iterdir())


def test_watch_follows_a_run_to_its_end(case, tmp_path):
    out = tmp_path / "out"
    process = started(case, out)
    watcher = subprocess.Popen(
        [*COMMAND, "watch", str(out), "--every", "0.1"], stdout=subprocess.PIPE, text=True
    )
    time.sleep(1.5)
    assert watcher.poll() is None
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=60)
    text, _ = watcher.communicate(timeout=60)
    assert watcher.returncode == 130
    assert "interrupted" in text
    assert not (out / "progress.json").exists()


def test_watch_says_that_a_run_has_died_and_how_to_go_on(case, tmp_path, capsys):
    out = tmp_path / "out"
    process = started(case, out)
    while json.loads((out / "progress.json").read_text())["progress"] is None:
        time.sleep(0.02)
    process.kill()
    process.communicate(timeout=60)
    status, _, err = in_process(capsys, "watch", out)
    assert status == 1
    assert err.startswith(f"error: {out}: the run has died at t = ")
    assert err.endswith("is gone; go on from its last checkpoint with carom run CASE --resume\n")


def test_watch_of_a_run_that_has_ended_and_of_none(short, tmp_path, capsys):
    out = tmp_path / "out"
    assert in_process(capsys, "run", short, "--out", out, "--quiet")[0] == 0
    status, text, _ = in_process(capsys, "watch", out)
    assert status == 0
    assert "completed" in text
    status, _, err = in_process(capsys, "watch", tmp_path / "absent")
    assert status == 2
    assert "no run is going on there" in err


PROGRESS = Progress(
    step=25,
    steps=100,
    time=0.05,
    end_time=0.2,
    contacts=3,
    kinetic=5.0,
    strain=2.5,
    total=7.5,
    friction=0.25,
    retried=4,
    wall=10.0,
    eta=3725.0,
)


def test_lines_where_there_is_no_terminal(capsys, monkeypatch):
    monkeypatch.setattr("carom.cli.progress.LINE_EVERY", 0.0)
    with shown_progress(Console(force_terminal=False)) as observer:
        observer(PROGRESS)
    assert capsys.readouterr().out == (
        "step 25/100, t = 0.05 s, 3 contacts, kinetic 5 J, strain 2.5 J, friction took 0.25 J, "
        "4 steps rejected, ETA 1:02:05\n"
    )


def test_a_terminal_of_80_columns_has_room_for_all():
    screen = io.StringIO()
    with shown_progress(Console(file=screen, force_terminal=True, width=80)) as observer:
        observer(PROGRESS)
    text = screen.getvalue()
    for what in ("25/100", "ETA 1:02:05", "3 contacts", "strain 2.5 J", "4 steps rejected"):
        assert what in text
    assert "…" not in text
