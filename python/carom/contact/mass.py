"""The mass of bodies in somebody else's time loop: what impulses in contacts make of velocities."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import LinearOperator, cg, splu

from carom.contact.surface import Surface
from carom.errors import InputError
from carom.friction.arrays import numbers, shown
from carom.friction.operator import is_operator

LARGEST_RESIDUAL = 1e-12
"""Residual of M v = p relative to p above which conjugate gradients have not solved it."""

COUPLED = 1e-9
"""Velocity of one surface relative to that of the other above which M couples them."""

Array = NDArray[np.float64]
Action = Callable[[Array], Array]


class Mass:
    """Your mass, by your numbers of unknowns.

    Parameters
    ----------
    mass
        M [kg]: what is on its diagonal, shape [dof_count]; a matrix of shape
        [dof_count, dof_count], NumPy or scipy.sparse; or a function or ``LinearOperator`` that
        multiplies with it. Symmetric and positive definite.
    dofs, dof_count
        As of a `ContactModel`.
    surfaces
        Which nodes impulses can be in.

    Raises
    ------
    InputError
        If shapes do not fit, or a row of a node on a surface does not sum to a mass.
    """

    def __init__(
        self,
        mass: Any,  # noqa: ANN401 (an array, a matrix, a function)
        dofs: NDArray[np.int64],
        dof_count: int,
        surfaces: Sequence[Surface],
    ) -> None:
        self._dofs, self._count = dofs, dof_count
        self._product, self._solve, sizes = self._actions(mass)
        rows = np.append(numbers("mass", sizes), 0.0)
        free = dofs >= 0
        counted = np.maximum(free.sum(axis=1), 1)
        self.of_nodes: Array = np.where(free, rows[dofs], 0.0).sum(axis=1) / counted
        self.of_nodes[~free.any(axis=1)] = np.inf
        self._surfaces = surfaces
        self._nodes = [np.unique(np.concatenate([f.ravel() for f in s.facets])) for s in surfaces]
        for nodes in self._nodes:
            if (wrong := nodes[~(self.of_nodes[nodes] > 0.0)]).size:
                raise InputError(
                    f"mass: node {wrong[0]} has {self.of_nodes[wrong[0]]:g} kg; must be greater "
                    "than 0, so give what touches a mass, lumped if need be",
                    "mass",
                )
        self._answers: dict[int, Array] = {}

    def jolt(self, surface: int, nodes: NDArray[np.int64], impulse: Array) -> Array:
        """Return the velocities [m/s] that impulses [N s] on nodes of a surface make of rest."""
        dofs = self._dofs[nodes]
        free = dofs >= 0
        momentum = np.zeros(self._count)
        np.add.at(momentum, dofs[free], impulse[free])
        velocity = self._answers[surface] = self._solve(momentum)
        largest = np.abs(velocity).max(initial=0.0)
        for other, beside in enumerate(self._nodes):
            moved = np.where(self._dofs[beside] >= 0, velocity[self._dofs[beside]], 0.0)
            if other != surface and np.abs(moved).max(initial=0.0) > COUPLED * largest:
                raise InputError(
                    f"mass: an impulse on surface {self._surfaces[surface].name!r} moves "
                    f"{self._surfaces[other].name!r}; impulses of landing want a mass that couples "
                    "no two surfaces, so leave it out",
                    "mass",
                )
        return np.where(free, velocity[dofs], 0.0)

    def change(self, landed: Array) -> Array:
        """Return by how much velocities change if so much of the last answers is given."""
        change = np.zeros(self._count)
        for surface, answer in self._answers.items():
            change += landed[surface] * answer
        self._answers.clear()
        return change

    def _actions(self, mass: Any) -> tuple[Action, Action, Array]:  # noqa: ANN401 (as above)
        """Return what multiplies with M, what solves with it, and how each unknown resists alone.

        That is the sum of its row without signs, since rows of corners of second order sum to less
        than 0; of an operator, whose rows nobody sees, the sum.
        """
        if is_operator(mass):
            times = mass.matvec if isinstance(mass, LinearOperator) else mass

            def product(vector: Array) -> Array:
                return self._shaped(times(vector))

            return product, self._by_gradients, product(np.ones(self._count))
        if sp.issparse(mass) or np.ndim(mass) == 2:
            matrix = sp.csc_array(mass, dtype=np.float64)
            self._refuse_shape(matrix.shape, (self._count, self._count))
            factor = splu(matrix)
            own, rows = matrix.diagonal(), np.asarray(abs(matrix).sum(axis=1)).ravel()
            sizes = np.where(own > 0.0, rows, own)
            return lambda vector: np.asarray(matrix @ vector), factor.solve, sizes
        diagonal = numbers("mass", mass)
        self._refuse_shape(diagonal.shape, (self._count,))
        return lambda vector: diagonal * vector, lambda momentum: momentum / diagonal, diagonal

    def _by_gradients(self, momentum: Array) -> Array:
        """Solve by conjugate gradients: masses are well conditioned."""
        if not momentum.any():
            return np.zeros(self._count)
        operator = LinearOperator(
            (self._count, self._count), matvec=self._product, dtype=np.float64
        )
        # What is not positive definite may lead to no number, which the residual says.
        with np.errstate(all="ignore"):
            rtol = 0.01 * LARGEST_RESIDUAL
            velocity, _ = cg(operator, momentum, rtol=rtol, atol=0.0, maxiter=1000)
        residual = np.linalg.norm(self._product(velocity) - momentum) / np.linalg.norm(momentum)
        if not residual < LARGEST_RESIDUAL:
            raise InputError(
                f"mass: M v = p is solved to {residual:.1e} by conjugate gradients, where "
                f"{LARGEST_RESIDUAL:g} is wanted; it must be symmetric and positive definite",
                "mass",
            )
        return np.asarray(velocity)

    def _shaped(self, answer: Any) -> Array:  # noqa: ANN401 (what a function returns)
        found = np.asarray(answer, dtype=np.float64)
        self._refuse_shape(found.shape, (self._count,))
        return found

    @staticmethod
    def _refuse_shape(shape: tuple[int, ...], wanted: tuple[int, ...]) -> None:
        if shape != wanted:
            raise InputError(
                f"mass has shape {shown(shape)}; must be {shown(wanted)}, one row for each unknown",
                "mass",
            )
