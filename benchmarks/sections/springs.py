"""Springs and dampers."""

from __future__ import annotations

import numpy as np
import springs

from sections.layout import power, table

STEPS = (4e-3, 2e-3, 1e-3)

TEXT = """\
## Springs and dampers

A rigid block of {mass:g} kg on a spring of {stiffness:g} N/m (`tests/validation/springs.py`).

**Oscillator**, conserving: in its phase plane it turns by 2 arctan(ω Δt/2) in every step. Errors
of its places over 100 periods, relative to the amplitude, against that and against the motion
without steps over 3, and the largest drift of its energy. Asserted in
`test_springs.py::test_an_oscillator_turns_in_its_phase_plane_and_keeps_its_energy` and
`test_springs.py::test_its_period_converges_with_the_square_of_the_step`.

{swings}

**Damped**, ζ = {ratio:g}: the logarithmic decrement 2πζ/√(1 − ζ²) = {decrement:.5f}, relative
errors by the number of steps of a period; observed order {order:.2f}. Asserted in
`test_springs.py::test_a_damped_oscillator_has_its_logarithmic_decrement`.

{damped}

**Dry friction**, μ = {friction:g}, from 0.37 m: the amplitude falls by 2 μ N/k = {fall:g} m in
every half cycle, and the block stops where k |x| ≤ μ N. Δt = 1e-4 s; the largest error of all
amplitudes and of the place where it stops, relative to 0.37 m: {rubbed} in {halves} half cycles,
bound 1e-6
(`test_springs.py::test_dry_friction_takes_its_part_of_the_amplitude_in_every_half_cycle`).

**Stick–slip** on a belt at {belt:g} m/s, μ_s = {static:g}, μ_k = {kinetic:g}: sticking for
{stick:.4f} s, sliding for {slip:.4f} s, amplitude {amplitude:.5f} m as under *Friction laws*.
Relative errors; whole steps are counted. Asserted in
`test_springs.py::test_stick_slip_on_a_belt_is_that_of_the_closed_form`.

{cycles}
"""


def section() -> str:
    """Run the block with finer and finer steps."""
    swings = []
    for steps in (40, 80, 160):
        places, _, drift = springs.swing(springs.oscillator(steps_per_period=steps, periods=100.0))
        _, exact, _ = springs.swing(springs.oscillator(steps_per_period=steps, periods=3.0))
        swings.append((steps, power(places), power(exact), power(drift)))
    errors, order = springs.decrements()
    reached, wanted, _ = springs.rubbed()
    cycles = [(f"{step:g} s", *map(power, springs.stick_slip(step))) for step in STEPS]
    return TEXT.format(
        mass=springs.MASS,
        stiffness=springs.STIFFNESS,
        swings=table(("steps", "phase plane", "no steps", "drift of E/E₀"), swings),
        ratio=springs.RATIO,
        decrement=springs.DECREMENT,
        order=order,
        damped=table(
            ("steps", "error"), [(n, power(e)) for n, e in zip((50, 100, 200), errors, strict=True)]
        ),
        friction=springs.FRICTION,
        fall=springs.FALL,
        rubbed=power(np.abs(reached - wanted).max() / wanted[0]),
        halves=len(wanted) - 1,
        belt=springs.BELT,
        static=springs.STATIC,
        kinetic=springs.KINETIC,
        stick=springs.STICK,
        slip=springs.SLIP,
        amplitude=springs.AMPLITUDE,
        cycles=table(("Δt", "sticking", "sliding", "farthest", "nearest"), cycles),
    )
