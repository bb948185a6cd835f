"""The paper's cylinders as bodies of another code: is their energy kept, what does carom cost.

    .venv/bin/python benchmarks/foreign_bodies.py [end time]

The code is that of the tests, a page of NumPy for linear triangles (tests/plain_fem.py); carom is
given their mass, energy, force and stiffness. Without friction and with μ = 0.2 it prints

- the largest defect of the books at the end of a step over the initial energy,
- what friction took, the largest certificate, the iterations per step,
- the wall time, and the share of it that is not the other code's.
"""

from __future__ import annotations

import sys
from pathlib import Path
from time import perf_counter

import numpy as np

import carom

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests"))

from foreign_case import foreign_bodies  # noqa: E402


def main(end_time: float = 15.0) -> None:
    """Run the cylinders without and with friction."""
    for friction in (0.0, 0.2):
        case = carom.Scenario.from_toml(ROOT / "examples/two_cylinders.toml").with_overrides(
            [
                f"contact.friction={friction}",
                "contact.condition=midpoint",
                "bodies.0.mesh.cell=tri3",
                "bodies.1.mesh.cell=tri3",
            ]
        )
        time_step = case.analysis.time_step
        run = carom.ForeignRun(
            foreign_bodies(case), case.obstacles, time_step=time_step, contact=case.contact
        )
        initial, taken, rubbed, defect = run.energy, 0.0, 0.0, 0.0
        certificate, iterations = 0.0, 0
        start, steps = perf_counter(), round(end_time / time_step)
        for _ in range(steps):
            step = run.step()
            rubbed += step.friction
            taken += step.friction + step.normal_contact
            defect = max(defect, abs(run.energy + taken - initial))
            certificate = max(certificate, step.certificate)
            iterations += step.iterations
        wall = perf_counter() - start
        print(
            f"μ = {friction}: defect {defect / initial:.1e} E0, "
            f"friction {rubbed / initial:.4f} E0, "
            f"certificate {certificate:.1e} J, {iterations / steps:.1f} iterations per step, "
            f"{wall:.0f} s, of which carom {1.0 - run.law_time / wall:.1%}",
            flush=True,
        )
        assert np.isfinite(defect)


if __name__ == "__main__":
    main(*map(float, sys.argv[1:]))
