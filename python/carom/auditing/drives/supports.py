"""Supports as the auditor sees them: displacements of a body that are given over time."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from carom.auditing.arrays import AXES, Array, Indices, Mask
from carom.auditing.bodies.body import AuditBody
from carom.auditing.drives.guides import Guide, Guiding
from carom.auditing.functions.signals import AuditSignal
from carom.auditing.mesh.drawn import nodes_of
from carom.case.full_stage import Given
from carom.case.load import Load
from carom.case.motion import Fixed, Guided, Motion, Prescribed


class Supports:
    """What holds a body.

    Parameters
    ----------
    body
        The body.
    given
        The motions, of all bodies, and when each began.
    at_rest
        Whether what moves has no velocity, as in load steps.
    """

    def __init__(self, body: AuditBody, given: Sequence[Given], *, at_rest: bool) -> None:
        self._at_rest, self._dimension, self._mean = at_rest, body.dimension, body.mass.mean
        self.held: Mask = body.fixed.copy()
        """Which components of the displacement of nodes are given, shape [node_count, D]."""
        self.by: Indices = np.full(body.points.shape, -1)
        """By which support, shape [node_count, D]; −1 where by none."""
        self.anchor: Array = np.zeros(body.points.shape)
        """Displacements that those given are counted from [m], shape [node_count, D]."""
        self._since: list[float] = []
        self.names: list[str] = []
        """Names of the supports, as columns of the history have them."""
        self._signals: list[list[AuditSignal]] = []
        self.guide: Guide | None = None
        """What guides it, if it is rigid and something does."""
        for one in given:
            if one.what.body == body.name:
                self._hold(body, one.what)
                self._since.append(one.since)

    def __len__(self) -> int:
        return len(self.names)

    def _hold(self, body: AuditBody, motion: Load | Motion) -> None:
        if isinstance(motion, Guided):
            self.guide = Guide(motion, body.dimension, at_rest=self._at_rest)
            self.held[:] = self.guide.at(0.0).held
            self.names.append(motion.body)
            return
        assert isinstance(motion, Fixed | Prescribed), "loads are no motions"
        on = nodes_of(body.drawn, motion.on, body.points, body.boundary, body.cells.nodes)
        alike = np.isin(body.masters, body.masters[on])
        axes = AXES[: body.dimension]
        if isinstance(motion, Fixed):
            chosen = [motion.components is None or axis in motion.components for axis in axes]
            signals = [AuditSignal(0.0) for _ in axes]
        else:
            given = [getattr(motion, axis) for axis in axes]
            chosen = [signal is not None for signal in given]
            signals = [AuditSignal(signal) for signal in given]
        # Of two that hold the same the first has it.
        mine = alike[:, None] & np.array(chosen) & ~self.held
        self.by[mine] = len(self.names)
        self.held |= mine
        self.names.append(f"{motion.body}.{motion.on}")
        self._signals.append(signals)

    def begin(self, u: Array, time: float, before: Supports | None) -> None:
        """Count what begins at a time [s] from displacements [m], all else as it was `before`."""
        for number, since in enumerate(self._since):
            mine = self.by == number
            known = before is not None and since < time
            if self.guide is not None:
                goes_on = before.guide if before is not None and known else None
                self.guide.anchor = self._mean(u) if goes_on is None else goes_on.anchor
                continue
            self.anchor[mine] = (before.anchor if before is not None and known else u)[mine]

    def guiding(self, time: float) -> Guiding:
        """Return what guides the body at the end of a step [s]; nothing does as a rule."""
        return Guiding.none(self._dimension) if self.guide is None else self.guide.at(time)

    def displacement(self, time: float) -> Array:
        """Return what is given at a time [s], zero elsewhere [m], shape [node_count, D]."""
        return np.where(self.held, self.anchor + self._given(time, 0), 0.0)

    def velocity(self, time: float) -> Array:
        """Return its rate [m/s], shape [node_count, D]."""
        return np.zeros(self.held.shape) if self._at_rest else self._given(time, 1)

    def _given(self, time: float, order: int) -> Array:
        out = np.zeros(self.held.shape)
        for number, signals in enumerate(self._signals):
            for axis, signal in enumerate(signals):
                out[self.by[:, axis] == number, axis] = signal.at(time)[order]
        return out
