"""Every solver on every problem."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from carom.friction.bench.case import Case
from carom.friction.bench.profile import least_times
from carom.friction.bench.run import Run, run_solver
from carom.friction.bench.siconos import Siconos

WORTH_TUNING = 1e-3
"""Time below which a difference is of no consequence [s]."""


@dataclass(frozen=True)
class Comparison:
    """What came of it.

    Parameters
    ----------
    cases
        The problems.
    runs
        Runs of the solvers of carom, problem by problem.
    peer_runs
        Runs of another code's solvers.
    tolerance, time_limit
        What each run was given; the limit in seconds.
    """

    cases: Sequence[Case]
    runs: Sequence[Run]
    peer_runs: Sequence[Run]
    tolerance: float
    time_limit: float

    @property
    def solvers(self) -> list[str]:
        """Names of carom's solvers."""
        return list(dict.fromkeys(run.solver for run in self.runs))

    @property
    def peer_solvers(self) -> list[str]:
        """Names of the other code's solvers."""
        return list(dict.fromkeys(run.solver for run in self.peer_runs))

    @property
    def false_successes(self) -> list[Run]:
        """Runs whose solver takes for a solution what is none."""
        return [run for run in (*self.runs, *self.peer_runs) if run.false_success]

    def run(self, case: str, solver: str) -> Run | None:
        """Return a run; None if this solver is not for this problem."""
        runs = (*self.runs, *self.peer_runs)
        return next((run for run in runs if (run.case, run.solver) == (case, solver)), None)

    def best_peer(self, case: str) -> Run | None:
        """Return the fastest run of the other code that solved a problem."""
        solved = [run for run in self.peer_runs if run.case == case and run.solved]
        return min(solved, key=lambda run: run.time, default=None)

    def speed_ups(self, solver: str, *, least_time: float = 0.0) -> dict[str, float]:
        """Return by problem how many times less a solver takes than the best of the other code.

        Parameters
        ----------
        solver
            One of carom's.
        least_time
            Problems on which the other code takes less [s] are left out.
        """
        best = least_times(self.peer_runs)
        return {
            run.case: best[run.case] / run.time
            for run in self.runs
            if run.solver == solver
            and run.solved
            and run.case in best
            and best[run.case] >= least_time
        }


def geometric_mean(values: Iterable[float]) -> float:
    """Return the geometric mean; NaN of nothing."""
    values = list(values)
    return float(np.exp(np.mean(np.log(values)))) if values else float("nan")


def compare(
    cases: Sequence[Case],
    solvers: Sequence[str],
    *,
    tolerance: float,
    time_limit: float,
    siconos: Siconos | None = None,
    observer: Callable[[Run], None] = lambda run: None,
) -> Comparison:
    """Run all solvers on all problems, side by side.

    Parameters
    ----------
    cases
        The problems.
    solvers
        Names of carom's solvers.
    tolerance
        Residual at which a problem counts as solved.
    time_limit
        Time that a solve may take [s].
    siconos
        Siconos, if it takes part.
    observer
        Called with every run when it is done.
    """
    runs, peer_runs = [], []
    for case in cases:
        for solver in solvers:
            run = run_solver(case, solver, tolerance=tolerance, time_limit=time_limit)
            runs.append(run)
            observer(run)
        if siconos is None:
            continue
        for solver in siconos.solvers(case.problem.dimension):
            run = siconos.run(case, solver, tolerance=tolerance, time_limit=time_limit)
            peer_runs.append(run)
            observer(run)
    return Comparison(cases, runs, peer_runs, tolerance, time_limit)
