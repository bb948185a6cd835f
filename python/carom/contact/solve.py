"""Reactions of contacts, and the motion with them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from carom.contact.contacts import Contacts
from carom.errors import InputError
from carom.friction.arrays import numbers, shown
from carom.friction.operator import condensed, responses


@dataclass(frozen=True, eq=False, repr=False)
class Solution:
    """Reactions that obey the laws of contact and friction, and the motion that goes with them.

    Parameters
    ----------
    reactions
        r [N], component 0 normal, shape [n, D].
    motion
        d = free + K̄⁻¹ H r [m], shape [dof_count].
    force
        H r [N], shape [dof_count].
    certificate
        Distance from the laws, the sum of the bi-potential gaps [J].
    residual
        Relative residual in the natural units of the problem.
    iterations
        What the solver needed.
    solver
        The solver that gave the answer; empty without contacts.
    """

    reactions: NDArray[np.float64]
    motion: NDArray[np.float64]
    force: NDArray[np.float64]
    certificate: float
    residual: float
    iterations: int
    solver: str

    def __repr__(self) -> str:
        return (
            f"<Solution: {len(self.reactions)} contacts, {self.iterations} iterations, residual "
            f"{self.residual:.2e}, certificate {self.certificate:.2e} J>"
        )


def solve(
    contacts: Contacts,
    solver: Any,  # noqa: ANN401 (a callable or a LinearOperator)
    *,
    free: ArrayLike,
) -> Solution:
    """Solve for the reactions of contacts, starting from those known so far.

    Of K̄ the solver is asked for as many solutions as there are components of reactions, all at once
    if it takes several right-hand sides. What it solves with may hold anything: shells, fluids,
    damage.

    Parameters
    ----------
    contacts
        As `ContactModel.evaluate` last returned them.
    solver
        A function from right-hand sides [N] to solutions [m], of shape [dof_count, k] or
        [dof_count]; or a ``scipy.sparse.linalg.LinearOperator``. Its K̄ is symmetric and positive
        definite.
    free
        The motion d of the step without reactions [m], shape [dof_count].

    Raises
    ------
    InputError
        If shapes do not fit, or the solver's answer is not one of a regular symmetric K̄.
    ConvergenceError
        If no reactions are found; its ``problem`` and ``guess`` can be written as a file
        (`carom.friction.write`).
    """
    model = contacts._model
    motion = numbers("free", free)
    if motion.shape != (model.dof_count,):
        raise InputError(
            f"free has shape {shown(motion.shape)}; must be [{model.dof_count}], one number for "
            "each unknown",
            "free",
        )
    native = model.native_at(contacts)
    if not len(contacts):
        return Solution(contacts.guess, motion, np.zeros_like(motion), 0.0, 0.0, 0, "")
    H = contacts.H  # noqa: N806 (the field's notation)
    columns = responses(solver, H)
    W = condensed(H, columns)  # noqa: N806
    _refuse_indefinite(W, contacts.frame.shape[1])
    found = native.solve(W, np.reshape(H.T @ motion, contacts.offset.shape))
    model.has_reactions()
    flat = found["reactions"].ravel()
    return Solution(
        reactions=found["reactions"],
        motion=motion + columns @ flat,
        force=H @ flat,
        certificate=found["certificate"],
        residual=found["natural_residual"],
        iterations=found["iterations"],
        solver=found["solver"],
    )


def _refuse_indefinite(W: NDArray[np.float64], dimension: int) -> None:  # noqa: N803
    """Raise where a force along a normal moves its contact against itself, or not at all."""
    diagonal = np.diagonal(W)
    for contact, yields in enumerate(diagonal[::dimension]):
        if not yields > 0.0:
            raise InputError(
                f"solver: a force along the normal of contact {contact} moves it by {yields:g} "
                "m/N; K̄ must be positive definite",
                "solver",
            )
