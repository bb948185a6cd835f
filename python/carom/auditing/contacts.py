"""The stored contacts of a state, found again by the auditor's own closest points."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.auditing.arrays import Array, Indices, cross, einsum
from carom.auditing.model import AuditModel
from carom.auditing.pairs import Side
from carom.auditing.target import CORNER, Feet

SAME = 1e-7
"""Feet whose gap [model size] and normal differ by no more are equally good: at edges of facets."""


@dataclass(frozen=True)
class Contacts:
    """Contacts with a reaction, in the model's numbering of nodes.

    Parameters
    ----------
    node
        Source nodes, shape [count].
    source, target
        Body of the node; index of a body, or −1 − that of an obstacle; shape [count].
    reaction
        Force on the node [N], shape [count, 2].
    gap, normal
        By the auditor's closest point [m], shape [count] and [count, 2].
    followed, weights
        Nodes that the foot follows, and how much, shape [count, 4]; none for obstacles.
    shift, velocity
        How far the obstacle moves in the step [m], and its velocity at the end [m/s], shape
        [count, 2]; zero for bodies.
    gap_error, normal_error
        What was stored less that, shape [count].
    side
        The pairs they belong to; None where the case has no such pair.
    """

    node: Indices
    source: Indices
    target: Indices
    reaction: Array
    gap: Array
    normal: Array
    followed: Indices
    weights: Array
    shift: Array
    velocity: Array
    gap_error: Array
    normal_error: Array
    side: tuple[Side | None, ...]

    def less(self, others: list[Contacts]) -> Contacts:
        """Return the same contacts without the reactions of others."""
        reaction = self.reaction.copy()
        for other in others:
            reaction -= other.reaction
        return replace(self, reaction=reaction)

    def __len__(self) -> int:
        return len(self.node)

    @property
    def massless(self) -> NDArray[np.bool_]:
        """Which of them have a side without mass, shape [count]."""
        return np.array([side is not None and side.massless for side in self.side], dtype=bool)

    def only(self, chosen: NDArray[np.bool_]) -> Contacts:
        """Return those that are chosen."""
        side = tuple(side for side, keep in zip(self.side, chosen, strict=True) if keep)
        arrays = (one for one in fields(self) if one.name != "side")
        return Contacts(**{one.name: getattr(self, one.name)[chosen] for one in arrays}, side=side)

    def placed(self, chosen: NDArray[np.bool_], others: Contacts) -> Contacts:
        """Return the same contacts where they are if chosen, and else where `others` are."""
        geometry = ("gap", "normal", "followed", "weights", "gap_error", "normal_error")
        found = {}
        for name in geometry:
            mine, theirs = getattr(self, name), getattr(others, name)
            found[name] = np.where(chosen[:, None] if mine.ndim > 1 else chosen, mine, theirs)
        return replace(self, **found)

    @property
    def friction(self) -> Array:
        """Coulomb's coefficients, shape [count]; NaN where friction is a law."""
        return np.array([0.0 if side is None else side.law.fixed for side in self.side])

    @property
    def most_friction(self) -> Array:
        """The largest that μ can be, shape [count]."""
        return np.array([0.0 if side is None else side.law.most for side in self.side])

    @property
    def normal_force(self) -> Array:
        """r_n [N], shape [count]."""
        return einsum("ki,ki->k", self.reaction, self.normal)

    @property
    def friction_force(self) -> Array:
        """r_t [N], shape [count]."""
        return cross(self.normal, self.reaction)

    def relative(self, motion: Array, of_obstacles: Array) -> tuple[Array, Array]:
        """Return normal and tangential parts of the motion of nodes relative to their feet.

        Parameters
        ----------
        motion
            Of all nodes of the model, shape [node_count, 2].
        of_obstacles
            That of the obstacles: their shift, or their velocity where `motion` is one.
        """
        feet = einsum("kj,kji->ki", self.weights, motion[self.followed]) + of_obstacles
        relative = motion[self.node] - feet
        return einsum("ki,ki->k", relative, self.normal), cross(self.normal, relative)

    @property
    def prescribed_work(self) -> Array:
        """The work of obstacles that move against the reactions in the step [J], [count]."""
        return einsum("ki,ki->k", self.reaction, self.shift)

    def nodal_forces(self, node_count: int) -> Array:
        """Return the reactions spread over nodes and feet [N], shape [node_count, 2]."""
        force = np.zeros((node_count, 2))
        np.add.at(force, self.node, self.reaction)
        np.add.at(force, self.followed, -self.weights[:, :, None] * self.reaction[:, None])
        return force


def all_forces(parts: Sequence[Contacts], node_count: int) -> Array:
    """Return the reactions of several on the nodes [N], shape [node_count, 2]."""
    force = np.zeros((node_count, 2))
    for part in parts:
        force += part.nodal_forces(node_count)
    return force


