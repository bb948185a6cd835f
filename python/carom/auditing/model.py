"""A case and its mesh as the auditor sees them, built from the files alone."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np

from carom.auditing.arrays import Array, Indices
from carom.auditing.body import AuditBody
from carom.auditing.mass import NoMassInsideError
from carom.auditing.target import Target
from carom.case.analysis import Conserving, Static, Theta
from carom.case.body import Body, ReducedBody, RigidBody
from carom.case.contact import Pair
from carom.case.friction import FrictionLaw
from carom.case.mesh import Disc, Rectangle
from carom.case.obstacle import Obstacle, Plane
from carom.case.scenario import Scenario
from carom.errors import InputError

CONDITIONS = ("gap", "midpoint", "endpoint", "massless")

ALIKE = 1e-6
"""Facets and masses apart by no more than this part are alike."""


@dataclass(frozen=True)
class Side:
    """Nodes of a body against a body, or against an obstacle.

    Parameters
    ----------
    source
        Index of the body whose nodes are checked.
    target
        Index of a body, or −1 − that of an obstacle.
    friction
        Coulomb's coefficient.
    two_sided
        Whether the pair is checked from the other side too.
    restitution
        Coefficient of restitution of what is rigid where velocities are ruled; None elsewhere.
    massless
        Whether nodes of either body are without mass.
    """

    source: int
    target: int
    friction: float
    two_sided: bool
    restitution: float | None = None
    massless: bool = False


@dataclass(frozen=True)
class AuditPlane:
    """A plane that moves as prescribed.

    Parameters
    ----------
    point
        A point of it at t = 0 [m], shape [2].
    normal
        Unit normal, shape [2].
    velocity
        Velocity [m/s], shape [2].
    """

    point: Array
    normal: Array
    velocity: Array

    def distance(self, x: Array, time: float) -> Array:
        """Return the signed distance of points at a time [s], negative behind it [m]."""
        distance: Array = (x - (self.point + time * self.velocity)) @ self.normal
        return distance


class AuditModel:
    """Bodies, obstacles, pairs and the time scheme.

    Parameters
    ----------
    scenario
        The case as it was run.
    points
        Reference positions of all nodes [m], shape [node_count, 2].
    cells
        Nodes of each cell, by body.
    types
        VTK's type of the cells, by body.

    Raises
    ------
    InputError
        The auditor does not know something of the case, or the mesh is not that of the case.
    """

    def __init__(
        self, scenario: Scenario, points: Array, cells: list[Indices], types: list[int]
    ) -> None:
        if scenario.dimension != 2:
            raise InputError("cannot audit a case in 3D yet")
        for entry in scenario.bodies:
            if not isinstance(entry.mesh, Disc | Rectangle):
                raise InputError(f"cannot audit a mesh of the kind {entry.mesh.kind!r} yet")
        _refuse_what_is_driven(scenario)
        if scenario.analysis is None:
            raise InputError("cannot audit a case with stages yet")
        if scenario.initial is not None:
            raise InputError("cannot audit a case that does not start from bodies as drawn yet")
        self.scenario = scenario
        self.analysis = scenario.analysis
        self.points = points
        condition = scenario.contact.condition
        if condition not in CONDITIONS:
            raise InputError(f"cannot audit the contact condition {condition!r} yet")
        pairs = scenario.contact.pairs
        written = [scenario.contact.discretisation, *(p.discretisation for p in pairs)]
        if "mortar" in written:
            raise InputError("cannot audit mortar contact yet")
        self.massless = condition == "massless"
        if isinstance(self.analysis, Static):
            raise InputError("cannot audit a static analysis yet")
        scheme = self.analysis.scheme
        if not isinstance(scheme, Theta | Conserving):
            raise InputError(f"cannot audit the scheme {scheme.kind!r} yet")
        self.conserving = isinstance(scheme, Conserving)
        self.theta, self.xi = (scheme.theta, scheme.xi) if isinstance(scheme, Theta) else (0.5, 0.5)
        self.gravity = np.array(self.analysis.gravity or (0.0, 0.0))
        self.bodies = list(self._build_bodies(cells, types))
        light = [len(body.massless) > 0 for body in self.bodies]
        self.massless = any(light)
        """Whether there are nodes without mass."""
        self.mixed = self.massless and not all(light)
        """Whether some bodies keep their mass where others have none."""
        # What has mass on both sides is ruled by its motion.
        self.condition = "midpoint" if condition == "massless" and not self.massless else condition
        self.blended = self.conserving and self.massless
        smooth = scenario.contact.targets == "smooth"
        self.targets = [Target(b.facets, b.points, smooth=smooth) for b in self.bodies]
        self.planes = [_plane(obstacle) for obstacle in scenario.obstacles]
        self.sides = list(self._build_sides())
        self.size = max(_diameter(b.points) for b in self.bodies)

    @property
    def fastest_plane(self) -> float:
        """Largest speed of an obstacle [m/s]."""
        return max((float(np.linalg.norm(plane.velocity)) for plane in self.planes), default=0.0)

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
        names = [body.name for body in self.scenario.bodies]
        planes = [obstacle.name for obstacle in self.scenario.obstacles]
        return [
            (first, second)
            for a, first in enumerate(names)
            for second in (*names[a + 1 :], *planes)
            if self._enabled(first, second)
        ]

    def tracks(self) -> list[tuple[str, int]]:
        """Return the names of tracked points and the nodes nearest to them."""
        tracks = []
        for track in self.scenario.output.track:
            body = next(b for b in self.bodies if b.name == track.body)
            distance = np.linalg.norm(body.points - np.array(track.point), axis=1)
            tracks.append((track.name, int(distance.argmin()) + body.span.start))
        return tracks

    def _build_bodies(self, cells: list[Indices], types: list[int]) -> Iterator[AuditBody]:
        first = 0
        for entry, nodes, vtk_type in zip(self.scenario.bodies, cells, types, strict=True):
            last = int(nodes.max()) + 1
            if int(nodes.min()) != first or last > len(self.points):
                raise InputError(f"body {entry.name!r}: the mesh is not numbered body after body")
            make = partial(
                AuditBody,
                entry,
                self.scenario.materials,
                vtk_type=vtk_type,
                nodes=nodes - first,
                points=self.points[first:last],
                first_node=first,
            )
            spares = not isinstance(entry, RigidBody | ReducedBody) and self._may_touch(entry.name)
            try:
                yield make(massless=self.massless and spares)
            except NoMassInsideError:
                yield make(massless=False)
            first = last
        if first != len(self.points):
            raise InputError(f"the mesh has {len(self.points)} nodes, its bodies have {first}")

    def _pair(self, a: str, b: str) -> Pair | None:
        """Return what the case says of a pair by name."""
        entries = self.scenario.contact.pairs
        return next((entry for entry in entries if {a, b} == set(entry.between)), None)

    @property
    def impacts(self) -> bool:
        """Whether friction of some pair acts against the velocity at the end of a step.

        Its work is that of the motion of the step, which may be of either sign.
        """
        return any(side.restitution is not None for side in self.sides)

    def _restitution(self, a: str, b: str) -> float | None:
        """Return that of two by name, if both are rigid and velocities are ruled."""
        soft = {body.name for body in self.bodies if not body.rigid}
        if self.condition != "endpoint" or {a, b} & soft:
            return None
        entry = self._pair(a, b)
        own = None if entry is None else entry.restitution
        return self.scenario.contact.restitution or 0.0 if own is None else own

    @property
    def jolts(self) -> bool:
        """Whether impulses change velocities: of landing, or settling of bodies that are damped."""
        damped = any(body.law.damped for body in self.bodies)
        return self.condition == "midpoint" or self.mixed or (damped and not self.massless)

    def _enabled(self, a: str, b: str) -> bool:
        entry = self._pair(a, b)
        return entry is None or entry.enabled

    def _may_touch(self, name: str) -> bool:
        others = [body.name for body in self.scenario.bodies if body.name != name]
        others += [obstacle.name for obstacle in self.scenario.obstacles]
        return any(self._enabled(name, other) for other in others)

    def _build_sides(self) -> Iterator[Side]:
        contact = self.scenario.contact
        usual = _coefficient(contact.friction)
        names = [body.name for body in self.bodies]
        for a, first in enumerate(names):
            others = [(b, names[b]) for b in range(a + 1, len(names))]
            others += [(-1 - o, plane.name) for o, plane in enumerate(self.scenario.obstacles)]
            for b, second in others:
                entry = self._pair(first, second)
                sources, swapped = contact.sources, False
                coefficient = usual
                if entry is not None:
                    if not entry.enabled:
                        continue
                    if entry.friction is not None:
                        coefficient = _coefficient(entry.friction)
                    if entry.sources is not None:
                        sources, swapped = entry.sources, entry.between[0] == second
                bounce = self._restitution(first, second)
                met = [self.bodies[index] for index in (a, b) if index >= 0]
                make = partial(
                    Side,
                    friction=coefficient,
                    restitution=bounce,
                    massless=any(len(body.massless) > 0 for body in met),
                )
                if b < 0:
                    yield make(a, b, two_sided=False)
                    continue
                # The auditor has no mortar rows, of which one side has the multipliers.
                sources = sources or "both"
                if sources == "finer":
                    sources = "second" if self._is_finer(b, a) else "first"
                    swapped = False
                forward, backward = sources in ("first", "both"), sources in ("second", "both")
                if swapped:
                    forward, backward = backward, forward
                both = forward and backward
                if forward:
                    yield make(a, b, two_sided=both)
                if backward:
                    yield make(b, a, two_sided=both)

    def _is_finer(self, body: int, other: int) -> bool:
        wide, wide_other = self._mean_facet(body), self._mean_facet(other)
        if abs(wide - wide_other) > ALIKE * max(wide, wide_other):
            return wide < wide_other
        mass, mass_other = (self.bodies[b].mass.total for b in (body, other))
        return bool(mass < (1 - ALIKE) * mass_other)

    def _mean_facet(self, body: int) -> float:
        points, facets = self.bodies[body].points, self.bodies[body].facets
        lengths = np.linalg.norm(points[facets[:, 1]] - points[facets[:, 0]], axis=1)
        return float(lengths.mean())


def _diameter(points: Array) -> float:
    """Return the diameter of the smallest ball around the mean of all points [m]."""
    return 2.0 * float(np.linalg.norm(points - points.mean(axis=0), axis=1).max())


def _plane(entry: Obstacle) -> AuditPlane:
    if not isinstance(entry, Plane):
        raise InputError(f"cannot audit obstacles of kind {entry.kind!r} yet")
    normal = np.array(entry.normal)
    return AuditPlane(
        point=np.array(entry.point),
        normal=normal / np.linalg.norm(normal),
        velocity=np.array(entry.velocity or (0.0, 0.0)),
    )


def _coefficient(friction: float | FrictionLaw) -> float:
    if isinstance(friction, FrictionLaw):
        raise InputError("cannot audit friction that depends on the motion yet")
    return friction


def _refuse_what_is_driven(scenario: Scenario) -> None:
    """Refuse what the auditor has no second implementation of."""
    moving = any(obstacle.motion is not None for obstacle in scenario.obstacles)
    for given, what in ((scenario.loads, "loads"), (scenario.motions, "motions")):
        if given:
            raise InputError(f"cannot audit a case with {what} yet")
    if scenario.masses:
        raise InputError("cannot audit a case with masses at points yet")
    if scenario.springs:
        raise InputError("cannot audit a case with springs yet")
    if moving:
        raise InputError("cannot audit an obstacle with a motion yet")
    if any(pair.interference is not None for pair in scenario.contact.pairs):
        raise InputError("cannot audit a pair with an interference yet")
    if scenario.output.audit and any(body.kind == "reduced" for body in scenario.bodies):
        raise InputError("cannot audit the steps of a reduced body yet, as with output.audit")
    if any(isinstance(body, Body) and body.growth is not None for body in scenario.bodies):
        raise InputError("cannot audit a body that grows yet")
