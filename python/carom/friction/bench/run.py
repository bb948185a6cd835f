"""One solver on one problem, timed."""

from __future__ import annotations

import statistics
from dataclasses import dataclass

from carom.friction.bench.case import Case
from carom.friction.solve import solve

BUDGET = 0.1
"""Time for which a short solve is repeated, so that the clock and the caches do not matter [s]."""

FEWEST, MOST = 3, 200
"""Repetitions at least, unless they take ten times the budget, and at most."""

ENDLESS = 2**62
"""Iterations that never run out: the time limit ends a solve."""


@dataclass(frozen=True)
class Run:
    """What came of a solver on a problem.

    Parameters
    ----------
    case
        Name of the problem.
    solver
        Name of the solver.
    claimed
        Whether the solver says that it solved the problem.
    solved
        Whether its answer, measured by `carom.friction.measure`, is one to the tolerance.
    status
        ``solved``, or why not.
    time
        Median time of a solve [s].
    iterations
        Iterations as the solver counts them.
    residual
        The published residual of its answer, measured anew; NaN where there is no answer.
    certificate
        Its bi-potential gap [J].
    """

    case: str
    solver: str
    claimed: bool
    solved: bool
    status: str
    time: float
    iterations: int
    residual: float
    certificate: float

    @property
    def false_success(self) -> bool:
        """Whether the solver takes for a solution what is none."""
        return self.claimed and not self.solved


def run_solver(case: Case, solver: str, *, tolerance: float, time_limit: float) -> Run:
    """Run a solver of carom from zero, as often as a steady time needs."""
    times: list[float] = []
    while not _enough(times):
        solution = solve(
            case.problem,
            solver=solver,
            tolerance=tolerance,
            max_iterations=ENDLESS,
            time_limit=time_limit,
        )
        times.append(solution.time)
    measured = case.problem.measure(solution.reactions)
    return Run(
        case=case.name,
        solver=solver,
        claimed=solution.solved,
        solved=solution.solved and measured.decisive <= tolerance,
        status=solution.status,
        time=statistics.median(times),
        iterations=solution.iterations,
        residual=measured.residual,
        certificate=measured.certificate,
    )


def _enough(times: list[float]) -> bool:
    """Whether a solve that took these times has been repeated often enough."""
    total = sum(times)
    return total >= 10.0 * BUDGET or len(times) >= (FEWEST if total >= BUDGET else MOST)
