"""Schemes that dissipate."""

from __future__ import annotations

import bars
import cylinders
from runs import theta_scheme

from sections.layout import power, table, told

THETAS = (0.5, 0.55, 0.75, 1.0)
DISSIPATION = """\
## Dissipating schemes

`--set 'analysis.scheme={{kind="theta", theta=…, xi=…}}'` with θ = ξ. Energy falls monotonically
more with larger θ, and never rises for θ > ½ (`test_dissipation.py`; cylinders until 3.2 s there).

{bars}

{cylinders}
"""


def section() -> str:
    """Run both problems with θ = ξ from ½ to 1."""
    sweeps = {
        "two bars, 0.04 s": lambda scheme: bars.run(overrides=(scheme,)),
        "two cylinders, μ = 0.2, 15 s": lambda scheme: cylinders.run(
            friction=0.2, overrides=(scheme,)
        ),
    }
    tables = [
        table(
            (f"θ = ξ, {name}", "E_end/E₀", "scheme", "friction", "normal contact", "largest rise"),
            [
                (
                    f"{theta:g}",
                    f"{run.energy('final'):.4f}",
                    f"{run.energy('scheme'):.4f}",
                    f"{run.energy('friction'):.4f}",
                    power(run.energy("normal_contact")),
                    power(run.energy_rise),
                )
                for theta in THETAS
                for run in [told(f"{name}, θ = ξ = {theta}", sweep(theta_scheme(theta)))]
            ],
        )
        for name, sweep in sweeps.items()
    ]
    return DISSIPATION.format(bars=tables[0], cylinders=tables[1])
