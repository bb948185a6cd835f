"""Loads as the auditor sees them: forces on nodes as functions of time, and of place."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from carom.auditing.arrays import Array, Indices, solved, turned
from carom.auditing.bodies.body import AuditBody
from carom.auditing.functions.signals import AuditSignal
from carom.auditing.mesh.drawn import nodes_of
from carom.case.full_stage import Given
from carom.case.load import Force, Load, Pressure, Resultant, Traction
from carom.case.motion import Motion

Value = Callable[[AuditSignal], float]
"""What counts of a signal."""


class Loads:
    """The loads of a body.

    Parameters
    ----------
    body
        The body.
    given
        What acts, on all bodies.
    """

    def __init__(self, body: AuditBody, given: Sequence[Given]) -> None:
        self._body = body
        self._loads = [_Load(body, one.what) for one in given if one.what.body == body.name]

    def __len__(self) -> int:
        return len(self._loads)

    def at(self, time: float, u: Array) -> Array:
        """Return the forces on nodes [N] at a time [s] and displacements [m], [node_count, D]."""
        return self._sum(lambda signal: signal.at(time)[0], u)

    def mean(
        self, times: tuple[float, float], share: float, u: Array, middle: Array | None = None
    ) -> Array:
        """Return the same with values between those at two times, by the share of the second.

        Moments act by arms half way, with displacements `middle` [m]; `u` if not given.
        """

        def weighted(signal: AuditSignal) -> float:
            start, end = (signal.at(time)[0] for time in times)
            return (1.0 - share) * start + share * end

        return self._sum(weighted, u, middle)

    def _sum(self, value: Value, u: Array, middle: Array | None = None) -> Array:
        force = np.zeros_like(self._body.points)
        for load in self._loads:
            load.add(value, u, force)
            load.turn(value, u if middle is None else middle, force)
        return force


class _Load:
    """One load: the same vector on nodes or along the facets of a set, or a force and a moment."""

    def __init__(self, body: AuditBody, given: Load | Motion) -> None:
        self._body = body
        mesh, outline = body.drawn, body.boundary
        self._facets: Indices = outline[:0]
        self._nodes: Indices = np.zeros(0, dtype=np.int64)
        self._follows = False
        self._shares: Array = np.zeros(0)
        self._moment: list[AuditSignal] = []
        if isinstance(given, Force):
            self._nodes = nodes_of(mesh, given.on, body.points, outline, body.cells.nodes)
            self._vector = [AuditSignal(signal) for signal in given.force]
        elif isinstance(given, Resultant):
            place = body.centre_of_force(given.point)
            self._nodes, self._shares = place.nodes, place.shares
            zero = (0.0,) * body.dimension
            self._vector = [AuditSignal(signal) for signal in given.force or zero]
            moment = given.moment if isinstance(given.moment, tuple) else (given.moment,)
            self._moment = [AuditSignal(signal) for signal in moment]
        else:
            assert isinstance(given, Traction | Pressure), "there are no other loads"
            self._facets = outline[body.named(outline, (given.on,))]
            signals = given.traction if isinstance(given, Traction) else (given.pressure,)
            self._vector = [AuditSignal(signal) for signal in signals]
            self._follows = isinstance(given, Pressure) and given.follower

    def add(self, value: Value, u: Array, force: Array) -> None:
        """Add its forces to those on the nodes [N]."""
        size = np.array([value(signal) for signal in self._vector])
        shares = self._shares[:, None] if len(self._shares) else 1.0
        np.add.at(force, self._nodes, shares * size)
        if not len(self._facets):
            return
        faces = self._body.faces(self._facets)
        position = self._body.points + u if self._follows else self._body.points
        if len(size) == 1:
            of_facets = faces.pushed(position, float(size[0]))
        else:
            of_facets = faces.spread(position, size)
        np.add.at(force, self._facets, of_facets)

    def turn(self, value: Value, u: Array, force: Array) -> None:
        """Add forces on nodes with its moment, by arms at displacements [m], and no sum [N]."""
        if not any(value(signal) for signal in self._moment):
            return
        moment = np.array([value(signal) for signal in self._moment])
        arms = self._body.arms(u)
        spin = solved(self._body.nodal_inertia(arms), moment)
        force += self._body.mass.nodal[:, None] * turned(arms, spin)
