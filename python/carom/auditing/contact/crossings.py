"""Where edges of bodies in space cross."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.auditing.arrays import Array, cross, einsum
from carom.auditing.contact.edges import Edges, closest
from carom.auditing.targets.feet import BEYOND


@dataclass(frozen=True)
class Crossings:
    """Pairs of edges where their lines are closest.

    Parameters
    ----------
    source, target
        The edges in the numbering of the model.
    gap
        Distance along the normal [m], shape [count].
    normal
        At right angles to both, shape [count, 3].
    along
        Where that is, from the first to the second end of both edges, shape [count, 2].
    beyond
        How far it is beyond the end of an edge, in its length, shape [count].
    """

    source: Edges
    target: Edges
    gap: Array
    normal: Array
    along: Array
    beyond: Array


def crossings(position: Array, source: Edges, target: Edges, towards: Array) -> Crossings:
    """Return how edges cross those of a target, all with all.

    Parameters
    ----------
    position
        Where nodes are [m], shape [node_count, 3].
    source, target
        Edges.
    towards
        What normals are to point along as nearly as they can.
    """
    every = np.meshgrid(np.arange(len(source)), np.arange(len(target)), indexing="ij")
    number, other = (grid.ravel() for grid in every)
    source, target = source[number], target[other]
    along = closest(source, target, position)
    (x, e, _), (y, f, _) = (
        source.points(along[:, 0], position),
        target.points(along[:, 1], position),
    )
    normal = cross(e, f)
    normal = normal / np.linalg.norm(normal, axis=1, keepdims=True)
    normal = np.where((normal @ towards < 0.0)[:, None], -normal, normal)
    gap = einsum("ki,ki->k", normal, x - y)
    within = np.isfinite(gap) & (np.abs(along - 0.5) <= 0.5 + 2 * BEYOND).all(axis=1)
    return Crossings(
        source=source,
        target=target,
        gap=np.where(within, gap, np.inf),
        normal=np.where(within[:, None], normal, 0.0),
        along=np.clip(along, -BEYOND, 1.0 + BEYOND),
        beyond=np.maximum(np.abs(along - 0.5) - 0.5, 0.0).max(axis=1),
    )


def drawn_depths(points: Array, found: Crossings) -> Array:
    """Return how deep edges that cross were as drawn [m], shape [count]; zero if they did not.

    Parameters
    ----------
    points
        Where nodes are drawn [m], shape [node_count, 3].
    found
        The edges, with normals out of the target.
    """
    depths = np.zeros(len(found.gap))
    for k in np.flatnonzero(np.isfinite(found.gap)):
        one = np.array([k])
        gap = crossings(points, found.source[one], found.target[one], found.normal[k]).gap
        depths[k] = max(-float(gap[0]), 0.0) if np.isfinite(gap[0]) else 0.0
    return depths
