"""Tangent planes and slopes of smooth targets in space, as combinations of nodes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.auditing.arrays import Array, cross
from carom.auditing.targets.combination import Combination
from carom.auditing.targets.network import Corner, Network, Sector
from carom.auditing.targets.slopes import fitted_slope

SPANS = 0.3
"""The least sine of the angle between two sharp edges for them to span a tangent plane."""

IN_PLANE = 0.2
"""The least cosine of the angle between a side and a plane in which it still has a direction."""


@dataclass(frozen=True)
class Plane:
    """A tangent plane where nothing has moved, and what becomes of its vectors.

    Parameters
    ----------
    axes
        Unit vectors at right angles in it, shape [2, 3].
    images
        What these become.
    """

    axes: Array
    images: tuple[Combination, Combination]

    def coordinates(self, vector: Array) -> Array:
        """Return the coordinates of the part of a vector that is in it, shape [2]."""
        coordinates: Array = self.axes @ vector
        return coordinates

    def image(self, at: Array) -> Combination:
        """Return what becomes of the vector with these coordinates."""
        return float(at[0]) * self.images[0] + float(at[1]) * self.images[1]

    @classmethod
    def spanned(cls, a: Array, b: Array, first: Combination, other: Combination) -> Plane | None:
        """Return the plane of two vectors that become these; None if they are nearly parallel."""
        normal = cross(a, b)
        if np.linalg.norm(normal) <= SPANS * np.linalg.norm(a) * np.linalg.norm(b):
            return None
        along = a / np.linalg.norm(a)
        beside = cross(normal / np.linalg.norm(normal), along)
        image = 1.0 / float(np.linalg.norm(a)) * first
        rest = other - float(b @ along) * image
        return cls(np.stack([along, beside]), (image, 1.0 / float(b @ beside) * rest))


class Tangents:
    """The slopes of the sides of facets, and the tangent planes at their corners.

    Parameters
    ----------
    network
        The facets.
    points
        Reference positions of nodes [m], shape [node_count, 3].
    """

    def __init__(self, network: Network, points: Array) -> None:
        self._network, self._points = network, points
        self._planes: dict[int, Plane | None] = {}
        self._edges: dict[tuple[int, int], Combination] = {}
        curved = [sector for sector in network.sectors if not sector.flat]
        for sector in curved:
            if sector.bounds is None:
                self._planes[id(sector)] = self._fitted(sector, None)
        for sector in network.sectors:
            for to in sector.bounds or ():
                self._add_edge(sector.node, to)
        for sector in curved:
            if sector.bounds is not None:
                self._planes[id(sector)] = self._bounded(sector, sector.bounds)

    def of_side(self, side: Corner) -> tuple[Combination, Combination]:
        """Return the slopes of a side at its start and its end, along it and over all of it."""
        facet, k = side
        nodes = self._network.facets[facet]
        after = (k + 1) % len(nodes)
        a, b = nodes[k], nodes[after]
        sharp = side not in self._network.beyond
        return (
            self._slope((facet, k), a, b, sharp=sharp),
            -self._slope((facet, after), b, a, sharp=sharp),
        )

    def _slope(self, corner: Corner, start: int, end: int, *, sharp: bool) -> Combination:
        if sharp and (start, end) in self._edges:
            return self._edges[start, end]
        plane = self._planes.get(id(self._network.sector_of[corner]))
        at = None if plane is None else self._direction(plane, start, end)
        if plane is None or at is None:
            return Combination.between(start, end)
        return plane.image(at)

    def plane_at(self, corner: Corner) -> Plane | None:
        """Return the tangent plane at a corner: of its sector or, where that is flat, of sides."""
        plane = self._planes.get(id(self._network.sector_of[corner]))
        if plane is not None:
            return plane
        facet, k = corner
        out, _ = self.of_side(corner)
        _, into = self.of_side((facet, (k - 1) % len(self._network.facets[facet])))
        back = -into
        return Plane.spanned(out.at(self._points), back.at(self._points), out, back)

    def coordinates(self, plane: Plane, slope: Combination) -> tuple[Array, float]:
        """Return where a slope is in a plane where nothing has moved, and how long it is."""
        vector = slope.at(self._points)
        return plane.coordinates(vector), float(np.linalg.norm(vector))

    def _direction(self, plane: Plane, start: int, end: int) -> Array | None:
        """Return the place of a side in a plane: as long as an arc that leaves there in it.

        None if the side leaves the plane too steeply.
        """
        chord = self._points[end] - self._points[start]
        at = plane.coordinates(chord)
        cosine = min(float(np.linalg.norm(at) / np.linalg.norm(chord)), 1.0)
        if cosine < IN_PLANE:
            return None
        # A cubic is an arc of the angle θ if its slopes have the length L/cos²(θ/4).
        return at * (2.0 / (cosine * (1.0 + cosine)))

    def _fitted(self, sector: Sector, edge: Combination | None) -> Plane | None:
        """Return the plane that fits the nodes around, of wider ones where few know the bends."""
        narrow = self._fit(sector, edge, widened=False)
        if narrow is not None and narrow[1]:
            return narrow[0]
        wide = self._fit(sector, edge, widened=True)
        found = narrow if wide is None else wide
        return None if found is None else found[0]

    def _fit(
        self, sector: Sector, edge: Combination | None, *, widened: bool
    ) -> tuple[Plane, bool] | None:
        """Return the plane of a fit of second degree, and whether all bends are known in it.

        An `edge` is in it, and becomes what it is.
        """
        normal, points = sector.normal, self._points
        if edge is None:
            axis = np.eye(3)[np.abs(normal).argmin()]
            first = axis - normal * (normal @ axis)
        else:
            first = edge.at(points)
        length = float(np.linalg.norm(first))
        first = first / length
        upright = normal - first * (first @ normal)
        upright = upright / np.linalg.norm(upright)
        axes = np.stack([first, cross(upright, first)])
        nodes = self._network.around(sector, widened=widened)
        offsets = (points[nodes] - points[sector.node]) @ axes.T
        slope = fitted_slope(offsets, known=edge is not None)
        if slope is None:
            return None
        weights, sure = slope
        known = None if edge is None else 1.0 / length * edge
        images = [Combination(), Combination()]
        for node, offset, weight in zip(nodes, offsets, weights, strict=True):
            rise = Combination.between(sector.node, node)
            if known is not None:
                rise = rise - float(offset[0]) * known
            images = [image + float(w) * rise for image, w in zip(images, weight, strict=True)]
        return Plane(axes, (images[0] if known is None else known, images[1])), sure

    def _bounded(self, sector: Sector, ends: tuple[int, int]) -> Plane | None:
        """Return the plane of a sector between two sharp edges."""
        first, last = (self._edges.get((sector.node, to)) for to in ends)
        if first is None or last is None:
            return self._fitted(sector, None)
        if self._network.comes_from(sector.node, ends[0]) == ends[1]:
            return self._fitted(sector, first)
        spanned = Plane.spanned(first.at(self._points), last.at(self._points), first, last)
        return self._fitted(sector, None) if spanned is None else spanned

    def _add_edge(self, node: int, to: int) -> None:
        """Find the slope at its first node of a sharp edge."""
        if (node, to) in self._edges:
            return
        slope = self._passing(node, to)
        if slope is None:
            # At a corner the edge bends as it does at its other end: it is a parabola.
            there, chord = self._passing(to, node), Combination.between(node, to)
            slope = chord if there is None else 1.5 * chord + 0.5 * there
        self._edges[node, to] = slope

    def _passing(self, node: int, to: int) -> Combination | None:
        """Return the slope of a sharp edge at a node that it passes, or where it fades out."""
        if self._network.fades(node, to):
            sector = next((s for s in self._network.sectors if s.node == node), None)
            plane = None if sector is None else self._planes.get(id(sector))
            at = None if plane is None else self._direction(plane, node, to)
            return None if plane is None or at is None else plane.image(at)
        start = self._network.comes_from(node, to)
        if start is None:
            return None
        # The parabola through three nodes, with their distances as parameter.
        x, points = self._points[node], self._points
        behind = float(np.linalg.norm(points[start] - x))
        before = float(np.linalg.norm(points[to] - x))
        whole = behind + before
        tangent = before / (behind * whole) * Combination.between(start, node)
        tangent = tangent + behind / (before * whole) * Combination.between(node, to)
        direction = tangent.at(points)
        length = float(np.linalg.norm(direction))
        cosine = float((points[to] - x) @ direction) / (before * length)
        cosine = min(max(cosine, IN_PLANE), 1.0)
        return 2.0 * before / ((1.0 + cosine) * length) * tangent
