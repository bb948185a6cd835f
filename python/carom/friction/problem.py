"""A contact problem in local form: W, q and μ."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike, NDArray
from typing_extensions import Self

from carom.display.counting import count
from carom.errors import InputError
from carom.friction import arrays, symmetry
from carom.friction.blocks import BlockRows, block_rows
from carom.friction.measure import Measure, measure_by_powers


class Problem:
    """Find reactions r and motions w = W r + q that obey Signorini's and Coulomb's laws.

    Component 0 of each contact is normal, positive where it opens; the others are tangential. With
    displacements [m] and forces [N] the certificate is in joules; velocities [m/s] and impulses
    [N s] are as good.

    Parameters
    ----------
    W
        Delassus operator [m/N], shape [n D, n D], a NumPy array or any scipy.sparse matrix;
        symmetric, positive semidefinite. Smaller asymmetries than 1 % of its largest entry are
        removed, with an `AsymmetryWarning` above round-off.
    q
        Relative motion without reactions [m], shape [n, D] or [n D]; D = 1, 2 or 3.
    mu
        Friction coefficients, at least 0, shape [n]; a number holds for all contacts of a `q` of
        shape [n, D].

    Raises
    ------
    InputError
        If shapes do not fit, if a number is not finite, a coefficient is negative, or W is
        asymmetric by more than 1 % or clearly indefinite.

    Attributes
    ----------
    starts, columns, blocks
        W in compressed block rows: first block of each row, shape [n + 1]; block columns; blocks,
        shape [block_count, D, D].
    q
        Shape [n, D].
    mu
        Shape [n].
    asymmetry
        ``max |W − Wᵀ| / max |W|`` of the W given.
    """

    def __init__(self, W: Any, q: ArrayLike, mu: ArrayLike) -> None:  # noqa: ANN401
        rows = arrays.matrix("W", W)
        contacts, dimension = arrays.sizes("q", q, mu)
        q = arrays.vectors("q", q, contacts=contacts, dimension=dimension)
        mu = arrays.coefficients(mu, contacts=contacts)
        size = contacts * dimension
        if rows.shape != (size, size):
            raise InputError(
                f"W has shape {arrays.shown(rows.shape)}: must be [{size}, {size}] for {contacts} "
                f"contacts of {dimension} components, as q and mu have it",
                "W",
            )
        symmetric, asymmetry = symmetry.symmetrised(rows, dimension=dimension, stacklevel=2)
        symmetry.refuse_indefinite(symmetric, dimension=dimension, asymmetry=asymmetry)
        self._set(block_rows(symmetric, dimension), q, mu, asymmetry=asymmetry)
        self._symmetric = True

    @classmethod
    def from_blocks(
        cls,
        starts: ArrayLike,
        columns: ArrayLike,
        blocks: ArrayLike,
        q: ArrayLike,
        mu: ArrayLike,
    ) -> Self:
        """Make a problem of a W in compressed block rows, which is taken as it is.

        Parameters
        ----------
        starts, columns, blocks
            As the attributes have them; columns ascending in every row, with the diagonal, and
            (j, i) stored wherever (i, j) is.
        q
            Shape [n, D].
        mu
            Shape [n].
        """
        block_array = arrays.numbers("blocks", blocks)
        rows = BlockRows(
            np.array(starts, dtype=np.int64), np.array(columns, dtype=np.int64), block_array
        )
        contacts, dimension = len(rows.starts) - 1, block_array.shape[1]
        problem = cls.__new__(cls)
        problem._set(
            rows,
            arrays.vectors("q", q, contacts=contacts, dimension=dimension),
            arrays.coefficients(mu, contacts=contacts),
            asymmetry=0.0,
        )
        problem._symmetric = False
        return problem

    def _set(
        self,
        rows: BlockRows,
        q: NDArray[np.float64],
        mu: NDArray[np.float64],
        *,
        asymmetry: float,
    ) -> None:
        self._rows = rows
        self.starts, self.columns, self.blocks = rows.starts, rows.columns, rows.blocks
        self.q, self.mu, self.asymmetry = q, mu, asymmetry
        for array in (self.starts, self.columns, self.blocks, q, mu):
            array.flags.writeable = False

    @property
    def contacts(self) -> int:
        """Number of contacts n."""
        return len(self.mu)

    @property
    def dimension(self) -> int:
        """Components D of a contact vector."""
        return int(self.q.shape[1])

    @property
    def stiffness(self) -> float:
        """The natural unit of stiffness n D / tr W [N/m]; 1 where nothing can move."""
        mantissa, exponent = self._stiffness()
        with np.errstate(over="ignore", under="ignore"):
            return float(np.ldexp(mantissa, exponent))

    def _stiffness(self) -> tuple[float, int]:
        """Return m and e of the stiffness m 2^e, which may be too large for a float."""
        owners = np.repeat(np.arange(self.contacts), np.diff(self.starts))
        diagonal = np.einsum("kdd->kd", self.blocks[self.columns == owners])
        exponent = math.frexp(float(np.abs(diagonal).max(initial=0.0)))[1]
        trace = float(np.ldexp(diagonal, -exponent).sum())
        return (self.q.size / trace, -exponent) if trace > 0.0 else (1.0, 0)

    def matrix(self) -> sp.bsr_array:
        """Return W [m/N], shape [n D, n D], symmetric if W was given as a matrix."""
        return self._rows.matrix()

    def refuse_if_indefinite(self, *, seconds: float = math.inf) -> None:
        """Look longer for a negative eigenvalue of W than can be afforded for every problem.

        A W given in blocks, which need not be symmetric, is not looked at.

        Parameters
        ----------
        seconds
            Time after which the search is given up [s].

        Raises
        ------
        InputError
            If there is one that is clearly negative.
        """
        if self._symmetric and self.contacts and seconds > 0.0:
            symmetry.refuse_indefinite(
                self.matrix().tocsr(),
                dimension=self.dimension,
                asymmetry=self.asymmetry,
                steps=symmetry.MANY_STEPS,
                seconds=seconds,
            )

    def motions(self, reactions: ArrayLike) -> NDArray[np.float64]:
        """Return w = W r + q [m], shape [n, D], of reactions [N], shape [n, D] or [n D]."""
        r = self.vectors("reactions", reactions, finite=False)
        return np.asarray((self.matrix() @ r.ravel()).reshape(self.q.shape) + self.q)

    def measure(self, reactions: ArrayLike) -> Measure:
        """Return how far reactions [N], shape [n, D] or [n D], are from the law."""
        r = self.vectors("reactions", reactions, finite=False)
        w = self.motions(r)
        return measure_by_powers(r, w, q=self.q, mu=self.mu, stiffness=self._stiffness())

    def vectors(self, name: str, values: ArrayLike, *, finite: bool = True) -> NDArray[np.float64]:
        """Return one vector per contact, shape [n, D], from that shape or a flat one."""
        return arrays.vectors(
            name, values, contacts=self.contacts, dimension=self.dimension, finite=finite
        )

    def __repr__(self) -> str:
        return (
            f"<Problem: {count(self.contacts, 'contact')} in {self.dimension}D, "
            f"{count(len(self.columns), 'block')} of W>"
        )
