"""Mortar rows: contact in the mean under the multipliers of a boundary (Puso & Laursen 2004).

Each part of a facet of the source is a plane, against which facets of the target are cut. Places
are those of the surfaces over the facets, and what faces them is the closest point of the target.
docs/theory.md has the integrals.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from carom.auditing.arrays import Array, Indices
from carom.auditing.mesh.kinds import kind_with
from carom.auditing.targets.clipping import Rule, common, cut, oriented, rule_over, size, whole_size
from carom.auditing.targets.covering import Covering
from carom.auditing.targets.facing import (
    diameter,
    facing_facets,
    share_by_angle,
    share_by_distance,
)
from carom.auditing.targets.seen import View, shapes_at

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
    normal
        ∫Φ n with the outward normal of the source, shape [D].
    area
        ∫Φ over what the target covers [m] in the plane, else [m²].
    whole
        The same over all of it.
    sources, targets
        ∫Φ N of the nodes of either side, each in the numbering of its body.
    """

    normal: Array
    area: float = 0.0
    whole: float = 0.0
    sources: dict[int, float] = field(default_factory=dict)
    targets: dict[int, float] = field(default_factory=dict)

    @property
    def is_covered(self) -> bool:
        """Whether the target covers any of it."""
        return self.area > COVERED * self.whole and bool(np.linalg.norm(self.normal) > 0.0)


@dataclass(frozen=True)
class _Piece:
    """What a facet of the target covers of a part of the source.

    Parameters
    ----------
    rows
        The rows of the corners of the part.
    view
        The plane of the part.
    faced
        The facet of the target.
    points
        Points of quadrature in that plane, shape [count, D − 1].
    measures
        Values of the multipliers there times the sizes of points, shape [count, corner].
    nodes, weights
        The nodes of the source that all points follow, shape [n], and weights, shape [count, n].
    """

    rows: list[Row]
    view: View
    faced: int
    points: Array
    measures: Array
    nodes: Indices
    weights: Array

    def add(self, others: Indices, shares: Array) -> None:
        """Add what multipliers see to their rows.

        What faces the points follows these nodes with these shares, each of shape [count, m].
        """
        for row, measure in zip(self.rows, self.measures.T, strict=True):
            row.area += float(measure.sum())
            row.normal = row.normal + float(measure.sum()) * self.view.normal
            _add(row.sources, self.nodes, measure @ self.weights)
            _add(row.targets, others.ravel(), (measure[:, None] * shares).ravel())


class Rows:
    """The rows of a pair.

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
        self.of: dict[Multiplier, Row] = {}
        """The rows of all multipliers that face something."""
        pieces = [
            piece
            for facet, faced in facing_facets(source, target, positions)
            for part in range(len(source.parts(facet)))
            for piece in self._pieces(facet, part, faced)
        ]
        smooth = [piece for piece in pieces if target.is_smooth(piece.faced)]
        for piece in pieces:
            if not target.is_smooth(piece.faced):
                piece.add(*self._seen(piece))
        if smooth:
            self._add_closest(smooth)

    def _pieces(self, facet: int, part: int, faced: list[int]) -> Iterator[_Piece]:
        """Yield what facets of the target cover of a part of a facet of the source."""
        source, corners = self._source, self._source.parts(facet)[part]
        kind, nodes = source.kind(facet), self._x[source.facets[facet]]
        view = View.of(nodes[corners])
        seen = view.of_points(nodes)
        outline = oriented(seen[corners])
        rows = [self._row(int(source.facets[facet][a]), source.fans[facet][a]) for a in corners]
        for row, a in zip(rows, corners, strict=True):
            ring = 2.0 * np.pi * abs(nodes[a, 0]) if source.revolution else 1.0
            row.whole += whole_size(outline) * ring / len(corners)
        linear = kind_with(source.dimension - 1, len(corners))
        for g in faced:
            for points, sizes in self._covered(outline, view, (facet, g), curved=kind != linear):
                of_part = shapes_at(linear, seen[corners], points)
                shapes = shapes_at(kind, seen, points)
                depth = 2.0 * np.pi * (shapes @ nodes[:, 0]) if source.revolution else 1.0
                own, weights = source.over(facet, part, shapes, of_part)
                measures = (sizes * depth)[:, None] * of_part
                yield _Piece(rows, view, g, points, measures, own, weights)

    def _row(self, node: int, fan: int) -> Row:
        return self.of.setdefault((node, fan), Row(np.zeros(self._source.dimension)))

    def _covered(
        self, outline: Array, view: View, facets: tuple[int, int], *, curved: bool
    ) -> Iterator[Rule]:
        """Yield the points of what a facet of the target covers of an outline, and weights.

        `facets` are the one that the outline is of, and that of the target.
        """
        target, nodes = self._target, self._y[self._target.facets[facets[1]]]
        seen = view.of_points(nodes)
        sizes = (diameter(self._x[self._source.facets[facets[0]]]), diameter(nodes))
        parts = target.parts(facets[1])
        for corners in parts:
            opposite = View.of(nodes[corners])
            share = share_by_angle(view, opposite)
            if share == 0.0:
                continue
            shared = common(outline, oriented(seen[corners]))
            if not len(shared):
                continue
            share *= share_by_distance(view, opposite, sizes, shared)
            for simplex in cut(shared):
                if share > 0.0 and size(simplex) > NEGLIGIBLE * whole_size(outline):
                    points, weights = rule_over(simplex, curved=curved or len(parts) > 1)
                    yield points, share * weights

    def _seen(self, piece: _Piece) -> tuple[Indices, Array]:
        """Return what faces the points of a piece along the normal of its plane."""
        target, g = self._target, piece.faced
        nodes = piece.view.of_points(self._y[target.facets[g]])
        weights = shapes_at(target.kind(g), nodes, piece.points)
        return np.broadcast_to(target.facets[g], weights.shape), weights

    def _add_closest(self, pieces: list[_Piece]) -> None:
        """Add pieces before what is smooth, whose closest points face theirs."""
        x = np.concatenate([piece.weights @ self._x[piece.nodes] for piece in pieces])
        counts = [len(piece.points) for piece in pieces]
        faced = np.repeat([piece.faced for piece in pieces], counts)
        nodes, weights = self._target.facing(faced, x, self._y)
        last = 0
        for piece, count in zip(pieces, counts, strict=True):
            own = slice(last, last + count)
            piece.add(nodes[own], weights[own])
            last += count


def _add(sums: dict[int, float], nodes: Indices, shares: Array) -> None:
    for node, share in zip(nodes.tolist(), shares.tolist(), strict=True):
        sums[node] = sums.get(node, 0.0) + share
