"""Energy and momenta to round-off."""

from __future__ import annotations

import cylinders

from sections.layout import FRICTIONS, power, table, told

CONSERVATION = """\
## Energy and momenta to round-off

The cylinders with `--set 'analysis.scheme={{kind="conserving"}}' --set contact.condition=midpoint`
and the first one 0.3 mm higher, over 15 s. Asserted at Δt = 1e-3 s in `test_conservation.py`, with
linear and angular momentum between wall contacts.

{runs}
"""


def section() -> str:
    """Run the cylinders with the energy–momentum scheme and finer and finer steps."""
    return CONSERVATION.format(
        runs=table(
            ("Δt [s]", "μ", "largest drift", "largest defect", "friction", "iterations per step"),
            [
                (
                    f"{step:g}",
                    f"{friction:g}",
                    power(run.energy("max_drift")) if friction == 0.0 else "–",
                    power(run.energy("max_defect")),
                    f"{run.energy('friction'):.4f}",
                    f"{run.summary['newton_iterations'] / run.summary['steps']:.1f}",
                )
                for friction in FRICTIONS
                for step in (2e-3, 1e-3, 5e-4)
                for run in [
                    told(
                        f"cylinders, conserving, μ = {friction}, Δt = {step:g}",
                        cylinders.run(
                            friction=friction,
                            condition="midpoint",
                            overrides=(*cylinders.CONSERVING, f"analysis.time_step={step}"),
                        ),
                    )
                ]
            ],
        )
    )
