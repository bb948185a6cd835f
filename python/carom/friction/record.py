"""What a file keeps: a problem, where it came from, and what is known of its answer."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from carom.friction.global_problem import GlobalProblem
from carom.friction.problem import Problem
from carom.friction.solution import Solution

AnyProblem = Problem | GlobalProblem


@dataclass(frozen=True, eq=False)
class Iterate:
    """Reactions and what moves with them.

    Parameters
    ----------
    reactions
        r [N], shape [n, D].
    motions
        w [m], shape [n, D].
    velocities
        v, shape [dof_count]; None in local form.
    """

    reactions: NDArray[np.float64]
    motions: NDArray[np.float64]
    velocities: NDArray[np.float64] | None = None

    @classmethod
    def of(cls, problem: AnyProblem, given: ArrayLike | Solution | Iterate) -> Iterate:
        """Return a solution, or reactions of shape [n, D] or [n D] with the motions they cause."""
        if isinstance(given, Iterate):
            return given
        if isinstance(given, Solution):
            return cls(given.reactions, given.motions, given.velocities)
        r = problem.vectors("reactions", given)
        velocities = problem.velocities(r) if isinstance(problem, GlobalProblem) else None
        return cls(r, problem.motions(r), velocities)


@dataclass(frozen=True, eq=False)
class Record:
    """A problem as a file has it.

    Parameters
    ----------
    problem
        The problem.
    title, description
        Where it came from.
    guesses
        Where a solver may start.
    solution
        An answer, as good as whoever wrote it.
    """

    problem: AnyProblem
    title: str = ""
    description: str = ""
    guesses: tuple[Iterate, ...] = ()
    solution: Iterate | None = None
