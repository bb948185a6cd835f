import errno
import io
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
import typer

import carom
from carom import ConvergenceError, cli
from carom.cli.failures import failures


def carom_command(*arguments, cwd=None):
    """Run the command line in a process of its own, as a user would."""
    return subprocess.run(
        [sys.executable, "-c", "from carom.cli import main; main()", *map(str, arguments)],
        capture_output=True,
        text=True,
        cwd=cwd,
        check=False,
    )


def in_process(capsys, *arguments):
    """Run the command line here; return exit status, stdout and stderr."""
    with pytest.raises(SystemExit) as caught:
        cli.app([str(argument) for argument in arguments], prog_name="carom")
    captured = capsys.readouterr()
    return caught.value.code or 0, captured.out, captured.err


def test_version():
    done = carom_command("--version")
    assert (done.returncode, done.stdout.strip()) == (0, f"carom {carom.__version__}")


@pytest.mark.parametrize(
    ("override", "message"),
    [
        ("bodies.0.mesh.divsions=12", 'bodies.0.mesh.divsions: unknown key; did you mean "divisio'),
        ("materials.elastic.density=-1", "materials.elastic.density = -1: must be greater than 0"),
        ("analysis.time_step=0", "analysis.time_step = 0: must be greater than 0"),
        ("bodies=[]", "bodies = []: must have 1 or more entries"),
    ],
)
def test_bad_input_is_one_line_and_status_2(capsys, examples, override, message):
    case = examples / "two_cylinders.toml"
    for command in ("run", "check"):
        status, out, err = in_process(capsys, command, case, "--set", override)
        assert status == 2
        assert out == ""
        assert err.startswith(f"error: {case}: {message}")
        assert err.count("\n") == 1


def test_bad_input_writes_nothing(capsys, monkeypatch, tmp_path, examples):
    monkeypatch.chdir(tmp_path)
    in_process(capsys, "run", examples / "two_cylinders.toml", "--set", "bodies=[]")
    assert list(tmp_path.iterdir()) == []


def test_missing_case_is_status_2(capsys):
    status, _, err = in_process(capsys, "run", "absent.toml")
    assert (status, err) == (
        2,
        "error: absent.toml: cannot be read: No such file or directory\n",
    )


def test_a_case_is_never_overwritten_by_its_run(capsys, tmp_path, scenario):
    case = tmp_path / "case.toml"
    case.write_text(scenario.to_toml())
    status, _, err = in_process(capsys, "run", case, "--out", tmp_path)
    assert status == 2
    assert "would be overwritten" in err
    assert case.read_text() == scenario.to_toml()


def test_plot_of_no_results_is_status_2(capsys, tmp_path):
    status, _, err = in_process(capsys, "plot", tmp_path)
    assert status == 2
    assert err.startswith(f"error: {tmp_path}: has no summary.json")


@pytest.mark.parametrize(
    ("stop", "status", "line"),
    [
        (ConvergenceError("step 3 failed", {}), 3, "error: case.toml: step 3 failed"),
        (KeyboardInterrupt(), 130, "case.toml: interrupted"),
        (PermissionError(13, "Permission denied", "/root/x"), 1, "error: /root/x: Permission den"),
        (OSError(28, "No space left on device"), 1, "error: case.toml: No space left on device"),
    ],
)
def test_exit_statuses(capsys, stop, status, line):
    with pytest.raises(typer.Exit) as caught, failures(Path("case.toml")):
        raise stop
    assert caught.value.exit_code == status
    err = capsys.readouterr().err
    assert err.startswith(line)
    assert err.count("\n") == 1


