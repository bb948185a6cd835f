"""The stored contacts of a state, found again by the auditor's own closest points."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from carom.auditing.arrays import Array, Indices
from carom.auditing.contact.crossings import crossings, drawn_depths
from carom.auditing.contact.edges import edges
from carom.auditing.contact.obstacles import Cornered
from carom.auditing.contact.rounding import nearest_places
from carom.auditing.model import AuditModel
from carom.auditing.steps.between import Fit, between_nodes
from carom.auditing.steps.bonds import carried
from carom.auditing.steps.choosing import goes_on, settle
from carom.auditing.steps.contacts import (
    AT_EDGES,
    AT_MULTIPLIER,
    BEFORE_ROUND,
    BETWEEN_NODES,
    Contacts,
)
from carom.auditing.steps.cornered import ON_END, at_corners, at_edges, on_obstacle
from carom.auditing.steps.multipliers import at_multipliers
from carom.auditing.steps.place import Place
from carom.auditing.targets.feet import BEYOND, Feet

SAME = 1e-7
"""Feet whose gap [model size] and normal differ by no more are equally good: at edges of facets."""

NOT_AT_NODE = 1e-5
"""Contacts whose node has no foot as near to what is stored as this are not at a node."""


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
    found = _Finder(model, state, (position, time), step, like).found()
    bonds = found.bonds
    if not bonds.any():
        return found
    # What nothing breaks is where it was closed at the start of the run, for ever.
    begun = model.begun
    start = (model.points + begun.displacement, begun.time)
    tied = _Finder(model, state, start, (begun.time, begun.time + 1.0), None).found()
    return found.placed(~bonds, carried(model, tied, start, (position, time), found))


class _Finder:
    def __init__(
        self,
        model: AuditModel,
        state: Mapping[str, Any],
        at: tuple[Array, float],
        step: tuple[float, float],
        like: Contacts | None,
    ) -> None:
        position, time = at
        self._model, self._position, self._time, self._like = model, position, time, like
        self._state = state
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
        self._alike: dict[int, list[Place]] = {}
        """Feet of a contact that are as good as one another."""

    def _pushed_apart(self, contact: int, depth: Array | float | None) -> Array:
        """Return the interference at both ends of the step [m] of a contact as deep, [2, ...].

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

    def found(self) -> Contacts:
        """Return the contacts."""
        mortar = np.array([side is not None and side.mortar for side in self._sides], dtype=bool)
        for t in np.unique(self._target):
            at = np.flatnonzero(self._target == t)
            round_ones = np.array([self._is_round(int(k)) for k in at], dtype=bool)
            for contact in at[round_ones]:
                self._of_ball(int(contact))
            at = at[~round_ones]
            if t >= 0 and t < len(self._model.bodies):
                for contact in at[mortar[at]]:
                    self._under_multipliers(int(t), int(contact))
                if not mortar[at].all():
                    self._before_body(int(t), at[~mortar[at]])
            elif t < 0 and -1 - t < len(self._model.obstacles):
                self._before_obstacle(int(-1 - t), at)
        if self._like is None:
            settle(self._state, self._places, self._alike, self._other_places)
        return self._gathered()

    def _is_round(self, contact: int) -> bool:
        """Return whether a contact is of a round body with what has no corners."""
        source, target = int(self._source[contact]), int(self._target[contact])
        bodies, obstacles = self._model.bodies, self._model.obstacles
        known = source < len(bodies) and -len(obstacles) <= target < len(bodies)
        return known and self._model.is_round(source, target)

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

    def _misfit(
        self, contact: int, gap: Array, normal: Array, depth: Array | float | None = None
    ) -> Array:
        """Return how far gaps and normals are from what is stored, in sizes of the model.

        Gaps are stored as the law sees them.
        """
        apart = np.linalg.norm(self._normal[contact] - normal, axis=-1)
        start, end = self._pushed_apart(contact, depth)
        pushed = (1.0 - self._part) * start + self._part * end
        stored = self._state["contact_gap"][contact] + pushed
        misfit: Array = np.abs(gap - stored) / self._model.size + apart
        return misfit

    def _before_obstacle(self, number: int, at: Indices) -> None:
        obstacle = self._model.obstacles[number]
        if isinstance(obstacle.shape, Cornered):
            self._before_cornered(number, obstacle.shape, at)
            return
        gaps, normals = obstacle.nearest(self._position[self._node[at]], self._time)
        for k, contact in enumerate(at):
            misfit = float(self._misfit(contact, gaps[k], normals[k]))
            own = self._places[contact].sources
            self._places[contact] = Place(float(gaps[k]), normals[k], misfit, sources=own)
            if self._may_be(BEFORE_ROUND, contact):
                self._before_round(number, int(contact))

    def _before_cornered(self, number: int, shape: Cornered, at: Indices) -> None:
        """Look for feet of nodes on an obstacle with corners, of its corners on bodies, and edges.

        Facets of the obstacle are to a body what those of another are.
        """
        shift = self._model.obstacles[number].travel.displacement(self._time)
        for contact in map(int, at):
            node = int(self._node[contact])
            places = self._fitted(contact, on_obstacle(shape, shift, node, self._position))
            fits = any(place.misfit <= NOT_AT_NODE and not place.clamped for place in places)
            if self._like is not None or not fits:
                places += self._at_its_corners(number, contact)
            if self._like is not None and places:
                places = [self._nearest_to_known(places, contact)]
            if not places:
                continue
            least = min(place.misfit for place in places)
            alike = [place for place in places if place.misfit <= least + SAME]
            alike.sort(key=lambda place: place.clamped)
            self._places[contact] = alike[0]
            if len(alike) > 1:
                self._alike[contact] = alike

    def _at_its_corners(self, number: int, contact: int) -> list[Place]:
        """Return where corners and edges of an obstacle are on facets and edges of the source."""
        obstacle, source = self._model.obstacles[number], int(self._source[contact])
        if source >= len(self._model.bodies) or not isinstance(obstacle.shape, Cornered):
            return []
        shape, shift = obstacle.shape, obstacle.travel.displacement(self._time)
        body, target = self._model.bodies[source], self._model.targets[source]
        places = at_corners(shape, shift, body, target, self._position)
        if self._model.dimension == 3:
            node, towards = int(self._node[contact]), self._normal[contact]
            places += at_edges(shape, shift, (body, node), self._position, towards)
        if self._like is None:
            # What is stored of a contact names the node that takes most of it.
            places = [place for place in places if place.named_by(int(self._node[contact]))]
        return self._fitted(contact, places)

    def _fitted(self, contact: int, places: list[Place]) -> list[Place]:
        """Return places with how far they are from what is stored of a contact."""
        return [
            replace(
                place,
                misfit=float(self._misfit(contact, np.array(place.gap), place.normal, place.depth)),
            )
            for place in places
        ]

    def _nearest_to_known(self, places: list[Place], contact: int) -> Place:
        """Return which of the places goes on from the contact that it is like."""
        assert self._like is not None, "something is known"
        site, facet = int(self._like.site[contact]), int(self._like.facet[contact])
        own = [p for p in places if p.site == site and p.facet == facet] or places
        known = (self._like.sources[contact], self._like.shares[contact])
        # Of edges and corners on the same facet the one whose nodes are most alike.
        apart = [(round(place.apart(*known), 6), place.misfit) for place in own]
        return own[apart.index(min(apart))]

    def _may_be(self, site: int, contact: int) -> bool:
        """Return whether a contact may be something else than at its node."""
        if self._like is not None:
            return int(self._like.site[contact]) == site
        place = self._places[contact]
        # Along a straight edge on what is nearly flat, gaps and normals change little.
        least = SAME if site == BETWEEN_NODES else NOT_AT_NODE
        return place.clamped or not place.misfit <= least

    def _before_round(self, number: int, contact: int) -> None:
        """Look for the facet or edge around the node that is before something round."""
        source = self._source[contact]
        if source >= len(self._model.bodies) or self._model.dimension == 2:
            return
        body = self._model.bodies[source]
        own = int(self._node[contact]) - body.span.start
        shift = self._model.obstacles[number].travel.displacement(self._time)
        known = None if self._like is None else self._like.sources[contact] - body.span.start
        shape = self._model.obstacles[number].shape
        for place in nearest_places(shape, body, own, self._position[body.span] - shift, known):
            depth = None
            if self._resolves[contact]:
                drawn = nearest_places(shape, body, own, body.points, place.nodes)
                depth = max(-min(one.gap for one in drawn), 0.0)
            misfit = float(self._misfit(contact, np.array(place.gap), place.normal, depth))
            if misfit < self._places[contact].misfit or known is not None:
                nodes = [(int(n) + body.span.start, w) for n, w in place.stencil]
                self._places[contact] = Place(
                    place.gap, place.normal, misfit, BEFORE_ROUND, sources=nodes, depth=depth
                )

    def _under_multipliers(self, number: int, contact: int) -> None:
        """Place a contact of a mortar pair under a multiplier, or where edges cross."""
        source = int(self._source[contact])
        if (source, number) not in self._multipliers:
            places = at_multipliers(self._model, source, number, self._position)
            self._multipliers[source, number] = places
        own = [p for p in self._multipliers[source, number] if p.node == self._node[contact]]
        if self._like is not None:
            fan = int(self._like.facet[contact])
            own = [place for place in own if place.facet == fan]
        places = self._fitted(contact, own)
        if places and (self._like is None or self._like.site[contact] == AT_MULTIPLIER):
            self._places[contact] = min(places, key=lambda place: place.misfit)
        if self._model.dimension == 3 and self._may_be(AT_EDGES, contact):
            crossed = self._at_edges(number, contact)
            if crossed:
                self._places[contact], self._alike[contact] = crossed[0], crossed

    def _before_body(self, number: int, at: Indices) -> None:
        model, target = self._model, self._model.targets[number]
        span = model.bodies[number].span
        feet = target.feet(self._position[self._node[at]], self._position[span])
        for k, contact in enumerate(at):
            mine = np.flatnonzero(feet.point == k)
            if int(self._source[contact]) == number:
                own = int(self._node[contact]) - span.start
                mine = mine[~np.isin(feet.facet[mine], _around(target.facets, own))]
            if len(mine):
                self._at_node(feet, mine, int(contact), number)
            if model.dimension == 3 and self._may_be(AT_EDGES, contact):
                crossed = self._at_edges(number, int(contact))
                if crossed:
                    self._places[contact], self._alike[int(contact)] = crossed[0], crossed
            if model.dimension == 3 and self._may_be(BETWEEN_NODES, contact):
                self._between_nodes(number, int(contact))

    def _at_node(self, feet: Feet, mine: Indices, contact: int, number: int) -> None:
        misfit = self._misfit(contact, feet.gap[mine], feet.normal[mine])
        alike_ones = misfit <= misfit.min() + SAME
        good = mine[alike_ones]
        # At a node that two facets share, the one whose normal it is.
        good = good[np.lexsort((misfit[alike_ones], feet.beyond[good]))]
        if self._like is not None:
            near = (int(self._like.facet[contact]), self._like.normal[contact])
            target = self._model.targets[number]
            good = np.array([goes_on(feet, mine, near, target, otherwise=int(good[0]))])
        first = self._model.bodies[number].span.start
        alike = [
            Place(
                gap=float(feet.gap[foot]),
                normal=feet.normal[foot],
                misfit=float(misfit.min()),
                facet=int(feet.facet[foot]),
                clamped=bool(feet.beyond[foot] >= BEYOND - ON_END),
                sources=self._places[contact].sources,
                followed=[
                    (int(node) + first, float(weight))
                    for node, weight in zip(feet.nodes[foot], feet.weights[foot], strict=True)
                ],
            )
            for foot in good
        ]
        self._places[contact] = alike[0]
        if len(alike) > 1:
            self._alike[contact] = alike

    def _between_nodes(self, number: int, contact: int) -> None:
        """Look for the point of an edge around the node that is before a facet of the target."""
        places = self._points_between(number, contact)
        best = min(places, key=lambda place: place.misfit, default=self._places[contact])
        if self._like is not None or best.misfit < self._places[contact].misfit:
            self._places[contact] = best
            self._alike.pop(contact, None)

    def _points_between(self, number: int, contact: int, most: float | None = None) -> list[Place]:
        """Return the places of the points of edges around the node that fit best, or so well."""
        model, source = self._model, int(self._source[contact])
        if source >= len(model.bodies) or source == number or model.dimension == 2:
            return []
        own, known = (source, int(self._node[contact])), self._known(contact)
        fit = Fit(partial(self._misfit, contact), most, bool(self._resolves[contact]))
        return between_nodes(model, own, number, self._position, known, fit=fit)

    def _known(self, contact: int) -> tuple[Indices, Array, int] | None:
        """Return nodes and weights of the source of the contact that one is like, and its facet."""
        like = self._like
        if like is None:
            return None
        return like.sources[contact], like.shares[contact], int(like.facet[contact])

    def _other_places(self, contact: int) -> list[Place]:
        """Return where edges cross, or corners are, that fit a contact as well as its node does."""
        target = int(self._target[contact])
        if self._is_round(contact):
            return []
        if target >= 0:
            most = self._places[contact].misfit + SAME
            points = self._points_between(target, contact, most)
            crossed = self._at_edges(target, contact) if self._model.dimension == 3 else []
            return [*crossed, *points]
        number = -1 - target
        if number >= len(self._model.obstacles):
            return []
        found = self._at_its_corners(number, contact)
        most = self._places[contact].misfit + SAME
        return [place for place in found if place.misfit <= most]

    def _at_edges(self, number: int, contact: int) -> list[Place]:
        """Return where edges around the node cross edges of the target, all that fit best."""
        model, source = self._model, self._source[contact]
        if source >= len(model.bodies) or number >= len(model.bodies):
            return []
        mine, theirs = edges(model.bodies[source]), edges(model.bodies[number])
        if self._like is None:
            mine = mine.at(int(self._node[contact]))
        else:
            mine = mine.between(self._like.sources[contact, :2])
            theirs = theirs.between(self._like.followed[contact, :2])
        found = crossings(self._position, mine, theirs, self._normal[contact])
        if source == number:
            # Edges with a node in common meet there.
            ends = (found.source.ends[:, :, None] == found.target.ends[:, None]).any(axis=(1, 2))
            found = replace(found, gap=np.where(ends, np.inf, found.gap))
        depths: list[float | None] = [None] * len(found.gap)
        misfit = self._misfit(contact, found.gap, found.normal)
        if self._resolves[contact]:
            depths = drawn_depths(model.points, found, (0, 0)).tolist()
            each = zip(found.gap, found.normal, depths, strict=True)
            misfit = np.array([float(self._misfit(contact, *one)) for one in each])
        if not len(misfit) or not misfit.min() < np.inf:
            return []
        if self._like is None and not misfit.min() < self._places[contact].misfit + SAME:
            return []
        # Edges that go on in one line cross at the same place.
        good = np.flatnonzero(misfit <= misfit.min() + SAME)
        good = good[np.argsort(found.beyond[good], kind="stable")]
        places = [
            Place(
                gap=float(found.gap[k]),
                normal=found.normal[k],
                misfit=float(misfit[k]),
                site=AT_EDGES,
                sources=found.source.stencil(int(k), float(found.along[k, 0])),
                followed=found.target.stencil(int(k), float(found.along[k, 1])),
                depth=depths[k],
            )
            for k in good
        ]
        node = int(self._node[contact])
        return [place for place in places if self._like is not None or place.named_by(node)]

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
            site=np.array([place.site for place in self._places], dtype=np.int64),
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
