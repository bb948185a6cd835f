"""Runs on several ranks by MPI and PETSc: the same energies and events, whoever has the cells."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import cases
import pytest

import carom


def written(scenario, path):
    path.write_text(scenario.to_toml(), encoding="utf-8")
    return path


def same(a, b, bound=1e-11):
    scale = max(abs(a["energy"]["initial"]), abs(a["energy"]["final"]))
    assert a["status"] == b["status"] == "completed"
    for name, value in a["energy"].items():
        assert b["energy"][name] == pytest.approx(value, abs=bound * scale), name
    for one, other in zip(a["contacts"], b["contacts"], strict=True):
        assert one["pair"] == other["pair"]
        assert [one["onset"], one["release"]] == [other["onset"], other["release"]]


@pytest.mark.parametrize(("case", "counts"), [(cases.discs, (1, 2)), (cases.ball, (1, 2, 4))])
def test_ranks_make_the_run_of_one_process(tmp_path, run, case, counts):
    scenario = case()
    file = written(scenario, tmp_path / "case.toml")
    alone = carom.run(scenario, out=tmp_path / "alone").summary
    for count in counts:
        out = tmp_path / f"{count}"
        status, _, complained = run(
            count, "-m", "carom", "run", file, "--out", out, "--engine", "petsc", "--quiet"
        )
        assert status == 0, complained
        same(alone, carom.Result.open(out).summary)


CHANGED = """
import runpy, sys
from carom.ranks import petsc

petsc.SHARED = 0
{}
sys.argv = ["carom", *sys.argv[1:]]
runpy.run_module("carom", run_name="__main__")
"""


@pytest.mark.parametrize(
    ("case", "count", "changes"),
    [
        (cases.pressed, 3, ""),
        (cases.squeezed, 2, ""),
        (cases.squeezed, 2, "petsc.FACTORED = {2: 0, 3: 0}"),
    ],
    ids=["in time", "load steps", "load steps by multigrid"],
)
def test_ranks_share_what_petsc_solves(tmp_path, run, case, count, changes):
    scenario = case()
    file, out = written(scenario, tmp_path / "case.toml"), tmp_path / "out"
    script = tmp_path / "changed.py"
    script.write_text(CHANGED.format(changes), encoding="utf-8")
    status, _, complained = run(
        count, script, "run", file, "--out", out, "--engine", "petsc", "--quiet"
    )
    assert status == 0, complained
    same(carom.run(scenario, out=tmp_path / "alone").summary, carom.Result.open(out).summary)


def test_a_run_goes_on_with_another_number_of_ranks(tmp_path, run):
    scenario = cases.ball()
    file, out = written(scenario, tmp_path / "case.toml"), tmp_path / "out"

    def enough(state):
        if state.time > 0.0045:
            raise carom.Stop

    carom.run(scenario, out=out, observers=[carom.Observer(enough)])
    status, _, complained = run(
        2, "-m", "carom", "run", file, "--out", out, "--engine", "petsc", "--quiet", "--resume"
    )
    assert status == 0, complained
    same(carom.run(scenario, out=tmp_path / "alone").summary, carom.Result.open(out).summary)


@pytest.mark.long
def test_a_rank_that_is_killed_ends_all_and_the_run_goes_on_with_another_number(
    tmp_path, run, ranks
):
    scenario = cases.discs(
        analysis={"end_time": 1.0, "time_step": 2e-3}, output={"checkpoint_every": 0.1}
    )
    file, out = written(scenario, tmp_path / "case.toml"), tmp_path / "out"
    command = ("-m", "carom", "run", file, "--out", out, "--engine", "petsc", "--quiet")
    process = ranks(2, *command)
    end = time.monotonic() + 60.0
    while not (out / "checkpoint.h5").exists():
        assert time.monotonic() < end
        assert process.poll() is None
        time.sleep(0.02)
    children = subprocess.run(
        ["pgrep", "-P", str(process.pid)], capture_output=True, text=True, check=True
    )
    pids = [int(pid) for pid in children.stdout.split()]
    os.kill(max(pids), signal.SIGKILL)
    process.communicate(timeout=60)
    assert process.returncode != 0
    while any(Path(f"/proc/{pid}").exists() for pid in pids):
        assert time.monotonic() < end
        time.sleep(0.02)
    status, _, complained = run(3, *command, "--resume")
    assert status == 0, complained
    same(carom.run(scenario, out=tmp_path / "alone").summary, carom.Result.open(out).summary)


@pytest.mark.long
def test_ctrl_c_leaves_results_and_a_checkpoint(tmp_path, ranks):
    scenario = cases.discs(analysis={"end_time": 20.0, "time_step": 2e-3})
    file, out = written(scenario, tmp_path / "case.toml"), tmp_path / "out"
    process = ranks(2, "-m", "carom", "run", file, "--out", out, "--engine", "petsc", "--quiet")
    end = time.monotonic() + 60.0
    while not (out / "progress.json").exists():
        assert process.poll() is None, process.communicate()
        assert time.monotonic() < end
        time.sleep(0.02)
    time.sleep(0.5)
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=60)
    assert process.returncode != 0
    summary = carom.Result.open(out).summary
    assert summary["status"] == "interrupted"
    assert (out / "checkpoint.h5").exists()


def test_what_all_ranks_refuse_is_said_once(tmp_path, run):
    file = written(cases.discs(), tmp_path / "case.toml")
    command = ("-m", "carom", "run", file, "--out", tmp_path / "out", "--engine", "petsc")
    status, _, complained = run(2, *command, "--set", "materials.m.young=-1")
    assert status == 2
    assert complained.count("must be greater than 0") == 1
    status, _, complained = run(2, *command, "--threads", "4")
    assert status == 2
    assert complained.count("each rank has one thread") == 1


FREED = """
import numpy as np
from carom.ranks import engine_named

def memory():
    lines = open("/proc/self/status").read().splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith("VmRSS:"))

engine_named("petsc")
kept = [np.ones(1000) for _ in range(1000)]
before = memory()
blocks = [np.ones(10_000_000) for _ in range(2)]
kept += [np.ones(1000) for _ in range(1000)]
del blocks
print(memory() - before)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere PETSc leaves memory alone")
def test_a_rank_gives_back_the_memory_that_it_frees(tmp_path, run):
    """Symptom guarded against: what PETSc does as it is imported kept a quarter more."""
    script = tmp_path / "freed.py"
    script.write_text(FREED, encoding="utf-8")
    status, said, complained = run(1, script)
    assert status == 0, complained
    assert int(said) < 20_000


ALONE = """
import typer
from carom.cli.together import together

with together("petsc", threads=None) as engine:
    if engine.rank == 1:
        typer.echo("error: the disk of this one is full", err=True)
        raise typer.Exit(1)
    engine.wait()
"""


def test_a_rank_that_fails_alone_says_so_and_ends_the_others(tmp_path, run):
    script = tmp_path / "alone.py"
    script.write_text(ALONE, encoding="utf-8")
    start = time.monotonic()
    status, _, complained = run(2, script)
    assert status != 0
    assert "rank 1: error: the disk of this one is full" in complained
    assert time.monotonic() - start < 200.0
