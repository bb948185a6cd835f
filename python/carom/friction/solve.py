"""Solving a contact problem."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from carom import _carom
from carom.errors import InputError
from carom.friction.problem import Problem
from carom.friction.solution import Solution
from carom.messages import known

SOLVERS: tuple[str, ...] = tuple(_carom.friction_solvers())
"""The names of all solvers, the default first."""

DEFAULT_TOLERANCE = 1e-8
DEFAULT_ITERATIONS = 100_000


def solve(
    W: Any,  # noqa: ANN401 (NumPy, any scipy.sparse, or a problem)
    q: ArrayLike | None = None,
    mu: ArrayLike | None = None,
    *,
    solver: str = SOLVERS[0],
    tolerance: float = DEFAULT_TOLERANCE,
    max_iterations: int = DEFAULT_ITERATIONS,
    time_limit: float | None = None,
    guess: ArrayLike | None = None,
) -> Solution:
    """Find reactions r and motions w = W r + q that obey Signorini's and Coulomb's laws.

    An answer that is not one is returned all the same: look at `Solution.solved`.

    Parameters
    ----------
    W
        Delassus operator [m/N], shape [n D, n D], NumPy or scipy.sparse; or a `Problem`, then
        without `q` and `mu`.
    q
        Relative motion without reactions [m], component 0 of each contact normal, shape [n, D] or
        [n D].
    mu
        Friction coefficients, shape [n].
    solver
        One of `SOLVERS`.
    tolerance
        Residual at which the problem counts as solved.
    max_iterations
        Iterations after which the solver gives up.
    time_limit
        Time after which the solver gives up [s].
    guess
        Reactions to start from [N], shape [n, D] or [n D]; without it zero.

    Raises
    ------
    InputError
        If the problem or an option is not valid (see `Problem`).
    """
    problem = _problem(W, q, mu)
    rule = _checked_rule(solver, tolerance, max_iterations, time_limit)
    start = np.zeros_like(problem.q) if guess is None else problem.vectors("guess", guess)
    return Solution(
        **{"velocities": None} | _carom.solve_friction(problem, start, solver=solver, **rule)
    )


def _problem(W: Any, q: ArrayLike | None, mu: ArrayLike | None) -> Problem:  # noqa: ANN401
    if isinstance(W, Problem):
        if q is not None or mu is not None:
            raise InputError("q and mu are part of the problem: give either it or W, q and mu")
        return W
    if q is None or mu is None:
        raise InputError(f"{'q' if q is None else 'mu'} is missing: give W, q and mu")
    return Problem(W, q, mu)


def _checked_rule(
    solver: str, tolerance: float, max_iterations: int, time_limit: float | None
) -> dict[str, Any]:
    """Return when to stop, as the native functions want it."""
    if solver not in SOLVERS:
        raise InputError(f"solver = {solver!r}: {known(solver, SOLVERS)}", "solver")
    if not (math.isfinite(tolerance) and tolerance > 0.0):
        raise InputError(f"tolerance = {tolerance:g}: must be greater than 0", "tolerance")
    if max_iterations < 0:
        raise InputError(f"max_iterations = {max_iterations}: must be at least 0", "max_iterations")
    if time_limit is not None and not (math.isfinite(time_limit) and time_limit >= 0.0):
        raise InputError(f"time_limit = {time_limit:g}: must be at least 0", "time_limit")
    return {"tolerance": tolerance, "max_iterations": max_iterations, "time_limit": time_limit}
