"""A contact problem in global form: M, H, f, b and μ."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
import scipy.sparse as sp
import scipy.sparse.linalg as spla
from numpy.typing import ArrayLike, NDArray

from carom import _carom
from carom.display.counting import count
from carom.errors import InputError
from carom.friction import arrays
from carom.friction.measure import Measure, measure
from carom.friction.problem import Problem

COLUMNS_AT_ONCE = 64
"""Right-hand sides that are solved together where W is needed column by column."""


class GlobalProblem:
    """Find v, r and w with M v = H r + f and w = Hᵀ v + b that obey Signorini's and Coulomb's laws.

    Eliminating v gives the local form, W = Hᵀ M⁻¹ H and q = Hᵀ M⁻¹ f + b. Units are those of
    `Problem`: displacements and forces, or velocities and impulses.

    Parameters
    ----------
    M
        Mass or stiffness, shape [dof_count, dof_count], a NumPy array or any scipy.sparse matrix;
        regular, not necessarily symmetric.
    H
        Contact reactions to dofs, shape [dof_count, n D].
    f
        Loads, shape [dof_count].
    b
        Relative motions at v = 0, component 0 of each contact normal, shape [n, D] or [n D].
    mu
        Friction coefficients, at least 0, shape [n]; a number holds for all contacts of a `b` of
        shape [n, D].

    Raises
    ------
    InputError
        If shapes do not fit, a number is not finite, or a coefficient is negative.

    Attributes
    ----------
    m_starts, m_rows, m_values
        M in compressed columns: first entry of each column, shape [dof_count + 1]; rows; values.
    h_starts, h_rows, h_values
        H likewise.
    f
        Shape [dof_count].
    b
        Shape [n, D].
    mu
        Shape [n].
    """

    def __init__(self, M: Any, H: Any, f: ArrayLike, b: ArrayLike, mu: ArrayLike) -> None:  # noqa: ANN401
        m, h = arrays.matrix("M", M), arrays.matrix("H", H)
        dofs = m.shape[0]
        if m.shape != (dofs, dofs):
            raise InputError(f"M has shape {arrays.shown(m.shape)}: must be square", "M")
        contacts, dimension = arrays.sizes("b", b, mu)
        if h.shape != (dofs, contacts * dimension):
            raise InputError(
                f"H has shape {arrays.shown(h.shape)}: must be [{dofs}, {contacts * dimension}], "
                f"rows as M has and columns for {contacts} contacts of {dimension} components",
                "H",
            )
        loads = arrays.numbers("f", f)
        if loads.shape != (dofs,):
            raise InputError(
                f"f has shape {arrays.shown(loads.shape)}: must be [{dofs}] as M has rows", "f"
            )
        self.f = loads
        self.b = arrays.vectors("b", b, contacts=contacts, dimension=dimension)
        self.mu = arrays.coefficients(mu, contacts=contacts)
        self.m_starts, self.m_rows, self.m_values = _columns(m)
        self.h_starts, self.h_rows, self.h_values = _columns(h)
        for array in vars(self).values():
            array.flags.writeable = False

    @property
    def contacts(self) -> int:
        """Number of contacts n."""
        return len(self.mu)

    @property
    def dimension(self) -> int:
        """Components D of a contact vector."""
        return int(self.b.shape[1])

    @property
    def dofs(self) -> int:
        """Number of degrees of freedom."""
        return len(self.f)

    @property
    def M(self) -> sp.csc_array:  # noqa: N802
        """M, shape [dof_count, dof_count]."""
        return sp.csc_array(
            (self.m_values, self.m_rows, self.m_starts), shape=(self.dofs, self.dofs)
        )

    @property
    def H(self) -> sp.csc_array:  # noqa: N802
        """H, shape [dof_count, n D]."""
        return sp.csc_array(
            (self.h_values, self.h_rows, self.h_starts), shape=(self.dofs, self.b.size)
        )

    @cached_property
    def q(self) -> NDArray[np.float64]:
        """Relative motions without reactions Hᵀ M⁻¹ f + b, shape [n, D]."""
        return self.motions(np.zeros_like(self.b))

    @cached_property
    def stiffness(self) -> float:
        """The natural unit of stiffness n D / tr W [N/m]; 1 where nothing can move."""
        trace = 0.0
        for first in range(0, self.b.size, COLUMNS_AT_ONCE):
            columns = self.H[:, first : first + COLUMNS_AT_ONCE]
            trace += float(columns.multiply(self._factor.solve(columns.toarray())).sum())
        return self.b.size / trace if trace > 0.0 else 1.0

    def velocities(self, reactions: ArrayLike) -> NDArray[np.float64]:
        """Return v with M v = H r + f, shape [dof_count], of reactions, shape [n, D] or [n D]."""
        r = self.vectors("reactions", reactions, finite=False)
        return np.asarray(self._factor.solve(self.H @ r.ravel() + self.f))

    def motions(self, reactions: ArrayLike) -> NDArray[np.float64]:
        """Return w = Hᵀ v + b, shape [n, D], of reactions, shape [n, D] or [n D]."""
        return np.asarray((self.H.T @ self.velocities(reactions)).reshape(self.b.shape) + self.b)

    def measure(self, reactions: ArrayLike) -> Measure:
        """Return how far reactions, shape [n, D] or [n D], are from the law."""
        r = self.vectors("reactions", reactions, finite=False)
        return measure(r, self.motions(r), q=self.q, mu=self.mu, stiffness=self.stiffness)

    def condense(self) -> Problem:
        """Return the problem in local form, W = Hᵀ M⁻¹ H and q = Hᵀ M⁻¹ f + b.

        W is taken as it comes out: with an M that is not symmetric it is not symmetric either.

        Raises
        ------
        InputError
            If M is singular.
        """
        try:
            local = _carom.condense_friction(self)
        except ValueError as error:
            raise InputError(str(error), "M") from error
        return Problem.from_blocks(**local, mu=self.mu)

    def vectors(self, name: str, values: ArrayLike, *, finite: bool = True) -> NDArray[np.float64]:
        """Return one vector per contact, shape [n, D], from that shape or a flat one."""
        return arrays.vectors(
            name, values, contacts=self.contacts, dimension=self.dimension, finite=finite
        )

    @cached_property
    def _factor(self) -> Any:  # noqa: ANN401 (scipy has no type for it)
        try:
            return spla.splu(sp.csc_matrix(self.M))
        except RuntimeError:
            raise InputError(
                "M is singular: must be regular; hold every rigid motion", "M"
            ) from None

    def __repr__(self) -> str:
        contacts = count(self.contacts, "contact")
        return f"<GlobalProblem: {contacts} in {self.dimension}D, {count(self.dofs, 'dof')}>"


def _columns(
    rows: sp.csr_array,
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]:
    """Return first entries, rows and values of compressed columns."""
    columns = rows.tocsc()
    columns.sort_indices()
    return (
        columns.indptr.astype(np.int64),
        columns.indices.astype(np.int64),
        columns.data.astype(np.float64),
    )
