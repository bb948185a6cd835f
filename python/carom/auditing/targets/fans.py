"""The sides of a boundary at its nodes: facets that go on into one another without a corner."""

from __future__ import annotations

from itertools import count

import numpy as np

from carom.auditing.arrays import Array, Indices
from carom.auditing.mesh.facets import node_counts
from carom.auditing.targets.feet import CORNER
from carom.auditing.targets.network import Network
from carom.auditing.targets.tiles import TILES, cut

Fans = list[list[int]]
"""For every facet the fans around its nodes, each a number of its own."""


def fans(facets: Indices, points: Array) -> Fans:
    """Return the fans of facets.

    Parameters
    ----------
    facets
        Facets in the body's numbering, shape [facet_count, a].
    points
        Reference positions of the body's nodes [m], shape [node_count, D].
    """
    return _in_plane(facets, points) if points.shape[1] == 2 else _in_space(facets, points)


def _in_plane(facets: Indices, points: Array) -> Fans:
    numbers = count()
    found = [[next(numbers) for _ in facet] for facet in facets]
    around = np.bincount(facets[:, :2].ravel(), minlength=len(points))
    after = {int(facet[0]): f for f, facet in enumerate(facets)}
    for f, facet in enumerate(facets):
        g = after.get(int(facet[1]))
        if g is None or around[facet[1]] != 2:
            continue
        # Facets of second order have the directions of their halves.
        own = points[facet[1]] - points[facet[-1] if len(facet) == 3 else facet[0]]
        other = points[facets[g][2 if len(facet) == 3 else 1]] - points[facet[1]]
        if own @ other >= CORNER * np.linalg.norm(own) * np.linalg.norm(other):
            found[f][1] = found[g][0]
    return found


def _in_space(facets: Indices, points: Array) -> Fans:
    tiles, owner = cut(facets)
    network = Network(tiles, points)
    numbers = {id(sector): number for number, sector in enumerate(network.sectors)}
    sizes = node_counts(facets)
    found = [[0] * int(size) for size in sizes]
    part, last = 0, -1
    for tile, own in enumerate(owner):
        part = part + 1 if own == last else 0
        last = own
        for corner, a in enumerate(TILES[int(sizes[own])][part]):
            found[own][a] = numbers[id(network.sector_of[tile, corner])]
    return found
