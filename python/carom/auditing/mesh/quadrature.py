"""Rules of integration over the reference domains of cells and facets."""

from __future__ import annotations

from functools import cache

import numpy as np

from carom.auditing.arrays import Array
from carom.auditing.mesh.kinds import Kind

Rule = tuple[Array, Array]
"""Points, shape [q, d], and their weights, shape [q]."""


def rule_of_stresses(kind: Kind, *, revolution: bool = False) -> Rule:
    """Return the rule that is exact for products of slopes in cells that are not distorted.

    In a body of revolution strains of hoops are values, and the radius is a factor.
    """
    return _rule(kind, 2 * kind.degree if revolution else 2 * (kind.degree - 1))


def rule_of_masses(kind: Kind, *, revolution: bool = False) -> Rule:
    """Return the rule that is exact for products of values in cells that are not distorted."""
    return _rule(kind, 2 * kind.degree + 1 if revolution else 2 * kind.degree)


def _rule(kind: Kind, degree: int) -> Rule:
    if kind.is_wedge:
        return _swept(kind)
    if not kind.is_simplex:
        return _gauss(kind.degree, kind.dimension)
    return (_triangle if kind.dimension == 2 else _tetrahedron)(degree)


def _swept(kind: Kind) -> Rule:
    """Return the rule of a wedge: slopes along it have the whole degree of the triangle."""
    places, weights = _triangle(2 * kind.degree)
    heights, shares = np.polynomial.legendre.leggauss(kind.degree + 1)
    table = [np.column_stack([places, np.full(len(places), z)]) for z in heights]
    return np.concatenate(table), np.concatenate([share * weights for share in shares])


@cache
def _gauss(degree: int, dimension: int) -> Rule:
    """Return the product of Gauss's rules with two or, for the second degree, three points."""
    places, weights = np.polynomial.legendre.leggauss(degree + 1)
    grids = np.meshgrid(*[places] * dimension, indexing="ij")
    parts = np.meshgrid(*[weights] * dimension, indexing="ij")
    weight: Array = np.prod([part.ravel() for part in parts], axis=0)
    return np.stack([grid.ravel() for grid in grids], axis=1), weight


def _orbit(dimension: int, a: float) -> Array:
    """Return the points with the barycentric coordinates a but for one, the corners' own."""
    table = np.full((dimension + 1, dimension), a)
    for axis in range(dimension):
        table[axis + 1, axis] = 1.0 - dimension * a
    return table


def _joined(*parts: tuple[Array, float]) -> Rule:
    points = np.concatenate([places for places, _ in parts])
    return points, np.concatenate([np.full(len(places), weight) for places, weight in parts])


def _triangle(degree: int) -> Rule:
    """Return the rule of Dunavant (1985) of the least degree that will do, up to five."""
    middle = np.full((1, 2), 1.0 / 3.0)
    if degree < 2:
        return _joined((middle, 0.5))
    if degree == 2:
        return _joined((_orbit(2, 1.0 / 6.0), 1.0 / 6.0))
    if degree < 5:
        # Both orbits of the six points of degree four, in closed form.
        root = np.sqrt(38.0 - 44.0 * np.sqrt(0.4))
        other = np.sqrt(213125.0 - 53320.0 * np.sqrt(10.0))
        near = ((8.0 - np.sqrt(10.0) + root) / 18.0, (620.0 + other) / 3720.0)
        far = ((8.0 - np.sqrt(10.0) - root) / 18.0, (620.0 - other) / 3720.0)
        return _joined(*((_orbit(2, a), 0.5 * weight) for a, weight in (near, far)))
    root = np.sqrt(15.0)
    orbits = [(_orbit(2, (6.0 + s) / 21.0), (155.0 + s) / 2400.0) for s in (-root, root)]
    return _joined((middle, 9.0 / 80.0), *orbits)


def _tetrahedron(degree: int) -> Rule:
    """Return the rule of the least degree that will do, up to five (Walkington 2000)."""
    if degree < 2:
        return _joined((np.full((1, 3), 0.25), 1.0 / 6.0))
    if degree == 2:
        return _joined((_orbit(3, (5.0 - np.sqrt(5.0)) / 20.0), 1.0 / 24.0))
    a = 0.045_503_704_125_649_65
    # Two of the four barycentric coordinates are a, the others ½ − a.
    pairs = [(i, j) for i in range(4) for j in range(i)]
    edges = np.array([[a if k in pair else 0.5 - a for k in range(1, 4)] for pair in pairs])
    return _joined(
        (_orbit(3, 0.310_885_919_263_300_6), 0.112_687_925_718_015_85 / 6.0),
        (_orbit(3, 0.092_735_250_310_891_23), 0.073_493_043_116_361_95 / 6.0),
        (edges, 0.042_546_020_777_081_47 / 6.0),
    )
