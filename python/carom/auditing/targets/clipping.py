"""What two facets have in common where one is seen in the plane of the other, and its integrals.

A facet of the plane is an interval there, one of space a convex polygon. Both are given by their
corners, shape [corner, 1] or [corner, 2], in rising order or counter-clockwise.
"""

from __future__ import annotations

import numpy as np

from carom.auditing.arrays import Array

Rule = tuple[Array, Array]
"""Points of quadrature, shape [q, D − 1], and their weights, shape [q]."""


def common(subject: Array, window: Array) -> Array:
    """Return the corners of what both have in common; none where that is nothing."""
    if subject.shape[1] == 1:
        low, high = max(subject[0, 0], window[0, 0]), min(subject[1, 0], window[1, 0])
        return np.array([[low], [high]]) if low < high else np.zeros((0, 1))
    # Cut along every side of the window (Sutherland & Hodgman 1974).
    part = list(subject)
    for a, b in zip(window, np.roll(window, -1, axis=0), strict=True):
        heights = [_twice_area(a, b, p) for p in part]
        kept = []
        for k, (p, height) in enumerate(zip(part, heights, strict=True)):
            after = (k + 1) % len(part)
            if height >= 0.0:
                kept.append(p)
            if height * heights[after] < 0.0:
                kept.append(p + height / (height - heights[after]) * (part[after] - p))
        part = kept
    return np.array(part).reshape(-1, 2)


def oriented(corners: Array) -> Array:
    """Return corners in rising order, or counter-clockwise."""
    if corners.shape[1] == 1:
        return np.sort(corners, axis=0)
    return corners if sum(map(size, _fan(corners))) >= 0.0 else corners[::-1]


def size(simplex: Array) -> float:
    """Return the length of a segment or the area of a triangle; negative of one that is turned."""
    if simplex.shape[1] == 1:
        return float(simplex[1, 0] - simplex[0, 0])
    return 0.5 * _twice_area(*simplex)


def whole_size(corners: Array) -> float:
    """Return the size of what has these corners."""
    return size(corners) if corners.shape[1] == 1 else sum(map(size, _fan(corners)))


def cut(corners: Array) -> list[Array]:
    """Return the simplices over which an interval or a polygon is integrated.

    One with more than three corners is cut from its centre.
    """
    if len(corners) <= corners.shape[1]:
        return []
    if len(corners) == corners.shape[1] + 1:
        return [corners]
    shares = np.array([abs(size(simplex)) for simplex in _fan(corners)])
    if shares.sum() == 0.0:
        return []
    middles = np.array([simplex.mean(axis=0) for simplex in _fan(corners)])
    centre = shares @ middles / shares.sum()
    sides = zip(corners, np.roll(corners, -1, axis=0), strict=True)
    return [np.stack([centre, a, b]) for a, b in sides]


def rule_over(simplex: Array, *, curved: bool) -> Rule:
    """Return the rule of a simplex: exact to degree 5 on segments, on triangles to 4, curved 6."""
    if simplex.shape[1] == 1:
        places, weights = np.polynomial.legendre.leggauss(3)
        shares = np.stack([0.5 - 0.5 * places, 0.5 + 0.5 * places], axis=1)
        return shares @ simplex, 0.5 * weights * size(simplex)
    shares, weights = _TWELVE if curved else _SIX
    return shares @ simplex, weights * size(simplex)


def _fan(corners: Array) -> list[Array]:
    return [corners[[0, k, k + 1]] for k in range(1, len(corners) - 1)]


def _twice_area(a: Array, b: Array, c: Array) -> float:
    return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))


def _orbits(*orbits: tuple[tuple[float, ...], float]) -> Rule:
    """Return barycentric points and weights of orbits, each by a point and its weight."""
    rows = []
    for point, weight in orbits:
        a, b = point[:2]
        c = 1.0 - a - b
        turns = [(a, b, c), (b, c, a), (c, a, b)]
        if len({a, b, c}) == 3:
            turns += [(a, c, b), (c, b, a), (b, a, c)]
        rows += [(*turn, weight) for turn in turns]
    table = np.array(rows)
    return table[:, :3], table[:, 3]


# Dunavant, Int. J. Numer. Methods Eng. 21, 1985.
_SIX = _orbits(
    ((0.445_948_490_915_964_9,) * 2, 0.223_381_589_678_011_47),
    ((0.091_576_213_509_770_74,) * 2, 0.109_951_743_655_321_87),
)
_TWELVE = _orbits(
    ((0.249_286_745_170_910_42,) * 2, 0.116_786_275_726_379_37),
    ((0.063_089_014_491_502_23,) * 2, 0.050_844_906_370_206_82),
    ((0.053_145_049_844_816_95, 0.310_352_451_033_784_4), 0.082_851_075_618_373_57),
)
