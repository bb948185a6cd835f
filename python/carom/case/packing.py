"""Random places for round things in a box, none of which overlap."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from random import Random

Place = tuple[float, ...]

ATTEMPTS = 2000
"""Places that are tried for one thing before the box counts as full."""


def packed(
    radii: Sequence[float], corner: Place, size: Place, *, gap: float, random: Random
) -> list[Place]:
    """Return places for things of these radii, in their order; fewer where the box is full.

    Each is put where there is room for it, the largest first, and stays there: random sequential
    addition, which fills about 54 % of the plane and 38 % of space with equal ones
    (Widom, J. Chem. Phys. 44, 1966).

    Parameters
    ----------
    radii
        How far each thing reaches from its place [m], shape [n].
    corner
        Corner of the box of the smallest coordinates [m], shape [D].
    size
        Sides of the box [m], shape [D]. Things are wholly inside.
    gap
        Least distance between two things, and to the sides of the box [m].
    random
        Where the numbers come from.
    """
    if not radii:
        return []
    cells = _Cells(2.0 * max(radii) + gap)
    places: dict[int, Place] = {}
    for index in sorted(range(len(radii)), key=lambda i: -radii[i]):
        radius = radii[index]
        lows = [low + radius + gap for low in corner]
        ways = [side - 2.0 * (radius + gap) for side in size]
        if min(ways) < 0.0:
            break
        for _ in range(ATTEMPTS):
            place = tuple(low + way * random.random() for low, way in zip(lows, ways, strict=True))
            if all(math.dist(place, at) >= radius + r + gap for at, r in cells.near(place)):
                cells.add(place, radius)
                places[index] = place
                break
        else:
            break
    return [places[index] for index in sorted(places)]


class _Cells:
    """Places by the cells of a grid, so wide that only neighbours can touch."""

    def __init__(self, width: float) -> None:
        self._width = width
        self._cells: dict[tuple[int, ...], list[tuple[Place, float]]] = {}

    def add(self, place: Place, radius: float) -> None:
        self._cells.setdefault(self._cell(place), []).append((place, radius))

    def near(self, place: Place) -> Iterator[tuple[Place, float]]:
        for step in itertools.product((-1, 0, 1), repeat=len(place)):
            cell = tuple(k + s for k, s in zip(self._cell(place), step, strict=True))
            yield from self._cells.get(cell, ())

    def _cell(self, place: Place) -> tuple[int, ...]:
        return tuple(math.floor(x / self._width) for x in place)
