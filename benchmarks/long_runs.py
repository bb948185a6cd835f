"""Does an error of the energy grow? 150,000 steps of the two cylinders, printed as a table.

    .venv/bin/python benchmarks/long_runs.py [midpoint | massless …]

Takes some three minutes per row.
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "validation"))

import cylinders
import numpy as np
from runs import growth

END = 150.0  # s
MARKS = (5_000, 15_000, 50_000, 100_000, 150_000)
SETTLED = 30_000
"""From when on the growth is fitted: all modes of the bodies then vibrate."""

CASES = (
    ("midpoint", 0.0, ()),
    ("midpoint", 0.0, ("analysis.newton.tolerance=1e-12",)),
    ("midpoint", 0.2, ()),
    ("massless", 0.0, ()),
)


def main() -> None:
    """Run and print."""
    chosen = sys.argv[1:]
    for condition, friction, overrides in CASES:
        if chosen and condition not in chosen:
            continue
        run = cylinders.run(
            friction=friction,
            condition=condition,
            end_time=END,
            overrides=(
                *(cylinders.PRIZE if condition == "massless" else cylinders.CONSERVING),
                *overrides,
            ),
        )
        defect = run.curve("defect")
        steps = np.diff(defect[SETTLED:])
        cells = (
            f"`{condition}`",
            f"{friction:g}",
            *(overrides or ("default",)),
            *(f"{np.abs(defect[: mark + 1]).max():.1e}" for mark in MARKS),
            f"{growth(defect, first=SETTLED):.2f}",
            f"{steps.mean():.0e}",
            f"{steps.std():.0e}",
            str(run.summary["retried_steps"]),
        )
        print(f"| {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main()
