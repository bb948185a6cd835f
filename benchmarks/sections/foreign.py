"""Bodies of other codes in runs of carom."""

from __future__ import annotations

import foreign_cylinders

from sections.layout import FRICTIONS, power, table, told

FOREIGN = """\
## Bodies of another code

The cylinders as `carom.ForeignBody`, in `carom.run`: triangles of a page of NumPy
(`tests/plain_fem.py`), of which carom asks mass, energy, force and stiffness. Scheme, condition
and start are those of the section above; Δt = 1e-3 s, 15 s. Asserted in
`test_foreign_cylinders.py`.

{runs}
"""


def section() -> str:
    """Run the cylinders by another code, without and with friction."""
    return FOREIGN.format(
        runs=table(
            (
                "μ",
                "drift",
                "defect",
                "friction",
                "certificate [J]",
                "contacts",
                "iterations per step",
            ),
            [
                (
                    f"{friction:g}",
                    power(run.energy("max_drift")) if friction == 0.0 else "–",
                    power(run.energy("max_defect")),
                    f"{run.energy('friction'):.4f}",
                    power(run.summary["certificate"]["max_joule"]),
                    len(run.summary["contacts"]),
                    f"{run.summary['newton_iterations'] / run.summary['steps']:.1f}",
                )
                for friction in FRICTIONS
                for run in [
                    told(
                        f"cylinders of another code, μ = {friction}",
                        foreign_cylinders.run(friction=friction),
                    )
                ]
            ],
        )
    )
