"""How far a number may be from what the auditor computes, from the tolerances of the run itself.

There are two reasons for differences. Sums of floating-point numbers in another order differ by
round-off of their largest terms. And the run stops its iterations: the displacements of a step are
known up to Newton's tolerance times the largest motion in the step. What must vanish in the step
may be as large as that error times what it depends on.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from carom.auditing.arrays import Array, components
from carom.auditing.bodies.body import AuditBody
from carom.auditing.model import AuditModel
from carom.auditing.steps.step import Step

EPS = float(np.finfo(np.float64).eps)

ROUND_OFF = 2.0**13 * EPS
"""Relative difference of two sums over a mesh, of their largest terms: 1.8e-12."""

FLOOR = 4 * EPS
"""Corrections below this part of the model's size are round-off to the run."""

READ = 1e-10
"""The same of energies of reduced bodies, whose amplitudes steps read from places of nodes."""

SAFETY = 10.0
"""The last correction of a run bounds its error only up to the rate of convergence."""

LAST = 1e2
"""Contacts are evaluated before the last correction, which is above Newton's tolerance by up to
this where iterations converge so fast that the next one would be below it."""


class Scales:
    """Magnitudes of a model over its states, and tolerances made of them.

    Parameters
    ----------
    model
        The model.
    """

    def __init__(self, model: AuditModel) -> None:
        self._model = model
        self._iterations: dict[tuple[float, int], Array] = {}
        self.speed = model.fastest_obstacle
        """Largest speed of a node, or of an obstacle [m/s]."""
        self.reach = model.fastest_obstacle * model.stage.duration
        """Largest distance of a node from the origin, or of an obstacle from its start [m]."""
        analysis = model.analysis
        travel = model.fastest_obstacle * analysis.end_time
        self.travel = EPS * travel * model.stage.duration / analysis.time_step
        """How far places of obstacles may be off, which the run sums step by step [m]."""
        self.moved = 0.0
        """Largest displacement of a node [m]."""
        self.masses = np.array([body.mass.total if body.known else 0.0 for body in model.bodies])
        """Masses of the bodies [kg]; of those whose code is not there what `believe` finds."""
        self.mass = float(self.masses.sum())
        reduced = any(body.modes is not None for body in model.bodies)
        self.sums = READ if reduced else ROUND_OFF
        """Relative difference of two energies, of the largest one."""
        weight = self.mass * float(np.linalg.norm(model.gravity))
        self.certified = 0.0
        """How far all steps together may be from the laws of contact [J], by what the run says."""
        self.prevented = 0.0
        """How far reactions keep rigid bodies from moving in a load step [m]."""
        # Where nothing ever moves, round-off of places does work on weights.
        self.energy = EPS * model.size * weight
        """Largest energy of a state [J]."""

    def share(self, others: Sequence[Scales]) -> None:
        """Take the largest magnitudes of the stages of a run."""
        for name in ("energy", "speed", "reach", "moved"):
            setattr(self, name, max(getattr(one, name) for one in (self, *others)))

    def certify(self, certified: float, reference: float, force: float) -> None:
        """Take note of how exactly contact problems were solved.

        Parameters
        ----------
        certified
            Sum of the certificates of all steps [J].
        reference
            Largest energy of the run, or work of a step's reactions over what they prevent [J].
        force
            Largest sum of normal reactions [N].
        """
        self.certified = certified
        if self._model.static and force > 0 and any(body.rigid for body in self._model.bodies):
            self.prevented = reference / force

    def believe(self, history: Mapping[str, Array]) -> None:
        """Take from the history how large energies are, and how heavy bodies that are not known.

        These are magnitudes alone: a body of m has ½ m v² of translation.
        """
        if not self._model.whole:
            self.energy = max(self.energy, float(history["total"].max()))
        for index, body in enumerate(self._model.bodies):
            if body.known:
                continue
            drift = [history[f"{body.name}.{v}"] for v in components("v", body.dimension)]
            squares = np.square(drift).sum(axis=0)
            fastest = int(squares.argmax())
            translation = float(history[f"{body.name}.translation"][fastest])
            if squares[fastest] > 0.0:
                self.masses[index] = 2.0 * translation / float(squares[fastest])

    def include(self, displacement: Array, velocity: Array, time: float) -> None:
        """Take a state at a time [s] into account."""
        energy = sum(spring.energy(displacement, time) for spring in self._model.springs)
        for body in self._model.known:
            energy += body.kinetic_energy(displacement[body.span], velocity[body.span])
            energy += abs(body.strain_energy(displacement[body.span], body.growth.at(time)))
        self.energy = max(self.energy, energy)
        self.speed = max(self.speed, float(np.abs(velocity).max()))
        self.moved = max(self.moved, float(np.abs(displacement).max()))
        self.reach = max(self.reach, float(np.abs(self._model.points + displacement).max()))

    def penetration(self) -> float:
        """Return how deep nodes may be where gaps are ruled [m]."""
        analysis = self._model.analysis
        motion = self.moved if self._model.static else self.speed * analysis.time_step
        if self._model.faceted:
            # Facets are frozen for a step: a node that slides on may get behind the next one.
            return motion
        floor = FLOOR * self._model.size
        # Rigid bodies have no stiffness: contact problems of load steps are about what their
        # reactions prevent, which is more than anything moves.
        solved = self._model.contact.solver.tolerance * self.prevented
        return SAFETY * max(analysis.newton.tolerance * motion, floor, solved) + self.travel

    def strain(self, body: AuditBody, u: Array, time: float) -> float:
        """Return how far the strain energy of a state at a time [s] may be off [J]."""
        energy = body.strain_energy(u, body.growth.at(time))
        return ROUND_OFF * abs(energy) + self._round_off(body, u, energy)

    def _round_off(self, body: AuditBody, u: Array, energy: float) -> float:
        """Return what round-off of displacements makes of a strain energy [J].

        It is of their size, and does work on the internal forces.
        """
        error = EPS * (self._model.size + float(np.abs(u).max()))
        slope = body.slope(u, energy) + float(body.row_stiffness.sum()) * error
        return SAFETY * slope * error

    def displacement(self, step: Step) -> float:
        """Return how far the displacements of a step may be off [m]."""
        motion = step.motion
        if self._model.static:
            # Iterations of load steps end at what is small beside all that has moved.
            motion = max(motion, float(np.abs(step.u0).max()))
        tolerance = self._model.analysis.newton.tolerance * motion
        return SAFETY * max(tolerance, FLOOR * (self._model.size + self.reach))

    def displacement_in(self, dt: Array) -> Array:
        """Return how far displacements of steps of these lengths [s] may be off [m]."""
        motion = (self.speed + float(np.linalg.norm(self._model.gravity)) * dt) * dt
        tolerance = self._model.analysis.newton.tolerance * motion
        return SAFETY * np.maximum(tolerance, FLOOR * (self._model.size + self.reach))

    def geometry(self, step: Step) -> float:
        """Return how far the places of contacts may be off [m]."""
        return LAST * self.displacement(step) + self.travel

    def force(self, step: Step, index: int) -> Array:
        """Return how far the equation of motion of nodes of a body may be off [N], [node_count]."""
        off = self.iteration(step.dt, index) * self.displacement(step)
        body = self._model.bodies[index]
        if not (self._model.conserving and body.divides):
            return off
        ends = [(u[body.span], time) for u, time in step.ends]
        energies = [(u, body.strain_energy(u, body.growth.at(time))) for u, time in ends]
        energy = sum(SAFETY * EPS * abs(e) + self._round_off(body, u, e) for u, e in energies)
        return off + body.doubt(ends[0][0], ends[1][0], energy)

    def resisted(self, step: Step, index: int) -> float:
        """Return how far the work of what resists a body, and of what holds it, may be off [J].

        Displacements have round-off of the size of the model, over which these forces do work.
        """
        f, held = step.forces.of[index], self._model.supports[index].held
        parts = (f.inertia, f.internal, f.gravity, f.loads, f.connections)
        size = float(np.abs(f.viscous).sum())
        size += sum(float(np.abs(part[held]).sum()) for part in parts)
        return SAFETY * EPS * (self._model.size + self.reach) * size

    def reaction(self, step: Step, total: float) -> float:
        """Return how far reactions whose sizes sum to `total` [N] may be from Coulomb's cone [N].

        The solver's residual is relative to the reactions, or to the force that would undo the
        motion of the step where that is larger.
        """
        bodies = range(len(self._model.bodies))
        stiffest = max(float(self.iteration(step.dt, index).max()) for index in bodies)
        tolerance = self._model.contact.solver.tolerance
        return SAFETY * tolerance * (total + stiffest * step.motion)

    def least_reaction(self, dt: float) -> float:
        """Return below what reactions are round-off in a step of this length [N].

        Displacements have round-off of the size of the model, and what resists it makes forces of
        that.
        """
        bodies = range(len(self._model.bodies))
        stiffest = max(float(self.iteration(dt, index).max()) for index in bodies)
        return EPS * (self._model.size + self.reach) * stiffest

    def iteration(self, dt: float, index: int) -> Array:
        """Return the force on nodes where all displacements are off by 1 m [N/m], [node_count]."""
        key = (dt, index)
        if key not in self._iterations:
            self._iterations[key] = self._iteration(dt, index)
        return self._iterations[key]

    def _iteration(self, dt: float, index: int) -> Array:
        body, model = self._model.bodies[index], self._model
        rate = 0.0 if model.static else 1 / (model.theta * dt)
        if not body.known:
            # Its inertia, as if all of it were at every node.
            return np.full(len(body.points), float(self.masses[index]) * rate / dt)
        if model.static and body.rigid:
            # Nothing resists it but what it touches.
            stiffest = max(float(other.row_stiffness.max()) for other in model.bodies)
            return np.full(len(body.points), stiffest)
        resisted: Array = body.row_stiffness * (
            1.0 + (body.law.stiffness_damping.max() + body.law.sluggishness) * rate
        )
        for spring in model.springs:
            own = (spring.nodes >= body.span.start) & (spring.nodes < body.span.stop)
            shares = np.abs(spring.shares)
            held = spring.stiffness(dt) * float(shares.sum()) * shares[own]
            np.add.at(resisted, spring.nodes[own] - body.span.start, held)
        if model.static:
            return resisted
        return resisted + np.abs(body.mass.nodal) * (rate / dt + body.law.mass_damping * rate)
