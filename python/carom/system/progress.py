"""How far a run has come, for whoever watches it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from time import perf_counter


@dataclass(frozen=True)
class Progress:
    """How far a run has come.

    Parameters
    ----------
    step, steps
        Steps done and to do.
    time, end_time
        Time reached and to reach [s].
    contacts
        Active contacts.
    kinetic, strain, springs, total
        Energies [J].
    friction
        Energy dissipated by friction so far [J].
    retried
        Steps or substeps that failed and were halved.
    wall
        Wall time so far [s]; of a run that goes on, with that before.
    eta
        Wall time that is left at the present pace [s]; None before the first step.
    """

    step: int
    steps: int
    time: float
    end_time: float
    contacts: int
    kinetic: float
    strain: float
    total: float
    friction: float
    retried: int = 0
    springs: float = 0.0
    wall: float = 0.0
    eta: float | None = None


ShowProgress = Callable[[Progress], None]
"""What is called with the progress of a run, every tenth of a second or so."""


class Pace:
    """How fast a run goes.

    Parameters
    ----------
    step, steps
        Steps done at its start and to do.
    """

    def __init__(self, step: int, steps: int) -> None:
        self._start, self._step, self._steps = perf_counter(), step, steps

    def eta(self, step: int) -> float | None:
        """Return the wall time left after so many steps [s]; None before the first."""
        done = step - self._step
        if done == 0:
            return None if step < self._steps else 0.0
        return (perf_counter() - self._start) * (self._steps - step) / done
