"""Which foot of a point goes on from a known one."""

from __future__ import annotations

import numpy as np

from carom.auditing.arrays import Array, Indices
from carom.auditing.targets.feet import BEYOND, CORNER, Feet, Target


def goes_on(
    feet: Feet,
    mine: Indices,
    known: tuple[int, Array],
    target: Target,
    *,
    begun: Array | None,
    otherwise: int,
) -> int:
    """Return which of the feet `mine` of a point goes on from a known one.

    It stays on its facet. On a smooth target it goes on to the next one where the foot is on that;
    beyond an edge, beside both, it stays. In steps in time it stays for half a facet beyond a kink
    of the plane, of a side that was straight, which is concave at the start of the step.

    Parameters
    ----------
    feet
        Feet of points.
    mine
        Those of the point.
    known
        Facet of the known foot, and its normal.
    target
        The target.
    begun
        Where nodes of the target are at the start of a step in time of the plane [m], else None.
    otherwise
        What to return where none goes on from it.
    """
    facet, normal = known
    own = feet.facet[mine] == facet
    on = feet.beyond[mine] == 0.0
    walks = facet >= 0 and bool(target.smooth[facet])
    choices = [own & on] if walks else [own]
    if walks:
        # Sides beyond a corner are not beside it.
        beside = np.isin(target.facets[feet.facet[mine]], target.facets[facet]).any(axis=1)
        beside &= feet.normal[mine] @ normal > CORNER
        beside &= target.smooth[feet.facet[mine]]
        # At ends that are smooth a facet has no feet beyond.
        both = [own & (feet.beyond[mine] < BEYOND), beside & on]
        if begun is not None and all(chosen.any() for chosen in both):
            next_facet = int(feet.facet[mine[both[1].argmax()]])
            if _is_concave(target.facets[[facet, next_facet], :2], begun):
                choices.append(both[0])
        choices += [beside & on, own]
    found = next((chosen for chosen in choices if chosen.any()), None)
    return otherwise if found is None else int(mine[found.argmax()])


def _is_concave(sides: Indices, position: Array) -> bool:
    """Return whether a line turns outwards from a side to the next or the one before.

    Both are given by their first and last nodes, shape [2, 2].
    """
    (x, y), (u, v) = position[sides[:, 1]] - position[sides[:, 0]]
    left = float(x * v - y * u)
    return left < 0.0 if sides[0, 1] == sides[1, 0] else left > 0.0
