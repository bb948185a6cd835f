"""Bodies that would leap: no search finds what they pass, and no law holds for what they hit."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from carom.case.body import AnyBody
from carom.case.full_stage import FullStage
from carom.case.scenario import Scenario
from carom.case.stage import GivenVelocity
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
    names = [body.name for body in scenario.bodies]
    for stage in scenario.full_stages():
        if not stage.is_dynamic:
            continue
        moves: list[tuple[int, AnyBody | GivenVelocity]]
        moves = [(names.index(given.body), given) for given in stage.velocities]
        paths = [f"{stage.key}velocities.{number}" for number in range(len(moves))]
        if stage.start_time == 0.0:
            moves += list(enumerate(scenario.bodies))
            paths += [f"bodies.{index}" for index in range(len(names))]
        for path, (index, given) in zip(paths, moves, strict=True):
            _refuse_leap(given, description["bodies"][index], stage, path)


def _refuse_leap(
    given: AnyBody | GivenVelocity, built: Mapping[str, Any], stage: FullStage, path: str
) -> None:
    """Refuse a body that leaves everything behind in one step of a stage."""
    size, step = built["diameter"], stage.analysis.time_step
    spin = given.spin if isinstance(given.spin, tuple) else (given.spin or 0.0,)
    for key, speed in (
        ("velocity", math.hypot(*(given.velocity or ()))),
        ("spin", 0.5 * size * math.hypot(*spin)),
    ):
        if step * speed > LEAP * size:
            place = f"{path}.{key}"
            raise InputError(
                f"{place}: {built['name']} would move by {step * speed:.3g} m in a step of "
                f"{step:g} s, and it is {size:.3g} m large; check the unit, or take a "
                f"shorter {stage.key}analysis.time_step",
                place,
            )
