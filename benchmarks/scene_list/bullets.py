"""Blocks that are shot at thin walls."""

from __future__ import annotations

from .making import SCENES, Case, block, case, fixed

SPEEDS = (10, 100, 1000)
"""Of bullets, in their sizes per second."""


def bullet(dimension: int, sizes_per_second: float, *, rigid: bool) -> Case:
    """Return a block shot at a thin wall."""
    size = 0.2
    speed = size * sizes_per_second
    aside = [-size / 2] * (dimension - 1)
    velocity = [0.0] * (dimension - 1) + [-speed]
    shot = block([*aside, 0.25], [size] * dimension, [4] * dimension, velocity=velocity)
    corner, wall = [-0.5] * (dimension - 1) + [-0.02], [1.0] * (dimension - 1) + [0.04]
    bodies, obstacles = [shot], [fixed("wall", corner, wall)]
    if not rigid:
        bodies, obstacles = [shot, block(corner, wall, [8] * (dimension - 1) + [1])], []
    made = case(bodies, obstacles, end=0.6 / speed, step=0.06 / speed, gravity=False, damped=False)
    # What meets it must not be faster than sound in it: that would be another question.
    made["materials"]["m"]["young"] = max(1e6, 1e3 * (10.0 * speed) ** 2)
    return made


def _enter_bullets() -> None:
    for dimension, where in ((2, "in the plane"), (3, "in space")):
        for speed in SPEEDS:
            for rigid in (True, False):
                name = f"bullet {speed} {'rigid' if rigid else 'loose'} {where}"
                SCENES[name] = lambda _, d=dimension, s=speed, r=rigid: bullet(d, s, rigid=r)


_enter_bullets()
