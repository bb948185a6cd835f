"""The unit in which the times of a run are told: s, or ms, µs, ns, ps where the run is short."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class TimeUnit:
    """A unit of time.

    Parameters
    ----------
    symbol
        How it is written.
    seconds
        What it is worth [s].
    """

    symbol: str
    seconds: float

    def text(self, time: float, digits: int = 6) -> str:
        """Return a time [s] in this unit, such as ``12.5 µs``."""
        return f"{time / self.seconds:.{digits}g} {self.symbol}"


SECONDS = TimeUnit("s", 1.0)

UNITS = (
    SECONDS,
    TimeUnit("ms", 1e-3),
    TimeUnit("µs", 1e-6),
    TimeUnit("ns", 1e-9),
    TimeUnit("ps", 1e-12),
)

LEAST = 0.1
"""Of a unit, which the longest time must reach: 0.1 needs no more digits than 100."""


def time_unit(longest: float) -> TimeUnit:
    """Return the unit for a run that lasts so long [s], the same wherever its times are shown.

    Seconds also where nothing lasts: for 0, and for what is not finite.
    """
    if not (math.isfinite(longest) and longest > 0.0):
        return SECONDS
    # By a hair less, as 1e-4 is a little less than 0.1 times 1e-3.
    enough = (unit for unit in UNITS if longest >= LEAST * unit.seconds * (1.0 - 1e-9))
    return next(enough, UNITS[-1])