def test_run_check_and_plot(tmp_path, examples):
    case = examples / "two_bars.toml"
    short = ["--set", "analysis.end_time=0.001", "--set", "bodies.0.mesh.divisions=[10, 1]"]

    checked = carom_command("check", case, *short)
    assert checked.returncode == 0, checked.stderr
    assert "gap 0.02 m" in checked.stdout

    done = carom_command("run", case, *short, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "step 100/100" in done.stdout
    assert "results/two_bars" in done.stdout

    (tmp_path / "results/two_bars/energy.png").unlink()
    plotted = carom_command("plot", tmp_path / "results/two_bars")
    assert plotted.returncode == 0, plotted.stderr
    assert (tmp_path / "results/two_bars/energy.png").exists()

    quiet = carom_command("run", case, *short, "--quiet", "--out", tmp_path / "quiet")
    assert (quiet.returncode, quiet.stdout, quiet.stderr) == (0, "", "")


def test_overlapping_bodies_are_status_2_and_write_nothing(tmp_path, examples):
    done = carom_command(
        "run",
        examples / "two_cylinders.toml",
        "--set",
        "bodies.1.mesh.centre=[3.5, 4.0]",
        cwd=tmp_path,
    )
    assert done.returncode == 2
    assert done.stderr.startswith("error: ")
    assert done.stderr.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_a_step_that_does_not_converge_is_status_3(tmp_path, examples):
    out = tmp_path / "out"
    hopeless = ["analysis.newton.max_iterations=1", "analysis.max_halvings=0", "bodies.0.spin=30"]
    overrides = [argument for override in hopeless for argument in ("--set", override)]
    done = carom_command("run", examples / "two_cylinders.toml", *overrides, "--out", out)
    assert done.returncode == 3
    assert done.stderr.startswith("error: ")
    assert done.stderr.count("\n") == 1
    summary = carom.Result.open(out).summary
    assert summary["status"] == "failed"
    assert summary["reason"] in done.stderr


def test_ctrl_c_is_status_130_and_keeps_the_results(tmp_path, examples):
    command = "from carom.cli import main; main()"
    case = examples / "two_cylinders.toml"
    process = subprocess.Popen([sys.executable, "-c", command, "run", case, "--out", tmp_path])
    deadline = time.monotonic() + 60
    while not (tmp_path / "fields.vtkhdf").exists() and time.monotonic() < deadline:
        time.sleep(0.05)
    time.sleep(0.5)
    process.send_signal(signal.SIGINT)
    assert process.wait(timeout=60) == 130
    result = carom.Result.open(tmp_path)
    assert result.summary["status"] == "interrupted"
    assert result.history["time"][-1] == pytest.approx(result.summary["end_time"])


def test_threads_are_passed_on_to_the_native_core(capsys, monkeypatch, tmp_path, examples):
    monkeypatch.setenv("RAYON_NUM_THREADS", "7")  # so that it is put back
    case = examples / "two_cylinders.toml"
    arguments = ("--set", "analysis.end_time=0.002", "--out", tmp_path / "out", "--threads", 3)
    assert in_process(capsys, "run", case, *arguments)[0] == 0
    assert os.environ["RAYON_NUM_THREADS"] == "3"
    status, _, error = in_process(capsys, "run", case, "--threads", 0)
    assert status == 2
    assert "--threads" in error


class Refusing(io.StringIO):
    """Standard output on a full disk, or in a pipe that nobody reads."""

    def __init__(self, number):
        super().__init__()
        self._number = number

    def write(self, text):
        raise OSError(self._number, os.strerror(self._number))


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EPIPE])
def test_a_run_goes_on_where_nobody_can_read_of_it(capsys, monkeypatch, tmp_path, examples, number):
    monkeypatch.setattr(sys, "stdout", Refusing(number))
    options = ("--set", "analysis.end_time=0.02", "--out", tmp_path / "out")
    with pytest.raises(SystemExit) as caught:
        cli.app(["run", str(examples / "two_cylinders.toml"), *map(str, options)])
    assert caught.value.code in (0, None)
    told = "standard output: No space left on device; the work goes on, untold\n"
    assert capsys.readouterr().err == (told if number == errno.ENOSPC else "")
    assert carom.Result.open(tmp_path / "out").summary["status"] == "completed"


def test_what_cannot_be_printed_is_no_traceback(capsys, monkeypatch, examples):
    monkeypatch.setattr(sys, "stdout", Refusing(errno.ENOSPC))
    monkeypatch.setattr(sys, "argv", ["carom", "check", str(examples / "two_cylinders.toml")])
    with pytest.raises(SystemExit) as caught:
        cli.main()
    assert caught.value.code == 1
    assert capsys.readouterr().err == "error: standard output: No space left on device\n"


def test_threads_that_no_machine_has_are_refused(capsys, monkeypatch, tmp_path, examples):
    monkeypatch.setenv("RAYON_NUM_THREADS", "7")
    case = examples / "two_cylinders.toml"
    arguments = ("--out", tmp_path / "out", "--threads", 100_000_000)
    status, _, error = in_process(capsys, "run", case, *arguments)
    assert (status, error.count("\n")) == (2, 1)
    assert error.startswith(f"error: --threads 100000000: there are {os.cpu_count()} cores; take")
    assert os.environ["RAYON_NUM_THREADS"] == "7"
    assert not (tmp_path / "out").exists()