def find(
    model: AuditModel,
    state: Mapping[str, Any],
    position: Array,
    time: float,
    *,
    step: tuple[float, float],
    like: Contacts | None = None,
) -> Contacts:
    """Find the contacts of a state with nodes at `position` [m] and obstacles as at `time` [s].

    The `step` has start and end [s].

    Feet are those that come closest to the stored gaps and normals. What is stored is not of all
    times of a step: feet at others are near those of the contacts `like` them.
    """
    stored, target = state["contact_node"], state["contact_target"]
    count = len(stored)
    node = np.clip(stored, 0, len(model.points) - 1)
    source = np.array([model.body_of(int(n)) for n in stored], dtype=np.int64)
    gap, normal = np.full(count, np.nan), np.full((count, 2), np.nan)
    followed, weights = np.zeros((count, 4), dtype=np.int64), np.zeros((count, 4))
    shift, velocity = np.zeros((count, 2)), np.zeros((count, 2))
    stored_gap, stored_normal = state["contact_gap"], state["contact_normal"]
    for t in np.unique(target):
        at = np.flatnonzero(target == t)
        x = position[node[at]]
        if t < 0:
            if -1 - t < len(model.obstacles):
                obstacle = model.obstacles[-1 - t]
                gap[at], normal[at] = obstacle.nearest(x, time)
                before, after = (obstacle.travel.displacement(end) for end in step)
                shift[at], velocity[at] = after - before, obstacle.travel.velocity(step[1])
            continue
        if t >= len(model.bodies):
            continue
        span = model.bodies[t].span
        feet = model.targets[t].feet(x, position[span])
        misfit = np.abs(feet.gap - stored_gap[at][feet.point]) / model.size
        misfit += np.linalg.norm(feet.normal - stored_normal[at][feet.point], axis=1)
        for k, contact in enumerate(at):
            mine = np.flatnonzero(feet.point == k)
            if len(mine) == 0:
                continue
            good = mine[misfit[mine] <= misfit[mine].min() + SAME]
            best = good[feet.beyond[good].argmin()]
            if like is not None:
                near = (like.followed[contact] - span.start, like.normal[contact])
                best = _nearest(feet, mine, near, smooth=model.smooth, otherwise=int(best))
            gap[contact], normal[contact] = feet.gap[best], feet.normal[best]
            followed[contact] = feet.nodes[best] + span.start
            weights[contact] = feet.weights[best]
    sides = {(side.source, side.target): side for side in model.sides}
    return Contacts(
        node=node,
        source=source,
        target=target,
        reaction=state["contact_reaction"],
        gap=gap,
        normal=normal,
        followed=followed,
        weights=weights,
        shift=shift,
        velocity=velocity,
        gap_error=stored_gap - gap,
        normal_error=np.linalg.norm(stored_normal - normal, axis=1),
        side=tuple(sides.get((int(s), int(t))) for s, t in zip(source, target, strict=True)),
    )


def _nearest(
    feet: Feet, mine: Indices, known: tuple[Indices, Array], *, smooth: bool, otherwise: int
) -> int:
    """Return which of the feet `mine` of a point goes on from a known one.

    It stays on its facet. On a smooth target it goes on to the next one where the foot is on that;
    beyond an edge, beside both, it stays.

    Parameters
    ----------
    feet
        Feet of points.
    mine
        Those of the point.
    known
        Nodes that the known foot follows, in the numbering of the body, and its normal.
    smooth
        Whether the target is smooth.
    otherwise
        What to return where none goes on from it.
    """
    nodes, normal = known
    own = (feet.nodes[mine] == nodes).all(axis=1)
    on = feet.beyond[mine] == 0.0
    choices = [own & on] if smooth else [own]
    if smooth:
        # The first two nodes are those of the facet; sides beyond a corner are not beside it.
        beside = np.isin(feet.nodes[mine, :2], nodes[:2]).any(axis=1)
        beside &= feet.normal[mine] @ normal > CORNER
        choices += [beside & on, own]
    found = next((chosen for chosen in choices if chosen.any()), None)
    return otherwise if found is None else int(mine[found.argmax()])


def smallest_gaps(model: AuditModel, position: Array, time: float) -> list[float]:
    """Return for every side the smallest signed distance of its nodes from its target [m]."""
    return [_smallest_gap(model, side, position, time) for side in model.sides]


def _smallest_gap(model: AuditModel, side: Side, position: Array, time: float) -> float:
    body = model.bodies[side.source]
    x = position[body.span][body.sources]
    if side.target < 0:
        return float(model.obstacles[-1 - side.target].distance(x, time).min())
    target = model.bodies[side.target]
    nodes = position[target.span]
    # Only nodes that may be the closest are looked at closely: a facet is no farther than its
    # nodes, and no closer than these by more than its own length or so.
    near = np.linalg.norm(x[:, None] - nodes[target.surface][None], axis=2).min(axis=1)
    longest = np.linalg.norm(np.diff(nodes[target.facets], axis=1), axis=2).max()
    close = x[near <= near.min() + 2 * longest]
    smallest = float(model.targets[side.target].signed_distance(close, nodes).min())
    if np.isfinite(smallest):
        return smallest
    # All of these are beyond the rim of an open surface.
    return float(model.targets[side.target].signed_distance(x, nodes).min())
