"""Mortar rows: contact in the mean under the multipliers of a boundary (Puso & Laursen 2004).

Each part of a facet of the source is a plane, against which facets of the target are cut. Places
are those of the surfaces over the facets, and what faces them is the closest point of the target.
docs/theory.md has the integrals.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from carom.auditing.arrays import Array, Indices
from carom.auditing.mesh.kinds import kind_with
from carom.auditing.targets.clipping import Rule, common, cut, oriented, rule_over, size, whole_size
from carom.auditing.targets.covering import Covering
from carom.auditing.targets.seen import View, shapes_at

OPPOSED = 0.5
"""Facets face one another if their normals are opposite to 60°."""

REACH = 0.5
"""And if they are no farther from one another than this part of both diameters."""

DEPTH = 0.25
"""How deep a facet may be behind another, in the diameters of the smaller."""

NEGLIGIBLE = 1e-14
"""Pieces below this part of what they are cut from count for nothing."""

COVERED = 1e-12
"""The least part of its multiplier that a target covers."""

Multiplier = tuple[int, int]
"""A node of the source, and the fan of facets around it."""


@dataclass
class Row:
    """What a multiplier sees.

    Parameters
    ----------
    area
        ∫Φ over what the target covers [m] in the plane, else [m²].
    whole
        The same over all of it.
    normal
        ∫Φ n with the outward normal of the source, shape [D].
    sources, targets
        ∫Φ N of the nodes of either side, each in the numbering of its body.
    """

    area: float = 0.0
    whole: float = 0.0
    normal: Array = field(default_factory=lambda: np.zeros(0))
    sources: dict[int, float] = field(default_factory=dict)
    targets: dict[int, float] = field(default_factory=dict)

    @property
    def is_covered(self) -> bool:
        """Whether the target covers any of it."""
        return self.area > COVERED * self.whole and bool(np.linalg.norm(self.normal) > 0.0)


class Rows:
    """The rows of a pair where its nodes are.

    Parameters
    ----------
    source, target
        Both sides.
    positions
        Where the nodes of either are [m], shape [node_count, D].
    """

    def __init__(self, source: Covering, target: Covering, positions: tuple[Array, Array]) -> None:
        self._source, self._target = source, target
        self._x, self._y = positions
        self._looks = [self._look(target, g, self._y) for g in range(len(target.facets))]
        self.of: defaultdict[Multiplier, Row] = defaultdict(
            lambda: Row(normal=np.zeros(source.dimension))
        )
        """The rows of all multipliers that face something."""
        for facet in range(len(source.facets)):
            facing = list(self._facing(facet))
            if facing:
                self._integrate(facet, facing)

    @staticmethod
    def _look(side: Covering, facet: int, position: Array) -> tuple[View, Array, float, float]:
        """Return the plane of a facet, its corners, its diameter and its radius [m]."""
        nodes = position[side.facets[facet]]
        corners = nodes[: side.corner_count(facet)]
        apart = np.linalg.norm(nodes[:, None] - nodes[None], axis=2)
        radius = float(np.linalg.norm(nodes - nodes.mean(axis=0), axis=1).max())
        return View.of(corners), corners, float(apart.max()), radius

    def _facing(self, facet: int) -> Iterator[int]:
        """Yield the facets of the target that a facet of the source faces."""
        view, corners, diameter, radius = self._look(self._source, facet, self._x)
        middle = self._x[self._source.facets[facet]].mean(axis=0)
        outline = oriented(view.of_points(corners))
        for g, (other, others, wide, round_it) in enumerate(self._looks):
            if not view.normal @ other.normal < -OPPOSED:
                continue
            apart = np.linalg.norm(self._y[self._target.facets[g]].mean(axis=0) - middle)
            if apart > radius + round_it + REACH * (diameter + wide):
                continue
            limit = DEPTH * min(diameter, wide)
            depths = [-float(view.normal @ (other.origin - view.origin))]
            covered = common(outline, oriented(view.of_points(others)))
            depths += [-view.height(other, point) for point in covered]
            if min(depths) < limit:
                yield g

    def _integrate(self, facet: int, facing: list[int]) -> None:
        source = self._source
        kind, nodes = source.kind(facet), self._x[source.facets[facet]]
        for part, corners in enumerate(source.parts(facet)):
            view = View.of(nodes[corners])
            seen = view.of_points(nodes)
            outline = oriented(seen[corners])
            rows = [self.of[int(source.facets[facet][a]), source.fans[facet][a]] for a in corners]
            for row, a in zip(rows, corners, strict=True):
                ring = 2.0 * np.pi * abs(nodes[a, 0]) if source.revolution else 1.0
                row.whole += whole_size(outline) * ring / len(corners)
            linear = kind_with(source.dimension - 1, len(corners))
            for g in facing:
                for points, sizes in self._pieces(outline, view, g, curved=kind != linear):
                    of_part = shapes_at(linear, seen[corners], points)
                    shapes = shapes_at(kind, seen, points)
                    depth = 2.0 * np.pi * (shapes @ nodes[:, 0]) if source.revolution else 1.0
                    own, mine = source.over(facet, part, shapes, of_part)
                    faced = self._faced(g, points, view, mine @ self._x[own])
                    met = _Seen((sizes * depth)[:, None] * of_part, (own, mine), faced)
                    for corner, row in enumerate(rows):
                        met.add_to(row, corner, view.normal)

    def _pieces(self, outline: Array, view: View, g: int, *, curved: bool) -> Iterator[Rule]:
        """Yield the points of what a facet of the target covers of an outline, and weights."""
        target = self._target
        seen = view.of_points(self._y[target.facets[g]])
        parts = target.parts(g)
        for corners in parts:
            for simplex in cut(common(outline, oriented(seen[corners]))):
                if size(simplex) > NEGLIGIBLE * whole_size(outline):
                    yield rule_over(simplex, curved=curved or len(parts) > 1)

    def _faced(self, g: int, points: Array, view: View, x: Array) -> tuple[Indices, Array]:
        """Return the nodes that what faces points follows, and weights, each of [count, node].

        The points are seen in the plane of the source, and are at x [m], shape [count, D].
        """
        target = self._target
        if target.is_smooth(g):
            return target.facing(g, x, self._y)
        seen = view.of_points(self._y[target.facets[g]])
        weights = shapes_at(target.kind(g), seen, points)
        return np.broadcast_to(target.facets[g], weights.shape), weights


@dataclass(frozen=True)
class _Seen:
    """What multipliers see at points.

    Parameters
    ----------
    measures
        Their values times the sizes of points, shape [count, corner].
    own
        The nodes that all points follow, shape [n], and weights, shape [count, n].
    faced
        Those of what faces them, each of shape [count, m].
    """

    measures: Array
    own: tuple[Indices, Array]
    faced: tuple[Indices, Array]

    def add_to(self, row: Row, corner: int, normal: Array) -> None:
        """Add what the multiplier of a corner sees to its row."""
        measure = self.measures[:, corner]
        row.area += float(measure.sum())
        row.normal = row.normal + float(measure.sum()) * normal
        nodes, weights = self.own
        _add(row.sources, nodes, measure @ weights)
        nodes, weights = self.faced
        _add(row.targets, nodes.ravel(), (measure[:, None] * weights).ravel())


def _add(sums: dict[int, float], nodes: Indices, shares: Array) -> None:
    for node, share in zip(nodes.tolist(), shares.tolist(), strict=True):
        sums[node] = sums.get(node, 0.0) + share
