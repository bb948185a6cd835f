"""Checks of the fields on boundaries: areas, pressures, and where friction left its energy."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from carom.auditing.arrays import Array
from carom.auditing.model import AuditModel
from carom.auditing.records.files import Facets, Frame, SurfaceFrame
from carom.auditing.report import Findings
from carom.auditing.steps.contacts import BEARS, Contacts
from carom.auditing.steps.scales import EPS, ROUND_OFF, SAFETY, Scales


class SurfaceChecks:
    """Checks of ``surface.vtkhdf``.

    Parameters
    ----------
    model, scales
        The model and its magnitudes.
    findings
        Where what is found goes.
    facets
        The mesh of the file.
    growing
        Whether friction may only leave energy, never take it back.
    """

    def __init__(
        self,
        model: AuditModel,
        scales: Scales,
        findings: Findings,
        facets: Facets,
        *,
        growing: bool,
    ) -> None:
        self._model, self._scales, self._check = model, scales, findings.check
        self._growing = growing
        self._facets, self._body = facets.nodes, facets.body
        mine = [
            (index, *sorted(set(facet)))
            for index, body in enumerate(model.bodies)
            for facet in (body.facets + body.span.start).tolist()
        ]
        theirs = [
            (int(index), *sorted(set(facet)))
            for index, facet in zip(self._body, self._facets.tolist(), strict=True)
        ]
        self._known = sorted(mine) == sorted(theirs)
        self._check("surface: facets", float(not self._known), 0.0, "facets that may touch")
        self._check("surface: facets", facets.points - model.points, 0.0, "points")
        if self._known:
            # Ours are outward; those of the file may have another order.
            ours = {
                frozenset(facet): (index, own)
                for index, body in enumerate(model.bodies)
                for own, facet in enumerate((body.facets + body.span.start).tolist())
            }
            self._own = [ours[frozenset(facet)] for facet in self._facets.tolist()]
            areas = [body.facet_areas for body in model.bodies]
            self._area = np.array([areas[index][own] for index, own in self._own])
        self._last: Array | None = None
        self._pressure = np.zeros(len(self._facets))

    def _normals(self, position: Array) -> Array:
        """Return outward normals of the facets of the file, shape [facet_count, D]."""
        normals = [b.faces(b.facets).normals(position[b.span]) for b in self._model.bodies]
        return np.array([normals[index][own] for index, own in self._own])

    def frame(
        self,
        fields: SurfaceFrame | None,
        frame: Frame,
        row: Mapping[str, float] | None,
        share: Callable[[str, float], float | None],
    ) -> None:
        """Check the fields of an output time.

        Parameters
        ----------
        fields
            The fields; None if there are none.
        frame
            Those of the bodies at that time.
        row
            The row of the history of that time, if it has one.
        share
            What the ledger says of friction on a body at a time [J], if it has a row.
        """
        where = f"t = {frame.time:g} s"
        if fields is None or not self._known:
            self._check("surface: frames", 1.0, 0.0, f"{where}, missing")
            return
        self._check("surface: frames", fields.time - frame.time, 0.0, f"{where}, time")
        self._check("surface: frames", fields.flat, 0.0, f"{where}, out of the plane")
        error = fields.displacement - frame.displacement
        self._check("surface: frames", error, 0.0, f"{where}, displacement")
        off = ROUND_OFF * self._area + SAFETY * EPS * np.abs(self._model.points).max()
        self._check("surface: areas", fields.area - self._area, off, where)
        self._pressures(fields.pressure, frame, row, where)
        left = fields.friction_energy * fields.area
        size = float(np.abs(left).sum()) + ROUND_OFF * self._scales.energy
        if row is not None:
            off = ROUND_OFF * (size + abs(row["friction"]))
            self._check("surface: friction", left.sum() - row["friction"], off, where)
        for index, body in enumerate(self._model.bodies):
            wanted = share(body.name, frame.time)
            if wanted is not None:
                off = ROUND_OFF * (size + abs(wanted))
                error = left[self._body == index].sum() - wanted
                self._check("surface: friction", error, off, f"{body.name}, {where}")
        if self._growing:
            last = np.zeros(len(left)) if self._last is None else self._last
            fall = np.maximum(last - left, 0.0)
            off = ROUND_OFF * self._scales.energy + self._scales.certified
            self._check("surface: friction", fall, off, f"{where}, falls")
        self._last = left

    def _pressures(
        self, pressure: Array, frame: Frame, row: Mapping[str, float] | None, where: str
    ) -> None:
        """Check what pressures are without the contacts: they push, and where there is a force."""
        self._pressure, size = pressure, float(np.abs(pressure).max(initial=0.0))
        self._check("surface: pressure", np.maximum(-pressure, 0.0), 0.0, f"{where}, pulls")
        free = ~(frame.reaction[self._facets] != 0.0).any(axis=(1, 2))
        self._check("surface: pressure", pressure[free], 0.0, f"{where}, of nothing")
        if row is not None and frame.time > self._model.stage.start_time:
            # Bodies that touch one another both bear what they press with.
            whole, force = float((pressure * self._area).sum()), row["normal_force"]
            most = force * (2.0 if any(side.target >= 0 for side in self._model.sides) else 1.0)
            if self._model.coheres:
                most = np.inf  # What pulls takes from the sum, and is no pressure.
            error = max(force - whole, whole - most, 0.0)
            off = ROUND_OFF * (abs(force) + size * float(self._area.sum()))
            off += self._scales.least_reaction(self._model.analysis.time_step)
            self._check("surface: pressure", error, off, f"{where}, in sum")

    def borne(self, contacts: Contacts, frame: Frame, moved: float) -> None:
        """Check the pressures of the last output time against the contacts of its step.

        Parameters
        ----------
        contacts
            The contacts, where the condition is written.
        frame
            The fields of the bodies at the end of the step.
        moved
            How far feet may be off, in lengths of facets.
        """
        if not self._known:
            return
        position = self._model.points + frame.displacement
        normals = self._normals(position)
        edges = position[self._facets[:, 1]] - position[self._facets[:, 0]]
        length = np.linalg.norm(edges, axis=1)
        mine, off = np.zeros(len(self._area)), np.zeros(len(self._area))
        turn = SAFETY * EPS * (self._model.size + self._scales.reach) / float(length.min())
        for k in range(len(contacts)):
            # What pulls is no pressure.
            force, normal = float(contacts.normal_force[k]), contacts.normal[k]
            force = max(force, 0.0) if contacts.adhesion[k] > 0.0 else force
            loads = [(node, share, normal) for node, share in contacts.borne(k)]
            loads += [(node, share, -normal) for node, share in contacts.passed_on(k)]
            for node, share, towards in loads:
                # The run's normal is that of its last guess.
                slack = SAFETY * np.linalg.norm(contacts.reaction[k]) * contacts.normal_error[k]
                facing = -normals @ towards
                into = (mine, off)
                self._bear(node, share * force, facing, into, turn=turn, slack=float(slack))
        where = f"t = {frame.time:g} s"
        # The run may have a foot at a node on the other facet there, with nodes that bear nothing.
        off += (SAFETY * ROUND_OFF + moved) * self._pressure.max(initial=0.0)
        off += self._scales.least_reaction(self._model.analysis.time_step) / self._area
        self._check("surface: pressure", self._pressure - mine, off, where)

    def _bear(
        self,
        node: int,
        force: float,
        facing: Array,
        into: tuple[Array, Array],
        *,
        turn: float,
        slack: float,
    ) -> None:
        """Add the pressures of a force on a node, and how far they may be off, to its facets."""
        around = np.flatnonzero((self._facets == node).any(axis=1))
        best = facing[around].max()
        weight = np.where(facing[around] >= BEARS * best, self._area[around] * facing[around], 0.0)
        if best <= 0.0:
            weight = self._area[around]
        pressures = force * weight / weight.sum() / self._area[around]
        np.add.at(into[0], around, pressures)
        # A facet that faces it just well enough, or just not.
        doubt = np.abs(facing[around] - BEARS * best) <= turn
        off = (abs(force) * (ROUND_OFF + turn + doubt.any()) + slack) / self._area[around]
        np.add.at(into[1], around, off)
