"""One run in a process of its own: ``python -m compare.worker JOB.json OUTCOME.json``."""

from __future__ import annotations

import json
import os
import sys
import tempfile
from importlib import import_module
from pathlib import Path

from compare.outcome import Job, Outcome
from compare.problems import PROBLEMS


def main(job_file: Path, outcome_file: Path) -> None:
    """Run the job in a directory that is removed afterwards."""
    job = Job(**json.loads(job_file.read_text(encoding="utf-8")))
    problem = PROBLEMS[job.problem].shortened(job.steps)
    run = import_module(f"compare.codes.{job.code}").run
    with tempfile.TemporaryDirectory() as directory:
        start = Path.cwd()
        os.chdir(directory)
        try:
            outcome: Outcome = run(problem, job.variant, job.friction)
        finally:
            os.chdir(start)
    outcome.write(outcome_file)


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
