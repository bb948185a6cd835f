"""What a solver found."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False, repr=False)
class Solution:
    """The answer of a solver, with its distance from the law.

    Parameters
    ----------
    reactions
        r [N], component 0 normal, shape [n, D].
    motions
        w = W r + q [m], shape [n, D].
    velocities
        v with M v = H r + f, shape [dof_count]; None for a problem in local form.
    status
        ``solved`` where both residuals are at or below the tolerance. Otherwise why the solver
        stopped: ``iteration-limit``, ``time-limit``, ``stalled`` (no step improved the answer any
        more), ``inconsistent`` (no reactions can keep the contacts apart) or ``diverged``.
    solver
        The solver that gave the answer; with ``auto`` the one it ended with.
    iterations
        Sweeps over all contacts, or linear systems for Newton's method.
    residual, natural_residual, certificate
        As in `carom.friction.Measure`; the certificate in joules.
    time
        Time of the solve alone [s], in one thread.
    history
        Iteration and residual, measured on the way, shape [sample_count, 2].
    method
        Of a global problem, ``condense`` or ``admm``; None for a problem in local form.
    """

    reactions: NDArray[np.float64]
    motions: NDArray[np.float64]
    velocities: NDArray[np.float64] | None
    status: str
    solver: str
    iterations: int
    residual: float
    natural_residual: float
    certificate: float
    time: float
    history: NDArray[np.float64]
    method: str | None = None

    @property
    def solved(self) -> bool:
        """Whether the answer obeys the law to the tolerance."""
        return self.status == "solved"

    def __repr__(self) -> str:
        return (
            f"<Solution: {self.status} by {self.solver}, {len(self.reactions)} contacts, "
            f"{self.iterations} iterations, residual {self.residual:.2e}, certificate "
            f"{self.certificate:.2e} J, {1e3 * self.time:.3g} ms>"
        )
