"""Checks of a stored step: its equations, its ledger and the laws of contact."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from carom.auditing.arrays import AXES, Array, cross
from carom.auditing.bodies.body import AuditBody
from carom.auditing.bodies.rigid import RigidStep
from carom.auditing.checks.blend import BlendChecks
from carom.auditing.checks.contacts import ContactChecks
from carom.auditing.drives.guides import Guide
from carom.auditing.model import AuditModel
from carom.auditing.report import Findings
from carom.auditing.steps.arriving import arriving
from carom.auditing.steps.contacts import all_forces
from carom.auditing.steps.forces import BodyForces
from carom.auditing.steps.scales import EPS, ROUND_OFF, SAFETY, Scales
from carom.auditing.steps.step import BODY_ENERGIES, CONNECTION_ENERGIES, Step, defect
from carom.ledger_terms import names

Row = Mapping[str, float]

IMPULSE = 1e-11
"""How well impulses and the velocities that they make agree, relative to all of them."""

UNTOLD = "energies of steps that depend on a body whose code is not there"

ENERGIES = (*BODY_ENERGIES, *CONNECTION_ENERGIES, *names("pair"))


class StepChecks:
    """Checks of steps.

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
        self.pressed: dict[float, dict[frozenset[str], float]] = {}
        """Sums of normal reactions [N] by names of the pair, at ends of steps [s]."""
        self._contacts = ContactChecks(model, scales, findings)
        self._blends = BlendChecks(scales, findings)
        self._gap = (0.0, 0.0)
        """The bi-potential gap of the last step, and how far it may be off [J]."""

    def go_on(self, before: StepChecks) -> None:
        """Go on from the stage before."""
        self._contacts.sliding.go_on(before._contacts.sliding)

    def step(self, step: Step) -> None:
        """Check a step by itself."""
        where = f"t = {step.time:g} s"
        self._check("time grid", step.off_grid, SAFETY * EPS * step.time, where)
        self._velocity(step, where)
        parts = [step.touching.pressed, *step.touching.impulses]
        contact = all_forces(parts, len(self._model.points))
        for index, body in enumerate(self._model.bodies):
            at = f"{body.name}, {where}"
            if not body.known:
                continue
            self._motion(step, index, at)
            self._supports(step, index, at)
            if body.moves_as_a_whole:
                # Its equation of motion is that of its momenta, and of amplitudes.
                self._whole(step, index, at)
            else:
                self._impulse(step, index, contact[body.span], at)
        self._ledger(step, where)
        self._gap = self._contacts.step(step, where)
        self._note_forces(step)

    def turn(self, step: Step) -> float:
        """Return how far feet may be off: places over the length of a facet."""
        return self._contacts.turn(step)

    def rows(self, step: Step, before: Row | None, after: Row) -> None:
        """Check the history's row at the end of a step, and that at its start if there is one."""
        where = f"t = {step.time:g} s"
        found = step.touching.all
        off = self._contacts.turn(step) * float(np.abs(found.reaction).sum())
        off += self._scales.least_reaction(step.dt)
        surely, perhaps = arriving(step, self._scales)
        # What comes to its target with the end of the step is counted in the next.
        least, most = int((~perhaps).sum()), int((~surely).sum())
        self._check("contact count", _outside(after["contacts"], least, most), 0.0, where)
        force = found.normal_force
        off += float(np.abs(force[perhaps & ~surely]).sum())
        self._check("normal force", after["normal_force"] - force[~surely].sum(), off, where)
        if self._model.coheres:
            held = int((found.adhesion > 0.0).sum())
            self._check("holding", after["holding"] - held, 0.0, where)
        gap, doubt = self._gap
        total = float(np.abs(found.reaction).sum() + found.adhesion.sum())
        off = total * self._scales.geometry(step) + doubt
        self._check("certificate", max(gap - after["certificate"], 0.0), off, where)
        # Where time stands still nothing has a mean velocity.
        for name, node in () if step.settles else self._model.tracks():
            stored = [after[f"{name}.vmid_{axis}"] for axis in AXES[: self._model.dimension]]
            rate = EPS * (self._scales.reach + self._model.size) / step.dt
            off = SAFETY * (rate + EPS * step.time / step.dt * self._scales.speed)
            error = step.d[node] / step.dt - stored
            self._check("tracked points", error, off, f"{name}, {where}")
        self._support_forces(step, after, where)
        self._extremes(step, after, alone=before is not None, where=where)
        if before is not None:
            for name in ENERGIES:
                change = after[name] - before[name]
                off = ROUND_OFF * (self._scales.energy + abs(after[name]))
                self._check(
                    "ledger in history", change - step.ledger[name], off, f"{name}, {where}"
                )

    def _support_forces(self, step: Step, after: Row, where: str) -> None:
        """Check the forces of supports in the history."""
        for index, supports in enumerate(self._model.supports):
            force, allowed = step.forces.support(index), self._scales.force(step, index)
            for number, name in enumerate(supports.names):
                mine = (supports.by == number) | (supports.guide is not None)
                total = np.where(mine, force, 0.0).sum(axis=0)
                stored = np.array(
                    [after[f"{name}.force_{axis}"] for axis in AXES[: self._model.dimension]]
                )
                off = (allowed[:, None] * mine).sum(axis=0) + ROUND_OFF * np.abs(force).sum()
                self._check("support forces", stored - total, off, f"{name}, {where}")

    def _extremes(self, step: Step, after: Row, *, alone: bool, where: str) -> None:
        """Check what the row says of the steps since the one before, of which this may be alone."""
        model, ledger = self._model, step.ledger
        blend = float(np.abs(step.blend).max()) if model.blended else 0.0
        off = ROUND_OFF * sum(abs(energy) for energy in ledger.values())
        for name, figure, allowed in (
            ("blend", blend, 0.0),
            ("step_defect", abs(defect(ledger)), off),
        ):
            excess = figure - after[name]
            self._check("step extremes", excess if alone else max(excess, 0.0), allowed, where)
        if model.blended:
            # What the groups have yet to give back is what the ledger of the run does not explain.
            off = ROUND_OFF * (self._scales.energy + sum(abs(after[name]) for name in ENERGIES))
            self._check(
                "waiting energy", step.end["energy_debt"].sum() - after["defect"], off, where
            )

    def _note_forces(self, step: Step) -> None:
        found = step.touching.all.only(~arriving(step, self._scales)[0])
        forces = self.pressed.setdefault(step.time, {})
        for key in sorted(set(zip(found.source.tolist(), found.target.tolist(), strict=True))):
            mine = (found.source == key[0]) & (found.target == key[1])
            names = frozenset(self._model.name(index) for index in key)
            forces[names] = forces.get(names, 0.0) + float(found.normal_force[mine].sum())

    def _velocity(self, step: Step, where: str) -> None:
        if self._model.static:
            self._check("velocity update", step.v1, 0.0, where)
            return
        rate = 1 / (self._model.theta * step.dt)
        # d is known from displacements, with their round-off.
        off = (np.abs(step.u0) + np.abs(step.u1)) * rate + np.abs(step.v0) / self._model.theta
        off = 4 * EPS * (off + np.abs(step.v1))
        for body, share in zip(self._model.bodies, step.shares, strict=True):
            if len(body.massless) or share:
                # Means over the body, and what is no vibration, have the round-off of all of it.
                off[body.span] += 4 * EPS * np.abs(step.v1[body.span]).max()
                off[body.span] += 4 * off[body.span].max(axis=0)
            if body.moves_as_a_whole:
                # Its velocities are those of its momenta, its motion that of the iterations.
                off[body.span] += self._scales.displacement(step) * rate
        change = step.v1 - step.v_scheme
        total = step.dt * sum(float(np.abs(part.reaction).sum()) for part in step.touching.impulses)
        if total == 0.0:
            self._check("velocity update", change, off, where)
            return
        # What impulses in contacts make of velocities: M Δv = p, whatever M⁻¹ is.
        turn = self._contacts.turn(step)
        for body in self._model.bodies:
            if not body.known or (body.modes is not None and body.vibrations.doubt):
                continue
            mass = body.mass
            impulse = step.touching.impulse(body)
            if body.moves_as_a_whole:
                impulse = step.whole(body).borne(impulse)
            error = body.folded(mass.times(change[body.span]) - impulse)
            # What is held keeps its velocity, and supports see to it.
            if not body.rigid:
                error[self._model.supports[self._model.bodies.index(body)].held] = 0.0
            # Rows of consistent masses of second order may sum to less than zero.
            allowed = np.abs(mass.nodal)[:, None] * off[body.span].max() + total * (turn + IMPULSE)
            self._check("velocity update", error, allowed, f"{body.name}, {where}")

    def _motion(self, step: Step, index: int, at: str) -> None:
        body = self._model.bodies[index]
        size = np.abs(step.forces.residual(index)).max(axis=1)
        off = body.folded(self._scales.force(step, index))
        held = np.zeros(len(size), dtype=bool)
        held[body.massless] = True
        self._check("equation of motion", size[~held], off[~held], at)
        if step.motion > 0 and not held.all():
            stiffness = body.folded(self._scales.iteration(step.dt, index))[~held]
            correction = float((size[~held] / np.where(stiffness > 0, stiffness, np.inf)).max())
            # Newton's tolerance is that of the last correction, beside the motion.
            self._findings.report(
                "residual of a step as a correction, relative to its motion; the case asks for "
                f"{self._model.analysis.newton.tolerance:g}",
                correction / step.motion,
                "",
            )
        if held.any():
            self._check("massless nodes", size[held], off[held], at)

    def _supports(self, step: Step, index: int, at: str) -> None:
        """Check that what is held is where it is to be, at the velocity that it is to have."""
        supports, span = self._model.supports[index], self._model.bodies[index].span
        if supports.guide is not None:
            self._guided(step, index, supports.guide, at)
            return
        if not supports.held.any():
            return
        held = supports.held
        place = step.u1[span] - supports.displacement(step.time)
        off = SAFETY * EPS * (self._model.size + self._scales.reach)
        self._check("supports", place[held], off, at)
        speed = step.end["velocity"][span] - supports.velocity(step.time)
        off = ROUND_OFF * self._scales.speed
        self._check("supports", step.dt * speed[held], step.dt * off, f"{at}, velocity")

    def _guided(self, step: Step, index: int, guide: Guide, at: str) -> None:
        """Check that a rigid body is where it is guided, at the velocity that it is to have."""
        body, rigid = self._model.bodies[index], step.rigid(self._model.bodies[index])
        guiding, u1 = rigid.guiding, step.u1[body.span]
        off = SAFETY * EPS * (self._model.size + self._scales.reach)
        place = body.mass.mean(u1) - guide.displacement(step.time)
        self._check("supports", place[guiding.along], off, at)
        # Turns as the way of what is farthest from the centre.
        radius = float(np.linalg.norm(rigid.arms[0], axis=1).max())
        turn = rigid.turn - guide.turn(float(step.start["time"]), step.time)
        self._check("supports", radius * turn[guiding.about], SAFETY * off, f"{at}, turn")
        v = step.end["velocity"][body.span]
        speed = body.mass.mean(v) - guiding.velocity
        spin = radius * (body.spin(u1, v) - guiding.spin)
        off = step.dt * SAFETY * ROUND_OFF * (self._scales.speed + self._scales.reach / step.dt)
        self._check("supports", step.dt * speed[guiding.along], off, f"{at}, velocity")
        self._check("supports", step.dt * spin[guiding.about], off, f"{at}, spin")

    def _whole(self, step: Step, index: int, at: str) -> None:
        """Check that nodes of a rigid body move as one, and both momenta change by what acts."""
        body = self._model.bodies[index]
        motion = step.whole(body)
        if isinstance(motion, RigidStep):
            off = self._scales.displacement(step)
            self._check("rigid motion", motion.bending(step.d[body.span]), off, at)
        residual, forces = step.forces.residual(index), self._scales.force(step, index)
        self._check("impulse", step.dt * residual.sum(axis=0), step.dt * forces.sum(), at)
        arms = motion.arms[1]
        moment = step.dt * cross(arms, residual).sum(axis=0)
        off = step.dt * float(forces.sum()) * float(np.abs(arms).max())
        self._check("angular impulse", moment, off, at)

    def _impulse(self, step: Step, index: int, contact: Array, at: str) -> None:
        model, body, f = self._model, self._model.bodies[index], step.forces.of[index]
        # Load steps balance forces at their end, others half way.
        u = step.u1 if model.static else 0.5 * (step.u0 + step.u1)
        middle = body.points + u[body.span]
        arm = middle - body.mass.mean(middle)
        force, moment = self._outer(step, index, contact, arm)
        if body.anchored:
            # What its law does to it as a whole nobody else knows.
            force = force - f.internal.sum(axis=0)
        off = self._scales.force(step, index)
        total = step.dt * (f.inertia.sum(axis=0) - force)
        if body.revolution:
            # What is radial is borne by the hoops.
            total[0] = 0.0
        self._check("impulse", total, step.dt * off.sum(), at)
        if body.revolution:
            return
        if body.images.size:
            self._findings.leave(f"angular momentum of {body.name!r}: it repeats itself")
            return
        if model.blended and not body.turns:
            self._findings.leave(f"angular momentum of {body.name!r}: its law has none to keep")
            return
        if body.anchored or not (model.conserving and body.turns):
            torque = cross(arm, self._inner(body, f)).sum(axis=0)
            largest = float(np.abs(torque).max())
            self._findings.report("largest moment of inner forces in a step", largest, "N m")
            moment -= torque
        rough = float(np.abs(contact).sum()) * self._scales.geometry(step)
        off = step.dt * (off.sum() * np.abs(arm).max() + rough)
        self._check(
            "angular impulse", step.dt * (cross(arm, f.inertia).sum(axis=0) - moment), off, at
        )

    def _inner(self, body: AuditBody, f: BodyForces) -> Array:
        """Return the inner forces of the step as the mass feels them."""
        if not self._model.massless:
            return f.internal
        inner: Array = f.internal.copy()
        b = body.massless
        inner[b] = (1 - self._model.xi) * f.start[b] + self._model.xi * f.end[b]
        return inner

    def _outer(self, step: Step, index: int, contact: Array, arm: Array) -> tuple[Array, Array]:
        """Return resultant and moment of what acts on a body in the step [N], [N m].

        Reactions act where the scheme puts them: those of the step at its middle, those of a state
        in the balance of massless nodes at that state.
        """
        model, body, f = self._model, self._model.bodies[index], step.forces.of[index]
        d, b = step.d[body.span], body.massless
        light = np.zeros(d.shape, dtype=bool)
        light[b] = model.supports[index].held[b]
        pull = f.end_connections if model.static else f.connections
        outer = f.gravity + f.loads + pull - f.viscous + step.forces.support(index)
        if model.blended:
            alpha = float(step.blend[index])
            start, end = (
                found.nodal_forces(len(model.points))[body.span]
                for found in (step.touching.first, step.touching.balanced)
            )
            parts = [
                ((0.5 - alpha) * start, arm - 0.5 * d),
                ((0.5 + alpha) * end, arm + 0.5 * d),
                (contact - end, arm),
            ]
        elif model.massless:
            # The end is balanced by reactions; the start is balanced by what it was balanced with.
            static = model.xi * (f.end_loads - f.viscous)
            outer[b] = np.where(light, outer, static)[b]
            held = np.zeros_like(contact)
            held[b] = (1 - model.xi) * f.start[b] - model.xi * f.steadying[b]
            parts = [(step.forces.contact(body), arm)] if not len(b) else []
            parts += [(model.xi * contact, arm), (held, arm)] if len(b) else []
        else:
            parts = [(contact, arm)]
        # Supports see to what they hold over the whole step.
        parts = [(np.where(light, 0.0, part), at) for part, at in parts]
        parts.append((np.where(light, step.forces.contact_on_held(body), 0.0), arm))
        parts.append((outer, arm))
        force: Array = np.sum([part.sum(axis=0) for part, _ in parts], axis=0)
        moment: Array = np.sum([cross(at, part).sum(axis=0) for part, at in parts], axis=0)
        return force, moment

    def _ledger(self, step: Step, where: str) -> None:
        model, scales = self._model, self._scales
        mine = step.energy_terms()
        sums = 2 * ROUND_OFF * scales.energy
        strain = sums + sum(
            scales.strain(b, u[b.span], t) for b in model.known for u, t in step.ends
        )
        reactions = float(np.abs(step.touching.all.reaction).sum())
        if model.massless:
            reactions += float(np.abs(step.touching.first.reaction).sum())
        work = sums + reactions * scales.geometry(step)
        friction = work + step.work.doubt
        known = [index for index, body in enumerate(model.bodies) if body.known]
        resisted = sum(scales.resisted(step, index) for index in known)
        off = {"strain": strain, "plastic": strain, "friction": friction, "normal_contact": work}
        off |= {"viscous": sums + resisted, "prescribed": work + resisted}
        if any(body.growth.acts for body in model.bodies):
            off["prescribed"] += strain
        if model.static:
            # What contact does in the mean of a load step is the scheme's, too.
            off["scheme"] = strain + work
        if step.starts_elsewhere and step.uses_start:
            self._findings.leave("what the first step of a stage makes of contacts of the last")
            off |= dict.fromkeys(("scheme", "normal_contact"), friction)
            off["prescribed"] += step.work.doubt
        for name in ENERGIES:
            error = step.ledger[name] - mine[name]
            if step.untold(mine[name]):
                self._findings.leave(UNTOLD)
                continue
            self._check(f"ledger: {name.replace('_', ' ')}", error, off.get(name, sums), where)
        missed = defect(mine)
        if not model.conserving:
            self._findings.report("largest defect of a step", missed, "J")
            return
        work = strain + friction + self._newton_work(step)
        if model.blended and model.whole:
            self._blends.step(step, work, strain + friction, where)
        elif model.whole:
            self._check("energy of the step", missed, work, where)
        for body, terms in zip(model.bodies, step.body_terms, strict=True):
            if not body.known:
                continue
            change = terms["kinetic"] + terms["strain"] - terms["external"]
            change += terms["viscous"] + terms["plastic"]
            at = f"{body.name}, {where}"
            received = terms["contact"] + terms["connections"] + terms["prescribed"]
            self._check("energy of bodies", change - received, work, at)

    def _newton_work(self, step: Step) -> float:
        """Return the work that the error of the equation of motion may do in a step [J]."""
        return sum(
            float(self._scales.force(step, i) @ np.abs(step.d[b.span]).max(axis=1))
            for i, b in enumerate(self._model.bodies)
            if b.known
        )


def _outside(figure: float, least: float, most: float) -> float:
    """Return how far a figure is outside of bounds."""
    return max(least - figure, figure - most, 0.0)
