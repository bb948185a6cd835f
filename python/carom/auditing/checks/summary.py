"""Checks of the summary against case, history and what a run can be."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, get_args

import numpy as np

from carom.auditing.arrays import turning_axes
from carom.auditing.bodies.body import AuditBody
from carom.auditing.drives.supports import Supports
from carom.auditing.records.numbers import number
from carom.auditing.records.parts import SUMS, Part
from carom.auditing.records.rows import GRID, Rows
from carom.auditing.report import Findings
from carom.auditing.steps.scales import EPS, FLOOR, ROUND_OFF, SAFETY, Scales
from carom.io.summary_types import Status


class SummaryChecks:
    """Checks of the summary.

    Parameters
    ----------
    parts
        The stages of the run.
    scales
        The magnitudes of the last of them.
    findings
        Where what is found goes.
    rows
        The history.
    summary
        What ``summary.json`` says.
    """

    def __init__(
        self,
        parts: Sequence[Part],
        scales: Scales,
        findings: Findings,
        rows: Rows,
        summary: Mapping[str, Any],
    ) -> None:
        self._parts, self._models = parts, [part.model for part in parts]
        self._model, self._scales, self._findings = self._models[-1], scales, findings
        self._rows, self._history, self._summary = rows, rows.history, summary
        self._end = self._model.scenario.end_time

    def all(self) -> None:
        """Check everything."""
        self._energies()
        self._extremes()
        self._friction()
        self._repaid()
        self._counts()
        self._run()
        self._status()
        if self._model.scenario.stages:
            self._stages()

    def _energies(self) -> None:
        h, energy = self._history, self._summary["energy"]
        check = self._findings.check
        # What goes on from another run is summed anew.
        begun = ROUND_OFF * self._scales.energy if self._model.scenario.initial else 0.0
        check("summary: energies", number(energy["initial"]) - h["total"][0], begun, "initial")
        check("summary: energies", number(energy["final"]) - h["total"][-1], 0.0, "final")
        for name in ("kinetic", "strain", "springs", *SUMS):
            check("summary: energies", number(energy[name]) - h[name][-1], 0.0, name)

    def _extremes(self) -> None:
        h, summary, every = self._history, self._summary, self._rows.complete
        energy, certificate = summary["energy"], summary["certificate"]
        off = ROUND_OFF * self._scales.energy
        for name, stored, rows, allowed in (
            ("energy.max_drift", energy["max_drift"], np.abs(h["total"] - h["total"][0]), off),
            ("energy.max_defect", energy["max_defect"], np.abs(h["defect"]), 0.0),
        ):
            self._extreme(name, number(stored) - rows.max(), allowed, exact=every)
        for name, stored, rows in (
            ("certificate.max_joule", certificate["max_joule"], h["certificate"]),
            ("certificate.max_residual", certificate["max_residual"], h["residual"]),
            ("max_blend", summary["max_blend"], h["blend"]),
            ("penetration.max_depth", summary["penetration"]["max_depth"], h["penetration"]),
            ("energy.max_step_defect", energy["max_step_defect"], h["step_defect"]),
        ):
            # A row has the largest since the row before.
            self._extreme(name, number(stored) - rows.max(), 0.0, exact=True)
        self._tolerance(off)
        worst = summary["penetration"]["worst"]
        if worst is not None:
            over = number(worst["depth"]) - number(summary["penetration"]["max_depth"])
            self._findings.check("summary: extremes", max(over, 0.0), 0.0, "penetration.worst")
        self._findings.leave(
            "where and when solids were deepest in one another", "summary.json: penetration"
        )
        if summary["min_gap"] is not None:
            excess = h["min_gap"].min() - number(summary["min_gap"])
            self._extreme("min_gap", excess, 0.0, exact=every)
        ruled = all(model.condition in ("gap", "massless") for model in self._models)
        if ruled and self._model.sides:
            mixed = any(model.mixed for model in self._models)
            one_sided = not mixed and all(side.ruled_by_gaps for side in self._model.sides)
            depth = -number(summary["min_gap"]) if summary["min_gap"] is not None else 0.0
            if one_sided:
                allowed = self._scales.penetration()
                self._findings.check("summary: extremes", max(depth, 0.0), allowed, "min_gap")

    def _extreme(self, name: str, excess: float, off: float, *, exact: bool) -> None:
        """Check that an extreme is that of the rows, or at least not less."""
        figure = excess if exact or excess < 0 else 0.0
        self._findings.check("summary: extremes", figure, off, name)
        if not exact:
            self._findings.leave(
                "extremes between two rows",
                f"summary.json: {name}",
                store="output.history_every = the time step, and no halved steps",
            )

    def _friction(self) -> None:
        """Check that the run's least friction says whether friction of any step gave energy."""
        least, h = number(self._summary["least_friction"]), self._history
        self._findings.check("summary: extremes", max(least, 0.0), 0.0, "least_friction")
        if any(model.gives_back for model in self._models):
            self._findings.leave("the least friction of a step", "summary.json: least_friction")
            return
        # No step may give back more than this, and none can have taken less than nothing.
        longest = max(part.rows.dt for part in self._parts)
        slip = self._scales.displacement_in(np.array(longest)) + self._scales.travel
        off = SAFETY**2 * float(slip) * float(h["normal_force"].max()) + (
            ROUND_OFF * self._scales.energy
        )
        self._findings.check("summary: extremes", min(least, 0.0), off, "least_friction")
        self._findings.leave(
            "the least friction of a step, which is round-off", "summary.json: least_friction"
        )

    def _repaid(self) -> None:
        """Check that vibration took or gave nothing where no stresses are blended."""
        repaid = number(self._summary["repaid"])
        if not any(model.blended for model in self._models):
            self._findings.check("summary: extremes", repaid, 0.0, "repaid")
            return
        self._findings.check("summary: extremes", min(repaid, 0.0), 0.0, "repaid")
        self._findings.leave(
            "what vibrations took or gave of what blends left over, in all steps together",
            "summary.json: repaid",
        )

    def _tolerance(self, off: float) -> None:
        """Check what the certificate is measured by: the largest energy, or work of reactions."""
        certificate, h, check = self._summary["certificate"], self._history, self._findings.check
        share = self._model.contact.certificate_tolerance
        allowed = number(certificate["tolerance_joule"])
        largest = float((h["total"] + h["friction"]).max())
        if "reference_joule" not in certificate:
            excess = allowed / share - largest
            self._extreme("certificate.tolerance_joule", excess, off, exact=self._rows.complete)
            return
        reference = number(certificate["reference_joule"])
        check("summary: extremes", allowed - share * reference, EPS * allowed, "tolerance_joule")
        excess = reference - largest
        self._extreme("certificate.reference_joule", min(excess, 0.0), off, exact=True)
        if excess > off:
            self._findings.leave(
                "what the certificate is measured by, where that is work of reactions or between "
                "two rows",
                "summary.json: certificate.reference_joule",
            )
        solver = number(certificate.get("solver_joule", 0.0))
        check("summary: extremes", max(-solver, 0.0), 0.0, "solver_joule")
        self._findings.leave(
            "how much of the certificate the contact solver left",
            "summary.json: certificate.solver_joule",
        )

    def _counts(self) -> None:
        rows, summary, check = self._rows, self._summary, self._findings.check
        end = float(rows.times[-1])
        spans = [(part.end - part.model.stage.start_time) / part.rows.dt for part in self._parts]
        steps = sum(np.ceil(span - GRID) for span in spans)
        if summary["status"] == "failed":
            steps = min(steps, summary["steps"])
        dofs = sum(_unknowns(body) for body in self._model.bodies)
        dofs -= sum(
            _given(body, supports)
            for body, supports in zip(self._model.bodies, self._model.supports, strict=True)
        )
        for name, figure in (
            ("steps", summary["steps"] - steps),
            ("end_time", summary["end_time"] - end),
            ("time_step", summary["time_step"] - rows.dt),
        ):
            check("summary: counts", float(figure), 0.0, name)
        if self._model.whole:
            # Which nodes of a body are fixed nobody but its code says.
            check("summary: counts", float(summary["dofs"] - dofs), 0.0, "dofs")
        if "size" in summary:
            off = ROUND_OFF * self._model.size
            check("summary: counts", number(summary["size"]) - self._model.size, off, "size")
        retried = float(self._history["retried_steps"].sum() - summary["retried_steps"])
        if summary["status"] == "failed":
            retried = max(retried, 0.0)  # the last ones may come after the last row
        check("summary: counts", retried, 0.0, "retried_steps")
        self._newton()

    def _newton(self) -> None:
        """Check that every row has whole iterations, and as many as are said.

        What a row has is their mean over its steps. Where all bodies rest steps have none: then no
        strain changes.
        """
        rows, check = self._rows, self._findings.check
        known = np.isfinite(rows.steps)
        mean, steps = self._history["newton_iterations"][known], rows.steps[known]
        count = mean * steps
        off = SAFETY * EPS * np.maximum(count, 1.0)
        check("summary: counts", count - np.rint(count), off, "newton_iterations of rows")
        strain = self._history["strain"]
        change = np.abs(np.diff(strain, prepend=strain[:1]))[known]
        idle = np.where((steps > 0.0) & (np.rint(count) == 0.0), change, 0.0)
        size = SAFETY * EPS * float(np.abs(strain).max(initial=0.0))
        check("summary: counts", idle, size, "newton_iterations of rows")
        most = max(model.analysis.newton.max_iterations for model in self._models)
        # A step that contacts turn up in is repeated, four times in all.
        check("summary: counts", np.maximum(mean - 4 * most, 0.0), off, "newton_iterations of rows")
        said = float(self._summary["newton_iterations"])
        total = float(np.rint(count).sum())
        if known.all():
            check("summary: counts", total - said, 0.0, "newton_iterations")
        else:
            check("summary: counts", max(total - said, 0.0), 0.0, "newton_iterations")
            self._findings.leave(
                "iterations of the nominal step that failed",
                "summary.json: newton_iterations",
                "history.csv: newton_iterations",
            )

    def _run(self) -> None:
        """Check what the summary says of the run as such."""
        summary, check = self._summary, self._findings.check
        scenario = self._model.scenario
        check("summary: run", float(summary["title"] != scenario.title), 0.0, "title")
        wall, per_step = number(summary["wall_s"]), number(summary["wall_s_per_step"])
        check("summary: run", max(-wall, 0.0), 0.0, "wall_s")
        error = per_step - wall / max(summary["steps"], 1)
        check("summary: run", error, SAFETY * EPS * wall, "wall_s_per_step")
        asked = scenario.contact.solver.cross_check
        answered = summary["cross_check"] is not None
        check("summary: run", float(asked != answered), 0.0, "cross_check")
        check("summary: run", float(summary["factorisations"] < 0), 0.0, "factorisations")
        leave = self._findings.leave
        leave("which version ran", "summary.json: version")
        leave("how often matrices were factorised", "summary.json: factorisations")
        if answered:
            leave("what a second solver said", "summary.json: cross_check")

    def _stages(self) -> None:
        """Check what the summary says of stages: their times, and what their ledgers gained."""
        check, said = self._findings.check, self._summary["stages"]
        check("summary: stages", float(len(said) != len(self._parts)), 0.0, "number")
        for part, own in zip(self._parts, said, strict=False):
            stage, rows = part.model.stage, part.rows
            at = own["name"]
            check("summary: stages", float(at != stage.name), 0.0, at)
            for name, figure in (
                ("start_time", own["start_time"] - stage.start_time),
                ("end_time", own["end_time"] - part.end),
                ("time_step", own["time_step"] - rows.dt),
                ("steps", own["steps"] - np.ceil((part.end - stage.start_time) / rows.dt - GRID)),
                ("retried_steps", own["retried_steps"] - rows.history["retried_steps"].sum()),
            ):
                check("summary: stages", float(figure), 0.0, f"{at}, {name}")
            h, energy = rows.history, own["energy"]
            size = sum(float(np.abs(self._history[name]).max()) for name in SUMS)
            off = ROUND_OFF * (self._scales.energy + size)
            for name in SUMS:
                check("summary: stages", number(energy[name]) - h[name][-1], off, f"{at}, {name}")
            for name, column in (("final", "total"), ("kinetic", "kinetic"), ("strain", "strain")):
                check("summary: stages", number(energy[name]) - h[column][-1], off, f"{at}, {name}")
            check("summary: stages", number(energy["initial"]) - h["total"][0], off, at)
            worst = h["step_defect"].max() - number(energy["max_step_defect"])
            check("summary: stages", worst, 0.0, f"{at}, max_step_defect")
            for name, rows_of in (
                ("max_drift", np.abs(h["total"] - h["total"][0])),
                ("max_defect", np.abs(h["defect"])),
            ):
                short = float(rows_of.max()) - number(energy[name])
                check("summary: stages", max(short, 0.0), off, f"{at}, {name}")
            for entry in (*own["bodies"], *own["pairs"]):
                key = entry["name"] if "name" in entry else "|".join(entry["between"])
                columns = part.ledger.get(key, {})
                for name in columns.keys() & entry.keys() - {"time"}:
                    error = number(entry[name]) - columns[name][-1]
                    check("summary: stages", error, off, f"{at}, {key}, {name}")

    def _status(self) -> None:
        """Check that a run is called completed if it is, and if it keeps Coulomb's law."""
        summary, certificate = self._summary, self._summary["certificate"]
        status, end = summary["status"], float(self._rows.times[-1])
        kept = number(certificate["max_joule"]) <= number(certificate["tolerance_joule"])
        known = get_args(Status)
        # So many steps of so much are not quite the end.
        slack = FLOOR * abs(self._end)
        check = self._findings.check
        check("summary: status", float(status not in known), 0.0, f"{status!r}")
        if status == "failed":
            check("summary: status", float(end >= self._end - slack), 0.0, "failed at the end")
        if status == "completed":
            check("summary: status", end - self._end, slack, "end of the run")
        worst = summary["penetration"]["worst"]
        apart = worst is None or number(worst["depth"]) <= number(worst["allowed"])
        if status in ("completed", "intersecting", "stopped") and kept:
            check("summary: status", float(apart == (status == "intersecting")), 0.0, "penetration")
        if status in ("completed", "uncertified", "intersecting", "stopped"):
            check("summary: status", float(kept == (status == "uncertified")), 0.0, "certificate")


def _unknowns(body: AuditBody) -> int:
    if body.modes is not None:
        return body.dimension * len(body.surface) + body.modes
    if body.rigid:
        return body.dimension + turning_axes(body.dimension)
    return body.dimension * (len(body.points) - len(body.images))


def _given(body: AuditBody, supports: Supports) -> int:
    """Return how many unknowns of a body are given."""
    if supports.guide is not None:
        guiding = supports.guide.at(0.0)
        return int(guiding.along.sum() + guiding.about.sum())
    return int(supports.held[body.masters == np.arange(len(body.points))].sum())
