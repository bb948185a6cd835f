"""Energy-exact, quiet and non-penetrating at once: the cylinders with massless contact.

.venv/bin/python benchmarks/prize.py
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "validation"))

import cylinders
from runs import Run

STEPS = (2e-3, 1e-3, 5e-4, 2.5e-4)  # s
FAST = "bodies.0.velocity=[4.0, -8.0]"


def row(name: str, friction: float, run: Run, *, slow: bool = True) -> str:
    """Describe a run."""
    summary = run.summary
    free = friction == 0.0
    cells = (
        name,
        f"{friction:g}",
        f"{run.energy('max_drift'):.1e}" if free else "–",
        f"{run.energy('max_defect'):.1e}",
        f"{summary['min_gap']:.1e}".replace("-", "−", 1),
        f"{cylinders.total_variation(run):.0f}" if free and slow else "–",
        f"{max(cylinders.momentum_spread(run).values()):.0e}" if free and slow else "–",
        f"{summary['max_blend']:.2f}",
        f"{summary['least_friction']:.0e}",
        f"{summary['newton_iterations'] / summary['steps']:.1f}",
        str(summary["retried_steps"]),
        f"{1e3 * run.wall / summary['steps']:.2f}",
    )
    return f"| {' | '.join(cells)} |"


def main() -> None:
    """Run and print."""
    for friction in (0.0, 0.2):
        for step in STEPS:
            overrides = (*cylinders.PRIZE, f"analysis.time_step={step}")
            run = cylinders.run(friction=friction, condition="massless", overrides=overrides)
            print(row(f"`massless`, Δt = {step:g} s", friction, run), flush=True)
        run = cylinders.run(
            friction=friction,
            condition="massless",
            end_time=3.75,
            overrides=(*cylinders.PRIZE, FAST),
        )
        print(row("`massless`, 4 × speed, 3.75 s", friction, run, slow=False), flush=True)
    for condition in ("gap", "midpoint"):
        run = cylinders.run(friction=0.0, condition=condition, overrides=cylinders.CONSERVING)
        print(row(f"`{condition}`, Δt = 0.001 s", 0.0, run), flush=True)


if __name__ == "__main__":
    main()
