"""K̄⁻¹ as somebody else knows it: a function from right-hand sides to solutions."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import LinearOperator

from carom.errors import InputError
from carom.friction.arrays import shown
from carom.friction.symmetry import LARGEST_ASYMMETRY


def is_operator(value: object) -> bool:
    """Whether something is known by what it does to vectors alone."""
    return isinstance(value, LinearOperator) or callable(value)


def responses(solver: Any, H: Any) -> NDArray[np.float64]:  # noqa: ANN401 (as in `condensed`)
    """Return K̄⁻¹ H [m/N], shape [dof_count, n D].

    The solver is asked for all columns at once; one that takes vectors alone column by column.

    Raises
    ------
    InputError
        If an answer has another shape or is not finite.
    """
    columns = H.toarray() if sp.issparse(H) else np.asarray(H, dtype=np.float64)
    if columns.shape[1] == 0:
        return np.zeros(columns.shape)
    if isinstance(solver, LinearOperator):
        answer = _array(solver.matmat(columns))
    else:
        try:
            answer = _array(solver(columns))
        except (TypeError, ValueError):
            answer = np.empty(0)
        if answer.shape != columns.shape:
            answer = np.column_stack([solution(solver, column) for column in columns.T])
    _check(answer, columns.shape)
    return answer


def solution(solver: Any, right_hand_side: NDArray[np.float64]) -> NDArray[np.float64]:  # noqa: ANN401
    """Return K̄⁻¹ times one vector, shape [dof_count].

    Raises
    ------
    InputError
        If the answer has another shape or is not finite.
    """
    call = solver.matvec if isinstance(solver, LinearOperator) else solver
    answer = _array(call(right_hand_side))
    _check(answer, right_hand_side.shape)
    return answer


def condensed(H: Any, of_columns: NDArray[np.float64]) -> NDArray[np.float64]:  # noqa: ANN401
    """Return W = Hᵀ K̄⁻¹ H [m/N], shape [n D, n D], made symmetric where round-off is not.

    Parameters
    ----------
    H
        Map from reactions to forces, shape [dof_count, n D], NumPy or scipy.sparse.
    of_columns
        K̄⁻¹ H, as `responses` returns it.

    Raises
    ------
    InputError
        If K̄⁻¹ is clearly not symmetric.
    """
    W = np.asarray(H.T @ of_columns)
    difference = np.abs(W - W.T)
    largest, asymmetry = np.abs(W).max(initial=0.0), difference.max(initial=0.0)
    if asymmetry > LARGEST_ASYMMETRY * largest:
        row, column = (int(k) for k in np.unravel_index(int(difference.argmax()), W.shape))
        raise InputError(
            f"solver: Hᵀ K̄⁻¹ H is asymmetric by {asymmetry / largest:.2g} of its largest entry, at "
            f"[{row}, {column}], where {LARGEST_ASYMMETRY:g} is allowed; give the solver of a "
            "symmetric K̄, and solve it more accurately if it iterates",
            "solver",
        )
    symmetric: NDArray[np.float64] = 0.5 * (W + W.T)
    return symmetric


def _array(answer: object) -> NDArray[np.float64]:
    try:
        return np.asarray(answer, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(
            f"solver: its answer is {type(answer).__name__}; must be an array of numbers", "solver"
        ) from None


def _check(answer: NDArray[np.float64], shape: tuple[int, ...]) -> None:
    if answer.shape != shape:
        raise InputError(
            f"solver: its answer has shape {shown(answer.shape)} for a right-hand side of shape "
            f"{shown(shape)}; must be as long",
            "solver",
        )
    if not np.isfinite(answer).all():
        where = tuple(int(k) for k in np.argwhere(~np.isfinite(answer))[0])
        raise InputError(
            f"solver: its answer is {answer[where]} at [{', '.join(map(str, where))}]; K̄ must be "
            "regular, so support what moves freely or give it mass",
            "solver",
        )
