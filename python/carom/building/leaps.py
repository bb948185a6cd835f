"""Bodies that would leap: no search finds what they pass, and no law holds for what they hit."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from carom.case.scenario import Scenario
from carom.errors import InputError

LEAP = 10.0
"""Motion in a step, in diameters of the body, that is no motion any more."""


def refuse_leaps(scenario: Scenario, description: Mapping[str, Any]) -> None:
    """Refuse velocities and spins with which a body leaves everything behind in one step.

    Parameters
    ----------
    scenario
        The case.
    description
        What the native simulation says of it.

    Raises
    ------
    InputError
        A body moves by more than `LEAP` times its size in the first step.
    """
    step = scenario.analysis.time_step
    if scenario.analysis.kind != "dynamic":
        return
    for index, (body, built) in enumerate(zip(scenario.bodies, description["bodies"], strict=True)):
        size = built["diameter"]
        spin = body.spin if isinstance(body.spin, tuple) else (body.spin or 0.0,)
        for key, speed in (
            ("velocity", math.hypot(*(body.velocity or ()))),
            ("spin", 0.5 * size * math.hypot(*spin)),
        ):
            if step * speed > LEAP * size:
                place = f"bodies.{index}.{key}"
                raise InputError(
                    f"{place}: {body.name} would move by {step * speed:.3g} m in a step of "
                    f"{step:g} s, and it is {size:.3g} m large; check the unit, or take a "
                    "shorter analysis.time_step",
                    place,
                )
