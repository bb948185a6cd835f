"""A case and its mesh as the auditor sees them, built from the files alone."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property, partial
from types import MappingProxyType

import numpy as np

from carom.auditing.arrays import Array, Indices
from carom.auditing.bodies.body import AuditBody
from carom.auditing.bodies.code import Code
from carom.auditing.bodies.foreign import ForeignBody
from carom.auditing.bodies.mass import NoMassInsideError
from carom.auditing.bodies.places import Attached
from carom.auditing.contact.interference import Interference
from carom.auditing.contact.obstacles import AuditObstacle, Cornered, Round, obstacle_of
from carom.auditing.contact.overlaps import corners_in, crossed, nodes_in, round_in
from carom.auditing.contact.pairs import ALIKE, Pairs, Side, build_sides
from carom.auditing.drives.loads import Loads
from carom.auditing.drives.springs import AuditSpring, build_spring
from carom.auditing.drives.supports import Supports
from carom.auditing.targets.covering import Covering
from carom.auditing.targets.curve import Curve
from carom.auditing.targets.feet import Target
from carom.auditing.targets.gregory import GregoryPatches
from carom.auditing.targets.sheet import FlatPatches, Sheet
from carom.case.analysis import Conserving, Static, Theta
from carom.case.body import Body, DescribedBody, ReducedBody, RigidBody
from carom.case.foreign_body import ForeignEntry
from carom.case.full_stage import FullStage
from carom.case.scenario import Scenario
from carom.errors import InputError

CONDITIONS = ("gap", "midpoint", "endpoint", "massless")


@dataclass(frozen=True)
class Begun:
    """Where a run began.

    Parameters
    ----------
    displacement
        Of all nodes [m], shape [node_count, D].
    time
        When [s].
    """

    displacement: Array
    time: float


class AuditModel:
    """Bodies, obstacles, pairs and the time scheme.

    Parameters
    ----------
    scenario
        The case as it was run.
    stage
        The analysis of it: all that holds in one stage.
    points
        Reference positions of all nodes [m], shape [node_count, D].
    cells
        Nodes of each cell, by body.
    types
        VTK's types of the cells, by body.
    touching_themselves
        Names of the bodies that have touched themselves.
    codes
        What other codes say of their bodies, by name: of all that the case has.

    Raises
    ------
    InputError
        The auditor does not know something of the case, or the mesh is not that of the case.
    """

    def __init__(
        self,
        scenario: Scenario,
        stage: FullStage,
        points: Array,
        cells: list[Indices],
        types: list[Indices],
        *,
        touching_themselves: Collection[str] = (),
        codes: Mapping[str, Code] = MappingProxyType({}),
    ) -> None:
        self.scenario, self.stage = scenario, stage
        self.dimension = scenario.dimension
        """2 in the plane, 3 in space."""
        self._pairs = Pairs(scenario, stage, touching_themselves)
        self.analysis, self.contact = stage.analysis, stage.contact
        self.points = points
        condition = self.contact.condition
        if condition not in CONDITIONS:
            raise InputError(f"cannot audit the contact condition {condition!r} yet")
        written = [condition]
        if not stage.is_dynamic:
            # Load steps have the weight where steps in time of other stages have it.
            written += [one.contact.condition for one in scenario.full_stages()]
        self.massless = "massless" in written
        self._read_scheme()
        given = self.analysis.gravity
        self.gravity = np.zeros(self.dimension) if given is None else np.array(given)
        self.bodies = list(self._build_bodies(cells, types, codes))
        if self.static:
            for body in self.bodies:
                body.weigh_all_nodes()
        light = [len(body.massless) > 0 for body in self.bodies]
        self.massless = any(light)
        """Whether there are nodes without mass."""
        self.mixed = self.massless and not all(light)
        """Whether some bodies keep their mass where others have none."""
        # What has mass on both sides is ruled by its motion.
        self.condition = "midpoint" if condition == "massless" and not self.massless else condition
        self.blended = self.conserving and self.massless
        self.smooth = self.contact.targets == "smooth"
        """Whether targets are smooth curves."""
        self.targets = [_target(b, smooth=self.smooth) for b in self.bodies]
        self.obstacles = [obstacle_of(one, self.dimension) for one in scenario.obstacles]
        impacts = self.condition == "endpoint"
        self.sides = list(build_sides(self._pairs, self.bodies, impacts=impacts))
        self.supports = [Supports(body, stage.motions, at_rest=self.static) for body in self.bodies]
        """Those of every body."""
        self.loads = [Loads(body, stage.loads) for body in self.bodies]
        """Those of every body."""
        self.springs = [build_spring(spring, self) for spring in scenario.springs]
        self._coverings: dict[int, Covering] = {}
        self._depths: dict[tuple[int, int], Array] = {}
        self._deepest: dict[tuple[int, int], float] = {}
        self.before: AuditModel | None = None
        """The stage before."""
        self.begun = Begun(np.zeros_like(points), 0.0)
        """Where the run began."""
        self.size = max(_diameter(b.points) for b in self.bodies)

    def _read_scheme(self) -> None:
        """Take what the analysis says of the scheme."""
        self.static = isinstance(self.analysis, Static)
        """Whether there is no inertia: forces balance at the end of each load step."""
        self.stabilised = isinstance(self.analysis, Static) and (
            self.analysis.stabilisation != "none"
        )
        """Whether load steps that find no equilibrium go on with inertia to another."""
        # Where there is no velocity the end of a step has all the weight.
        self.conserving, self.theta, self.xi = False, 1.0, 1.0
        if not isinstance(self.analysis, Static):
            scheme = self.analysis.scheme
            self.conserving = isinstance(scheme, Conserving)
            self.theta, self.xi = 0.5, 0.5
            if isinstance(scheme, Theta):
                self.theta, self.xi = scheme.theta, scheme.xi

    @property
    def known(self) -> list[AuditBody]:
        """Bodies whose law and mass are known: all, unless another code has them for itself."""
        return [body for body in self.bodies if body.known]

    @property
    def whole(self) -> bool:
        """Whether all bodies are known, and so are sums over them."""
        return len(self.known) == len(self.bodies)

    @property
    def faceted(self) -> bool:
        """Whether facets are frozen for a step: those of bodies, or of obstacles with corners."""
        of_bodies = self.contact.targets == "faceted" and len(self.bodies) > 1
        return of_bodies or self.corner_count > 0

    @property
    def corner_count(self) -> int:
        """How many corners obstacles have."""
        shapes = [obstacle.shape for obstacle in self.obstacles]
        return sum(len(shape.corners) for shape in shapes if isinstance(shape, Cornered))

    @property
    def starts_elsewhere(self) -> bool:
        """Whether the contacts that it starts with are not where the starting state is.

        Those of steps that rule the motion are where these have their middle.
        """
        if self.before is not None:
            return self.before.condition not in ("gap", "massless")
        initial = self.scenario.initial
        return initial is not None and initial.result is not None

    @cached_property
    def fastest_obstacle(self) -> float:
        """Largest speed of an obstacle [m/s]."""
        start, step = self.stage.start_time, self.analysis.time_step
        steps = int(np.ceil(self.stage.duration / step - 1e-6))
        times = start + np.arange(steps + 1) * step
        speeds = [
            float(np.linalg.norm(velocity))
            for travel in (obstacle.travel for obstacle in self.obstacles)
            for velocity in map(travel.velocity, times if travel.varies else times[:1])
        ]
        return max(speeds, default=0.0)

    def body_of(self, node: int) -> int:
        """Return the index of the body of a node; the number of bodies if it is of none."""
        mine = (i for i, b in enumerate(self.bodies) if b.span.start <= node < b.span.stop)
        return next(mine, len(self.bodies))

    def name(self, index: int) -> str:
        """Return the name of a body, or of the obstacle −1 − index; no name if there is none."""
        members = self.bodies if index >= 0 else self.scenario.obstacles
        position = index if index >= 0 else -1 - index
        return members[position].name if position < len(members) else ""

    def pairs(self) -> list[tuple[str, str]]:
        """Return the names of all that may touch, two and two, in the order of the case."""
        return self._pairs.names

    def joins_bodies(self, spring: AuditSpring) -> bool:
        """Return whether a spring is between two bodies, and has no resultant."""
        return abs(float(spring.shares.sum())) < ALIKE

    def connected(self, body: AuditBody) -> bool:
        """Return whether springs are attached to a body."""
        first, last = body.span.start, body.span.stop
        return any(bool(np.any((s.nodes >= first) & (s.nodes < last))) for s in self.springs)

    def loaded(self, body: AuditBody) -> bool:
        """Return whether there are loads on a body."""
        return len(self.loads[self.bodies.index(body)]) > 0

    def supported(self, body: AuditBody) -> bool:
        """Return whether a body is held."""
        return len(self.supports[self.bodies.index(body)]) > 0

    def driven(self, body: AuditBody) -> bool:
        """Return whether anything acts on a body but gravity, damping and contact."""
        outer = self.connected(body) or self.loaded(body) or self.supported(body)
        return outer or body.anchored

    @property
    def coheres(self) -> bool:
        """Whether some pair holds together."""
        return any(side.holding is not None for side in self.sides)

    @property
    def rubs_by_law(self) -> bool:
        """Whether friction of some pair remembers what happened before a step."""
        return any(side.law.remembers for side in self.sides)

    def obstacle(self, name: str) -> AuditObstacle:
        """Return an obstacle by name."""
        return self.obstacles[self._pairs.obstacle(name)]

    def interference(self, a: str, b: str) -> Interference:
        """Return by how much the surfaces of two are pushed apart, by their names."""
        return self._pairs.interference(a, b)

    def covering(self, index: int) -> Covering:
        """Return the boundary of a body as mortar rows are integrated over it."""
        if index not in self._coverings:
            body = self.bodies[index]
            self._coverings[index] = Covering(
                body.facets, body.points, self.targets[index], revolution=body.revolution
            )
        return self._coverings[index]

    def most_contacts(self, side: Side) -> int:
        """Return how many nodes of a side may touch, or how many multipliers."""
        if side.mortar:
            return self.covering(side.source).multiplier_count
        return len(self.bodies[side.source].sources)

    def is_round(self, source: int, target: int) -> bool:
        """Return whether both sides are what they are without their meshes: round, or plain."""
        if self.bodies[source].ball is None:
            return False
        if target < 0:
            return not isinstance(self.obstacles[-1 - target].shape, Cornered)
        return self.bodies[target].ball is not None

    def round_gap(
        self, source: int, target: int, position: Array, time: float
    ) -> tuple[float, Array]:
        """Return the gap [m] and the normal, shape [D], of a round body before what has no corners.

        Nodes are at `position` [m], shape [node_count, D], and obstacles as at a time [s].
        """
        body, ball = self.bodies[source], self.bodies[source].ball
        assert ball is not None, "the source is round"
        centre = ball.centre(position[body.span])
        if target < 0:
            gap, normal = self.obstacles[-1 - target].nearest(centre[None], time)
            return float(gap[0]) - ball.radius, normal[0]
        other, theirs = self.bodies[target], self.bodies[target].ball
        assert theirs is not None, "the target is round"
        apart = centre - theirs.centre(position[other.span])
        distance = float(np.linalg.norm(apart))
        normal = apart / distance if distance > 0.0 else np.eye(self.dimension)[0]
        return distance - ball.radius - theirs.radius, normal

    def drawn_depths(self, source: int, target: int) -> Array:
        """Return how deep nodes of a body are in a body or obstacle as drawn [m], [node_count].

        It is zero of what is outside, and of what may not touch.
        """
        if (source, target) not in self._depths:
            body, depths = self.bodies[source], np.zeros(len(self.bodies[source].points))
            x = body.points[body.sources]
            if self.is_round(source, target):
                gaps = np.full(len(x), self.round_gap(source, target, self.points, 0.0)[0])
                depths[body.sources] = np.maximum(-gaps, 0.0)
            elif target >= 0:
                faced = (self.targets[target], self.bodies[target].points)
                depths[body.sources] = nodes_in(body, *faced)
            elif isinstance(shape := self.obstacles[-1 - target].shape, Cornered):
                depths[body.sources] = nodes_in(body, shape.target, shape.corners)
            else:
                gaps = self.obstacles[-1 - target].distance(x, 0.0)
                depths[body.sources] = np.maximum(-gaps, 0.0)
            self._depths[source, target] = depths
        return self._depths[source, target]

    def deepest(self, source: int, target: int) -> float:
        """Return how deep the deepest contact of two is as drawn [m], checked from either side."""
        key = (source, target)
        if key not in self._deepest:
            sides = [s for s in self.sides if {s.source, s.target} == set(key)]
            depths = [float(self.drawn_depths(s.source, s.target).max()) for s in sides]
            depths += [self._between_nodes(s.source, s.target) for s in sides]
            self._deepest[key] = max(depths, default=0.0)
        return self._deepest[key]

    def _between_nodes(self, source: int, target: int) -> float:
        """Return how deep two are as drawn at corners and edges, or facets before the round [m]."""
        body = self.bodies[source]
        if self.is_round(source, target):
            return 0.0
        if target >= 0:
            return crossed(body, self.bodies[target]) if self.dimension == 3 else 0.0
        shape, deepest = self.obstacles[-1 - target].shape, 0.0
        if isinstance(shape, Cornered):
            deepest = corners_in(body, self.targets[source], shape.corners)
            if self.dimension == 3:
                deepest = max(deepest, crossed(body, shape))
        elif isinstance(shape, Round) and self.dimension == 3:
            deepest = round_in(body, shape)
        return deepest

    def tracks(self) -> list[tuple[str, int]]:
        """Return the names of tracked points and the nodes nearest to them."""
        tracks = []
        for track in self.scenario.output.track:
            body = next(b for b in self.bodies if b.name == track.body)
            distance = np.linalg.norm(body.points - np.array(track.point), axis=1)
            tracks.append((track.name, int(distance.argmin()) + body.span.start))
        return tracks

    def _build_bodies(
        self, cells: list[Indices], types: list[Indices], codes: Mapping[str, Code]
    ) -> Iterator[AuditBody]:
        first = 0
        for entry, nodes, own in zip(self.scenario.bodies, cells, types, strict=True):
            last = int(nodes.max()) + 1
            if int(nodes.min()) != first or last > len(self.points):
                raise InputError(f"body {entry.name!r}: the mesh is not numbered body after body")
            if isinstance(entry, ForeignEntry):
                given = (own, nodes - first, self.points[first:last])
                yield ForeignBody(entry, codes[entry.name], cells=given, first_node=first)
                first = last
                continue
            make = partial(
                AuditBody,
                entry,
                self.scenario.materials,
                types=own,
                nodes=nodes - first,
                points=self.points[first:last],
                first_node=first,
                masses=[one for one in self.scenario.masses if one.body == entry.name],
            )
            whole = make(massless=False)
            if not (self.massless and self._spares_mass(entry, whole)):
                yield whole
            else:
                try:
                    yield make(massless=True)
                except NoMassInsideError:
                    yield whole
            first = last
        if first != len(self.points):
            raise InputError(f"the mesh has {len(self.points)} nodes, its bodies have {first}")

    def _spares_mass(self, entry: DescribedBody, body: AuditBody) -> bool:
        """Return whether a body may have no mass where it touches others.

        What is rigid or reduced may not, nor what flows, grows, rubs by a law or holds on to
        others, nor where springs or masses are attached to what may touch.
        """
        if isinstance(entry, RigidBody | ReducedBody) or self._pairs.rubs_by_law(entry.name):
            return False
        if self._pairs.holds(entry.name):
            return False
        if body.law.flows or body.growth.acts:
            return False
        attached: list[Attached] = [*self.scenario.masses]
        attached += [end for spring in self.scenario.springs for end in spring.between]
        places = [body.places(at) for at in attached if at.body == entry.name]
        nodes = [place.nodes for several in places for place in several]
        touched = np.isin(np.concatenate([[-1], *nodes]), body.surface)
        is_named = isinstance(entry, Body) and entry.self_contact is True
        return (is_named or self._pairs.may_touch_others(entry.name)) and not touched.any()

    @property
    def impacts(self) -> bool:
        """Whether friction of some pair acts against the velocity at the end of a step.

        Its work is that of the motion of the step, which may be of either sign.
        """
        return any(side.restitution is not None for side in self.sides)

    @property
    def gives_back(self) -> bool:
        """Whether friction of a step may give energy back.

        So it may without mass, against velocities at the end of a step, where landing takes of a
        reaction and of its friction, and where bonds slide by as much as iterations leave.
        """
        bonds = any(side.holding is not None and side.holding.unbreakable for side in self.sides)
        return self.massless or self.impacts or bonds or self.condition == "midpoint"

    @property
    def jolts(self) -> bool:
        """Whether impulses change velocities: of landing, or settling of bodies that are damped."""
        damped = any(body.law.damped for body in self.bodies)
        jolted = self.condition == "midpoint" or self.mixed or (damped and not self.massless)
        return jolted and not self.static


def _target(body: AuditBody, *, smooth: bool) -> Target:
    if body.dimension == 2:
        return Curve(body.facets, body.points, smooth=smooth)
    return Sheet(GregoryPatches(body.facets, body.points) if smooth else FlatPatches(body.facets))


def _diameter(points: Array) -> float:
    """Return the diameter of the smallest ball around the mean of all points [m]."""
    return 2.0 * float(np.linalg.norm(points - points.mean(axis=0), axis=1).max())
