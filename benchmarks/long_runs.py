"""Does an error of the energy grow? 150,000 steps of the two cylinders, printed as a table.

    .venv/bin/python benchmarks/long_runs.py [midpoint | massless …]

Takes half a minute to three minutes per row.
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "validation"))

import cylinders
import numpy as np
from runs import growth
from sections.layout import power, table, told

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

HEADER = (
    *("condition", "μ", "Newton tolerance", *(f"{mark:,}" for mark in MARKS)),
    *("exponent", "mean", "deviation", "tried again"),
)


def measured(chosen: list[str]) -> str:
    """Run the cases of these conditions, or all, and return the table."""
    rows = []
    for condition, friction, overrides in CASES:
        if chosen and condition not in chosen:
            continue
        scheme = cylinders.PRIZE if condition == "massless" else cylinders.CONSERVING
        run = cylinders.run(
            friction=friction,
            condition=condition,
            end_time=END,
            overrides=(*scheme, *overrides),
        )
        told(f"cylinders, {END:g} s, {condition}, μ = {friction}, {overrides}", run)
        defect = run.curve("defect")
        steps = np.diff(defect[SETTLED:])
        rows.append(
            (
                f"`{condition}`",
                f"{friction:g}",
                *(each.split("=")[1] for each in overrides or ("=default",)),
                *(power(np.abs(defect[: mark + 1]).max()) for mark in MARKS),
                f"{growth(defect, first=SETTLED):.2f}",
                f"{steps.mean():.0e}".replace("-", "−", 1 if steps.mean() < 0 else 0),
                f"{steps.std():.0e}",
                str(run.summary["retried_steps"]),
            )
        )
    return table(HEADER, rows)


if __name__ == "__main__":
    print(measured(sys.argv[1:]))
