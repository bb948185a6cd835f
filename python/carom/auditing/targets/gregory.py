"""Smooth targets in space: Gregory patches over the facets of a boundary, through its nodes.

A patch has a cubic curve along each side and a slope across it in which both neighbours agree
(Gregory 1974; Chiyokura & Kimura 1983; Longhi 1987). Facets that are flat with all around them stay
as they are. docs/theory.md has the construction.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise

import numpy as np

from carom.auditing.arrays import Array, Indices, Mask, einsum, sizes
from carom.auditing.mesh.facets import corners_of, node_counts
from carom.auditing.targets.combination import Combination
from carom.auditing.targets.domain import SQUARE, TRIANGLE, Domain, Domains
from carom.auditing.targets.feet import TIE
from carom.auditing.targets.network import Network
from carom.auditing.targets.sheet import FlatPatches, rim_edges
from carom.auditing.targets.tangents import IN_PLANE, Plane, Tangents
from carom.auditing.targets.tiles import cut, padded

LOOSE = 0.05
"""Patches do not quite meet at sharp edges where some are cells of second degree as they are: up to
this part of their size their distances say nothing of which is closer."""

CONTROLS = 20
"""Control points of a patch with four sides; one with three has 15."""


class GregoryPatches:
    """The patches over the facets of a boundary.

    Facets of second degree are cut into tiles between their nodes, each with a patch. Control
    points are, with n corners: the corners; then of every side the two of its curve between its
    ends, and two inner ones.

    Parameters
    ----------
    facets
        Facets, of one kind or several, shape [facet_count, a].
    points
        Reference positions of nodes [m], shape [node_count, 3].
    """

    def __init__(self, facets: Indices, points: Array) -> None:
        tiles, owner = cut(facets)
        network = Network(tiles, points)
        tangents = Tangents(network, points)
        straight = [
            all(network.sector_of[tile, k].flat for k in range(len(nodes)))
            for tile, nodes in enumerate(tiles)
        ]
        bent = {own for own, is_flat in zip(owner, straight, strict=True) if not is_flat}
        # What is flat all over stays as its shape functions have it.
        kept = [tile for tile, own in enumerate(owner) if own in bent]
        whole = np.array([f for f in range(len(facets)) if f not in bent], dtype=np.int64)
        self.curved: Mask = np.arange(len(kept) + len(whole)) < len(kept)
        """Which patches go on into others without a kink, shape [patch_count]: they come first."""
        parts = [tile - owner.index(own) for tile, own in enumerate(owner)]
        self.over: Mapping[tuple[int, int], int] = {
            (owner[tile], parts[tile]): patch for patch, tile in enumerate(kept)
        }
        self.owners: Sequence[int] = [*(owner[tile] for tile in kept), *whole.tolist()]
        controls = [self._controls(network, tangents, tile) for tile in kept]
        used = [sorted({n for control in own for n in control.weights}) for own in controls]
        flat = facets[whole]
        self._flat = FlatPatches(flat)
        widest = max([flat.shape[1] if len(flat) else 0, *map(len, used)])
        self._weights = np.zeros((len(kept), CONTROLS, widest))
        """Weights of the nodes in every control point, [tile, control, node]."""
        for k, (own, nodes) in enumerate(zip(controls, used, strict=True)):
            for row, control in zip(self._weights[k], own, strict=False):
                for node, weight in control.weights.items():
                    row[nodes.index(node)] = weight
        self._count = max(CONTROLS, flat.shape[1])
        self.nodes = padded([*used, *flat.tolist()], widest)
        corners = [tiles[tile] for tile in kept]
        self.facets = padded([*corners, *flat.tolist()], max(flat.shape[1], 4))
        triangular = [len(nodes) == 3 for nodes in corners]
        self.domains = Domains(np.append(np.array(triangular, bool), self._flat.triangular))
        # A sharp edge is a cubic on one side and the parabola of a cell on the other.
        self.tie = LOOSE if kept and (node_counts(flat) > 4).any() else TIE
        rims = rim_edges(padded(tiles, 4))[kept]
        self.rim = np.concatenate(
            [rims, rim_edges(padded(corners_of(facets, 3).tolist(), 4))[whole]]
        )

    def controls(self, position: Array) -> Array:
        """Return the control points, see `Patches`."""
        controls = np.zeros((len(self.nodes), self._count, 3))
        kept = len(self._weights)
        controls[:kept, :CONTROLS] = einsum(
            "kcn,kni->kci", self._weights, position[self.nodes[:kept]]
        )
        flat = self._flat.controls(position)
        controls[kept:, : flat.shape[1]] = flat
        return controls

    def reach(self, controls: Array, centre: Array) -> Array:
        """Return radii of spheres that patches are within, see `Patches`.

        Shares are positive and make one: patches are within the hull of their control points.
        """
        kept = len(self._weights)
        far = sizes(controls[:kept, :CONTROLS] - centre[:kept, None])
        far = np.where(self._weights.any(axis=2), far, 0.0).max(axis=1, initial=0.0)
        return np.append(far, self._flat.reach(controls[kept:], centre[kept:]))

    def values(self, patch: Indices, xi: Array) -> Array:
        """Return the shares of the control points at ξ, shape [count, c]."""
        values = np.zeros((len(patch), self._count))
        for mine, shares, _ in self._shares(patch, xi):
            values[mine, : shares.shape[1]] = shares
        flat = ~self.curved[patch]
        if flat.any():
            found = self._flat.values(patch[flat] - len(self._weights), xi[flat])
            values[flat, : found.shape[1]] = found
        return values

    def slopes(self, patch: Indices, xi: Array) -> Array:
        """Return their derivatives by ξ, shape [count, c, 2]."""
        slopes = np.zeros((len(patch), self._count, 2))
        for mine, _, shares in self._shares(patch, xi):
            slopes[mine, : shares.shape[1]] = shares
        flat = ~self.curved[patch]
        if flat.any():
            found = self._flat.slopes(patch[flat] - len(self._weights), xi[flat])
            slopes[flat, : found.shape[1]] = found
        return slopes

    def of_nodes(self, patch: Indices, shares: Array) -> Array:
        """Return the weights of nodes that make shares of control points, shape [count, n]."""
        weights = np.zeros((len(patch), self.nodes.shape[1]))
        curved = self.curved[patch]
        weights[curved] = einsum(
            "kc,kcn->kn", shares[curved, :CONTROLS], self._weights[patch[curved]]
        )
        width = self._flat.nodes.shape[1]
        weights[~curved, :width] = shares[~curved, :width]
        return weights

    def _shares(self, patch: Indices, xi: Array) -> Iterator[tuple[Mask, Array, Array]]:
        """Yield for curved patches of either kind which they are, shares, and their slopes."""
        triangular = self.domains.triangular[patch]
        for domain, chosen in ((TRIANGLE, triangular), (SQUARE, ~triangular)):
            mine = chosen & self.curved[patch]
            if mine.any():
                yield mine, *shape_functions(domain, xi[mine])

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
