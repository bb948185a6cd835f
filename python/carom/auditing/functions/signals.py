"""Functions of time as the auditor reads them: a value, and its rate to the right."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from carom.auditing.arrays import Array
from carom.auditing.functions.formula import Formula
from carom.case.signal import Signal, Table


class AuditSignal:
    """A function of time.

    Parameters
    ----------
    given
        What the case says; None is zero.
    """

    def __init__(self, given: Signal | None) -> None:
        self.given = given is not None
        """Whether the case says anything."""
        self._given = 0.0 if given is None else given
        self._formula = Formula(given) if isinstance(given, str) else None

    def at(self, time: float) -> tuple[float, float]:
        """Return value and rate [1/s] at a time [s]."""
        given = self._given
        if self._formula is not None:
            return self._formula.with_rate("t", time)
        if isinstance(given, Table):
            return _in_table(np.array(given.time), np.array(given.value), time)
        assert isinstance(given, float | int)
        return float(given), 0.0


def _in_table(times: Array, values: Array, time: float) -> tuple[float, float]:
    """Return value and rate in a table: at a kink the rate of the piece that begins there."""
    after = int(np.searchsorted(times, time, side="right"))
    if after in (0, len(times)):
        return float(values[min(after, len(times) - 1)]), 0.0
    rate = float(np.diff(values)[after - 1] / np.diff(times)[after - 1])
    return float(values[after - 1]) + (time - float(times[after - 1])) * rate, rate


class Travel:
    """A displacement over time.

    Parameters
    ----------
    signals
        Its components [m].
    """

    def __init__(self, signals: Sequence[Signal | None]) -> None:
        self._signals = [AuditSignal(signal) for signal in signals]

    varies = True
    """Whether its rate does."""

    def displacement(self, time: float) -> Array:
        """Return it [m] at a time [s], shape [D]."""
        return np.array([signal.at(time)[0] for signal in self._signals])

    def velocity(self, time: float) -> Array:
        """Return its rate [m/s], shape [D]."""
        return np.array([signal.at(time)[1] for signal in self._signals])


class Uniform(Travel):
    """Motion at a constant velocity.

    Parameters
    ----------
    velocity
        The velocity [m/s], shape [D].
    """

    varies = False

    def __init__(self, velocity: Array) -> None:
        super().__init__([None] * len(velocity))
        self._velocity = velocity

    def displacement(self, time: float) -> Array:
        """Return it [m] at a time [s], shape [D]."""
        moved: Array = time * self._velocity
        return moved

    def velocity(self, time: float) -> Array:
        """Return its rate [m/s], shape [D]."""
        del time
        return self._velocity
