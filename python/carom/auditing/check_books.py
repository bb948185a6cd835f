"""Checks of the history row by row, and of the summary against it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from carom.auditing.arrays import Array
from carom.auditing.check_steps import LARGEST_BLEND
from carom.auditing.model import AuditModel
from carom.auditing.report import Findings
from carom.auditing.scales import EPS, ROUND_OFF, SAFETY, Scales

Books = Mapping[str, Array]

SUMMED = ("friction", "viscous", "plastic", "scheme", "normal_contact", "external", "prescribed")
"""Terms of the ledger that are sums since the start."""


PRESSED = 1e-6
"""Normal forces of pairs depend on normals, which are where the run's last correction was."""


class BookChecks:
    """Checks of history and summary.

    Parameters
    ----------
    model, scales
        The model and its magnitudes.
    findings
        Where what is found goes.
    history, summary
        What ``history.csv`` and ``summary.json`` say.
    """

    def __init__(
        self,
        model: AuditModel,
        scales: Scales,
        findings: Findings,
        history: Books,
        summary: Mapping[str, Any],
    ) -> None:
        self._model, self._scales, self._findings = model, scales, findings
        self._history, self._summary = history, summary
        analysis = model.scenario.analysis
        self._dt, self._end = analysis.time_step, analysis.end_time
        self._times = history["time"]
        # Steps between rows; rows between which all steps were nominal and single say most.
        self._steps = np.rint(np.diff(self._times) / self._dt)
        self._halved = summary["retried_steps"] > 0
        self._every_step = not self._halved and bool((self._steps <= 1).all())

    def all(self) -> None:
        """Check everything."""
        self._grid()
        self._energies()
        self._motion()
        self._signs()
        self._summary_energies()
        self._extremes()
        self._counts()
        self._events()
        self._status()

    def _rows(self, name: str, figures: Array, off: float | Array) -> None:
        """Note figures of rows, each with its time."""
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
        nominal = np.rint(times / self._dt) * self._dt
        off_grid = np.minimum(np.abs(times - nominal), np.abs(times - self._end))
        if self._summary["status"] == "failed":
            off_grid[-1] = 0.0  # where the last good part of a step ended
        self._rows("row times", off_grid, SAFETY * EPS * np.abs(times))
        self._rows("row times", np.maximum(-np.diff(times), 0.0), 0.0)
        self._rows("row times", (np.diff(times) == 0.0).astype(float), 0.0)

    def _energies(self) -> None:
        h = self._history
        off = ROUND_OFF * self._scales.energy
        self._rows("row: total", h["total"] - h["kinetic"] - h["strain"], off)
        change = h["kinetic"] - h["kinetic"][0] + h["strain"] - h["strain"][0]
        taken = h["friction"] + h["viscous"] + h["plastic"] + h["scheme"]
        taken = taken + h["normal_contact"]
        taken = taken - h["external"] - h["prescribed"]
        scale = sum((np.abs(h[name]) for name in SUMMED), np.zeros(len(change)))
        self._rows("row: defect", h["defect"] - change - taken, off + ROUND_OFF * scale)
        # The defect is the sum of those of the steps, of which the row has the largest.
        if not self._halved:
            count = np.maximum(np.ceil(np.diff(h["time"]) / self._dt - 1e-6), 1.0)
            change, largest = np.abs(np.diff(h["defect"])), h["step_defect"][1:]
            error = np.maximum(change - count * largest, 0.0)
            error = np.where(count == 1, np.abs(change - largest), error)
            size = self._scales.energy + scale[1:]
            self._rows("row: step defect", error, SAFETY * ROUND_OFF * size)
        # A massless contact may have turned since it was last pressed, and the blend may weigh the
        # reactions of the start negatively: then the run says so.
        if self._model.condition != "massless" or self._summary["least_friction"] >= 0:
            self._rows("row: friction", np.maximum(-np.diff(h["friction"]), 0.0), off)
        else:
            self._findings.leave("sign of friction: massless contacts took and gave")
        if self._model.theta == self._model.xi:
            self._rows("row: viscous", np.maximum(-np.diff(h["viscous"]), 0.0), off)

    def _motion(self) -> None:
        model, scales, h = self._model, self._scales, self._history
        external, least = np.zeros(len(self._times)), np.zeros(len(self._times))
        momentum = np.zeros((len(self._times), 2))
        dt = np.diff(self._times)
        # Halved steps have velocities between that no row has.
        single = (self._steps == 1) & (not self._halved)
        for body in model.bodies:
            x, v = (
                np.stack([h[f"{body.name}.{column}"] for column in columns], axis=1)
                for columns in (("x", "y"), ("v_x", "v_y"))
            )
            mass = body.mass.total
            external = external + mass * (x - x[0]) @ model.gravity
            momentum = momentum + mass * v
            least = least + 0.5 * mass * (v**2).sum(axis=1)
            mean = (1 - model.theta) * v[:-1] + model.theta * v[1:]
            error = np.abs(np.diff(x, axis=0) - dt[:, None] * mean).max(axis=1)
            off = ROUND_OFF * (scales.reach + model.size)
            self._rows("row: centres", np.where(single, error, 0.0), off)
        steps = max(float(self._summary["steps"]), 1.0)
        weight = scales.mass * float(np.linalg.norm(model.gravity)) * (scales.reach + model.size)
        off = ROUND_OFF * (scales.energy + weight) + SAFETY * EPS * steps * weight
        self._rows("row: external", h["external"] - external, off)
        stored = np.stack([h["momentum_x"], h["momentum_y"]], axis=1)
        off = SAFETY * ROUND_OFF * scales.mass * scales.speed
        self._rows("row: momentum", np.abs(stored - momentum).max(axis=1), off)
        self._rows("row: kinetic", np.maximum(least - h["kinetic"], 0.0), ROUND_OFF * scales.energy)
        damped = any(body.damping.mass > 0 for body in model.bodies)
        lossy = model.massless and not model.conserving
        if not (model.planes or model.gravity.any() or damped or lossy):
            newton = model.scenario.analysis.newton.tolerance
            off += SAFETY * steps * newton * scales.mass * scales.speed
            self._rows("row: isolated", np.abs(stored - stored[0]).max(axis=1), off)

    def _signs(self) -> None:
        h = self._history
        for name in (
            *("contacts", "normal_force", "certificate", "residual", "newton_iterations"),
            *("blend", "step_defect", "retried_steps", "shortest_step"),
        ):
            self._rows("row: signs", np.maximum(-h[name], 0.0), 0.0)
        for name in ("contacts", "retried_steps"):
            self._rows("row: signs", h[name] % 1.0, 0.0)
        # A step that fails is halved, but for the one that a run fails with.
        longest = np.where(h["retried_steps"] > 0, 0.5, 1.0) * self._dt
        if self._summary["status"] == "failed":
            longest[-1] = self._dt
        off = SAFETY * EPS * self._end
        self._rows("row: signs", np.maximum(h["shortest_step"] - longest, 0.0), off)
        self._rows(
            "row: signs", ((h["contacts"] > 0) != (h["normal_force"] > 0)).astype(float), 0.0
        )
        limit = LARGEST_BLEND if self._model.blended else 0.0
        self._rows("row: signs", np.maximum(h["blend"] - limit, 0.0), 0.0)
        two_sided = any(side.two_sided for side in self._model.sides)
        if self._model.condition in ("gap", "massless") and self._model.sides and not two_sided:
            off = self._scales.penetration()
            self._rows("row: penetration", np.maximum(-h["min_gap"], 0.0), off)

    def _summary_energies(self) -> None:
        h, energy = self._history, self._summary["energy"]
        check = self._findings.check
        check("summary: energies", _number(energy["initial"]) - h["total"][0], 0.0, "initial")
        check("summary: energies", _number(energy["final"]) - h["total"][-1], 0.0, "final")
        for name in ("kinetic", "strain", *SUMMED):
            check("summary: energies", _number(energy[name]) - h[name][-1], 0.0, name)

    def _extremes(self) -> None:
        h, summary = self._history, self._summary
        energy = summary["energy"]
        off = ROUND_OFF * self._scales.energy
        for name, stored, rows in (
            ("drift", energy["max_drift"], np.abs(h["total"] - h["total"][0])),
            ("defect", energy["max_defect"], np.abs(h["defect"])),
            ("energy", self._largest_energy(), h["total"] + h["friction"]),
        ):
            self._extreme(name, _number(stored) - rows.max(), off, exact=self._every_step)
        certificate = summary["certificate"]
        for name, stored, rows in (
            ("certificate", certificate["max_joule"], h["certificate"]),
            ("residual", certificate["max_residual"], h["residual"]),
            ("blend", summary["max_blend"], h["blend"]),
            ("step_defect", energy["max_step_defect"], h["step_defect"]),
        ):
            # A row has the largest since the row before.
            self._extreme(name, _number(stored) - rows.max(), 0.0, exact=True)
        if summary["min_gap"] is not None:
            excess = h["min_gap"].min() - _number(summary["min_gap"])
            self._extreme("gap", excess, 0.0, exact=self._every_step)

    def _largest_energy(self) -> float:
        """Return the largest energy of the run [J], which the certificate is measured by."""
        allowed = _number(self._summary["certificate"]["tolerance_joule"])
        return allowed / self._model.scenario.contact.certificate_tolerance

    def _status(self) -> None:
        """Check that a run is called completed if it is, and if it keeps Coulomb's law."""
        summary, certificate = self._summary, self._summary["certificate"]
        status = summary["status"]
        kept = _number(certificate["max_joule"]) <= _number(certificate["tolerance_joule"])
        known = ("completed", "uncertified", "stopped", "failed", "interrupted")
        check = self._findings.check
        check("summary: status", float(status not in known), 0.0, f"{status!r}")
        if status == "failed":
            check("summary: status", float(self._times[-1] >= self._end), 0.0, "failed at the end")
        if status == "completed":
            check("summary: status", float(self._times[-1]) - self._end, 0.0, "end of the run")
        if status in ("completed", "uncertified", "stopped"):
            check("summary: status", float(kept == (status == "uncertified")), 0.0, "certificate")

    def _extreme(self, name: str, excess: float, off: float, *, exact: bool) -> None:
        """Check that an extreme is that of the rows, or at least not less."""
        figure = excess if exact or excess < 0 else 0.0
        self._findings.check("summary: extremes", figure, off, name)

    def _counts(self) -> None:
        summary, check = self._summary, self._findings.check
        end = float(self._times[-1])
        steps = np.ceil(end / self._dt - 1e-6)
        if summary["status"] == "failed":
            steps = min(steps, summary["steps"])
        dofs = sum(2 * (len(body.points) - len(body.images)) for body in self._model.bodies)
        for name, figure in (
            ("steps", summary["steps"] - steps),
            ("end_time", summary["end_time"] - end),
            ("time_step", summary["time_step"] - self._dt),
            ("dofs", summary["dofs"] - dofs),
        ):
            check("summary: counts", float(figure), 0.0, name)
        retried = float(self._history["retried_steps"].sum() - summary["retried_steps"])
        if summary["status"] == "failed":
            retried = max(retried, 0.0)  # the last ones may come after the last row
        check("summary: counts", retried, 0.0, "retried_steps")
        if not self._halved and len(self._steps):
            mean = self._history["newton_iterations"][1:]
            # The last step of a run may be a short one.
            steps_between = np.maximum(np.ceil(np.diff(self._times) / self._dt - 1e-6), 1.0)
            total = float(mean @ steps_between)
            off = SAFETY * EPS * total * len(mean)
            check("summary: counts", total - summary["newton_iterations"], off, "newton_iterations")

    def _events(self) -> None:
        h, events, check = self._history, self._summary["contacts"], self._findings.check
        touched = np.zeros(len(self._times))
        for event in events:
            release = np.inf if event["release"] is None else event["release"]
            check("summary: contacts", max(event["onset"] - release, 0.0), 0.0, "order of times")
            during = (self._times >= event["onset"]) & (self._times <= release)
            touched += np.where(during, event["peak_force"], 0.0)
        force = h["normal_force"]
        self._rows("summary: contacts", np.maximum(force - touched, 0.0), ROUND_OFF * force)
        if self._model.condition != "massless":
            # Without mass, friction in a step that ends without a reaction belongs to no event.
            total = sum(event["friction_work"] for event in events)
            last = float(h["friction"][-1])
            off = SAFETY * ROUND_OFF * max(abs(last), self._scales.energy * ROUND_OFF)
            check("summary: contacts", total - last, off, "friction_work")

    def force(self, time: float, names: frozenset[str], force: float) -> None:
        """Check that an event has the force with which a pair pressed at a time."""
        peaks = [
            _number(event["peak_force"])
            for event in self._summary["contacts"]
            if names == set(event["pair"])
            and event["onset"] <= time
            and (event["release"] is None or time <= event["release"])
        ]
        lacking = max(force - max(peaks, default=0.0), 0.0)
        where = f"{' – '.join(sorted(names))}, t = {time:g} s"
        self._findings.check("summary: contacts", lacking, PRESSED * force, where)


def _number(value: object) -> float:
    """Return a number of the summary; null, which stands for what is not finite, is not one."""
    return float(value) if isinstance(value, int | float) else float("nan")
