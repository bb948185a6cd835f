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
    stays: bool,
    otherwise: int,
) -> int:
    """Return which of the feet `mine` of a point goes on from a known one.

    It stays on its facet. On a smooth target it goes on to the next one where the foot is on that;
    beyond an edge, beside both, it stays. At kinks of the plane, of sides that were straight, it
    may stay for half a facet.

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
    stays
        Whether it stays at kinks.
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
        if stays:
            # At its other ends a facet has no feet beyond.
            choices.append(own & (feet.beyond[mine] < BEYOND))
        choices += [beside & on, own]
    found = next((chosen for chosen in choices if chosen.any()), None)
    return otherwise if found is None else int(mine[found.argmax()])
