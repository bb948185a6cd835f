"""Edges that touch facets between their nodes, where one of the two is of second order."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from carom.auditing.arrays import Array, Indices
from carom.auditing.contact.edges import edges
from carom.auditing.model import AuditModel
from carom.auditing.steps.contacts import BETWEEN_NODES
from carom.auditing.steps.place import Place
from carom.auditing.targets.feet import Feet

PARTS = 16
"""Points of an edge that may touch cut it into so many parts."""

Stencil = list[tuple[int, float]]


@dataclass(frozen=True)
class Fit:
    """What places are asked for.

    Parameters
    ----------
    misfits
        How far gaps [m], normals and depths as drawn [m] are from what is stored, [count].
    most
        The largest misfit; without one, the least that there is.
    resolves
        Whether it matters how deep they were inside as drawn.
    """

    misfits: Callable[[Array, Array, Array | None], Array]
    most: float | None
    resolves: bool


def between_nodes(
    model: AuditModel,
    source: tuple[int, int],
    number: int,
    position: Array,
    known: tuple[Indices, Array, int] | None,
    *,
    fit: Fit,
) -> list[Place]:
    """Return the places of points of edges on the facets of a body.

    There are very many of them: none is made of those that do not fit.

    Parameters
    ----------
    model, position
        The model, and where its nodes are [m], shape [node_count, 3].
    source
        The body of the edges, and the node that takes most of what presses on them.
    number
        The body whose facets they are before.
    known
        If given, nodes and weights of the only point that counts, and its facet.
    fit
        Which of them are asked for.
    """
    span, target = model.bodies[number].span, model.targets[number]
    stencils = _points(model, source) if known is None else [_nonzero(*known[:2])]
    if not stencils:
        return []
    at = np.array([_point(stencil, position) for stencil in stencils])
    feet = target.feet(at, position[span])
    rows = np.arange(len(feet.gap))
    if known is not None and (feet.facet == known[2]).any():
        rows = np.flatnonzero(feet.facet == known[2])
    depths = None
    if fit.resolves:
        drawn = np.array([_point(stencil, model.points) for stencil in stencils])
        inside = np.maximum(-target.signed_distance(drawn, model.points[span]), 0.0)
        depths = np.where(np.isfinite(inside), inside, 0.0)[feet.point[rows]]
    misfit = fit.misfits(feet.gap[rows], feet.normal[rows], depths)
    most = misfit.min(initial=np.inf) if fit.most is None else fit.most
    kept = np.flatnonzero(misfit <= most)
    return [
        _place(
            feet,
            int(rows[k]),
            stencils[feet.point[rows[k]]],
            span.start,
            depth=0.0 if depths is None else float(depths[k]),
            misfit=float(misfit[k]),
        )
        for k in kept
    ]


def _points(model: AuditModel, source: tuple[int, int]) -> list[Stencil]:
    """Return what the points of edges follow of which a node takes most."""
    body, node = source
    own = edges(model.bodies[body])
    own = own[(np.column_stack([own.ends, own.far]) == node).any(axis=1)]
    points = [own.stencil(k, j / PARTS) for k in range(len(own)) for j in range(1, PARTS)]
    return [
        stencil for stencil in points if Place(0.0, np.zeros(3), sources=stencil).named_by(node)
    ]


def _place(
    feet: Feet, row: int, stencil: Stencil, first: int, *, depth: float, misfit: float
) -> Place:
    followed = zip(feet.nodes[row], feet.weights[row], strict=True)
    return Place(
        gap=float(feet.gap[row]),
        normal=feet.normal[row],
        misfit=misfit,
        site=BETWEEN_NODES,
        facet=int(feet.facet[row]),
        depth=depth,
        sources=stencil,
        followed=[(int(node) + first, float(weight)) for node, weight in followed],
    )


def _nonzero(nodes: Indices, weights: Array) -> Stencil:
    return [(int(n), float(w)) for n, w in zip(nodes, weights, strict=True) if w != 0.0]


def _point(stencil: Stencil, position: Array) -> Array:
    nodes, weights = zip(*stencil, strict=True)
    point: Array = np.array(weights) @ position[list(nodes)]
    return point
