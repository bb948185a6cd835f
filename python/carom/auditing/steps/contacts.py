"""The contacts of a state, and how far nodes are from what they may touch."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from carom.auditing.arrays import Array, Indices, Mask, einsum
from carom.auditing.contact.friction import Law
from carom.auditing.contact.holding import OF_BONDS
from carom.auditing.contact.pairs import Side
from carom.auditing.model import AuditModel
from carom.auditing.steps.ellipse import Ellipse
from carom.auditing.steps.sites import Sites

BEARS = 0.5
"""Facets bear a contact at their node that face it at least this well, relative to the best."""


@dataclass(frozen=True)
class Contacts:
    """Contacts with a reaction, in the model's numbering of nodes.

    Parameters
    ----------
    node
        Source nodes, of edges and facets the one that takes most, shape [count].
    sites
        Where they are.
    source, target
        Body of the node; index of a body, or −1 − that of an obstacle; shape [count].
    reaction
        Force on the source [N], shape [count, D].
    adhesion
        What it is less by along the normal than what is in Coulomb's cone [N], shape [count]; zero
        of what does not hold.
    gap, normal
        By the auditor's closest point, less the interference [m], shape [count] and [count, D].
    sources, shares
        Nodes of the source, and how much of it each is, shape [count, m].
    followed, weights
        Nodes that the foot follows, and how much, shape [count, n]; none for obstacles.
    facet
        Facet of the foot, shape [count]; −1 for obstacles. Of a multiplier the fan that it is on.
    area
        Of multipliers what of them the target covers: an area [m²], in the plane a length [m],
        shape [count].
    shift, velocity
        How far the obstacle moves in the step [m], and its velocity at the end [m/s], shape
        [count, D]; zero for bodies.
    interference
        By how much surfaces are pushed apart at start and end of the step [m], shape [count, 2].
    gap_error, normal_error
        What was stored less that, shape [count].
    grain
        Unit vectors in the tangent plane that friction depends on, zero of what is alike in all
        directions, shape [count, D].
    side
        The pairs they belong to; None where the case has no such pair.
    """

    node: Indices
    sites: Sites
    source: Indices
    target: Indices
    reaction: Array
    adhesion: Array
    gap: Array
    normal: Array
    sources: Indices
    shares: Array
    followed: Indices
    weights: Array
    facet: Indices
    area: Array
    shift: Array
    velocity: Array
    interference: Array
    gap_error: Array
    normal_error: Array
    grain: Array
    side: tuple[Side | None, ...]

    @property
    def widening(self) -> Array:
        """How much farther surfaces are pushed apart in the step [m], shape [count]."""
        widening: Array = self.interference[:, 1] - self.interference[:, 0]
        return widening

    def less(self, others: list[Contacts]) -> Contacts:
        """Return the same contacts without the reactions of others."""
        reaction = self.reaction.copy()
        for other in others:
            reaction -= other.reaction
        return replace(self, reaction=reaction)

    def __len__(self) -> int:
        return len(self.node)

    @property
    def massless(self) -> Mask:
        """Which of them have a side without mass, shape [count]."""
        return np.array([side is not None and side.massless for side in self.side], dtype=bool)

    def only(self, chosen: Mask) -> Contacts:
        """Return those that are chosen."""
        side = tuple(side for side, keep in zip(self.side, chosen, strict=True) if keep)
        arrays = (one for one in fields(self) if one.name != "side")
        return Contacts(**{one.name: getattr(self, one.name)[chosen] for one in arrays}, side=side)

    def placed(self, chosen: Mask, others: Contacts) -> Contacts:
        """Return the same contacts where they are if chosen, and else where `others` are."""
        geometry = (
            *("gap", "normal", "sources", "shares", "followed", "weights", "facet", "area"),
            *("gap_error", "normal_error", "grain"),
        )
        found: dict[str, Any] = {}
        for name in geometry:
            mine, theirs = _alike(getattr(self, name), getattr(others, name))
            found[name] = np.where(chosen[:, None] if mine.ndim > 1 else chosen, mine, theirs)
        return replace(self, **found)

    @property
    def friction(self) -> Ellipse:
        """Their cones by coefficients; these are NaN where friction is a law."""
        return self.cone(self._by_direction(lambda law: law.fixed))

    @property
    def most_friction(self) -> Array:
        """The largest that both μ can be, shape [count, 2]."""
        return self._by_direction(lambda law: law.most)

    def cone(self, coefficients: Array) -> Ellipse:
        """Return their cones with these coefficients, shape [count, 2]."""
        return Ellipse(self.grain, self.normal, coefficients)

    def _by_direction(self, value: Callable[[Law], float]) -> Array:
        out = np.zeros((len(self), 2))
        for k, side in enumerate(self.side):
            if side is not None:
                out[k] = [value(law) for law in side.law.directions]
        out[self.bonds] = OF_BONDS
        return out

    @property
    def bonds(self) -> Mask:
        """Which of them hold and cannot be broken, shape [count]."""
        unbreakable = [
            side is not None and side.holding is not None and side.holding.unbreakable
            for side in self.side
        ]
        bonds: Mask = np.array(unbreakable, dtype=bool) & (self.adhesion > 0.0)
        return bonds

    @property
    def normal_force(self) -> Array:
        """r_n [N], shape [count]."""
        return einsum("ki,ki->k", self.reaction, self.normal)

    @property
    def force_in_cone(self) -> Array:
        """r_n + A [N]: what Signorini's and Coulomb's laws are about, shape [count]."""
        force: Array = self.normal_force + self.adhesion
        return force

    @property
    def friction_force(self) -> Array:
        """r_t [N], shape [count, D]."""
        force: Array = self.reaction - self.normal_force[:, None] * self.normal
        return force

    def weighted(self, normal: float, across: float) -> Contacts:
        """Return the same contacts with these parts of their normal and tangential reactions."""
        along = self.normal_force[:, None] * self.normal
        return replace(self, reaction=normal * along + across * (self.reaction - along))

    def relative(self, motion: Array, of_obstacles: Array) -> tuple[Array, Array]:
        """Return normal and tangential parts of the motion of nodes relative to their feet.

        They are of the shapes [count] and [count, D].

        Parameters
        ----------
        motion
            Of all nodes of the model, shape [node_count, D].
        of_obstacles
            That of the obstacles: their shift, or their velocity where `motion` is one.
        """
        feet = einsum("kj,kji->ki", self.weights, motion[self.followed]) + of_obstacles
        relative = einsum("kj,kji->ki", self.shares, motion[self.sources]) - feet
        along = einsum("ki,ki->k", relative, self.normal)
        return along, relative - along[:, None] * self.normal

    def driven(self, held: Array, of_obstacles: Array) -> Array:
        """Return what prescribed motion does against the reactions [J] or [W], shape [count].

        Parameters
        ----------
        held
            The motion of what supports hold, zero elsewhere, shape [node_count, D].
        of_obstacles
            That of the obstacles.
        """
        along, across = self.relative(held, of_obstacles)
        relative = along[:, None] * self.normal + across
        return -einsum("ki,ki->k", self.reaction, relative)

    @property
    def keys(self) -> list[tuple[int, ...]]:
        """What tells each contact from the others: what it is against, and where."""
        each = enumerate(self.target.tolist())
        return [(target, *self.sites.key(k)) for k, target in each]

    def borne(self, k: int) -> list[tuple[int, float]]:
        """Return the nodes of the source of a contact, with what each has of what presses on it."""
        return _shared(self.sources[k], self.shares[k])

    def passed_on(self, k: int) -> list[tuple[int, float]]:
        """Return the same of its foot; none of obstacles."""
        return _shared(self.followed[k], self.weights[k]) if self.target[k] >= 0 else []

    def nodal_forces(self, node_count: int) -> Array:
        """Return the reactions spread over nodes and feet [N], shape [node_count, D]."""
        force = np.zeros((node_count, self.normal.shape[1]))
        np.add.at(force, self.sources, self.shares[:, :, None] * self.reaction[:, None])
        np.add.at(force, self.followed, -self.weights[:, :, None] * self.reaction[:, None])
        return force


def _alike(a: Array, b: Array) -> tuple[Array, Array]:
    """Return arrays whose rows are as long as those of the other: nodes without a weight follow."""
    if a.ndim == 1:
        return a, b
    width = max(a.shape[1], b.shape[1])
    longer = [np.pad(rows, ((0, 0), (0, width - rows.shape[1]))) for rows in (a, b)]
    return longer[0], longer[1]


def _shared(nodes: Indices, weights: Array) -> list[tuple[int, float]]:
    sizes = np.abs(weights)
    pairs = zip(nodes.tolist(), (sizes / sizes.sum()).tolist(), strict=True)
    return [(node, share) for node, share in pairs if share > 0.0]


def all_forces(parts: Sequence[Contacts], node_count: int) -> Array:
    """Return the reactions of several on the nodes [N], shape [node_count, D]."""
    force: Array = np.sum([part.nodal_forces(node_count) for part in parts], axis=0)
    return force


def smallest_gaps(model: AuditModel, position: Array, time: float) -> list[float]:
    """Return for every side the smallest gap of its nodes [m].

    It is the signed distance from the target less the interference. What touches itself is on its
    own boundary everywhere, and has none.
    """
    gaps = []
    for side in model.sides:
        if side.source == side.target:
            gaps.append(np.inf)
            continue
        if side.interference.left(time) > 0.0:
            gaps.append(_smallest_of_overlapping(model, side, position, time))
            continue
        pushed = float(side.interference.as_state(time))
        gaps.append(_smallest_gap(model, side, position, time) - pushed)
    return gaps


def _smallest_of_overlapping(model: AuditModel, side: Side, position: Array, time: float) -> float:
    """Return the same where contacts have clearances of their own: less that of the deepest."""
    body = model.bodies[side.source]
    x = position[body.span][body.sources]
    if model.is_round(side.source, side.target):
        gaps = np.full(len(x), model.round_gap(side.source, side.target, position, time)[0])
    elif side.target < 0:
        gaps = model.obstacles[-1 - side.target].distance(x, time)
    else:
        nodes = position[model.bodies[side.target].span]
        gaps = model.targets[side.target].signed_distance(x, nodes)
    # What overlaps is taken up by no more than that of the deepest contact.
    deepest = model.deepest(side.source, side.target)
    return float(gaps.min() - side.interference.as_state(time, deepest))


def _smallest_gap(model: AuditModel, side: Side, position: Array, time: float) -> float:
    if model.is_round(side.source, side.target):
        return model.round_gap(side.source, side.target, position, time)[0]
    body = model.bodies[side.source]
    x = position[body.span][body.sources]
    if side.target < 0:
        return float(model.obstacles[-1 - side.target].distance(x, time).min())
    target = model.bodies[side.target]
    nodes = position[target.span]
    # Only nodes that may be the closest are looked at closely: a facet is no farther than its
    # nodes, and no closer than these by more than its own length or so.
    near = np.linalg.norm(x[:, None] - nodes[target.surface][None], axis=2).min(axis=1)
    across = nodes[target.facets] - nodes[target.facets[:, :1]]
    longest = np.linalg.norm(across, axis=2).max()
    close = x[near <= near.min() + 2 * longest]
    smallest = float(model.targets[side.target].signed_distance(close, nodes).min())
    if np.isfinite(smallest):
        return smallest
    # All of these are beyond the rim of an open surface.
    return float(model.targets[side.target].signed_distance(x, nodes).min())
