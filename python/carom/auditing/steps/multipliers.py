"""The multipliers of mortar pairs as places of contacts."""

from __future__ import annotations

import numpy as np

from carom.auditing.arrays import Array
from carom.auditing.model import AuditModel
from carom.auditing.steps.place import Place
from carom.auditing.steps.sites import AT_MULTIPLIER
from carom.auditing.targets.mortar import Row, Rows


def at_multipliers(model: AuditModel, source: int, target: int, position: Array) -> list[Place]:
    """Return the multipliers of the source of a pair that face the target.

    The facet of each is the number of the fan of facets that it is on. Nodes are at `position` [m],
    shape [node_count, D].
    """
    sides = [model.covering(index) for index in (source, target)]
    spans = [model.bodies[index].span for index in (source, target)]
    rows = Rows(sides[0], sides[1], (position[spans[0]], position[spans[1]]))
    firsts = (spans[0].start, spans[1].start)
    return [
        _place(node + firsts[0], fan, row, firsts, position)
        for (node, fan), row in rows.of.items()
        if row.is_covered
    ]


def _place(node: int, fan: int, row: Row, firsts: tuple[int, int], position: Array) -> Place:
    normal = -row.normal / np.linalg.norm(row.normal)
    own, others = (
        [(other + first, share / row.area) for other, share in shares.items()]
        for shares, first in zip((row.sources, row.targets), firsts, strict=True)
    )
    apart = _mean(own, position) - _mean(others, position)
    return Place(
        gap=float(normal @ apart),
        normal=normal,
        site=AT_MULTIPLIER,
        facet=fan,
        node=node,
        area=row.area,
        sources=own,
        followed=others,
    )


def _mean(weighted: list[tuple[int, float]], position: Array) -> Array:
    nodes, weights = zip(*weighted, strict=True)
    mean: Array = np.array(weights) @ position[list(nodes)]
    return mean
