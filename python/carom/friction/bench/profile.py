"""Performance profiles [1]_: how often a solver is within a factor of the best one.

References
----------
.. [1] E. D. Dolan, J. J. Moré, *Benchmarking optimization software with performance profiles*,
   Mathematical Programming 91 (2002) 201–213.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from carom.friction.bench.run import Run


def ratios(runs: Iterable[Run]) -> dict[str, NDArray[np.float64]]:
    """Return by solver its times over the least time on each problem, ascending.

    A problem that the solver did not solve counts as infinite, one that no solver solved too.
    """
    runs = list(runs)
    best = least_times(runs)
    by_solver: dict[str, list[float]] = {}
    for run in runs:
        ratio = run.time / best[run.case] if run.solved else np.inf
        by_solver.setdefault(run.solver, []).append(ratio)
    return {solver: np.sort(found) for solver, found in by_solver.items()}


def least_times(runs: Iterable[Run]) -> dict[str, float]:
    """Return by problem the least time of the solvers that solved it: the virtual best."""
    best: dict[str, float] = {}
    for run in runs:
        if run.solved:
            best[run.case] = min(run.time, best.get(run.case, np.inf))
    return best


def shares(
    found: Mapping[str, NDArray[np.float64]], factors: Sequence[float]
) -> dict[str, list[float]]:
    """Return by solver the share of its problems that it solves within each factor of the best."""
    return {
        solver: [float(np.mean(each <= factor)) for factor in factors]
        for solver, each in found.items()
    }
