"""Edges of bodies in space: straight lines from node to node, or halves of parabolas."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.auditing.arrays import Array, Indices, Mask, einsum
from carom.auditing.bodies.body import AuditBody
from carom.auditing.mesh.facets import grouped
from carom.auditing.targets.feet import BEYOND

ITERATIONS = 12
"""Newton's iterations, after that by which straight lines are closest."""


@dataclass(frozen=True)
class Edges:
    """Lines from s = 0 at a first node to s = 1 at a second.

    What is half of the parabola through three nodes ends at the middle one.

    Parameters
    ----------
    ends
        First and second nodes, shape [count, 2].
    far
        Third nodes of parabolas, of what is straight the first, shape [count].
    bent
        Which are parabolas, shape [count].
    """

    ends: Indices
    far: Indices
    bent: Mask

    @classmethod
    def straight(cls, ends: Indices) -> Edges:
        """Return straight edges between nodes, shape [count, 2]."""
        return cls(ends, ends[:, 0], np.zeros(len(ends), dtype=bool))

    def __len__(self) -> int:
        """Return how many there are."""
        return len(self.ends)

    def __getitem__(self, which: Indices | Mask) -> Edges:
        """Return some of them."""
        return Edges(self.ends[which], self.far[which], self.bent[which])

    def numbered_from(self, first: int) -> Edges:
        """Return them with numbers of nodes that are greater by so much."""
        return Edges(self.ends + first, self.far + first, self.bent)

    def at(self, node: int) -> Edges:
        """Return those that end at a node."""
        return self[(self.ends == node).any(axis=1)]

    def between(self, ends: Indices) -> Edges:
        """Return the one between two nodes."""
        return self[(np.sort(self.ends, axis=1) == np.sort(ends)).all(axis=1)]

    def points(self, s: Array, position: Array) -> tuple[Array, Array, Array]:
        """Return points at s [m] and the first two derivatives by s, shapes [count, 3].

        Half an edge beyond their ends they go straight on. `s` has shape [count].
        """
        a, b, far = (position[nodes] for nodes in (*self.ends.T, self.far))
        bow = np.where(self.bent[:, None], 0.5 * (a + far) - b, 0.0)
        held = np.clip(s, -BEYOND, 1.0 + BEYOND)[:, None]
        slope = (b - a) - bow * (1.0 - 2.0 * held)
        rest = s[:, None] - held
        on = a + (b - a) * held - bow * held * (1.0 - held) + slope * rest
        return on, slope, np.where(rest == 0.0, 2.0 * bow, 0.0)

    def stencil(self, k: int, s: float) -> list[tuple[int, float]]:
        """Return the nodes that a point of one follows, no farther out than it bends."""
        first, second = map(int, self.ends[k])
        if not self.bent[k]:
            return [(first, 1.0 - s), (second, s)]
        bent = 0.5 * s * (1.0 - s)
        return [(first, 1.0 - s - bent), (second, s + 2.0 * bent), (int(self.far[k]), -bent)]


def edges(body: AuditBody) -> Edges:
    """Return the lines from node to node around the facets that may touch, each once."""
    straight: list[Indices] = [np.zeros((0, 2), dtype=np.int64)]
    bent: list[Indices] = [np.zeros((0, 3), dtype=np.int64)]
    for kind, _, facets in grouped(body.facets, body.dimension):
        for side in kind.facets:
            if len(side) == 2:
                straight.append(np.sort(facets[:, side], axis=1))
            else:
                bent += [facets[:, side[[0, 2, 1]]], facets[:, side[[1, 2, 0]]]]
    lines = np.unique(np.concatenate(straight), axis=0) + body.span.start
    bows = np.unique(np.concatenate(bent), axis=0) + body.span.start
    return Edges(
        ends=np.concatenate([lines, bows[:, :2]]),
        far=np.concatenate([lines[:, 0], bows[:, 2]]),
        bent=np.repeat([False, True], [len(lines), len(bows)]),
    )


def closest(source: Edges, target: Edges, position: Array) -> Array:
    """Return where edges are closest to others in turn, if they did not end, shape [count, 2].

    Straight ones are so in closed form, others by Newton's method from there. Where lines are
    parallel nothing is finite.
    """
    found = np.zeros((len(source), 2))
    bent = (source.bent | target.bent).any()
    for _ in range(1 + ITERATIONS * int(bent)):
        x, e, bend_e = source.points(found[:, 0], position)
        y, f, bend_f = target.points(found[:, 1], position)
        offset = x - y
        ee, ff, ef = (einsum("ki,ki->k", u, v) for u, v in ((e, e), (f, f), (e, f)))
        on_e, on_f = (einsum("ki,ki->k", u, offset) for u in (e, f))
        bent_ee = ee + einsum("ki,ki->k", bend_e, offset)
        bent_ff = ff - einsum("ki,ki->k", bend_f, offset)
        # Far apart for how much they bend, they are taken for straight.
        bends = (bent_ee * bent_ff - ef * ef > 0.5 * (ee * ff - ef * ef)) & (bent_ee > 0.0)
        ee, ff = np.where(bends, bent_ee, ee), np.where(bends, bent_ff, ff)
        way = np.stack([ef * on_f - ff * on_e, ee * on_f - ef * on_e], axis=1)
        found = found + way / (ee * ff - ef * ef)[:, None]
    return found
