"""The shapes in which a reduced body vibrates, found again from its mass and stiffness."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.auditing.arrays import Array, Indices, turned, turning_axes

NOTHING = 1e-10
"""Shapes with less than this part of the mass of others are rigid motions."""

MOST_UNKNOWNS = 4000
"""Larger matrices than of so many displacements are not made."""

ALIKE = 1e-6
"""Squares of frequencies that differ by less than this part are the same."""


@dataclass(frozen=True)
class Vibrations:
    """Free vibrations of what some shapes span (Craig & Bampton 1968).

    Parameters
    ----------
    shapes
        Displacements of nodes for an amplitude of one, [node_count, D, mode] [1/√kg]. They have the
        mass one each, none with one another, and neither momentum nor angular momentum.
    loads
        M times the shapes, of the same shape [√kg].
    doubt
        Why these may not be the shapes of the run, if so. Where its modes end between two of the
        same frequency, as of a body with a square section, there are all of these; and none where
        matrices would be too large.
    """

    shapes: Array
    loads: Array
    doubt: str = ""

    @classmethod
    def unknown(cls, arms: Array) -> Vibrations:
        """Return those of a body with too many nodes at these arms, shape [node_count, D]."""
        none = np.zeros((*arms.shape, 0))
        return cls(none, none, f"it has more than {MOST_UNKNOWNS} unknowns")

    @classmethod
    def of(
        cls, mass: Array, stiffness: Array, arms: Array, kept: Indices, modes: int
    ) -> Vibrations:
        """Return those that the displacements of some nodes span with modes that hold these.

        Parameters
        ----------
        mass, stiffness
            M [kg], and K where nothing has moved [N/m], shape [node_count × D, node_count × D].
        arms
            Nodes from the centre [m], shape [node_count, D].
        kept
            The nodes whose displacements are kept.
        modes
            How many modes with these held there are beside.
        """
        count, axes = arms.shape
        held = np.zeros((count, axes), dtype=bool)
        held[kept] = True
        b, i = np.flatnonzero(held.ravel()), np.flatnonzero(~held.ravel())
        basis, doubt = np.zeros((count * axes, len(b))), ""
        basis[b, np.arange(len(b))] = 1.0
        if len(i):
            inside = stiffness[np.ix_(i, i)]
            basis[i] = -np.linalg.solve(inside, stiffness[np.ix_(i, b)])
            values, vectors = _modes(inside, mass[np.ix_(i, i)])
            last = values[: max(modes, 1)].max()
            alike = int((values <= (1.0 + ALIKE) * last).sum()) if modes else 0
            doubt = "its modes end between equal frequencies" if alike > modes else ""
            more = np.zeros((count * axes, alike))
            more[i] = vectors[:, :alike]
            basis = np.concatenate([basis, more], axis=1)
        rigid = np.stack(
            [np.broadcast_to(axis, arms.shape).ravel() for axis in np.eye(axes)]
            + [turned(arms, axis).ravel() for axis in np.eye(turning_axes(axes))],
            axis=1,
        )
        # What is left of the shapes beside rigid motions, each with the mass one.
        moved = mass @ rigid
        shares = np.linalg.solve(rigid.T @ moved, moved.T @ basis)
        free = basis - rigid @ shares
        sizes, turns = np.linalg.eigh(free.T @ mass @ free)
        some = sizes > NOTHING * sizes.max()
        free = free @ turns[:, some] / np.sqrt(sizes[some])
        shapes = free.reshape(count, axes, -1)
        return cls(shapes, (mass @ free).reshape(shapes.shape), doubt)

    def amplitudes(self, field: Array) -> Array:
        """Return the amplitudes that a field has [m √kg], shape [mode]."""
        found: Array = np.einsum("aik,ai->k", self.loads, field)
        return found

    def projected(self, field: Array) -> Array:
        """Return what of a field is a vibration, shape [node_count, D]."""
        if not self.shapes.size:
            return field
        part: Array = self.shapes @ self.amplitudes(field)
        return part

    def borne(self, forces: Array) -> Array:
        """Return the forces with the same work on vibrations that are M times one of them [N]."""
        part: Array = self.loads @ np.einsum("aik,ai->k", self.shapes, forces)
        return part

    def yielding(self, forces: Array) -> Array:
        """Return the vibration that impulses give [m/s], shape [node_count, D]."""
        part: Array = self.shapes @ np.einsum("aik,ai->k", self.shapes, forces)
        return part


def _modes(stiffness: Array, mass: Array) -> tuple[Array, Array]:
    """Return ω² [1/s²] and the modes of a pair of matrices, the slowest first."""
    root = np.linalg.cholesky(mass)
    half = np.linalg.solve(root, stiffness)
    whole = np.linalg.solve(root, half.T)
    values, vectors = np.linalg.eigh(0.5 * (whole + whole.T))
    return values, np.linalg.solve(root.T, vectors)
