"""How the facets of a boundary in space hang together, and where the boundary has sharp edges."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from carom.auditing.arrays import Array, cross
from carom.auditing.targets.feet import CORNER, FLAT

Corner = tuple[int, int]
"""A corner of a facet, or the side that begins there: the facet, and its number in it."""


@dataclass(frozen=True)
class Sector:
    """The corners around a node between two sharp edges, or all around it.

    Parameters
    ----------
    node
        The node.
    corners
        Counter-clockwise as seen from outside.
    bounds
        The far ends of the sharp edges that it is between; None of one that goes all around.
    normal
        Mean outward normal, shape [3].
    flat
        Whether it is flat, and the edges that bound it straight.
    """

    node: int
    corners: tuple[Corner, ...]
    bounds: tuple[int, int] | None
    normal: Array
    flat: bool


class Network:
    """The facets of a boundary where nothing has moved.

    Parameters
    ----------
    facets
        The corners of triangles and quadrilaterals, outward by the right-hand rule.
    points
        Reference positions of nodes [m], shape [node_count, 3].
    """

    def __init__(self, facets: Sequence[list[int]], points: Array) -> None:
        self.facets, self._points = list(facets), points
        self._areas = [_areas(points[nodes]) for nodes in self.facets]
        """Twice the area of the triangle at every corner, outward, shape [corner, 3]."""
        self.beyond: dict[Corner, Corner] = self._neighbours()
        """The side across each side that is not sharp."""
        self.sharp = self._sharp_edges()
        """For every node with sharp edges their far ends, each with where it comes from."""
        self.sector_of: dict[Corner, Sector] = {}
        self.sectors: list[Sector] = []
        for facet in range(len(self.facets)):
            for corner in range(len(self.facets[facet])):
                if (facet, corner) not in self.sector_of:
                    self._add_sector((facet, corner))

    def sides(self, corner: Corner) -> tuple[int, int]:
        """Return the nodes that the sides from a corner and to it lead to."""
        facet, k = corner
        nodes = self.facets[facet]
        return nodes[(k + 1) % len(nodes)], nodes[k - 1]

    def around(self, sector: Sector, *, widened: bool) -> list[int]:
        """Return the other nodes of the facets of a sector, or also of facets around these.

        Wider surroundings end at sharp edges.
        """
        found = {n for facet, _ in sector.corners for n in self.facets[facet]}
        if widened:
            for facet, _ in sector.corners:
                for k in range(len(self.facets[facet])):
                    for other, _ in self.sector_of[facet, k].corners:
                        found.update(self.facets[other])
        return sorted(found - {sector.node})

    def comes_from(self, node: int, to: int) -> int | None:
        """Return from where a sharp edge comes that goes on from a node to another."""
        found = self.sharp.get(node, {}).get(to)
        return None if found is None else found[0]

    def fades(self, node: int, to: int) -> bool:
        """Return whether a sharp edge fades out at a node."""
        return self.comes_from(node, to) is None and len(self.sharp.get(node, {})) == 1

    def _neighbours(self) -> dict[Corner, Corner]:
        sides: dict[tuple[int, int], list[tuple[Corner, int]]] = defaultdict(list)
        for facet, nodes in enumerate(self.facets):
            for k, start in enumerate(nodes):
                end = nodes[(k + 1) % len(nodes)]
                sides[min(start, end), max(start, end)].append(((facet, k), start))
        found = {}
        for both in sides.values():
            # Three sides, or two that go the same way, are not of one surface there.
            if len(both) != 2 or both[0][1] == both[1][1]:
                continue
            (a, _), (b, _) = both
            if float(self._side_normal(a) @ self._side_normal(b)) >= CORNER:
                found[a], found[b] = b, a
        return found

    def _side_normal(self, side: Corner) -> Array:
        facet, k = side
        areas = self._areas[facet]
        return _unit(areas[k] + areas[(k + 1) % len(areas)])

    def _sharp_edges(self) -> dict[int, dict[int, tuple[int, bool] | None]]:
        ends: dict[int, set[int]] = defaultdict(set)
        for facet, nodes in enumerate(self.facets):
            for k, start in enumerate(nodes):
                if (facet, k) not in self.beyond:
                    end = nodes[(k + 1) % len(nodes)]
                    ends[start].add(end)
                    ends[end].add(start)
        found: dict[int, dict[int, tuple[int, bool] | None]] = {}
        for node, others in ends.items():
            towards = {n: _unit(self._points[n] - self._points[node]) for n in sorted(others)}
            passing: dict[int, tuple[int, bool] | None] = dict.fromkeys(towards)
            turns = [(-float(towards[a] @ towards[b]), a, b) for a, b in combinations(towards, 2)]
            for cosine, a, b in sorted(turns, key=lambda turn: -turn[0]):
                if cosine >= CORNER and passing[a] is None and passing[b] is None:
                    passing[a], passing[b] = (b, cosine > FLAT), (a, cosine > FLAT)
            found[node] = passing
        return found

    def _add_sector(self, start: Corner) -> None:
        """Find the sector of a corner, and note it for all its corners."""
        first, closed = start, False
        while (before := self._before(first)) is not None:
            first = before
            if first == start:
                closed = True
                break
        corners = [first]
        while (after := self._after(corners[-1])) is not None and after != first:
            corners.append(after)
        node = self.facets[start[0]][start[1]]
        bounds = None if closed else (self.sides(first)[0], self.sides(corners[-1])[1])
        normals = np.array([_unit(self._areas[facet][k]) for facet, k in corners])
        flat = bool((normals @ normals[0] > FLAT).all())
        for to in bounds or ():
            passage = self.sharp.get(node, {}).get(to)
            flat = flat and (passage is None or passage[1])
        sector = Sector(node, tuple(corners), bounds, _unit(normals.sum(axis=0)), flat)
        self.sectors.append(sector)
        self.sector_of |= dict.fromkeys(corners, sector)

    def _after(self, corner: Corner) -> Corner | None:
        """Return the next corner around the node, across the side that ends there."""
        facet, k = corner
        return self.beyond.get((facet, (k - 1) % len(self.facets[facet])))

    def _before(self, corner: Corner) -> Corner | None:
        side = self.beyond.get(corner)
        return None if side is None else (side[0], (side[1] + 1) % len(self.facets[side[0]]))


def _areas(ends: Array) -> Array:
    """Return twice the areas of the triangles at the corners of a facet [m²], [corner, 3]."""
    return cross(np.roll(ends, -1, axis=0) - ends, np.roll(ends, 1, axis=0) - ends)


def _unit(vector: Array) -> Array:
    unit: Array = vector / np.linalg.norm(vector)
    return unit
