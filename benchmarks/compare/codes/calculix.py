"""CalculiX: ``*DYNAMIC`` with ``NLGEOM`` and penalty contact; the whole process is timed."""

from __future__ import annotations

import re
import resource
import subprocess
from pathlib import Path

from compare.calculix_files import deck, printed
from compare.energy import Sampler
from compare.outcome import Outcome
from compare.problems import Problem


def run(problem: Problem, variant: str, friction: float) -> Outcome:
    """Run ``ccx`` in the current directory."""
    if friction:
        raise ValueError(f"the input for {variant} has no friction")
    Path("model.inp").write_text(deck(problem), encoding="ascii")
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(["ccx", "model"], capture_output=True, text=True, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    errors = re.findall(r"\*ERROR.*", done.stdout)
    if done.returncode or errors:
        raise RuntimeError(f"ccx ended with {done.returncode}: {'; '.join(errors)}")
    sampler = Sampler(problem)
    text = Path("model.dat").read_text(encoding="ascii")
    for time, displacements, velocities in printed(text, len(problem.points)):
        sampler.take(time, displacements, velocities)
    version = re.search(r"Version (\d[\d.]*\d)", done.stdout)
    return Outcome(
        version=version[1] if version else "",
        dofs=4 * len(problem.points),
        steps=round(sampler.motion.times[-1] / problem.time_step),
        seconds=after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime,
        motion=sampler.motion,
    )
