"""Checks of the momenta of rows: what nothing touches goes on as it is."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from carom.auditing.arrays import Array, Mask, cross
from carom.auditing.model import AuditModel
from carom.auditing.records.rows import Rows
from carom.auditing.report import Findings
from carom.auditing.steps.scales import EPS, ROUND_OFF, SAFETY, Scales


class MomentumChecks:
    """Checks of momentum and angular momentum between rows.

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
        self._rows, self._summary = rows, summary
        self._known = rows.nominal == rows.steps
        """Whether no step was halved since the row before, [row_count]."""
        self.angular = np.ones(len(rows), dtype=bool)
        """Rows whose angular momentum follows from that of the row before, [row_count]."""

    def all(self) -> None:
        """Check everything."""
        if self._model.static:
            # What a stage starts with is of the one before.
            own = self._rows.times > self._model.stage.start_time
            # A run may fail on its way from one equilibrium to another.
            own[-1] &= not (self._model.stabilised and self._summary["status"] == "failed")
            moment = self._rows.angular_momentum[own]
            self._findings.check("row: angular", moment, 0.0, "nothing has a velocity")
            return
        for body in self._model.bodies:
            self._flight(body.name)
        self._angular()

    def _touches(self, names: set[str]) -> Mask:
        """Return whether one of these may have touched since the row before, [row_count]."""
        times = self._rows.times
        before = np.concatenate([times[:1], times[:-1]])
        touched = np.zeros(len(times), dtype=bool)
        for event in self._summary["contacts"]:
            if names & set(event["pair"]):
                release = np.inf if event["release"] is None else event["release"]
                # Without mass, the reactions of the start act in a step too.
                touched |= (times >= event["onset"]) & (before <= release)
        if self._model.coheres:
            # What holds may pull without an event.
            holds = self._rows.history["holding"] > 0
            touched[1:] |= holds[:-1]
            touched |= holds
        return touched

    def _flight(self, name: str) -> None:
        """Check that the centre of a body that touches nothing moves as gravity and damping say."""
        model, rows, scales = self._model, self._rows, self._scales
        free = ~self._touches({name}) & self._known
        free[:1] = False
        body = next(body for body in model.bodies if body.name == name)
        if (model.massless and not model.conserving) or model.driven(body):
            # Boundaries without mass may leave momentum behind; springs and loads do as they like.
            return
        damping = body.law.mass_damping
        x, v = rows.centre(name), rows.drift(name)
        for row in np.flatnonzero(free):
            count = int(rows.steps[row])
            place, speed = x[row - 1], v[row - 1]
            lengths = self._lengths(int(row), count)
            for h in lengths:
                # v₊ = v + Δt (g − α ((1 − ξ) v + ξ v₊))
                later = speed * (1 - h * damping * (1 - model.xi)) + h * model.gravity
                later = later / (1 + h * damping * model.xi)
                place = place + h * ((1 - model.theta) * speed + model.theta * later)
                speed = later
            off = SAFETY * ROUND_OFF * scales.speed
            off += float((scales.displacement_in(lengths) / (model.theta * lengths)).sum())
            where = f"{name}, t = {rows.times[row]:g} s"
            # As lengths, so that both are in the same unit.
            span = float(lengths.sum())
            self._findings.check("row: flight", (v[row] - speed) * span, off * span, where)
            places = ROUND_OFF * (scales.reach + model.size)
            self._findings.check("row: flight", x[row] - place, off * span + places, where)

    def _lengths(self, row: int, count: int) -> Array:
        """Return the lengths of the steps before a row, of which none was halved [s]."""
        span = float(self._rows.times[row] - self._rows.times[row - 1])
        lengths = np.full(count, self._rows.dt)
        lengths[-1] = span - lengths[:-1].sum()
        return lengths

    def _angular(self) -> None:
        """Check that angular momentum changes by gravity alone where no obstacle is touched."""
        model, rows, scales = self._model, self._rows, self._scales
        damped = any(body.law.damped for body in model.bodies)
        turning = all(body.turns for body in model.bodies)
        free = self.angular
        free &= rows.single & ~self._touches({o.name for o in model.scenario.obstacles})
        apart = any(side.target >= 0 and side.interference.acts for side in model.sides)
        apart = apart or any(side.mortar for side in model.sides)
        if model.mixed or not model.massless or apart:
            # Reactions may act where nodes and feet are not at the same place.
            free &= ~self._touches({body.name for body in model.bodies})
        grounded = not all(model.joins_bodies(spring) for spring in model.springs)
        driven = (model.loaded(b) or model.supported(b) or b.anchored for b in model.bodies)
        grounded = grounded or any(driven)
        if not (model.conserving and turning) or damped or grounded:
            free[:] = False
        stored = rows.angular_momentum
        step = np.zeros_like(stored)
        for body in model.bodies:
            x, mass = rows.centre(body.name), body.mass.total
            middle = 0.5 * (x[1:] + x[:-1])
            step[1:] += mass * cross(middle, np.broadcast_to(model.gravity, middle.shape))
        step[1:] *= np.diff(rows.times)[:, None]
        h = np.diff(rows.times, prepend=rows.times[0] - rows.dt)
        iteration = sum(scales.iteration(rows.dt, i).sum() for i in range(len(model.bodies)))
        off = h * iteration * scales.displacement_in(h) * (scales.reach + model.size)
        off = off + SAFETY * ROUND_OFF * scales.mass * scales.speed * scales.reach
        off = off + SAFETY * EPS * np.abs(step).max(axis=1)
        error = np.diff(stored, axis=0, prepend=stored[:1]) - step
        for row in np.flatnonzero(free):
            where = f"t = {rows.times[row]:g} s"
            self._findings.check("row: angular", error[row], off[row], where)
