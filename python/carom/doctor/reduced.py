"""Reduced bodies: whether they are slow and stiff enough for what their shapes leave out."""

from __future__ import annotations

import math
from collections.abc import Iterator

from carom.doctor.finding import Finding
from carom.doctor.patient import Patient

FAST = 0.1
"""Spin over the lowest frequency above which what spin does to shapes is 1 %."""


def reduced(patient: Patient) -> Iterator[Finding]:
    """Look at what reduced bodies leave out."""
    bodies = patient.description["bodies"]
    for index, (body, built) in enumerate(zip(patient.scenario.bodies, bodies, strict=True)):
        if built["vibrations"] is None:
            continue
        count, lowest = built["vibrations"]["count"], built["vibrations"]["lowest"]
        spin = body.spin if isinstance(body.spin, tuple) else (body.spin or 0.0,)
        speed = math.hypot(*spin)
        fact = f"{body.name} is reduced to {count} vibrations, the slowest of {lowest:.4g} rad/s"
        if speed <= FAST * lowest:
            yield Finding("ok", f"bodies.{index}", fact)
            continue
        yield Finding(
            "warning",
            f"bodies.{index}.spin",
            f"{fact}, and it spins at {speed:.4g} rad/s: it leaves out how spin stretches it",
            'leave kind out, so that it is "deformable"',
        )
