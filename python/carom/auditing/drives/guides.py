"""Guides of rigid bodies as the auditor sees them: the part of their motion that is given."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.auditing.arrays import AXES, Array, Mask, turning_axes
from carom.auditing.functions.signals import AuditSignal
from carom.case.motion import Guided


@dataclass(frozen=True)
class Guiding:
    """What a guide does at the end of a step; what it leaves free is zero.

    Parameters
    ----------
    along, about
        Along and about which axes the body is guided, shapes [D] and [1] or [3].
    velocity, spin
        Of its centre [m/s] and about it [rad/s], in the same shapes.
    """

    along: Mask
    about: Mask
    velocity: Array
    spin: Array

    @classmethod
    def none(cls, dimension: int) -> Guiding:
        """Return that of a body that nothing guides."""
        turns = turning_axes(dimension)
        free, still = np.zeros(dimension, dtype=bool), np.zeros(dimension)
        return cls(free, np.zeros(turns, dtype=bool), still, np.zeros(turns))

    @property
    def held(self) -> Mask:
        """Which displacements of nodes are given, as no turn is free, shape [D]."""
        held: Mask = self.along & self.about.all()
        return held

    def unheld(self, forces: Array) -> Array:
        """Return forces on nodes without what presses on displacements that are given [N]."""
        return np.where(self.held, 0.0, forces)


class Guide:
    """Functions of time that guide a rigid body.

    Parameters
    ----------
    motion
        What the case says.
    dimension
        2 in the plane, 3 in space.
    at_rest
        Whether what moves has no velocity, as in load steps.
    """

    def __init__(self, motion: Guided, dimension: int, *, at_rest: bool) -> None:
        self._at_rest = at_rest
        turns = ["turn_z"] if dimension == 2 else [f"turn_{axis}" for axis in AXES]
        self._along, self._about = (
            [getattr(motion, name) for name in names] for names in (AXES[:dimension], turns)
        )
        self._signals = [[AuditSignal(one) for one in part] for part in (self._along, self._about)]
        self.anchor = np.zeros(dimension)
        """Where the displacement of the centre is counted from [m], shape [D]."""

    def displacement(self, time: float) -> Array:
        """Return how far the centre is from where the run began [m], shape [D]."""
        return self.anchor + self._given(0, time, 0)

    def turn(self, start: float, end: float) -> Array:
        """Return ϑ of a step between two times [s], 2 tan(½ angle), shape [1] or [3].

        Load steps that begin at t = 0 turn in the first one by what is there then, too.
        """
        before = self._given(1, start, 0) * (not (self._at_rest and start == 0.0))
        turn: Array = 2.0 * np.tan(0.5 * (self._given(1, end, 0) - before))
        return turn

    def at(self, time: float) -> Guiding:
        """Return what it does at the end of a step [s]."""
        along, about = (
            np.array([one is not None for one in part]) for part in (self._along, self._about)
        )
        moves = float(not self._at_rest)
        rates = [moves * self._given(part, time, 1) for part in (0, 1)]
        return Guiding(along, about, rates[0], rates[1])

    def _given(self, part: int, time: float, order: int) -> Array:
        return np.array([signal.at(time)[order] for signal in self._signals[part]])
