"""Edges of bodies in space, and where they cross."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.auditing.arrays import Array, Indices, cross, einsum
from carom.auditing.bodies.body import AuditBody
from carom.auditing.mesh.facets import grouped
from carom.auditing.targets.feet import BEYOND


@dataclass(frozen=True)
class Crossings:
    """Pairs of edges where their lines are closest.

    Parameters
    ----------
    source, target
        Ends of both edges in the numbering of the model, shape [count, 2].
    gap
        Distance along the normal [m], shape [count].
    normal
        At right angles to both, shape [count, 3].
    along
        Where that is, from the first to the second end of both edges, shape [count, 2].
    beyond
        How far it is beyond the end of an edge, in its length, shape [count].
    """

    source: Indices
    target: Indices
    gap: Array
    normal: Array
    along: Array
    beyond: Array


def edges(body: AuditBody) -> Indices:
    """Return the straight lines from node to node around the facets that may touch, [count, 2]."""
    lines: list[Indices] = []
    for kind, _, facets in grouped(body.facets, body.dimension):
        for side in kind.facets:
            ends = [side[:2]] if len(side) == 2 else [side[[0, 2]], side[[2, 1]]]
            lines += [facets[:, pair] for pair in ends]
    every: Indices = np.unique(np.sort(np.concatenate(lines), axis=1), axis=0)
    return every + body.span.start


def crossings(position: Array, source: Indices, target: Indices, towards: Array) -> Crossings:
    """Return how edges cross those of a target, all with all.

    Parameters
    ----------
    position
        Where nodes are [m], shape [node_count, 3].
    source, target
        Edges, shape [count, 2].
    towards
        What normals are to point along as nearly as they can.
    """
    number, other = (
        grid.ravel() for grid in np.meshgrid(range(len(source)), range(len(target)), indexing="ij")
    )
    source, target = source[number], target[other]
    (a, b), (c, d) = (position[ends].transpose(1, 0, 2) for ends in (source, target))
    e, f, offset = b - a, d - c, a - c
    normal = cross(e, f)
    normal = normal / np.linalg.norm(normal, axis=1, keepdims=True)
    normal = np.where((normal @ towards < 0.0)[:, None], -normal, normal)
    # a + s e and c + t f are closest where the line between them is at right angles to both.
    ee, ff, ef = (einsum("ki,ki->k", x, y) for x, y in ((e, e), (f, f), (e, f)))
    on_e, on_f = (einsum("ki,ki->k", x, offset) for x in (e, f))
    square = ee * ff - ef * ef
    along = np.stack([ef * on_f - ff * on_e, ee * on_f - ef * on_e], axis=1) / square[:, None]
    gap = einsum("ki,ki->k", normal, offset)
    within = np.isfinite(gap) & (np.abs(along - 0.5) <= 0.5 + 2 * BEYOND).all(axis=1)
    return Crossings(
        source=source,
        target=target,
        gap=np.where(within, gap, np.inf),
        normal=np.where(within[:, None], normal, 0.0),
        along=np.clip(along, -BEYOND, 1.0 + BEYOND),
        beyond=np.maximum(np.abs(along - 0.5) - 0.5, 0.0).max(axis=1),
    )


def drawn_depths(points: Array, found: Crossings, shifts: tuple[int, int]) -> Array:
    """Return how deep edges that cross were as drawn [m], shape [count]; zero if they did not.

    Parameters
    ----------
    points
        Where nodes are drawn [m], shape [node_count, 3].
    found
        The edges, with normals out of the target.
    shifts
        What the numbers of the ends of either side are more than those of `points`.
    """
    depths = np.zeros(len(found.gap))
    for k in np.flatnonzero(np.isfinite(found.gap)):
        ends = (found.source[k : k + 1] - shifts[0], found.target[k : k + 1] - shifts[1])
        gap = float(crossings(points, *ends, found.normal[k]).gap[0])
        depths[k] = max(-gap, 0.0) if np.isfinite(gap) else 0.0
    return depths
