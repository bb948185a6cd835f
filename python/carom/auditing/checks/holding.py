"""Checks of what holds contacts together: by how much, which, and that it does no work."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from carom.auditing.contact.holding import Holding
from carom.auditing.model import AuditModel
from carom.auditing.report import Findings
from carom.auditing.steps.bearing import bearing_area
from carom.auditing.steps.contacts import Contacts
from carom.auditing.steps.ruled import Ruled
from carom.auditing.steps.scales import ROUND_OFF, Scales
from carom.auditing.steps.sites import AT_MULTIPLIER, AT_NODE
from carom.auditing.steps.step import Step

CLOSED = 1e-9
"""Contacts with gaps up to this at the start, in sizes of the smaller body, are closed."""

Key = tuple[int, ...]


class HoldingChecks:
    """Checks of adhesion, step after step.

    Parameters
    ----------
    model, scales
        The model and its magnitudes.
    findings
        Where what is found goes.
    """

    def __init__(self, model: AuditModel, scales: Scales, findings: Findings) -> None:
        self._model, self._scales, self._check = model, scales, findings.check
        self._last: tuple[float, dict[Key, float]] | None = None
        """When the last stored step ended [s], and what held then [N]."""

    def step(self, step: Step, ruled: Ruled, turn: float, where: str) -> None:
        """Check a step whose contacts move as they are `ruled`; normals may be off by a `turn`."""
        found, before = step.touching.pressed, step.touching.at_start
        held = _held(before)
        self._adhesions(step, turn, where)
        self._go_on(float(step.start["time"]), held, where)
        self._last = (step.time, _held(found))
        self._begins(step, held, where)
        self._lets_go(step, held, where)
        # What opens holds no more, so that adhesion does no work.
        off = found.adhesion * self._scales.geometry(step)
        self._check("adhesion: work", found.adhesion * ruled.normal, off, where)

    def _adhesions(self, step: Step, turn: float, where: str) -> None:
        """Check that contacts hold by what the case says."""
        found = step.touching.pressed
        at_start = step.touching.find(step.end, 0.0, like=step.touching.all)
        normals, areas_at_start = at_start.normal, at_start.area
        position = step.position(0.0)
        for k in np.flatnonzero(found.adhesion > 0.0):
            side, adhesion = found.side[k], float(found.adhesion[k])
            holding = None if side is None else side.holding
            if holding is None:
                self._check("adhesion", adhesion, 0.0, where)
                continue
            if holding.unbreakable:
                continue
            least = most = holding.force
            if holding.stress > 0.0:
                least = most = 0.0
                if found.sites.kind[k] == AT_MULTIPLIER:
                    depth = self._model.bodies[found.source[k]].thickness
                    least = most = holding.stress * float(areas_at_start[k]) * depth
                elif found.sites.kind[k] == AT_NODE:
                    between = int(found.source[k]), int(found.node[k])
                    areas = bearing_area(self._model, *between, normals[k], position, turn=turn)
                    least, most = (holding.stress * area for area in areas)
            error = max(least - adhesion, adhesion - most, 0.0)
            self._check("adhesion", error, ROUND_OFF * most, where)

    def _go_on(self, start: float, held: Mapping[Key, float], where: str) -> None:
        """Check that a step starts with what held at the end of the one before, if stored."""
        if self._last is not None and self._last[0] == start:
            self._check("adhesion: history", float(held != self._last[1]), 0.0, where)

    def _begins(self, step: Step, held: Mapping[Key, float], where: str) -> None:
        """Check that nothing holds but what did, and what has closed before where that lasts."""
        found, gaps = step.touching.pressed, step.touching.start_gaps
        known = set(step.touching.at_start.keys)
        begun = float(step.start["time"]) == self._model.begun.time
        for k in np.flatnonzero(found.adhesion > 0.0):
            key, holding = found.keys[k], _holding(found, int(k))
            lasts = holding is not None and holding.lasting and not begun
            closed = gaps[k] <= CLOSED * self._model.size + self._scales.geometry(step)
            wrong = key not in held and not (lasts and key in known and closed)
            self._check("adhesion: history", float(wrong), 0.0, where)
        if begun:
            before = step.touching.at_start
            open_ones = (before.adhesion > 0.0) & (before.gap > CLOSED * self._model.size)
            self._check("adhesion: history", open_ones.astype(float), 0.0, where)

    def _lets_go(self, step: Step, held: Mapping[Key, float], where: str) -> None:
        """Check that what held at the start and holds no more has opened."""
        found, before = step.touching.pressed, step.touching.at_start
        holds = _held(found)
        late = step.touching.find(step.start, 1.0, like=before)
        along, _ = before.relative(step.d, before.shift)
        opened = np.maximum(late.gap - before.gap, along)
        for k, key in enumerate(before.keys):
            if key in held and key not in holds:
                bond = bool(before.bonds[k])
                closed = max(-float(opened[k]), 0.0)
                self._check("adhesion: history", float(bond), 0.0, where)
                self._check("adhesion: opening", closed, self._scales.geometry(step), where)


def _held(found: Contacts) -> dict[Key, float]:
    """Return the adhesion of the contacts that hold [N]."""
    each = zip(found.keys, found.adhesion.tolist(), strict=True)
    return {key: adhesion for key, adhesion in each if adhesion > 0.0}


def _holding(found: Contacts, contact: int) -> Holding | None:
    side = found.side[contact]
    return None if side is None else side.holding
