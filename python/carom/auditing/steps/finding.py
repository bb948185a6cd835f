"""The stored contacts of a state, found again by the auditor's own closest points."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from carom.auditing.arrays import Array, Indices
from carom.auditing.contact.crossings import crossings, drawn_depths
from carom.auditing.contact.edges import Edges, edges
from carom.auditing.contact.obstacles import Cornered, Round
from carom.auditing.contact.rounding import nearest_place
from carom.auditing.model import AuditModel
from carom.auditing.steps.between import between_nodes
from carom.auditing.steps.bonds import carried
from carom.auditing.steps.contacts import Contacts
from carom.auditing.steps.cornered import at_corner, at_edges, on_obstacle
from carom.auditing.steps.following import goes_on
from carom.auditing.steps.multipliers import at_multipliers
from carom.auditing.steps.place import Place
from carom.auditing.steps.sites import (
    AT_CORNER,
    AT_EDGES,
    AT_MULTIPLIER,
    AT_NODE,
    BEFORE_ROUND,
    BETWEEN_NODES,
    Sites,
)
from carom.auditing.targets.feet import Feet

SAME = 1e-7
"""Feet whose gap [model size] and normal differ by no more are equally good: at edges of facets."""

NO_FACET = -1
"""The facet of a foot on what has none."""

ON_FACETS = (AT_NODE, AT_CORNER, BETWEEN_NODES)
"""What is on a facet: where that is flat, on the stored one."""


def find(
    model: AuditModel,
    state: Mapping[str, Any],
    position: Array,
    time: float,
    *,
    step: tuple[float, float],
    like: Contacts | None = None,
    begun: Array | None = None,
) -> Contacts:
    """Find the contacts of a state with nodes at `position` [m] and obstacles as at `time` [s].

    The `step` has start and end [s]; where one in time of the plane has `begun` its nodes are [m],
    what is a kink there is one for the whole step.

    What is stored says which node, edges or corner they are at. Feet are those that come closest to
    the stored gaps and normals, on the stored facet where others are as good. Gaps and normals are
    not of all times of a step: feet at others are near those of the contacts `like` them.
    """
    found = _Finder(model, state, (position, time), step, (like, begun)).found()
    bonds = found.bonds
    if not bonds.any():
        return found
    # What nothing breaks is where it was closed at the start of the run, for ever.
    drawn = model.begun
    start = (model.points + drawn.displacement, drawn.time)
    tied = _Finder(model, state, start, (drawn.time, drawn.time + 1.0)).found()
    return found.placed(~bonds, carried(model, tied, start, (position, time), found))


class _Finder:
    def __init__(
        self,
        model: AuditModel,
        state: Mapping[str, Any],
        at: tuple[Array, float],
        step: tuple[float, float],
        near: tuple[Contacts | None, Array | None] = (None, None),
    ) -> None:
        position, time = at
        self._model, self._position, self._time = model, position, time
        self._like, self._begun = near
        self._state = state
        self._sites = Sites.of(state)
        stored = state["contact_node"]
        self._node = np.clip(stored, 0, len(model.points) - 1)
        self._source = np.array([model.body_of(int(n)) for n in stored], dtype=np.int64)
        self._target: Indices = state["contact_target"]
        self._step = step
        sides = {(side.source, side.target): side for side in model.sides}
        between = zip(self._source.tolist(), self._target.tolist(), strict=True)
        self._sides = tuple(sides.get(key) for key in between)
        # Load steps in which time stands still are at their end.
        self._part = (time - step[0]) / (step[1] - step[0]) if step[1] > step[0] else 1.0
        self._resolves = [
            side is not None and side.interference.left(step[0]) > 0.0 for side in self._sides
        ]
        """Where overlaps as drawn are being taken up."""
        self._normal: Array = state["contact_normal"]
        self._places = [
            Place(np.nan, np.full(model.dimension, np.nan), sources=[(int(node), 1.0)])
            for node in self._node
        ]

        self._multipliers: dict[tuple[int, int], list[Place]] = {}
        """The multipliers of mortar pairs, by source and target."""
        self._edges_of: dict[int, Edges] = {}

    def _pushed_apart(self, contact: int, depth: float | None) -> Array:
        """Return the interference at both ends of the step [m] of a contact as deep, shape [2].

        Where no depth is given it is that of its node.
        """
        side = self._sides[contact]
        if side is None:
            return np.zeros(2)
        if not self._resolves[contact]:
            depth = 0.0
        elif depth is None:
            own = int(self._node[contact]) - self._model.bodies[side.source].span.start
            depth = float(self._model.drawn_depths(side.source, side.target)[own])
        h = side.interference
        return np.array([h.as_state(self._step[0], depth), h.at(self._step[1], depth)])

    def _stand_off(self, contact: int, depth: float | None) -> float:
        """Return the same at the time that contacts are looked at [m]."""
        start, end = self._pushed_apart(contact, depth)
        return float((1.0 - self._part) * start + self._part * end)

    def found(self) -> Contacts:
        """Return the contacts."""
        bodies, obstacles = len(self._model.bodies), len(self._model.obstacles)
        known = (self._source < bodies) & (-obstacles <= self._target) & (self._target < bodies)
        at_nodes: dict[int, list[int]] = defaultdict(list)
        for contact in np.flatnonzero(known).tolist():
            target = int(self._target[contact])
            if self._is_round(contact):
                self._of_ball(contact)
            elif not self._may_be(contact):
                continue
            elif target < 0:
                self._before_obstacle(-1 - target, contact)
            elif self._sites.kind[contact] == AT_NODE:
                at_nodes[target].append(contact)
            else:
                self._before_body(target, contact)
        for target, own in at_nodes.items():
            self._at_nodes(target, np.array(own))
        return self._gathered()

    def _is_round(self, contact: int) -> bool:
        """Return whether a contact is of a round body with what has no corners."""
        return self._model.is_round(int(self._source[contact]), int(self._target[contact]))

    def _may_be(self, contact: int) -> bool:
        """Return whether a contact of its pair can be what is stored."""
        kind, side = int(self._sites.kind[contact]), self._sides[contact]
        if kind in (AT_NODE, AT_MULTIPLIER, BETWEEN_NODES) and self._target[contact] >= 0:
            mortar = side is not None and side.mortar
            if mortar != (kind == AT_MULTIPLIER):
                return False
        return self._sites.says(contact)

    def _of_ball(self, contact: int) -> None:
        """Place a contact of a round body where it touches."""
        model = self._model
        source, target = int(self._source[contact]), int(self._target[contact])
        gap, normal = model.round_gap(source, target, self._position, self._time)
        self._places[contact] = Place(
            gap=gap,
            normal=normal,
            misfit=float(self._misfit(contact, np.array(gap), normal)),
            sources=self._on_ball(source, normal),
            followed=self._on_ball(target, -normal) if target >= 0 else [],
        )

    def _on_ball(self, body: int, normal: Array) -> list[tuple[int, float]]:
        span, ball = self._model.bodies[body].span, self._model.bodies[body].ball
        assert ball is not None, "both sides are round"
        pressed = self._state["contact_force"][span].any(axis=1)
        found = ball.touching(normal, self._position[span], pressed)
        return [(node + span.start, weight) for node, weight in found]

    def _misfit(self, contact: int, gap: Array, normal: Array, depth: float | None = None) -> Array:
        """Return how far gaps and normals are from what is stored, in sizes of the model.

        Gaps are stored as the law sees them.
        """
        apart = np.linalg.norm(self._normal[contact] - normal, axis=-1)
        stored = self._state["contact_gap"][contact] + self._stand_off(contact, depth)
        misfit: Array = np.abs(gap - stored) / self._model.size + apart
        return misfit

    def _before_obstacle(self, number: int, contact: int) -> None:
        obstacle, kind = self._model.obstacles[number], self._sites.kind[contact]
        shape, shift = obstacle.shape, obstacle.travel.displacement(self._time)
        node = int(self._sites.numbers[contact, 0])
        places: list[Place] = []
        if kind == AT_NODE and node == self._node[contact]:
            places = self._on_obstacle(number, node)
        elif kind == BEFORE_ROUND and isinstance(shape, Round):
            places = self._before_round(shape, shift, contact)
        elif kind == AT_CORNER and isinstance(shape, Cornered):
            source = int(self._source[contact])
            body, target = self._model.bodies[source], self._model.targets[source]
            places = at_corner(shape, shift, node, (body, target), self._position)
        elif kind == AT_EDGES and isinstance(shape, Cornered) and self._model.dimension == 3:
            both = self._edge(contact), self._sites.crossed(contact)
            drawn = (self._model.points, self._position)
            places = at_edges(shape, shift, both, drawn, self._normal[contact])
        self._choose(contact, places)

    def _on_obstacle(self, number: int, node: int) -> list[Place]:
        obstacle = self._model.obstacles[number]
        if isinstance(obstacle.shape, Cornered):
            shift = obstacle.travel.displacement(self._time)
            return on_obstacle(obstacle.shape, shift, node, self._position)
        gaps, normals = obstacle.nearest(self._position[[node]], self._time)
        return [Place(float(gaps[0]), normals[0], sources=[(node, 1.0)])]

    def _before_round(self, shape: Round, shift: Array, contact: int) -> list[Place]:
        """Return the place of the facet or edge that is before something round."""
        body = self._model.bodies[int(self._source[contact])]
        nodes = self._sites.edge(contact)
        if nodes[0] < 0:
            nodes = self._sites.facets[contact]
        nodes = nodes[nodes >= 0] - body.span.start
        if not len(nodes) or not np.isin(nodes, body.surface).all():
            return []
        place = nearest_place(shape, nodes, self._position[body.span] - shift)
        drawn = nearest_place(shape, nodes, body.points)
        sources = [(node + body.span.start, weight) for node, weight in place.stencil]
        depth = max(-drawn.gap, 0.0)
        return [
            Place(place.gap, place.normal, site=BEFORE_ROUND, sources=sources, depth=depth),
        ]

    def _before_body(self, number: int, contact: int) -> None:
        """Place a contact with a body that is not at a node."""
        kind, places = self._sites.kind[contact], []
        if kind == AT_MULTIPLIER:
            places = self._under_multipliers(number, contact)
        elif kind == AT_EDGES and self._model.dimension == 3:
            places = self._at_edges(number, contact)
        elif kind == BETWEEN_NODES and self._model.dimension == 3:
            mine = self._edge(contact)
            if len(mine):
                stencil = self._sites.point(contact, mine)
                resolves = bool(self._resolves[contact])
                places = between_nodes(
                    self._model, stencil, number, self._position, resolves=resolves
                )
        self._choose(contact, places)

    def _under_multipliers(self, number: int, contact: int) -> list[Place]:
        """Return the multipliers at a node, on all its sides."""
        source = int(self._source[contact])
        if (source, number) not in self._multipliers:
            places = at_multipliers(self._model, source, number, self._position)
            self._multipliers[source, number] = places
        node = int(self._sites.numbers[contact, 0])
        own = [place for place in self._multipliers[source, number] if place.node == node]
        if self._like is not None:
            fan = int(self._like.facet[contact])
            own = [place for place in own if place.facet == fan]
        return own if node == self._node[contact] else []

    def _choose(self, contact: int, places: list[Place]) -> None:
        """Place a contact where it fits what is stored best, or goes on from what is known."""
        found = self._fitted(contact, places)
        if self._like is None:
            # What is stored of a contact names the node that takes most of it.
            node = int(self._node[contact])
            found = [p for p in found if p.site == AT_MULTIPLIER or p.named_by(node)]
            stored = self._stored_facets(contact)
            facets = stored.facets
            if self._sites.kind[contact] in ON_FACETS and not stored.smooth:
                found = [place for place in found if place.facet in facets]
            least = min((place.misfit for place in found), default=np.inf)
            found = [place for place in found if place.misfit <= least + SAME]
        else:
            facets = self._like.facet[[contact]]
        found = [place for place in found if place.facet in facets] or found
        if found:
            self._places[contact] = min(found, key=lambda place: place.misfit)

    def _stored_facets(self, contact: int) -> _Stored:
        """Return the facets that are stored of a contact."""
        of = int(self._target[contact])
        if self._sites.kind[contact] == AT_CORNER:
            of = int(self._source[contact])
        if of >= 0:
            first, target = self._model.bodies[of].span.start, self._model.targets[of]
            facets = self._sites.on(contact, target.facets, first)
            return _Stored(facets, smooth=bool(target.smooth[facets].any()))
        shape = self._model.obstacles[-1 - of].shape
        if not isinstance(shape, Cornered):
            return _Stored(np.array([NO_FACET]), smooth=False)
        return _Stored(self._sites.on(contact, shape.facets, 0), smooth=False)

    def _fitted(self, contact: int, places: list[Place]) -> list[Place]:
        """Return places with how far they are from what is stored of a contact."""
        return [
            replace(
                place,
                misfit=float(self._misfit(contact, np.array(place.gap), place.normal, place.depth)),
            )
            for place in places
        ]

    def _at_nodes(self, number: int, at: Indices) -> None:
        """Place contacts of nodes with a body."""
        model, target = self._model, self._model.targets[number]
        span = model.bodies[number].span
        at = at[self._sites.numbers[at, 0] == self._node[at]]
        if not len(at):
            return
        feet = target.feet(self._position[self._node[at]], self._position[span])
        for k, contact in enumerate(at.tolist()):
            mine = np.flatnonzero(feet.point == k)
            if int(self._source[contact]) == number:
                own = int(self._node[contact]) - span.start
                mine = mine[~np.isin(feet.facet[mine], _around(target.facets, own))]
            if len(mine):
                self._at_node(feet, mine, contact, number)

    def _at_node(self, feet: Feet, mine: Indices, contact: int, number: int) -> None:
        model = self._model
        target, stored = model.targets[number], self._stored_facets(contact)
        if self._like is None and not stored.smooth:
            mine = mine[np.isin(feet.facet[mine], stored.facets)]
            if not len(mine):
                return
        misfit = self._misfit(contact, feet.gap[mine], feet.normal[mine])
        alike = misfit <= misfit.min() + SAME
        good = mine[alike]
        # Where smooth facets meet, the stored one, or else the one whose normal it is.
        others = ~np.isin(feet.facet[good], stored.facets)
        foot = int(good[np.lexsort((misfit[alike], feet.beyond[good], others))[0]])
        if self._like is not None:
            near = (int(self._like.facet[contact]), self._like.normal[contact])
            begun = None if self._begun is None else self._begun[model.bodies[number].span]
            foot = goes_on(feet, mine, near, target, begun=begun, otherwise=foot)
        first = model.bodies[number].span.start
        self._places[contact] = Place(
            gap=float(feet.gap[foot]),
            normal=feet.normal[foot],
            misfit=float(misfit.min()),
            facet=int(feet.facet[foot]),
            sources=self._places[contact].sources,
            followed=[
                (int(node) + first, float(weight))
                for node, weight in zip(feet.nodes[foot], feet.weights[foot], strict=True)
            ],
        )

    def _edges(self, body: int) -> Edges:
        """Return the edges of a body, found once."""
        if body not in self._edges_of:
            self._edges_of[body] = edges(self._model.bodies[body])
        return self._edges_of[body]

    def _edge(self, contact: int) -> Edges:
        """Return the edge of the source of a contact; none if it has no such edge."""
        return self._edges(int(self._source[contact])).between(self._sites.edge(contact))

    def _at_edges(self, number: int, contact: int) -> list[Place]:
        """Return where the edge of the source crosses that of the target."""
        model = self._model
        theirs = self._edges(number).between(self._sites.crossed(contact))
        found = crossings(self._position, self._edge(contact), theirs, self._normal[contact])
        depths = drawn_depths(model.points, found)
        return [
            Place(
                gap=float(found.gap[k]),
                normal=found.normal[k],
                site=AT_EDGES,
                sources=found.source.stencil(int(k), float(found.along[k, 0])),
                followed=found.target.stencil(int(k), float(found.along[k, 1])),
                depth=float(depths[k]),
            )
            for k in np.flatnonzero(np.isfinite(found.gap))
        ]

    def _gathered(self) -> Contacts:
        model, count = self._model, len(self._places)
        shift = np.zeros((count, model.dimension))
        velocity = np.zeros_like(shift)
        for k, t in enumerate(self._target):
            if -len(model.obstacles) <= t < 0:
                travel = model.obstacles[-1 - t].travel
                before, after = (travel.displacement(end) for end in self._step)
                shift[k], velocity[k] = after - before, travel.velocity(self._step[1])
        gap = np.array([place.gap for place in self._places])
        pushed = [self._pushed_apart(k, place.depth) for k, place in enumerate(self._places)]
        interference = np.array(pushed).reshape(count, 2)
        stand_off = interference @ np.array([1.0 - self._part, self._part])
        normal = np.array([place.normal for place in self._places]).reshape(shift.shape)
        sources, shares = _padded([place.sources for place in self._places])
        followed, weights = _padded([place.followed for place in self._places])
        return Contacts(
            node=self._node,
            sites=self._sites,
            source=self._source,
            target=self._target,
            reaction=self._state["contact_reaction"],
            adhesion=self._state["contact_adhesion"],
            gap=gap - stand_off,
            normal=normal,
            sources=sources,
            shares=shares,
            followed=followed,
            weights=weights,
            facet=np.array([place.facet for place in self._places], dtype=np.int64),
            area=np.array([place.area for place in self._places]),
            shift=shift,
            velocity=velocity,
            interference=interference,
            gap_error=self._state["contact_gap"] + stand_off - gap,
            normal_error=np.linalg.norm(self._normal - normal, axis=1),
            grain=self._grain(),
            side=self._sides,
        )

    def _grain(self) -> Array:
        """Return the directions that friction depends on, shape [count, D]."""
        grain = np.zeros((len(self._places), self._model.dimension))
        for k, (side, place) in enumerate(zip(self._sides, self._places, strict=True)):
            if side is not None and side.grain is not None:
                stencil = (*place.sources, *place.followed)
                grain[k] = side.grain.on(place.normal, stencil, self._position)
        return grain


class _Stored(NamedTuple):
    """The facets that are stored of a contact; under smooth targets these are parts of one."""

    facets: Indices
    smooth: bool


def _around(facets: Indices, node: int) -> Indices:
    """Return the facets around a node and those that share a node with one of these."""
    around = np.unique(facets[(facets == node).any(axis=1)])
    near: Indices = np.flatnonzero(np.isin(facets, around).any(axis=1))
    return near


def _padded(stencils: list[list[tuple[int, float]]]) -> tuple[Indices, Array]:
    """Return nodes and weights as arrays, shape [count, n], with zero weights at the end."""
    width = max((len(stencil) for stencil in stencils), default=1)
    nodes = np.zeros((len(stencils), max(width, 1)), dtype=np.int64)
    weights = np.zeros(nodes.shape)
    for k, stencil in enumerate(stencils):
        for j, (node, weight) in enumerate(stencil):
            nodes[k, j], weights[k, j] = node, weight
    return nodes, weights
