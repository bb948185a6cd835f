"""Smooth targets in space: Gregory patches over the facets of a boundary, through its nodes.

A patch has a cubic curve along each side and a slope across it in which both neighbours agree
(Gregory 1974; Chiyokura & Kimura 1983; Longhi 1987). Facets that are flat with all around them stay
as they are. docs/theory.md has the construction.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from carom.auditing.arrays import Array, Indices, Mask, einsum
from carom.auditing.mesh.kinds import Kind
from carom.auditing.targets.combination import Combination
from carom.auditing.targets.domain import Domain
from carom.auditing.targets.network import Network
from carom.auditing.targets.tangents import IN_PLANE, Plane, Tangents


class GregoryPatches:
    """The patches over the facets of a boundary.

    Control points are, with n corners: the corners; then of every side the two of its curve between
    its ends, and two inner ones.

    Parameters
    ----------
    kind
        Kind of the facets: triangles or quadrilaterals of first degree.
    facets
        Their nodes, shape [facet_count, n].
    points
        Reference positions of nodes [m], shape [node_count, 3].
    """

    def __init__(self, kind: Kind, facets: Indices, points: Array) -> None:
        self.domain, self._kind = Domain.of(kind), kind
        network = Network(facets, points)
        tangents = Tangents(network, points)
        corners = range(facets.shape[1])
        flat = [
            all(network.sector_of[facet, k].flat for k in corners) for facet in range(len(facets))
        ]
        self.curved: Mask = ~np.array(flat, dtype=bool)
        """Which facets are not as flat as they are drawn, shape [facet_count]."""
        controls = [
            self._controls(network, tangents, facet) if self.curved[facet] else []
            for facet in range(len(facets))
        ]
        used = [
            sorted({n for control in own for n in control.weights}) or facets[k].tolist()
            for k, own in enumerate(controls)
        ]
        widest = max(map(len, used))
        self.nodes: Indices = np.zeros((len(facets), widest), dtype=np.int64)
        self._weights = np.zeros((len(facets), 5 * len(corners), widest))
        """Weights of the nodes in every control point, [facet_count, control, node]."""
        for k, (own, nodes) in enumerate(zip(controls, used, strict=True)):
            self.nodes[k, : len(nodes)] = nodes
            for row, control in zip(self._weights[k], own, strict=False):
                for node, weight in control.weights.items():
                    row[nodes.index(node)] = weight

    def values(self, patch: Indices, xi: Array) -> Array:
        """Return the weights of the nodes at ξ, shape [count, node]."""
        shares, _ = shape_functions(self.domain, xi)
        values = einsum("kc,kcn->kn", shares, self._weights[patch])
        flat = ~self.curved[patch]
        values[flat, : len(self._kind.nodes)] = self._kind.values(xi[flat])
        return values

    def slopes(self, patch: Indices, xi: Array) -> Array:
        """Return their derivatives by ξ, shape [count, node, 2]."""
        _, shares = shape_functions(self.domain, xi)
        slopes = einsum("kca,kcn->kna", shares, self._weights[patch])
        flat = ~self.curved[patch]
        slopes[flat, : len(self._kind.nodes)] = self._kind.slopes(xi[flat])
        return slopes

    def _controls(self, network: Network, tangents: Tangents, facet: int) -> list[Combination]:
        nodes = network.facets[facet]
        count = len(nodes)
        corners = [Combination.of(node) for node in nodes]
        slopes = [tangents.of_side((facet, k)) for k in range(count)]
        planes = [tangents.plane_at((facet, k)) for k in range(count)]
        degree = 4.0 if count == 3 else 3.0
        controls = list(corners)
        for k in range(count):
            after = (k + 1) % count
            first, last = slopes[k]
            curve = [
                corners[k],
                corners[k] + 1 / 3 * first,
                corners[after] - 1 / 3 * last,
                corners[after],
            ]
            ends = [
                _End(tangents, planes[k], first, -slopes[k - 1][1]),
                _End(tangents, planes[after], last, slopes[after][0]),
            ]
            inner = _across(ends, curve)
            controls += curve[1:3]
            controls += [curve[i + 1] + 1 / degree * inner[i] for i in range(2)]
        return controls


class _End:
    """One end of a side: how its slope, turned by 90° in the tangent plane, makes the next one.

    Parameters
    ----------
    tangents, plane
        The tangents, and the plane there.
    along, off
        The slope of the side, and of the next side away from it.
    """

    def __init__(
        self, tangents: Tangents, plane: Plane | None, along: Combination, off: Combination
    ) -> None:
        self.off = off
        self.shares: tuple[Combination, float, float] | None = None
        """d, and how much of it and of the slope makes that of the next side."""
        if plane is None:
            return
        at, length = tangents.coordinates(plane, along)
        size = float(at @ at)
        if np.sqrt(size) < IN_PLANE * length:
            return
        other, _ = tangents.coordinates(plane, off)
        turned = np.array([-at[1], at[0]])
        alpha, beta = float(other @ turned) / size, float(other @ at) / size
        self.shares = (plane.image(turned), alpha, beta)


def _across(ends: list[_End], curve: list[Combination]) -> list[Combination]:
    """Return the two inner coefficients of the slope across a side.

    It is α d + β c′ with c′ along the curve; α, β and d are linear between the ends.
    """
    start, end = (each.shares for each in ends)
    if start is None or end is None:
        s0, s1 = (each.off for each in ends)
        return [2 / 3 * s0 + 1 / 3 * s1, 1 / 3 * s0 + 2 / 3 * s1]
    (d0, alpha0, beta0), (d1, alpha1, beta1) = start, end
    c = [3.0 * (b - a) for a, b in pairwise(curve)]
    # α d is of second degree, and β c′ of third.
    q = [alpha0 * d0, 0.5 * alpha0 * d1 + 0.5 * alpha1 * d0, alpha1 * d1]
    return [
        1 / 3 * q[0] + 2 / 3 * q[1] + beta1 / 3 * c[0] + 2 * beta0 / 3 * c[1],
        2 / 3 * q[1] + 1 / 3 * q[2] + 2 * beta1 / 3 * c[1] + beta0 / 3 * c[2],
    ]


Jet = tuple[Array, Array]
"""A function at points and its slope, shapes [count] and [count, 2]."""


def shape_functions(domain: Domain, xi: Array) -> Jet:
    """Return the shares of the control points at ξ, [count, control], and their slopes."""
    jets = _on_triangle(xi) if domain.is_triangle else _on_square(xi)
    return np.stack([value for value, _ in jets], axis=1), np.stack([s for _, s in jets], axis=1)


def _affine(xi: Array, constant: float, slope: tuple[float, float]) -> Jet:
    return constant + xi @ np.array(slope), np.broadcast_to(slope, xi.shape)


def _product(*jets: Jet) -> Jet:
    value, slope = jets[0]
    for other, its in jets[1:]:
        slope = slope * other[:, None] + value[:, None] * its
        value = value * other
    return value, slope


def _times(factor: float, jet: Jet) -> Jet:
    return factor * jet[0], factor * jet[1]


def _sum(a: Jet, b: Jet) -> Jet:
    return a[0] + b[0], a[1] + b[1]


def _share(a: Jet, b: Jet) -> Jet:
    """Return a/(a + b); a half where both are zero, at a corner, where it counts for nothing."""
    whole = a[0] + b[0]
    safe = np.where(whole == 0.0, 1.0, whole)
    value = np.where(whole == 0.0, 0.5, a[0] / safe)
    slope = (a[1] * b[0][:, None] - a[0][:, None] * b[1]) / (safe**2)[:, None]
    return value, np.where((whole == 0.0)[:, None], 0.0, slope)


def _on_triangle(xi: Array) -> list[Jet]:
    b = [
        _affine(xi, 1.0, (-1.0, -1.0)),
        _affine(xi, 0.0, (1.0, 0.0)),
        _affine(xi, 0.0, (0.0, 1.0)),
    ]
    corners, sides = [], []
    for k in range(3):
        s, t, o = b[k], b[(k + 1) % 3], b[(k + 2) % 3]
        corners.append(_product(s, s, s))
        # The cubic curve as one of fourth degree.
        on_side = _times(3.0, _product(s, t, _sum(s, t)))
        inner = _times(12.0, _product(s, t, o))
        sides += [_product(on_side, s), _product(on_side, t)]
        sides += [_product(inner, s, _share(t, o)), _product(inner, t, _share(s, o))]
    return [*corners, *sides]


def _on_square(xi: Array) -> list[Jet]:
    u, v = _affine(xi, 0.5, (0.5, 0.0)), _affine(xi, 0.5, (0.0, 0.5))
    u1, v1 = _affine(xi, 0.5, (-0.5, 0.0)), _affine(xi, 0.5, (0.0, -0.5))

    def cubic(s: Jet, s1: Jet) -> list[Jet]:
        middles = [_times(3.0, _product(s, s1, s1)), _times(3.0, _product(s, s, s1))]
        return [_product(s1, s1, s1), *middles, _product(s, s, s)]

    bu, bv = cubic(u, u1), cubic(v, v1)
    # Coordinates along and across each side, and the functions of the control points that way.
    around = [
        (u, u1, v, bu, bv),
        (v, v1, u1, bv, bu[::-1]),
        (u1, u, v1, bu[::-1], bv[::-1]),
        (v1, v, u, bv[::-1], bu),
    ]
    corners, sides = [], []
    for s, s1, t, along, across in around:
        corners.append(_product(along[0], across[0]))
        sides += [_product(along[1], across[0]), _product(along[2], across[0])]
        sides.append(_product(along[1], across[1], _share(s, t)))
        sides.append(_product(along[2], across[1], _share(s1, t)))
    return [*corners, *sides]
