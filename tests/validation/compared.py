"""A number of a run beside the closed form that it should be."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from runs import Run


@dataclass(frozen=True)
class Compared:
    """What was measured, and what it should be.

    Parameters
    ----------
    problem
        The problem in a few words.
    value
        What a run gave, in the unit of the problem.
    exact
        The same by the reference.
    source
        Where the reference is from.
    iterations
        Newton iterations per load step.
    """

    problem: str
    value: float
    exact: float
    source: str
    iterations: float

    @property
    def error(self) -> float:
        """How much the value is off."""
        return self.value / self.exact - 1.0


def iterations_per_step(run: Run) -> float:
    """Return Newton iterations per load step, where every step has a row in the history."""
    return float(np.mean(run.history["newton_iterations"][1:]))
