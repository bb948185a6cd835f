"""Checks of the fields at an output time, and of the history's row of that time."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from carom.auditing.arrays import AXES, Array, components, turning_axes, turning_components
from carom.auditing.bodies.body import AuditBody
from carom.auditing.bodies.moving import KINETIC_PARTS
from carom.auditing.bodies.reduced_step import unshaped
from carom.auditing.bodies.rigid import bent
from carom.auditing.model import AuditModel
from carom.auditing.records.files import Frame
from carom.auditing.report import Findings
from carom.auditing.steps.arriving import most_uncounted
from carom.auditing.steps.contacts import smallest_gaps
from carom.auditing.steps.inside import deepest_node
from carom.auditing.steps.scales import EPS, ROUND_OFF, SAFETY, Scales

Row = Mapping[str, float]


class FrameChecks:
    """Checks of states.

    Parameters
    ----------
    model, scales
        The model and its magnitudes.
    findings
        Where what is found goes.
    """

    def __init__(self, model: AuditModel, scales: Scales, findings: Findings) -> None:
        self._model, self._scales, self._findings = model, scales, findings
        self._check = findings.check
        self._free = np.ones(len(model.points), dtype=bool)
        for body in model.bodies:
            self._free[body.span][body.surface] = False

    def frame(self, frame: Frame, row: Row | None) -> None:
        """Check the fields of an output time; `row` is the history's of that time, if any."""
        where = f"t = {frame.time:g} s"
        self._check("plane", frame.flat, 0.0, where)
        self._cells(frame, where)
        for body in self._model.bodies:
            if body.images.size:
                for field in (frame.displacement, frame.velocity):
                    mine = field[body.span]
                    self._check(
                        "tied nodes", mine - mine[body.masters], 0.0, f"{body.name}, {where}"
                    )
            if body.modes is not None:
                u = frame.displacement[body.span]
                beside, off = unshaped(body, u)
                off += self._round_off_of_places()
                self._check("reduced shapes", beside, off, f"{body.name}, {where}")
                if body.vibrations.doubt:
                    self._findings.leave(f"vibrations of {body.name!r}: {body.vibrations.doubt}")
            if body.rigid:
                bending = bent(body, frame.displacement[body.span])
                self._check(
                    "rigid motion", bending, self._round_off_of_places(), f"{body.name}, {where}"
                )
        self._check("free nodes", frame.reaction[self._free], 0.0, where)
        if not self._model.obstacles:
            off = ROUND_OFF * np.abs(frame.reaction).sum()
            off += self._scales.least_reaction(self._model.analysis.time_step)
            self._check("action and reaction", frame.reaction.sum(axis=0), off, where)
        smallest = self._gaps(frame, where)
        if row is None:
            self._findings.leave("frames at whose times the history has no row")
            return
        self._energies(frame, row, where)
        self._springs(frame, row, where)
        self._momenta(frame, row, where)
        for body in self._model.known:
            self._motion(body, frame, row, where)
        if smallest is not None and np.isfinite(smallest):
            above = max(row["min_gap"] - smallest, 0.0)
            off = self._round_off_of_places() + self._scales.travel
            self._check("smallest gap", above, off, where)
        deepest = deepest_node(self._model, self._model.points + frame.displacement, frame.time)
        off = self._round_off_of_places()
        # Rows say how deep steps have let nodes in, and the first has none.
        deeper = max(deepest - row["penetration"], 0.0) if frame.time > 0.0 else 0.0
        self._check("penetration", deeper, off, where)
        pressed = float(np.abs(frame.reaction).sum())
        if frame.time > self._model.stage.start_time:
            # A run that goes on from another starts with reactions of no step of its own.
            counted = row["contacts"] > 0
            most = most_uncounted(self._model, self._scales, row["shortest_step"])
            # What holds is counted even where it bears nothing.
            wrong = pressed == 0.0 and not self._model.coheres if counted else pressed > most
            self._check("contact count", float(wrong), 0.0, where)
        self._tracks(frame, row, where)

    def _round_off_of_places(self) -> float:
        return ROUND_OFF * (self._model.size + self._scales.reach)

    def _cells(self, frame: Frame, where: str) -> None:
        first = 0
        for body in self._model.bodies:
            u = frame.displacement[body.span]
            stress, density = body.cell_states(u, body.growth.at(frame.time))
            mine = slice(first, first + len(stress))
            first = mine.stop
            # Strains have the round-off of displacements over edges, and of F itself.
            size = float(np.abs(u).max()) + self._model.size
            strain = SAFETY * EPS * (1 + size / body.cells.shortest_edge)
            off = ROUND_OFF * np.abs(stress).max() + body.law.modulus * strain
            at = f"{body.name}, {where}"
            self._check("stress", frame.stress[mine] - stress, off, at)
            # Of a neo-Hookean body ψ is a small difference of terms of the size of its moduli.
            rest = body.law.modulus * EPS if body.law.subtracts else off * strain
            off = ROUND_OFF * density.max() + np.abs(stress).max() * strain + SAFETY * rest
            self._check("energy density", frame.energy_density[mine] - density, off, at)
            if body.law.flows:
                error = frame.plastic_strain[mine] - body.plastic_strain(
                    u, body.growth.at(frame.time)
                )
                self._check("plastic strain", error, SAFETY * strain, at)

    def _gaps(self, frame: Frame, where: str) -> float | None:
        model = self._model
        gaps = smallest_gaps(model, model.points + frame.displacement, frame.time)
        if not gaps:
            return None
        self._findings.report("deepest penetration at output times", max(-min(gaps), 0.0), "m")
        if model.condition in ("gap", "massless"):
            allowed = self._scales.penetration()
            one_sided = [
                gap
                for gap, side in zip(gaps, model.sides, strict=True)
                if side.ruled_by_gaps and (side.massless or not model.mixed)
            ]
            for gap in one_sided:
                self._check("no penetration", max(-gap, 0.0), allowed, where)
        return min(gaps)

    def _energies(self, frame: Frame, row: Row, where: str) -> None:
        bodies, scales = self._model.known, self._scales
        kinetic = sum(
            body.kinetic_energy(frame.displacement[body.span], frame.velocity[body.span])
            for body in bodies
        )
        strain = sum(
            body.strain_energy(frame.displacement[body.span], body.growth.at(frame.time))
            for body in bodies
        )
        off = scales.sums * scales.energy
        strain_off = off + sum(
            scales.strain(b, frame.displacement[b.span], frame.time) for b in bodies
        )
        springs = sum(s.energy(frame.displacement, frame.time) for s in self._model.springs)
        if self._model.springs:
            self._check("spring energy", row["springs"] - springs, strain_off, where)
        if not self._model.whole:
            return
        self._check("kinetic energy", row["kinetic"] - kinetic, off, where)
        self._check("strain energy", row["strain"] - strain, strain_off, where)
        total = kinetic + strain + springs
        self._check("total energy", row["total"] - total, strain_off, where)

    def _springs(self, frame: Frame, row: Row, where: str) -> None:
        """Check the lengths of springs, and the forces in them."""
        for spring in self._model.springs:
            moved = (frame.displacement, frame.velocity, frame.time)
            length, force = spring.length_and_force(*moved)
            at, place = f"{spring.name}, {where}", self._round_off_of_places()
            self._check("spring lengths", row[f"{spring.name}.length"] - length, place, at)
            off = spring.tension.steepest * place + ROUND_OFF * abs(force)
            off += spring.damping * SAFETY * ROUND_OFF * self._scales.speed
            self._check("spring forces", row[f"{spring.name}.force"] - force, off, at)

    def _momenta(self, frame: Frame, row: Row, where: str) -> None:
        dimension = self._model.dimension
        if not self._model.whole:
            return
        momentum, moment = np.zeros(dimension), np.zeros(turning_axes(dimension))
        for body in self._model.bodies:
            u, v = frame.displacement[body.span], frame.velocity[body.span]
            momentum += body.momentum(v)
            moment += body.angular_momentum(u, v)
        stored = np.array([row[name] for name in components("momentum", dimension)])
        off = ROUND_OFF * self._scales.mass * self._scales.speed
        self._check("momentum", stored - momentum, off, where)
        turning = turning_components("angular_momentum", dimension)
        stored = np.array([row[name] for name in turning])
        self._check("angular momentum", stored - moment, off * self._scales.reach, where)

    def _motion(self, body: AuditBody, frame: Frame, row: Row, where: str) -> None:
        u, v = frame.displacement[body.span], frame.velocity[body.span]
        speed, at = self._scales.speed, f"{body.name}, {where}"

        def stored(*columns: str) -> Array:
            return np.array([row[f"{body.name}.{column}"] for column in columns])

        centre = body.mass.mean(body.points + u)
        self._check(
            "centres", stored(*AXES[: body.dimension]) - centre, self._round_off_of_places(), at
        )
        drift = body.mass.drift(v)
        self._check(
            "drifts",
            stored(*components("v", body.dimension)) - drift,
            SAFETY * ROUND_OFF * speed,
            at,
        )
        parts = np.array(body.kinetic_parts(u, v))
        off = max(SAFETY * ROUND_OFF, self._scales.sums) * self._scales.energy
        self._check("kinetic parts", stored(*KINETIC_PARTS) - parts, off, at)
        off += self._scales.strain(body, u, frame.time)
        strain = body.strain_energy(u, body.growth.at(frame.time))
        self._check("body strain", stored("strain")[0] - strain, off, at)
        radius = float(np.ptp(body.points, axis=0).max())
        off = SAFETY * ROUND_OFF * speed * (1 + self._scales.reach / radius) / radius
        self._check(
            "spins", stored(*turning_components("spin", body.dimension)) - body.spin(u, v), off, at
        )

    def _tracks(self, frame: Frame, row: Row, where: str) -> None:
        for name, node in self._model.tracks():
            for quantity, values in (("u", frame.displacement), ("v", frame.velocity)):
                stored = [
                    row[f"{name}.{quantity}_{axis}"] for axis in AXES[: self._model.dimension]
                ]
                self._check("tracked points", values[node] - stored, 0.0, f"{name}, {where}")
