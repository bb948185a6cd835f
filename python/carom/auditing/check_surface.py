"""Checks of the fields on boundaries: areas, pressures, and where friction left its energy."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from carom.auditing.arrays import Array
from carom.auditing.files import Facets, Frame, SurfaceFrame
from carom.auditing.model import AuditModel
from carom.auditing.report import Findings
from carom.auditing.scales import EPS, ROUND_OFF, SAFETY, Scales


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
            (index, *sorted(facet))
            for index, body in enumerate(model.bodies)
            for facet in (body.facets + body.span.start).tolist()
        ]
        theirs = [
            (int(index), *sorted(facet))
            for index, facet in zip(self._body, self._facets.tolist(), strict=True)
        ]
        self._known = sorted(mine) == sorted(theirs)
        self._check("surface: facets", float(not self._known), 0.0, "facets that may touch")
        self._check("surface: facets", facets.points - model.points, 0.0, "points")
        if self._known:
            thickness = np.array([entry.thickness for entry in model.scenario.bodies])
            chord = self._chords(model.points)
            self._area = np.linalg.norm(chord, axis=1) * thickness[self._body]
            # The body is on the left of a facet of ours.
            left = {(a, b) for _, a, b in self._directed()}
            turned = [(int(a), int(b)) not in left for a, b in self._facets]
            self._sign = np.where(turned, -1.0, 1.0)[:, None]
            self._around = np.zeros(len(model.points))
            np.add.at(self._around, self._facets, self._area[:, None])
        self._last: Array | None = None

    def _directed(self) -> list[tuple[int, int, int]]:
        return [
            (index, a + body.span.start, b + body.span.start)
            for index, body in enumerate(self._model.bodies)
            for a, b in body.facets.tolist()
        ]

    def _chords(self, position: Array) -> Array:
        chords: Array = position[self._facets[:, 1]] - position[self._facets[:, 0]]
        return chords

    def frame(
        self,
        fields: SurfaceFrame | None,
        frame: Frame,
        friction: float | None,
        share: Callable[[str, float], float | None],
    ) -> None:
        """Check the fields of an output time.

        Parameters
        ----------
        fields
            The fields; None if there are none.
        frame
            Those of the bodies at that time.
        friction
            What the history says of friction [J], if it has a row of that time.
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
        self._pressure(fields.pressure, frame, where)
        left = fields.friction_energy * fields.area
        size = float(np.abs(left).sum()) + ROUND_OFF * self._scales.energy
        if friction is not None:
            off = ROUND_OFF * (size + abs(friction))
            self._check("surface: friction", left.sum() - friction, off, where)
        for index, body in enumerate(self._model.bodies):
            wanted = share(body.name, frame.time)
            if wanted is not None:
                off = ROUND_OFF * (size + abs(wanted))
                error = left[self._body == index].sum() - wanted
                self._check("surface: friction", error, off, f"{body.name}, {where}")
        if self._growing:
            last = np.zeros(len(left)) if self._last is None else self._last
            fall = np.maximum(last - left, 0.0)
            off = ROUND_OFF * self._scales.energy
            self._check("surface: friction", fall, off, f"{where}, falls")
        self._last = left

    def _pressure(self, pressure: Array, frame: Frame, where: str) -> None:
        chord = self._sign * self._chords(self._model.points + frame.displacement)
        length = np.linalg.norm(chord, axis=1, keepdims=True)
        normal = np.stack([chord[:, 1], -chord[:, 0]], axis=1) / length
        per_area = (frame.reaction / np.where(self._around > 0, self._around, 1.0)[:, None])[
            self._facets
        ].sum(axis=1)
        mine = -(per_area * normal).sum(axis=1)
        turn = SAFETY * EPS * (self._model.size + self._scales.reach) / length[:, 0]
        off = np.abs(per_area).sum(axis=1) * (ROUND_OFF + turn)
        self._check("surface: pressure", pressure - mine, off, where)
