"""What gravity and damping do to the balance of energy of massless contact.

.venv/bin/python benchmarks/loads.py
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "validation"))

import cylinders
from sections.layout import power, table

END = 1.0  # s

DAMPING = "materials.elastic.damping="

CASES: dict[str, tuple[str, ...]] = {
    "gravity": (),
    "and mass damping 0.2 /s": (f"{DAMPING}{{mass=0.2}}",),
    "and stiffness damping 1e-4 s": (f"{DAMPING}{{stiffness=1e-4}}",),
    "and stiffness damping 1e-3 s": (f"{DAMPING}{{stiffness=1e-3}}",),
    "both, 0.2 /s and 1e-3 s": (f"{DAMPING}{{mass=0.2, stiffness=1e-3}}",),
    "both at Δt = 5e-4 s": (f"{DAMPING}{{mass=0.2, stiffness=1e-3}}", "analysis.time_step=5e-4"),
}
"""What differs from the bare cylinders under gravity."""


def measured() -> str:
    """Run every case and return the table."""
    rows = []
    for name, extra in CASES.items():
        overrides = (*cylinders.LOADED, *extra)
        run = cylinders.run(friction=0.2, condition="massless", end_time=END, overrides=overrides)
        iterations = run.summary["newton_iterations"] / run.summary["steps"]
        rows.append((name, power(run.energy("max_defect")), f"{iterations:.1f}"))
    return table(("case", "largest defect", "iterations per step"), rows)


if __name__ == "__main__":
    print(measured())
