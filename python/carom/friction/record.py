"""What a file keeps: a problem, where it came from, and what is known of its answer."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from carom.errors import InputError
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

    def local(self) -> Iterate:
        """Return what the local form knows of it."""
        return Iterate(self.reactions, self.motions)


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

    def answered(self, solution: Solution) -> Record:
        """Return the record with an answer."""
        return replace(self, solution=Iterate.of(self.problem, solution))

    def condensed(self) -> Record:
        """Return the record of a global problem in local form.

        Raises
        ------
        InputError
            If the problem is in local form already, or if M is singular.
        """
        if not isinstance(self.problem, GlobalProblem):
            raise InputError("the problem is in local form already and cannot be condensed")
        return Record(
            self.problem.condense(),
            title=self.title,
            description=self.description,
            guesses=tuple(guess.local() for guess in self.guesses),
            solution=None if self.solution is None else self.solution.local(),
        )
