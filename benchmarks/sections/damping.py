"""The damped oscillator."""

from __future__ import annotations

import oscillator

from sections.layout import table

ORDERS = {0.5: 2, 1.0: 1}
"""Order of the scheme in Δt by θ = ξ."""

DAMPING = """\
## Damped motion

Rayleigh damping C = α M + β K with α = {alpha:g} /s and β = {beta:g} s, one cell of 1 m × 1 m
(`tests/validation/oscillator.py`): the exact solutions are a decaying velocity and a damped
oscillator. Largest error over 1 s relative to the largest exact value, by number of steps, and the
order in Δt by least squares. Asserted in
`test_damping.py::test_damped_motion_converges_at_the_order_of_the_scheme`.

{orders}
"""


def section() -> str:
    """Run the damped motions with finer and finer steps."""
    motions = (
        ("free flight", oscillator.coasting, oscillator.coasting_error),
        ("column under gravity", oscillator.column, oscillator.column_error),
    )
    rows = []
    for name, motion, error in motions:
        for theta, expected in ORDERS.items():
            runs = [motion(steps=steps, theta=theta) for steps in oscillator.STEPS]
            order = oscillator.order(runs, error)
            errors = [f"{error(run):.2e}" for run in runs]
            rows.append((name, f"{theta:g}", *errors, f"{order:.3f}", expected))
    return DAMPING.format(
        alpha=oscillator.DAMPING.mass,
        beta=oscillator.DAMPING.stiffness,
        orders=table(
            ("motion", "θ = ξ", *(str(steps) for steps in oscillator.STEPS), "order", "expected"),
            rows,
        ),
    )
