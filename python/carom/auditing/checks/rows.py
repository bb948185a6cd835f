"""Checks of the history row by row: what follows from other columns and rows alone."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.auditing.arrays import AXES, Array, components
from carom.auditing.bodies.body import AuditBody
from carom.auditing.bodies.moving import KINETIC_PARTS
from carom.auditing.checks.blend import LARGEST_BLEND
from carom.auditing.checks.pushes import beyond_pushes
from carom.auditing.model import AuditModel
from carom.auditing.records.parts import OF_STEPS, SUMS
from carom.auditing.records.rows import GRID, Rows
from carom.auditing.report import Findings
from carom.auditing.steps.scales import EPS, ROUND_OFF, SAFETY, Scales
from carom.ledger_terms import terms


class RowChecks:
    """Checks of rows.

    Parameters
    ----------
    model, scales
        The model and its magnitudes.
    findings
        Where what is found goes.
    rows
        The history.
    summary
        What ``summary.json`` says.
    """

    def __init__(
        self,
        model: AuditModel,
        scales: Scales,
        findings: Findings,
        rows: Rows,
        summary: Mapping[str, Any],
    ) -> None:
        self._model, self._scales, self._findings = model, scales, findings
        self._rows, self._history, self._summary = rows, rows.history, summary
        self._dt, self._end = rows.dt, model.analysis.end_time
        self._start = model.stage.start_time
        self._times = rows.times

    def all(self) -> None:
        """Check everything."""
        self._grid()
        self._energies()
        self._motion()
        self._centres()
        self._tracks()
        self._signs()
        self._lengths()

    def _check(self, name: str, figures: Array, off: float | Array) -> None:
        """Note figures of the last rows, each with its time."""
        figures = np.asarray(figures, dtype=np.float64)
        if len(figures) == 0:
            return
        off = np.broadcast_to(np.asarray(off, dtype=np.float64), figures.shape)
        bad = np.where(np.isnan(figures), np.inf, np.abs(figures) / np.maximum(off, 1e-300))
        worst = int(bad.argmax())
        time = self._times[len(self._times) - len(figures) + worst]
        self._findings.check(name, figures, off, f"t = {time:g} s")

    def _grid(self) -> None:
        times = self._times
        nominal = self._start + np.rint((times - self._start) / self._dt) * self._dt
        off_grid = np.minimum(np.abs(times - nominal), np.abs(times - self._end))
        if self._summary["status"] == "failed":
            off_grid[-1] = 0.0  # where the last good part of a step ended
        self._check("row times", off_grid, SAFETY * EPS * np.abs(times))
        self._check("row times", np.maximum(-np.diff(times), 0.0), 0.0)
        self._check("row times", (np.diff(times) == 0.0).astype(float), 0.0)
        # Every step that ends at or after the next multiple of the interval is due a row.
        every = self._model.stage.history_every
        count = np.floor((times[-1] - self._start) / self._dt + GRID) + 1
        ends = np.arange(count) * self._dt
        due = np.floor((ends + GRID * self._dt) / every)
        ends = self._start + ends
        missing = np.setdiff1d(ends[1:][np.diff(due) > 0], times)
        missing = missing[missing < times[-1] - GRID * self._dt]
        self._findings.check("row times", float(len(missing)), 0.0, "rows that are due")

    def _parts(self, off: float) -> None:
        """Check that energies add up over bodies, and kinetic ones over what moves."""
        h = self._history
        bodies = [body.name for body in self._model.bodies]
        for part in (*KINETIC_PARTS, "strain"):
            of_bodies = sum(h[f"{name}.{part}"] for name in bodies)
            self._check("row: parts", h[part] - of_bodies, off)
        self._check("row: parts", h["kinetic"] - sum(h[part] for part in KINETIC_PARTS), off)

    def _energies(self) -> None:
        h = self._history
        off = ROUND_OFF * self._scales.energy
        self._check("row: total", h["total"] - h["kinetic"] - h["strain"] - h["springs"], off)
        self._parts(off)
        # Energies are those of the state, all others sums since the start.
        known = sum(
            term.sign * (h[term.name] - (h[term.name][0] if term.side == "stored" else 0.0))
            for term in terms("run")
        )
        scale = sum((np.abs(h[name]) for name in SUMS), np.zeros(len(h["time"])))
        self._check("row: defect", h["defect"] - known, off + ROUND_OFF * scale)
        # The defect is the sum of those of the steps, of which the row has the largest.
        change, largest = np.abs(np.diff(h["defect"])), h["step_defect"][1:]
        steps = self._rows.steps[1:]
        error = np.maximum(change - steps * largest, 0.0)
        error = np.where(self._rows.single[1:], np.abs(change - largest), error)
        off_sums = SAFETY * ROUND_OFF * (self._scales.energy + scale[1:])
        self._check("row: step defect", np.where(np.isnan(steps), 0.0, error), off_sums)
        # A massless contact may have turned since it was last pressed, and the blend may weigh the
        # reactions of the start negatively, and landing take friction back: then the run says so.
        one_way = not self._model.gives_back
        if one_way or self._summary["least_friction"] >= 0:
            fall = np.maximum(-np.diff(h["friction"]), 0.0)
            self._check("row: friction", fall, off + self._rows.certified[1:])
        else:
            self._findings.leave("sign of friction: contacts took and gave")
        self._check("row: dampers", np.maximum(-np.diff(h["dampers"]), 0.0), off)
        if self._model.theta == self._model.xi:
            self._check("row: viscous", np.maximum(-np.diff(h["viscous"]), 0.0), off)

    def _motion(self) -> None:
        model, scales, h = self._model, self._scales, self._history
        external, least = np.zeros(len(self._times)), np.zeros(len(self._times))
        momentum = np.zeros((len(self._times), model.dimension))
        for body in model.bodies:
            x, v, mass = self._rows.centre(body.name), self._rows.drift(body.name), body.mass.total
            external = external + mass * (x - x[0]) @ model.gravity
            momentum = momentum + mass * v
            least = least + 0.5 * mass * (v**2).sum(axis=1)
        steps = max(float(self._summary["steps"]), 1.0)
        weight = scales.mass * float(np.linalg.norm(model.gravity)) * (scales.reach + model.size)
        off = ROUND_OFF * (scales.energy + weight) + SAFETY * EPS * steps * weight
        loaded = any(len(loads) for loads in model.loads)
        supported = any(len(supports) for supports in model.supports)
        if model.stage.velocities:
            self._findings.leave("the work of giving bodies velocities when a stage starts")
        elif model.whole and not loaded:
            error = beyond_pushes(model, h, h["external"] - external)
            self._check("row: external", error, off)
        stored = self._rows.momentum
        if all(body.mass.plain for body in model.bodies):
            off = SAFETY * ROUND_OFF * scales.mass * scales.speed
            self._check("row: momentum", np.abs(stored - momentum).max(axis=1), off)
            off = ROUND_OFF * scales.energy
            self._check("row: kinetic", np.maximum(least - h["kinetic"], 0.0), off)
        damped = any(body.law.mass_damping > 0 for body in model.bodies)
        lossy = model.massless and not model.conserving
        grounded = any(not model.joins_bodies(spring) for spring in model.springs)
        outside = bool(model.obstacles) or bool(model.gravity.any()) or loaded or supported
        outside = outside or any(body.anchored for body in model.bodies)
        if not (outside or damped or lossy or grounded):
            newton = model.analysis.newton.tolerance
            off = SAFETY * ROUND_OFF * scales.mass * scales.speed
            off += SAFETY * steps * newton * scales.mass * scales.speed
            self._check("row: isolated", np.abs(stored - stored[0]).max(axis=1), off)

    def _centres(self) -> None:
        """Check that centres move by the velocities of the scheme."""
        model, single = self._model, self._free()
        if model.static:
            return
        dt = np.diff(self._times)
        off = ROUND_OFF * (self._scales.reach + model.size)
        for body in model.bodies:
            if model.supported(body) or not body.mass.plain:
                continue  # What is held has the velocity that is given.
            x, v = self._rows.centre(body.name), self._rows.drift(body.name)
            mean = (1 - model.theta) * v[:-1] + model.theta * v[1:]
            error = np.abs(np.diff(x, axis=0) - dt[:, None] * mean).max(axis=1)
            self._check("row: centres", np.where(single, error, 0.0), off)

    def _free(self) -> NDArray[np.bool_]:
        """Return which rows after the first are of steps that the scheme alone leads through.

        Impulses in contacts change velocities at the end of a step.
        """
        single: NDArray[np.bool_] = self._rows.single[1:]
        if not self._model.jolts:
            return single
        dimension = self._model.dimension
        columns = (*AXES[:dimension], *components("v", dimension))
        names = (f"{body.name}.{column}" for body in self._model.bodies for column in columns)
        self._findings.leave(
            "velocities between rows with contacts: impulses change them",
            *(f"history.csv: {name}, between output times" for name in names),
        )
        free: NDArray[np.bool_] = single & (self._history["contacts"][1:] == 0)
        return free

    def _tracks(self) -> None:
        """Check that tracked points move by the velocities of the scheme."""
        model, h, single = self._model, self._history, self._rows.single[1:]
        free = self._free()
        dt = np.diff(self._times)
        for name, node in model.tracks():
            body = model.bodies[model.body_of(node)]
            light = node - body.span.start in body.massless
            for axis in AXES[: model.dimension]:
                u, v, mean = (h[f"{name}.{quantity}_{axis}"] for quantity in ("u", "v", "vmid"))
                # The length of a step is known up to the round-off of times.
                off = SAFETY * EPS * (self._scales.reach + model.size) + (
                    SAFETY * EPS * self._times[1:] * np.abs(mean[1:])
                )
                error = np.diff(u) - dt * mean[1:]
                self._check("row: tracks", np.where(single, error, 0.0), off)
                if light:
                    # It has become faster since the middle of the step as the whole body has.
                    centre, drift = h[f"{body.name}.{axis}"], h[f"{body.name}.v_{axis}"]
                    scheme = mean[1:] + drift[1:] - np.diff(centre) / dt
                    off += SAFETY * EPS * (np.abs(centre[1:]) + np.abs(drift[1:]) * dt)
                else:
                    scheme = (1 - 1 / model.theta) * v[:-1] + mean[1:] / model.theta
                known = single if light else free
                held = model.supports[model.bodies.index(body)].held[node - body.span.start]
                # What turns as a rigid body does has a scheme for its momenta, not for its nodes.
                turns = body.rigid or body.modes is not None or model.static
                known = known & (not held[AXES.index(axis)] and not turns)
                off = SAFETY * off / dt + SAFETY * EPS * np.abs(v[:-1])
                if model.blended and body.blends and not light:
                    off += self._repaid(body, node - body.span.start)
                self._check("row: tracks", np.where(known, v[1:] - scheme, 0.0) * dt, off * dt)

    def _repaid(self, body: AuditBody, node: int) -> Array:
        """Return how far velocities of a node may change as vibration pays for a blend [m/s].

        A share s of the velocities w of vibration, whose energy changes by s w·M w.
        """
        paid = float(self._summary["repaid"])
        squares = 2.0 * self._history[f"{body.name}.vibration"][1:] * body.mass.nodal[node]
        speeds: Array = np.sqrt(np.maximum(squares, 0.0))
        if paid == 0.0:
            return np.zeros_like(speeds)
        return np.divide(2.0 * paid, speeds, out=np.full_like(speeds, np.inf), where=speeds > 0.0)

    def _signs(self) -> None:
        h = self._history
        for name in OF_STEPS:
            if not (name == "normal_force" and self._model.coheres):
                self._check("row: signs", np.maximum(-h[name], 0.0), 0.0)
            self._findings.check("row: signs", h[name][0], 0.0, f"{name} before the first step")
        for name in ("contacts", "retried_steps"):
            self._check("row: signs", h[name] % 1.0, 0.0)
        if self._model.coheres:
            self._holding()
        else:
            pressed = h["normal_force"] > 0
            self._check("row: signs", ((h["contacts"] > 0) != pressed).astype(float), 0.0)
        limit = LARGEST_BLEND if self._model.blended else 0.0
        self._check("row: signs", np.maximum(h["blend"] - limit, 0.0), 0.0)
        flows = any(body.law.flows for body in self._model.bodies)
        off = ROUND_OFF * self._scales.energy
        self._check("row: plastic", np.maximum(-np.diff(h["plastic"], prepend=0.0), 0.0), off)
        for name, may_be in (
            ("plastic", flows),
            ("springs", bool(self._model.springs)),
            ("dampers", bool(self._model.springs)),
        ):
            if not may_be:
                self._check("row: signs", h[name], 0.0)
        most = sum(self._model.most_contacts(side) for side in self._model.sides)
        most += self._model.corner_count * len(self._model.bodies)
        self._check("row: signs", np.maximum(h["contacts"] - most, 0.0), 0.0)
        self._check("row: signs", np.maximum(-h["penetration"], 0.0), 0.0)
        solver = self._model.contact.solver.tolerance
        self._check("row: residual", h["residual"], solver)
        self._findings.report(
            f"largest residual of a contact problem; the case asks for {solver:g}",
            float(h["residual"].max()),
            "",
        )
        let_in = not all(side.ruled_by_gaps for side in self._model.sides) or self._model.mixed
        if self._model.condition in ("gap", "massless") and self._model.sides and not let_in:
            off = self._scales.penetration()
            # What a stage starts with is of the one before.
            own = self._times > self._start if self._model.before else np.isfinite(self._times)
            self._check("row: penetration", np.maximum(-h["min_gap"][own], 0.0), off)
            if self._model.contact.targets == "smooth" or not self._model.faceted:
                # What presses is closed.
                open_gap = np.where(h["normal_force"] > 0, h["min_gap"], 0.0)
                self._check("row: penetration", np.maximum(open_gap, 0.0), off)

    def _holding(self) -> None:
        """Check how many contacts hold: none that is not counted, and no more than before.

        Where it lasts contacts that close hold from then on.
        """
        h = self._history
        holding, contacts = h["holding"], h["contacts"]
        self._check("holding", holding % 1.0, 0.0)
        self._check("holding", np.maximum(-holding, 0.0), 0.0)
        self._check("holding", np.maximum(holding - contacts, 0.0)[1:], 0.0)
        self._check("row: signs", ((contacts == 0) & (h["normal_force"] != 0)).astype(float), 0.0)
        held = [side.holding for side in self._model.sides if side.holding is not None]
        if not any(holding.lasting for holding in held):
            self._check("holding", np.maximum(np.diff(holding), 0.0), 0.0)

    def _lengths(self) -> None:
        """Check the shortest steps: those of the times, or of as many halves as there may be."""
        h = self._history
        # A step that fails is halved, but for the one that a run fails with.
        # Stabilised ones that are not halved go on with inertia at once.
        halves = self._model.analysis.max_halvings > 0
        longest = np.where((h["retried_steps"] > 0) & halves, 0.5, 1.0) * self._dt
        if self._summary["status"] == "failed":
            longest[-1] = self._dt
        off = SAFETY * EPS * self._end
        self._check("row: signs", np.maximum(h["shortest_step"] - longest, 0.0), off)
        shortest, steps = h["shortest_step"][1:], self._rows.steps[1:]
        dt = np.diff(self._times)
        self._check("row: signs", np.where(self._rows.single[1:], shortest - dt, 0.0), off)
        # As many halvings as steps failed, at most; the last step of a run may be a short one.
        fewest = 0.5 ** np.minimum(h["retried_steps"][1:], 60)
        least = np.minimum(self._dt, dt) * fewest
        if not np.isnan(steps).any():
            duration = self._model.stage.duration
            whole = (np.ceil(duration / self._dt - 1e-6) - 1) * self._dt
            short = self._times[1:] > self._start + whole + off
            least = np.where(short, np.minimum(least, (duration - whole) * fewest), least)
            self._check("row: signs", np.maximum(least - shortest, 0.0), off)
