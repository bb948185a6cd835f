"""The reference domains of facets in space, and what is closest in them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from carom.auditing.arrays import Array, Indices, Mask, einsum
from carom.auditing.mesh.kinds import KINDS, Kind
from carom.auditing.targets.feet import BEYOND

ON_EDGE = 1e-9
"""What is closer to an edge, in widths of the domain, is on it."""

PARALLEL = 1e-14
"""Tangents whose metric has a determinant below this part of its trace squared are parallel."""


def solved_in_plane(metric: Array, right: Array) -> Array:
    """Return x of A x = b with metrics A, shapes [count, 2, 2], [count, 2] and [count, 2].

    At a corner where the sides of a facet go on in one line tangents are parallel: then b is along
    the image of A, and x is the shortest of all.
    """
    (a, b), (_, d) = np.moveaxis(metric, 0, -1)
    det, trace = a * d - b * b, a + d
    parallel = det <= PARALLEL * trace**2
    x, y = right.T
    whole = np.stack([d * x - b * y, a * y - b * x], axis=1)
    solved: Array = whole / np.where(parallel, 1.0, det)[:, None]
    return np.where(parallel[:, None], right / trace[:, None], solved)


@dataclass(frozen=True)
class Domain:
    """A triangle or a square.

    Parameters
    ----------
    corners
        Its corners, counter-clockwise, shape [corner_count, 2].
    """

    corners: Array

    @classmethod
    def of(cls, kind: Kind) -> Domain:
        """Return that of a facet."""
        return cls(kind.nodes[: kind.corner_count])

    @property
    def middle(self) -> Array:
        """Its middle, shape [2]."""
        middle: Array = self.corners.mean(axis=0)
        return middle

    @property
    def is_triangle(self) -> bool:
        """Whether it is a triangle."""
        return len(self.corners) == 3

    def inside(self, xi: Array) -> Array:
        """Return how far points are inside of each edge, in widths, [count, edge_count]."""
        if self.is_triangle:
            return np.stack([xi[:, 1], 1.0 - xi[:, 0] - xi[:, 1], xi[:, 0]], axis=1)
        x, y = xi.T
        return 0.5 * np.stack([1.0 + y, 1.0 - x, 1.0 - y, 1.0 + x], axis=1)

    def outside(self, xi: Array) -> Array:
        """Return how far points are outside, in widths, zero inside, shape [count]."""
        outside: Array = np.maximum(-self.inside(xi), 0.0).max(axis=1)
        return outside

    def leaves(self, xi: Array, step: Array, edges: Mask) -> Mask:
        """Return whether steps from points lead out across one of these edges, shape [count]."""
        at = self.inside(xi)
        change = self.inside(xi + step) - at
        across = edges & (at <= ON_EDGE) & (change < -ON_EDGE)
        return np.asarray(across.any(axis=1), dtype=bool)

    def reached(self, xi: Array) -> Array:
        """Return points brought to what reaches beyond the domain by half its width."""
        if not self.is_triangle:
            end = 1.0 + 2.0 * BEYOND
            return np.clip(xi, -end, end)
        # First both coordinates, then their sum, as near as it can be.
        low, most = -BEYOND, 1.0 + BEYOND
        xi = np.maximum(xi, low)
        excess = xi.sum(axis=1) - most
        first = np.clip(xi[:, 0] - 0.5 * excess, low, most - low)
        moved = np.stack([first, most - first], axis=1)
        return np.where((excess > 0)[:, None], moved, xi)

    def step(self, xi: Array, slope: Array, metric: Array) -> Array:
        """Return the steps that minimise ½ s·A s − b·s within the domain, shape [count, 2].

        Parameters
        ----------
        xi
            Where the steps begin, in the domain, shape [count, 2].
        slope, metric
            b and A, positive definite, shapes [count, 2] and [count, 2, 2].
        """
        best = solved_in_plane(metric, slope)
        out = np.flatnonzero(~(self.inside(xi + best) >= 0.0).all(axis=1))
        if len(out):
            best[out] = self._along_edges(xi[out], slope[out], metric[out])
        return best

    def _along_edges(self, xi: Array, slope: Array, metric: Array) -> Array:
        """Return the steps to edges that minimise the same."""
        best, least = np.zeros_like(xi), np.full(len(xi), np.inf)
        after = np.roll(self.corners, -1, axis=0)
        for a, b in zip(self.corners, after, strict=True):
            along = b - a
            to_a = a - xi
            # On an edge s = a − ξ + t (b − a).
            resisted = einsum("kij,j->ki", metric, along)
            slopes = (slope - einsum("kij,kj->ki", metric, to_a)) @ along
            t = np.clip(slopes / (resisted @ along), 0.0, 1.0)
            s = to_a + t[:, None] * along
            value = 0.5 * einsum("ki,kij,kj->k", s, metric, s) - einsum("ki,ki->k", slope, s)
            better = value < least
            best = np.where(better[:, None], s, best)
            least = np.where(better, value, least)
        return best


TRIANGLE, SQUARE = (Domain.of(KINDS[name]) for name in ("tri3", "quad4"))


class Domains:
    """The domains of several patches, of which some are triangles and the others squares.

    Parameters
    ----------
    triangular
        Which are triangles, shape [patch_count].
    """

    def __init__(self, triangular: Mask) -> None:
        self.triangular = triangular

    def middle(self, patch: Indices) -> Array:
        """Return the middles of the domains of patches, shape [count, 2]."""
        own = self.triangular[patch][:, None]
        middle: Array = np.where(own, TRIANGLE.middle, SQUARE.middle)
        return middle

    def outside(self, patch: Indices, xi: Array) -> Array:
        """Return how far points are outside, see `Domain.outside`."""
        return self._each(patch, lambda domain, at: domain.outside(xi[at]))

    def leaves(self, patch: Indices, xi: Array, step: Array, edges: Mask) -> Mask:
        """Return whether steps lead out across edges, [count, 4], see `Domain.leaves`."""

        def of_kind(domain: Domain, at: Mask) -> Array:
            count = len(domain.corners)
            return domain.leaves(xi[at], step[at], edges[at, :count]).astype(np.float64)

        return self._each(patch, of_kind) > 0.0

    def reached(self, patch: Indices, xi: Array) -> Array:
        """Return points brought to what reaches beyond a domain, see `Domain.reached`."""
        return self._each(patch, lambda domain, at: domain.reached(xi[at]))

    def step(self, patch: Indices, xi: Array, slope: Array, metric: Array) -> Array:
        """Return the steps that minimise a square within a domain, see `Domain.step`."""
        return self._each(patch, lambda domain, at: domain.step(xi[at], slope[at], metric[at]))

    def _each(self, patch: Indices, of_kind: Callable[[Domain, Mask], Array]) -> Array:
        """Return what is found for the patches of either kind, in the order of the patches."""
        triangular = self.triangular[patch]
        if triangular.all():
            return of_kind(TRIANGLE, triangular)
        if not triangular.any():
            return of_kind(SQUARE, ~triangular)
        first, other = of_kind(TRIANGLE, triangular), of_kind(SQUARE, ~triangular)
        found: Array = np.empty((len(patch), *first.shape[1:]))
        found[triangular], found[~triangular] = first, other
        return found
