"""Solving a contact problem."""

from __future__ import annotations

import math
import time
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse.linalg import LinearOperator

from carom import _carom
from carom.errors import InputError
from carom.friction.arrays import matrix
from carom.friction.global_problem import GlobalProblem
from carom.friction.operator import condensed, is_operator, responses
from carom.friction.problem import Problem
from carom.friction.record import AnyProblem
from carom.friction.solution import Solution
from carom.messages import known

SOLVERS: tuple[str, ...] = tuple(_carom.friction_solvers())
"""The names of all solvers, the default first."""

METHODS = ("auto", "condense", "admm")
"""What is done with a global problem."""

DEFAULT_TOLERANCE = 1e-8
DEFAULT_ITERATIONS = 100_000


def solve(
    W: Any,  # noqa: ANN401 (NumPy, any scipy.sparse, or a problem)
    q: ArrayLike | None = None,
    mu: ArrayLike | None = None,
    *,
    H: Any = None,  # noqa: ANN401 (NumPy or any scipy.sparse)
    solver: str = SOLVERS[0],
    method: str = METHODS[0],
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
        Delassus operator [m/N], shape [n D, n D], NumPy or scipy.sparse or a ``LinearOperator`` of
        scipy; or a `Problem` or `GlobalProblem`, then without `q` and `mu`. With `H` it is K̄⁻¹, a
        function from right-hand sides [N] to solutions [m] of shape [dof_count, k] or [dof_count],
        or a ``LinearOperator``, and Hᵀ K̄⁻¹ H the Delassus operator.
    q
        Relative motion without reactions [m], component 0 of each contact normal, shape [n, D] or
        [n D].
    mu
        Friction coefficients, shape [n].
    H
        Map from reactions to forces, shape [dof_count, n D], NumPy or scipy.sparse.
    solver
        One of `SOLVERS`.
    method
        Of a `GlobalProblem`: ``condense`` it to its local form for the solver, or iterate by
        ``admm`` on M and H without forming W. ``auto`` takes what needs less memory and time.
    tolerance
        Residual at which the problem counts as solved.
    max_iterations
        Iterations after which the solver gives up.
    time_limit
        Time after which `solve` gives up [s], from its call on. It ends within one iteration of
        the solver. The checks of W and the factor of M, which every problem needs, are not cut
        short. A factor that would not be ready in time is not begun.
    guess
        Reactions to start from [N], shape [n, D] or [n D]; without it zero.

    Raises
    ------
    InputError
        If the problem or an option is not valid (see `Problem`). That W is indefinite may show
        only after a solver gave up.
    """
    begin = time.perf_counter()
    problem = _problem(_delassus(W, H), q, mu)
    rule = _checked_rule(solver, method, tolerance, max_iterations, time_limit)
    start = np.zeros_like(problem.b if isinstance(problem, GlobalProblem) else problem.q)
    if guess is not None:
        start = problem.vectors("guess", guess)

    def left() -> float:
        limit = math.inf if time_limit is None else time_limit
        return max(0.0, limit - (time.perf_counter() - begin))

    if time_limit is not None:
        rule["time_limit"] = left()
    if isinstance(problem, Problem):
        solution = Solution(**_carom.solve_friction(problem, start, **rule), velocities=None)
        if not solution.solved:
            problem.refuse_if_indefinite(seconds=left())
        return solution
    try:
        return Solution(**_carom.solve_global_friction(problem, start, method=method, **rule))
    except ValueError as error:
        raise InputError(str(error), "M") from error


def _delassus(W: Any, H: Any) -> Any:  # noqa: ANN401
    """Return W itself, or made of what is known by its action alone."""
    if H is not None:
        if not is_operator(W):
            raise InputError(
                f"H goes with a function or a LinearOperator that solves with K̄, not with "
                f"{type(W).__name__}: leave it out, or give both as a GlobalProblem",
                "H",
            )
        rows = matrix("H", H)
        return condensed(rows, responses(W, rows))
    if isinstance(W, LinearOperator):
        return condensed(np.eye(W.shape[1]), responses(W, np.eye(W.shape[1])))
    if callable(W):
        raise InputError("H is missing: with a function that solves with K̄, give H too", "H")
    return W


def _problem(W: Any, q: ArrayLike | None, mu: ArrayLike | None) -> AnyProblem:  # noqa: ANN401
    if isinstance(W, Problem | GlobalProblem):
        if q is not None or mu is not None:
            raise InputError("q and mu are part of the problem: give either it or W, q and mu")
        return W
    if q is None or mu is None:
        raise InputError(f"{'q' if q is None else 'mu'} is missing: give W, q and mu")
    return Problem(W, q, mu)


def _checked_rule(
    solver: str, method: str, tolerance: float, max_iterations: int, time_limit: float | None
) -> dict[str, Any]:
    """Return the solver and when to stop, as the native functions want it."""
    if solver not in SOLVERS:
        raise InputError(f"solver = {solver!r}: {known(solver, SOLVERS)}", "solver")
    if method not in METHODS:
        raise InputError(f"method = {method!r}: {known(method, METHODS)}", "method")
    if not (math.isfinite(tolerance) and tolerance > 0.0):
        raise InputError(f"tolerance = {tolerance:g}: must be greater than 0", "tolerance")
    if max_iterations < 0:
        raise InputError(f"max_iterations = {max_iterations}: must be at least 0", "max_iterations")
    if time_limit is not None and not (math.isfinite(time_limit) and time_limit >= 0.0):
        raise InputError(f"time_limit = {time_limit:g}: must be at least 0", "time_limit")
    return {
        "solver": solver,
        "tolerance": tolerance,
        "max_iterations": max_iterations,
        "time_limit": time_limit,
    }
