"""Friction that depends on the sliding."""

from __future__ import annotations

import friction_laws
import numpy as np

from sections.layout import power, table

STEPS = (4e-3, 2e-3, 1e-3, 5e-4)

TEXT = """\
## Friction laws

A mass of 1 kg that weighs 10 N on a belt, held by a spring of 100 N/m, as a body of another code
(`tests/validation/friction_laws.py`).

**Stick–slip**, μ_s = {static:g}, μ_k = {kinetic:g}, belt at {belt:g} m/s. With Δ = (μ_s − μ_k)
N/k and ω² = k/m the mass sticks for 2Δ/v = {stick:.4f} s, slides for (2/ω)(π − arctan(ωΔ/v)) =
{slip:.4f} s, and swings by √(Δ² + v²/ω²) = {amplitude:.5f} m about the place where it would rest
while it slides. Relative errors by the time step; whole steps are counted. Asserted to 0.5 % in
`test_friction_laws.py::test_stick_slip_on_a_belt_is_that_of_the_closed_form`.

{cycles}

**Dry friction stops a swing** from 0.1 m: the amplitude falls by 2 μ_k N/k in every half cycle,
and the mass stops where k |x| ≤ μ_s N. Δt = 1e-4 s; the largest error of all amplitudes and of
the place where it stops, relative to 0.1 m. Asserted in
`test_friction_laws.py::test_dry_friction_stops_a_swing`.

{swings}

**Slip weakening** from 0.6 to 0.2 over 0.02 m: friction takes N (μ_k S + (μ_s − μ_k) D_c/2) over
the slip S. Asserted in `test_friction_laws.py::test_slip_weakening_takes_its_fracture_energy`.

{weakened}
"""


def section() -> str:
    """Run the masses with finer and finer steps."""
    cycles = [(f"{step:g} s", *map(power, friction_laws.stick_slip(step))) for step in STEPS]
    swings = []
    for static, kinetic in ((0.1, 0.1), (0.45, 0.1)):
        reached, wanted = friction_laws.oscillation(static, kinetic)
        error = np.abs(reached - wanted).max() / wanted[0]
        swings.append((f"{static:g}", f"{kinetic:g}", len(wanted) - 1, power(error), "≤ 1e-6"))
    weakened = []
    for step in (4e-4, 2e-4, 1e-4):
        taken, by_hand, defect, certificate = friction_laws.weakening(step)
        off = abs(taken / by_hand - 1.0)
        weakened.append((f"{step:g} s", *map(power, (off, defect, certificate))))
    return TEXT.format(
        static=friction_laws.STATIC,
        kinetic=friction_laws.KINETIC,
        belt=friction_laws.BELT,
        stick=friction_laws.STICK,
        slip=friction_laws.SLIP,
        amplitude=friction_laws.AMPLITUDE,
        cycles=table(("Δt", "sticking", "sliding", "farthest", "nearest"), cycles),
        swings=table(("μ_s", "μ_k", "half cycles", "error", "bound"), swings),
        weakened=table(
            ("Δt", "error of the energy", "largest defect [J]", "largest certificate [J]"), weakened
        ),
    )
