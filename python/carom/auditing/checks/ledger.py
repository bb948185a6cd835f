"""Checks of the books of bodies and pairs: against the whole, the states and the stored steps."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from carom.auditing.arrays import AXES, Array
from carom.auditing.checks.pushes import beyond_pushes
from carom.auditing.model import AuditModel
from carom.auditing.records.files import Frame
from carom.auditing.report import Findings
from carom.auditing.steps.scales import ROUND_OFF, Scales
from carom.auditing.steps.step import Step
from carom.ledger_terms import TERMS, names

BODY_COLUMNS = (*names("body"), "defect")
PAIR_COLUMNS = names("pair")

Entry = Mapping[str, Array]


class LedgerChecks:
    """Checks of ``ledger.csv``, and of what the summary says of bodies and pairs.

    Parameters
    ----------
    model, scales
        The model and its magnitudes.
    findings
        Where what is found goes.
    ledger
        The columns of every body and of every pair ``a|b`` that has touched.
    history, summary
        What ``history.csv`` and ``summary.json`` say.
    gives
        Whether bodies were given velocities, whose work the books have as ``external``.
    """

    def __init__(
        self,
        model: AuditModel,
        scales: Scales,
        findings: Findings,
        ledger: Mapping[str, Entry],
        *,
        history: Entry,
        summary: Mapping[str, Any],
        gives: bool = False,
    ) -> None:
        self._gives = gives
        self._model, self._scales = model, scales
        self._check, self._leave = findings.check, findings.leave
        self._history, self._summary = history, summary
        self._times = history["time"]
        self._pairs = {f"{a}|{b}": frozenset((a, b)) for a, b in model.pairs()}
        none = dict.fromkeys(("time", *BODY_COLUMNS, *PAIR_COLUMNS), np.zeros(0))
        self._bodies = {body.name: ledger.get(body.name, none) for body in model.bodies}
        self._touched = {name: ledger[name] for name in self._pairs if name in ledger}
        self._unknown = sorted(ledger.keys() - self._bodies.keys() - self._pairs.keys())
        self._energies: list[tuple[float, float]] = []
        self._whole = True

    def all(self) -> None:
        """Check all rows."""
        self._rows()
        if not self._whole:
            return
        self._sums()
        self._entries()

    def books(self) -> None:
        """Check the summary against the last rows."""
        self._rows()
        if self._whole:
            self._summary_books()

    def _rows(self) -> None:
        """Check that there is a row of every body at every time, and of pairs from a time on."""
        self._check("books: rows", [1.0 for _ in self._unknown], 0.0, ", ".join(self._unknown))
        for name, entry in (*self._bodies.items(), *self._touched.items()):
            times = entry["time"]
            count = len(times) if name in self._touched else len(self._times)
            fits = len(times) == count <= len(self._times)
            fits = fits and np.array_equal(times, self._times[len(self._times) - count :])
            self._check("books: rows", float(not fits), 0.0, name)
            self._whole = self._whole and fits

    def _padded(self, name: str, column: str) -> Array:
        """Return a column of a pair at all times, 0 before it touched."""
        entry = self._touched.get(name)
        values = np.zeros(0) if entry is None else entry[column]
        return np.concatenate([np.zeros(len(self._times) - len(values)), values])

    def _sums(self) -> None:
        h = self._history
        for name in sorted(set(names("body")) & set(names("run")) - set(PAIR_COLUMNS)):
            if name == "scheme" and self._model.springs and self._model.xi != 0.5:
                continue  # It takes from springs too.
            parts = [entry[name] for entry in self._bodies.values()]
            whole = h[name] - (h[name][0] if name in ("kinetic", "strain") else 0.0)
            self._sum(name, parts, whole)
        pulled = any(spring.carried for spring in self._model.springs)
        for name in PAIR_COLUMNS:
            if name == "prescribed" and pulled:
                continue  # Obstacles pull at springs too.
            parts = [self._padded(pair, name) for pair in self._pairs]
            if name == "prescribed":
                parts += [entry[name] for entry in self._bodies.values()]
            self._sum(name, parts, h[name])
        if not self._model.blended:
            # All that reactions do, they do to bodies.
            parts = [entry["contact"] for entry in self._bodies.values()]
            given = sum(
                (
                    -term.sign * self._padded(pair, term.name)
                    for term in TERMS
                    if "pair" in term.books
                    for pair in self._pairs
                ),
                np.zeros(len(self._times)),
            )
            self._sum("contact", parts, given)

    def _sum(self, name: str, parts: list[Array], whole: Array) -> None:
        total = sum(parts, np.zeros(len(whole)))
        size = sum((np.abs(part) for part in parts), np.abs(whole))
        off = self._scales.sums * (self._scales.energy + size)
        self._check("books: sums", total - whole, off, name)

    def _entries(self) -> None:
        model, h = self._model, self._history
        for number, body in enumerate(model.bodies):
            entry = self._bodies[body.name]
            known = sum(term.sign * entry[term.name] for term in TERMS if "body" in term.books)
            size = sum(np.abs(entry[name]) for name in BODY_COLUMNS)
            off = ROUND_OFF * (self._scales.energy + size)
            self._check("books: defect", entry["defect"] - known, off, body.name)
            centre = np.stack(
                [h[f"{body.name}.{axis}"] for axis in AXES[: model.dimension]], axis=1
            )
            weight = self._scales.masses[number] * model.gravity
            reach = float(np.linalg.norm(weight)) * (self._scales.reach + model.size)
            steps = max(float(self._summary["steps"]), 1.0)
            off = ROUND_OFF * (self._scales.energy + (1 + steps / 1e3) * reach)
            if not (model.supported(body) or body.growth.acts):
                nothing = entry["prescribed"]
                self._check("books: external", nothing, 0.0, f"{body.name}, no supports")
            if not model.connected(body):
                nothing = entry["connections"]
                self._check("books: external", nothing, 0.0, f"{body.name}, no springs")
            work = (centre - centre[0]) @ weight
            if body.known and not model.loaded(body) and not self._gives:
                error = beyond_pushes(model, h, entry["external"] - work)
                self._check("books: external", error, off, body.name)
        rubs = not model.gives_back or self._summary["least_friction"] >= 0
        for name, entry in self._touched.items():
            if rubs:
                fall = np.maximum(-np.diff(entry["friction"], prepend=0.0), 0.0)
                off = ROUND_OFF * self._scales.energy + self._scales.certified
                self._check("books: friction", fall, off, name)

    def _summary_books(self) -> None:
        bodies, pairs = self._summary["bodies"], self._summary["pairs"]
        count = abs(len(bodies) - len(self._bodies)) + abs(len(pairs) - len(self._pairs))
        self._check("summary: books", float(count), 0.0, "number of bodies and pairs")
        for said, (name, entry) in zip(bodies, self._bodies.items(), strict=False):
            self._check("summary: books", float(said["name"] != name), 0.0, name)
            for column in BODY_COLUMNS:
                error = said[column] - entry[column][-1]
                self._check("summary: books", error, 0.0, f"{name}, {column}")
        for said, (name, between) in zip(pairs, self._pairs.items(), strict=False):
            touched = name in self._touched
            alike = set(said["between"]) == between and said["has_touched"] == touched
            self._check("summary: books", float(not alike), 0.0, name)
            for column in PAIR_COLUMNS:
                error = said[column] - self._padded(name, column)[-1]
                self._check("summary: books", error, 0.0, f"{name}, {column}")

    def frame(self, frame: Frame) -> None:
        """Check the changes of energy of bodies up to an output time."""
        energies = [
            (
                body.kinetic_energy(frame.displacement[body.span], frame.velocity[body.span]),
                body.strain_energy(frame.displacement[body.span], body.growth.at(frame.time)),
            )
            for body in self._model.known
        ]
        self._energies = self._energies or energies
        for body, now, start in zip(self._model.known, energies, self._energies, strict=True):
            entry = self._bodies[body.name]
            off = 2 * self._scales.sums * self._scales.energy
            strain = off + self._scales.strain(body, frame.displacement[body.span], frame.time)
            for row in np.flatnonzero(entry["time"] == frame.time):
                at = f"{body.name}, t = {frame.time:g} s"
                error = entry["kinetic"][row] - (now[0] - start[0])
                self._check("books: energies", error, off, at)
                error = entry["strain"][row] - (now[1] - start[1])
                self._check("books: energies", error, strain, at)

    def step(self, step: Step) -> None:
        """Check that the rows at the ends of a stored step differ by its terms."""
        rows = [np.flatnonzero(self._times == t) for t in (float(step.start["time"]), step.time)]
        if not self._whole or not all(len(row) for row in rows):
            return
        before, after = (int(row[0]) for row in rows)
        scales, model = self._scales, self._model
        reactions = sum(np.abs(work.found.reaction).sum() for work in step.work.all)
        work = float(reactions) * scales.geometry(step)
        for index, (body, terms) in enumerate(zip(model.bodies, step.body_terms, strict=True)):
            if not body.known:
                continue
            strain = sum(scales.strain(body, u[body.span], t) for u, t in step.ends)
            resisted = scales.resisted(step, index)
            more = {"strain": strain, "plastic": strain, "contact": strain + work}
            more |= {"viscous": resisted, "prescribed": resisted + strain * body.growth.acts}
            if model.static:
                # What contact does in the mean of the step is the scheme's, too.
                more["scheme"] = strain + work
            if step.starts_elsewhere and step.uses_start:
                more |= dict.fromkeys(("scheme", "contact"), strain + work + step.work.doubt)
            entry = self._bodies[body.name]
            for name, term in terms.items():
                change = entry[name][after] - entry[name][before]
                off = 2 * ROUND_OFF * (scales.energy + abs(entry[name][after])) + more.get(name, 0)
                self._check(
                    "books: steps", change - term, off, f"{body.name}, {name}, t = {step.time:g} s"
                )
        self._pair_steps(step, before, after, 2 * ROUND_OFF * scales.energy + work)

    def _pair_steps(self, step: Step, before: int, after: int, off: float) -> None:
        """Check how rows of pairs differ by the work of their contacts, up to `off` [J]."""
        model = self._model
        terms_of = {name: dict.fromkeys(PAIR_COLUMNS, 0.0) for name in self._pairs}
        names = {between: name for name, between in self._pairs.items()}
        for part in step.work.all:
            for k, key in enumerate(zip(part.found.source, part.found.target, strict=True)):
                pair = names.get(frozenset(model.name(int(index)) for index in key))
                if pair is not None:
                    for column, values in part.terms.items():
                        terms_of[pair][column] += float(values[k])
        for name, terms in terms_of.items():
            for column, term in terms.items():
                values = self._padded(name, column)
                if step.untold(term):
                    continue
                error = values[after] - values[before] - term
                allowed = off + 2 * ROUND_OFF * abs(values[after]) + step.work.doubt
                at = f"{name}, {column}, t = {step.time:g} s"
                self._check("books: steps", error, allowed, at)

    def friction_on(self, body: str, time: float) -> float | None:
        """Return the part of friction that is left on the boundary of a body at a time [J].

        Half of what two bodies share, all of what one has with an obstacle; none without a row.
        """
        row = np.flatnonzero(self._times == time)
        if not self._whole or len(row) == 0:
            return None
        bodies = self._bodies.keys()
        return sum(
            float(self._padded(name, "friction")[row[0]]) / len(between & bodies)
            for name, between in self._pairs.items()
            if body in between
        )
