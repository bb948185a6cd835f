"""Run carom, Kratos and CalculiX side by side on the same problems.

    python benchmarks/compare [--problems cylinders bars] [--codes carom kratos calculix]
        [--frictions 0 0.2] [--runs 3]

Codes that are not installed are left out. Every run is a process of its own with one thread; the
codes take turns, so that all meet the same machine. CPU time is compared: of carom the native time
loop with nothing recorded, of Kratos its loop over the steps without our looks at it, of CalculiX
the whole process. Energies, velocities and times of contact come from `energy.py` for everybody.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from compare.catalogue import CODES
from compare.outcome import Job, Outcome
from compare.problems import PROBLEMS, Problem
from compare.table import differences, table

FOLDER = Path(__file__).resolve().parents[1]
"""Where the package `compare` is."""

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "CCX_NPROC_STIFFNESS")


def main() -> None:
    """Run everything and print a table per problem."""
    options = parsed()
    pythons = dict.fromkeys(CODES, sys.executable) | {"kratos": options.kratos_python}
    codes = []
    for code in options.codes:
        if CODES[code].is_there(pythons[code]):
            codes.append(code)
        else:
            print(f"{CODES[code].title} is left out; to install it: {CODES[code].install}")
    for name in options.problems:
        problem = PROBLEMS[name].shortened(options.steps)
        asked = tuple(jobs(problem, codes, options.frictions, options.steps))
        runs, failed = taken_in_turns(asked, options.runs, pythons)
        print(f"\n{problem.title}; median of {options.runs} runs\n\n{table(problem, runs)}\n")
        for job, why in failed.items():
            print(f"{job}: failed: {why}")
        for line in differences(problem, runs):
            print(f"to note: {line}")


def taken_in_turns(
    asked: Sequence[Job], turns: int, pythons: Mapping[str, str]
) -> tuple[dict[Job, list[Outcome]], dict[Job, str]]:
    """Run all jobs in each turn; return what came out, and why some are not run again."""
    runs: dict[Job, list[Outcome]] = {job: [] for job in asked}
    failed: dict[Job, str] = {}
    for turn in range(1, turns + 1):
        for job in (job for job in asked if job not in failed):
            print(f"{job.problem}, {turn} of {turns}: {job}", file=sys.stderr, flush=True)
            outcome = executed(job, pythons[job.code])
            if isinstance(outcome, str):
                failed[job] = outcome
            else:
                runs[job].append(outcome)
    return runs, failed


def parsed() -> argparse.Namespace:
    """Return the options of the command line."""
    parser = argparse.ArgumentParser(description="carom and other codes, side by side")
    parser.add_argument("--problems", nargs="+", choices=PROBLEMS, default=list(PROBLEMS))
    parser.add_argument("--codes", nargs="+", choices=CODES, default=list(CODES))
    parser.add_argument("--frictions", nargs="+", type=float, default=[0.0, 0.2])
    parser.add_argument("--runs", type=int, default=3, help="runs of which the median counts")
    parser.add_argument("--steps", type=int, help="only so many steps, for a quick look")
    parser.add_argument(
        "--kratos-python", default=sys.executable, help="interpreter that has Kratos and NumPy"
    )
    return parser.parse_args()


def jobs(
    problem: Problem, codes: Sequence[str], frictions: Sequence[float], steps: int | None
) -> Iterator[Job]:
    """Yield what is run in each turn."""
    for friction in frictions:
        for code in codes:
            if friction in CODES[code].frictions[problem.name]:
                for variant in CODES[code].variants:
                    yield Job(code, problem.name, variant, friction, steps)


def executed(job: Job, python: str) -> Outcome | str:
    """Run a job in a process of its own; return the end of what it said if it failed."""
    with tempfile.TemporaryDirectory() as directory:
        asked, answered = Path(directory, "job.json"), Path(directory, "outcome.json")
        asked.write_text(json.dumps(asdict(job)), encoding="utf-8")
        done = subprocess.run(
            [python, "-m", "compare.worker", str(asked), str(answered)],
            env={**os.environ, **dict.fromkeys(THREADS, "1"), "PYTHONPATH": str(FOLDER)},
            capture_output=True,
            text=True,
            errors="replace",
            check=False,
        )
        if done.returncode:
            said = (done.stderr.strip() or done.stdout.strip()).splitlines()
            return said[-1] if said else f"exit status {done.returncode}"
        return Outcome.read(answered)


if __name__ == "__main__":
    main()
