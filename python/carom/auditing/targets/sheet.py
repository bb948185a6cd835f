"""Where points are closest to a target in space."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol

import numpy as np

from carom.auditing.arrays import Array, Indices, Mask, cross, einsum, sizes
from carom.auditing.mesh.facets import corners_of, node_counts
from carom.auditing.mesh.kinds import kind_with
from carom.auditing.targets.domain import Domains, solved_in_plane
from carom.auditing.targets.feet import TIE, Feet
from carom.auditing.targets.tiles import padded

STEPS = 60
"""Most steps to a closest point."""

SHORTEST, LONGEST = 1 / 64, 8.0
"""The least that is gone of a step, and the most."""

CLOSE = 1e-14
"""Changes of ξ below this end the search."""

SQUARE = 0.99
"""The least cosine of the angle at which a point sees a patch whose closest point is within it."""

AT_ONCE = 4_000_000
"""Most pairs of points and facets whose distances are known at a time."""


class Patches(Protocol):
    """Pieces of surface, each a combination of nodes for every ξ of a domain."""

    @property
    def facets(self) -> Indices:
        """What they are over, outward by the right-hand rule, shape [patch_count, a]."""

    @property
    def nodes(self) -> Indices:
        """The nodes that every patch follows, shape [patch_count, n]."""

    @property
    def domains(self) -> Domains:
        """Where ξ is."""

    @property
    def rim(self) -> Mask:
        """Where an open surface ends: which edges are of no other, shape [patch_count, 4]."""

    @property
    def tie(self) -> float:
        """Distances closer than this part of a patch are the same."""

    @property
    def curved(self) -> Mask:
        """Which of them go on into others without a kink, shape [patch_count]."""

    @property
    def over(self) -> Mapping[tuple[int, int], int]:
        """The curved ones, by facets of the boundary and the numbers of their parts."""

    @property
    def owners(self) -> Sequence[int]:
        """The facets of the boundary that patches are over, [patch_count]."""

    def controls(self, position: Array) -> Array:
        """Return the control points, of which patches are combinations, [patch_count, c, 3]."""

    def values(self, patch: Indices, xi: Array) -> Array:
        """Return the shares of the control points at ξ, shape [count, c]."""

    def slopes(self, patch: Indices, xi: Array) -> Array:
        """Return their derivatives by ξ, shape [count, c, 2]."""

    def of_nodes(self, patch: Indices, shares: Array) -> Array:
        """Return the weights of nodes that make shares of control points, shape [count, n]."""

    def reach(self, controls: Array, centre: Array) -> Array:
        """Return radii of spheres around points within which patches are, shape [patch_count]."""


class FlatPatches:
    """Facets as their shape functions have them.

    Parameters
    ----------
    facets
        Their nodes, of one kind or several, shape [facet_count, a].
    """

    def __init__(self, facets: Indices) -> None:
        self.facets = self.nodes = facets
        counts = node_counts(facets)
        self._kinds = {int(count): kind_with(2, int(count)) for count in np.unique(counts)}
        self._counts = counts
        self.triangular: Mask = np.isin(counts, (3, 6))
        """Which of them are triangles, shape [facet_count]."""
        self.domains = Domains(self.triangular)
        self.rim = rim_edges(padded(corners_of(facets, 3).tolist(), 4))
        self.tie = TIE
        self.curved: Mask = np.zeros(len(facets), dtype=bool)
        self.over: Mapping[tuple[int, int], int] = {}
        self.owners: Sequence[int] = range(len(facets))

    def controls(self, position: Array) -> Array:
        """Return where the nodes are, see `Patches`."""
        nodes: Array = position[self.nodes]
        return nodes

    def of_nodes(self, patch: Indices, shares: Array) -> Array:
        """Return the shares themselves, see `Patches`."""
        return shares

    def reach(self, controls: Array, centre: Array) -> Array:
        """Return radii of spheres that facets are within, see `Patches`.

        Shape functions of corners alone are positive and make one. What the others add to these
        is at most two, for eight nodes, of how far their nodes are from where corners have them.
        """
        reach = np.zeros(len(controls))
        for count, kind in self._kinds.items():
            mine = self._counts == count
            nodes, corners = controls[mine, :count], controls[mine, : kind.corner_count]
            straight = kind_with(2, kind.corner_count).values(kind.nodes)
            off = nodes - einsum("ac,kci->kai", straight, corners)
            far = sizes(corners - centre[mine, None]).max(axis=1)
            reach[mine] = far + 2.0 * sizes(off).max(axis=1)
        return reach

    def values(self, patch: Indices, xi: Array) -> Array:
        """Return N_a at ξ, shape [count, a]."""
        values = np.zeros((len(patch), self.nodes.shape[1]))
        for count, kind in self._kinds.items():
            mine = self._counts[patch] == count
            values[mine, :count] = kind.values(xi[mine])
        return values

    def slopes(self, patch: Indices, xi: Array) -> Array:
        """Return ∂N_a/∂ξ, shape [count, a, 2]."""
        slopes = np.zeros((len(patch), self.nodes.shape[1], 2))
        for count, kind in self._kinds.items():
            mine = self._counts[patch] == count
            slopes[mine, :count] = kind.slopes(xi[mine])
        return slopes


class Sheet:
    """The boundary of a body in space that nodes of others are checked against.

    Parameters
    ----------
    patches
        The pieces of surface that it is made of, in the body's numbering of nodes.
    """

    def __init__(self, patches: Patches) -> None:
        self.facets, self._patches = patches.facets, patches
        self.smooth = patches.curved
        self.width = patches.nodes.shape[1]

    def patch_over(self, facet: int, part: int) -> int | None:
        """Return the curved patch over a part of a facet; None where it is as its cell is."""
        return self._patches.over.get((facet, part))

    def owner(self, patch: int) -> int:
        """Return the facet of the boundary that a patch is over."""
        return self._patches.owners[patch]

    def over(self, patch: int, xi: Array) -> tuple[Indices, Array]:
        """Return the nodes that points at ξ of a patch follow, and weights, [count, node]."""
        patches = np.full(len(xi), patch)
        weights = self._patches.of_nodes(patches, self._patches.values(patches, xi))
        return self._patches.nodes[patch], weights

    def feet(self, x: Array, position: Array) -> Feet:
        """Return all feet near the points, see `Target`."""
        controls = self._patches.controls(position)
        point, patch = self._near(x, controls, reach=4.0)
        xi = self._closest(x[point], patch, controls)
        own = controls[patch]
        value, slopes = self._patches.values(patch, xi), self._patches.slopes(patch, xi)
        tangents = einsum("kca,kci->kai", slopes, own)
        offset = x[point] - einsum("kc,kci->ki", value, own)
        # Where ξ is at an edge there may be a way to go on.
        further = self._patches.domains.reached(patch, xi + _along(tangents, offset)) - xi
        shares = value + einsum("kca,ka->kc", slopes, further)
        normal = _unit(cross(tangents[:, 0], tangents[:, 1]))
        left = x[point] - einsum("kc,kci->ki", shares, own)
        return Feet(
            point=point,
            facet=patch,
            gap=einsum("ki,ki->k", normal, left),
            normal=normal,
            nodes=self._patches.nodes[patch],
            weights=self._patches.of_nodes(patch, shares),
            beyond=self._patches.domains.outside(patch, xi + further),
        )

    def closest_weights(self, x: Array, position: Array) -> Array:
        """Return the weights of the nodes of its first patch where that is closest to a point."""
        patch = np.zeros(1, dtype=np.int64)
        xi = self._closest(x[None], patch, self._patches.controls(position))
        weights: Array = self._patches.of_nodes(patch, self._patches.values(patch, xi))[0]
        return weights

    def signed_distance(self, x: Array, position: Array) -> Array:
        """Return the distances of points from it [m], see `Target`."""
        controls = self._patches.controls(position)
        point, patch = self._near(x, controls, reach=4.0 * self._patches.tie)
        xi = self._closest(x[point], patch, controls)
        own = controls[patch]
        tangents = einsum("kca,kci->kai", self._patches.slopes(patch, xi), own)
        offset = x[point] - einsum("kc,kci->ki", self._patches.values(patch, xi), own)
        distance = np.linalg.norm(offset, axis=1)
        front = einsum("ki,ki->k", offset, _unit(cross(tangents[:, 0], tangents[:, 1])))
        size = np.linalg.norm(tangents, axis=2).max(axis=1)
        closest = np.full(len(x), np.inf)
        np.minimum.at(closest, point, distance)
        tied = distance <= closest[point] + TIE * size
        # What is closest within a patch is what the point is before, or behind.
        within = np.zeros(len(x), dtype=bool)
        within[point[tied & (np.abs(front) >= SQUARE * distance)]] = True
        loosely = distance <= closest[point] + self._patches.tie * size
        squarely = np.where(tied | (loosely & ~within[point]), np.abs(front), -1.0)
        order = np.lexsort((squarely, point))
        last = order[np.append(point[order][1:] != point[order][:-1], True)]
        signed: Array = np.full(len(x), np.inf)
        signed[point[last]] = np.copysign(closest[point[last]], front[last])
        further = _along(tangents[last], offset[last])
        facing = patch[last]
        off = self._patches.domains.leaves(facing, xi[last], further, self._patches.rim[facing])
        signed[point[last][off]] = np.inf
        return signed

    def _near(self, x: Array, controls: Array, reach: float) -> tuple[Indices, Indices]:
        """Return points with the patches that may be closest, and others as far as some radii."""
        each = np.arange(len(controls))
        middle = self._patches.values(each, self._patches.domains.middle(each))
        centre = einsum("kc,kci->ki", middle, controls)
        radius = self._patches.reach(controls, centre)
        points, patches = [], []
        step = max(AT_ONCE // max(len(centre), 1), 1)
        for first in range(0, len(x), step):
            far = np.linalg.norm(x[first : first + step, None] - centre[None], axis=2)
            # The middle of a patch is a point of it.
            bound = far.min(axis=1) + reach * radius.max()
            point, patch = np.nonzero(far - radius <= bound[:, None])
            points.append(point + first)
            patches.append(patch)
        return np.concatenate(points), np.concatenate(patches)

    def _closest(self, x: Array, patch: Indices, controls: Array) -> Array:
        """Return ξ of the closest points of patches, shape [count, 2].

        Steps go to where the tangent plane at the last one is closest, within the domain. Where it
        is curved they are too long before it, and too short behind it: as much as the last one was,
        by how far that changed the next (Barzilai & Borwein 1988). They are shortened until the
        distance falls.
        """
        domains, own = self._patches.domains, controls[patch]
        xi = domains.middle(patch)
        moving = np.arange(len(x))

        def off(at: Array, some: Indices) -> Array:
            value = self._patches.values(patch[some], at)
            return x[some] - einsum("kc,kci->ki", value, own[some])

        offset = off(xi, moving)
        last, part = np.zeros_like(xi), np.ones(len(x))
        for _ in range(STEPS):
            if not len(moving):
                break
            at, before = xi[moving], (offset[moving] ** 2).sum(axis=1)
            slopes = self._patches.slopes(patch[moving], at)
            tangents = einsum("kca,kci->kai", slopes, own[moving])
            metric = einsum("kai,kbi->kab", tangents, tangents)
            slope = einsum("kai,ki->ka", tangents, offset[moving])
            whole = domains.step(patch[moving], at, slope, metric)
            gone = _part(last[moving], whole, part[moving])
            outside = domains.outside(patch[moving], at + gone[:, None] * whole)
            gone[outside > domains.outside(patch[moving], at + whole)] = 1.0
            step = gone[:, None] * whole
            after = off(at + step, moving)
            for _ in range(30):
                worse = (after**2).sum(axis=1) > before
                worse &= np.abs(step).max(axis=1) > 1e-7
                if not worse.any():
                    break
                step[worse] *= 0.5
                gone[worse] *= 0.5
                after[worse] = off(at[worse] + step[worse], moving[worse])
            xi[moving], offset[moving] = at + step, after
            last[moving], part[moving] = whole, gone
            moving = moving[np.abs(whole).max(axis=1) > CLOSE]
        return xi


def _part(last: Array, whole: Array, part: Array) -> Array:
    """Return how much of steps to go, by the last ones and how much of these was gone, [count]."""
    square = einsum("ka,ka->k", last, last)
    changed = square - einsum("ka,ka->k", last, whole)
    # With no last step, or one that left the next as it was, there is nothing to go by.
    known = changed > part * square / LONGEST
    best = part * square / np.where(known, changed, 1.0)
    return np.where(known, np.maximum(best, SHORTEST), 1.0)


def _along(tangents: Array, offset: Array) -> Array:
    """Return how far along tangents their plane is closest to offsets, shape [count, 2]."""
    metric = einsum("kai,kbi->kab", tangents, tangents)
    slope = einsum("kai,ki->ka", tangents, offset)
    return solved_in_plane(metric, slope)


def _unit(vectors: Array) -> Array:
    unit: Array = vectors / np.linalg.norm(vectors, axis=1, keepdims=True)
    return unit


def rim_edges(corners: Indices) -> Mask:
    """Return which edges of facets are of one facet only, shape [facet_count, edge].

    Of facets with fewer corners than others the last ones are none.
    """
    ends = np.sort(np.stack([corners, np.roll(corners, -1, axis=1)], axis=2), axis=2)
    _, inverse, count = np.unique(
        ends.reshape(-1, 2), axis=0, return_inverse=True, return_counts=True
    )
    alone: Mask = (count == 1)[inverse].reshape(corners.shape)
    return alone
