"""Energy-exact, quiet and non-penetrating at once: the cylinders with massless contact.

.venv/bin/python benchmarks/prize.py
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "validation"))

import cylinders
from runs import Run
from sections.layout import power, table, told

STEPS = (1e-1, 5e-2, 2.5e-2, 1e-2, 2e-3, 1e-3, 5e-4, 2.5e-4)  # s
FAST = "bodies.0.velocity=[4.0, -8.0]"

HEADER = (
    *("run", "μ", "drift", "defect", "smallest gap [m]", "total variation [N]", "momenta"),
    *("largest α", "least friction [J]", "certificate [J]", "iterations per step"),
    *("steps tried again", "ms/step"),
)


def row(name: str, friction: float, run: Run, *, slow: bool = True) -> tuple[str, ...]:
    """Describe a run."""
    summary = run.summary
    free = friction == 0.0
    return (
        name,
        f"{friction:g}",
        power(run.energy("max_drift")) if free else "–",
        power(run.energy("max_defect")),
        power(summary["min_gap"]),
        f"{cylinders.total_variation(run):.0f}" if free and slow else "–",
        f"{max(cylinders.momentum_spread(run).values()):.0e}" if free and slow else "–",
        f"{summary['max_blend']:.2f}",
        f"{summary['least_friction']:.0e}",
        power(summary["certificate"]["max_joule"]),
        f"{summary['newton_iterations'] / summary['steps']:.1f}",
        str(summary["retried_steps"]),
        f"{1e3 * run.wall / summary['steps']:.2f}",
    )


def measured() -> str:
    """Run everything and return the table."""
    rows = []
    for friction in (0.0, 0.2):
        for step in STEPS:
            name = f"`massless`, Δt = {step:g} s"
            rows_of_steps = f"output.history_every={step}"
            fields = f"output.fields_every={max(step, 0.05)}"
            overrides = (*cylinders.PRIZE, f"analysis.time_step={step}", rows_of_steps, fields)
            run = cylinders.run(friction=friction, condition="massless", overrides=overrides)
            rows.append(row(name, friction, told(f"cylinders, {name}, μ = {friction}", run)))
        run = cylinders.run(
            friction=friction,
            condition="massless",
            end_time=3.75,
            overrides=(*cylinders.PRIZE, FAST),
        )
        rows.append(row("`massless`, 4 × speed, 3.75 s", friction, run, slow=False))
    for condition in ("gap", "midpoint"):
        run = cylinders.run(friction=0.0, condition=condition, overrides=cylinders.CONSERVING)
        rows.append(row(f"`{condition}`, Δt = 0.001 s", 0.0, run))
    return table(HEADER, rows)


if __name__ == "__main__":
    print(measured())
