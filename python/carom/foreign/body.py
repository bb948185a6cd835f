"""A body whose law somebody else knows."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike, NDArray

from carom.case.foreign_body import CONTACT_SET, ForeignEntry
from carom.contact.surface import Surface
from carom.errors import InputError
from carom.friction.arrays import matrix, numbers, shown
from carom.mesh_file.arrays import MeshArrays, Refused
from carom.mesh_file.cells import KINDS
from carom.mesh_file.upright import upright
from carom.messages import known

Entries = tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]
"""Rows, columns and values of a sparse matrix."""


class ForeignBody:
    """A deformable body of another code, among the bodies of a `Scenario` or for `ForeignRun`.

    Its unknowns are the displacements of its nodes. With the scheme ``conserving`` a step keeps its
    energy and momenta whatever its law, as long as its energy is the same wherever the body is
    moved to or turned, and the force is the gradient of the energy.

    Parameters
    ----------
    name
        Unique over bodies and obstacles.
    points
        Its nodes without deformation [m], shape [point_count, D], D = 2 or 3.
    facets
        Its boundary, or the part that may touch others, by its own nodes, as in
        `carom.contact.Surface`.
    mass
        Mass matrix [kg], shape [dof_count, dof_count], NumPy or scipy.sparse; positive definite.
    energy
        E(u) [J] of displacements u [m], shape [dof_count].
    force
        Its gradient [N], shape [dof_count].
    stiffness
        Its second derivative [N/m], NumPy or scipy.sparse, shape [dof_count, dof_count]. It decides
        how fast iterations converge, and nothing else, so it may be approximate.
    velocity
        Velocities of the nodes at the start [m/s], shape [point_count, D] or [D]; None is none.
    fixed
        Which components of which nodes do not move, shape [point_count, D]; None is none.
    dofs
        The number of the unknown of each node and component, shape [point_count, D]; without it
        component i of node n is D n + i.
    self_contact
        Whether it may touch itself.
    cells
        Its cells by the name of their kind in meshio, such as ``{"triangle": mesh.t.T}``, nodes in
        VTK's order, shape [cell_count, node_count]. They are what is drawn of it, and what may be
        inside what; `ForeignRun` does without.
    thickness
        Thickness of a body in the plane [m], by which fields have forces as pressures.

    Raises
    ------
    InputError
        If arrays do not fit.
    """

    def __init__(
        self,
        name: str,
        points: ArrayLike,
        facets: ArrayLike | Sequence[ArrayLike],
        *,
        mass: Any,  # noqa: ANN401 (NumPy or any scipy.sparse)
        energy: Callable[[NDArray[np.float64]], float],
        force: Callable[[NDArray[np.float64]], NDArray[np.float64]],
        stiffness: Callable[[NDArray[np.float64]], Any],
        velocity: ArrayLike | None = None,
        fixed: ArrayLike | None = None,
        dofs: ArrayLike | None = None,
        self_contact: bool = False,
        cells: Mapping[str, ArrayLike] | None = None,
        thickness: float = 1.0,
    ) -> None:
        self.name = name
        self._cells, self._thickness = cells, thickness
        self.surface = Surface(name, facets, self_contact=self_contact)
        self.points = numbers(self._key("points"), points)
        if self.points.ndim != 2 or self.points.shape[1] not in {2, 3} or not len(self.points):
            raise self._refusal(
                "points",
                f"has shape {shown(self.points.shape)}; must be [point_count, 2] or "
                "[point_count, 3]",
            )
        self.velocity = self._moving(velocity)
        self.fixed = self._held(fixed)
        self._dofs = self._numbered(dofs)
        # The node and component of every unknown.
        self._place = np.argsort(self._dofs.ravel())
        self._energy, self._force, self._stiffness = energy, force, stiffness
        self.mass_entries = self._entries("mass", mass)

    def as_entry(self) -> ForeignEntry:
        """Return what a scenario has in its place."""
        entry = ForeignEntry(
            name=self.name,
            thickness=self._thickness,
            contact_sets=(CONTACT_SET,),
            self_contact=self.surface.self_contact,
        )
        return entry.with_code(self)

    def mesh(self) -> MeshArrays:
        """Return its cells and facets, as a run of a scenario draws them.

        Raises
        ------
        InputError
            It has no cells, or they are none of carom's, inside out, or not of all its points.
        """
        if self._cells is None:
            raise self._refusal(
                "cells",
                "are missing; in a scenario a body is drawn, so give its cells by their kind, such "
                'as cells={"triangle": cells}',
            )
        blocks = [(kind, self._nodes_of(kind, cells)) for kind, cells in self._cells.items()]
        used = np.unique(np.concatenate([nodes.ravel() for _, nodes in blocks]))
        if not np.array_equal(used, np.arange(len(self.points))):
            raise self._refusal(
                "cells",
                f"have {len(used)} of the {len(self.points)} points; give every point a cell, and "
                "every cell its points",
            )
        try:
            right = upright(self.points, blocks)
        except Refused as refused:
            raise self._refusal("cells", refused.what) from None
        return MeshArrays(
            points=self.points,
            blocks=[(KINDS[kind].name, nodes) for kind, nodes in right.blocks],
            facet_sets={CONTACT_SET: self.surface.facets},
        )

    def _nodes_of(self, kind: str, cells: ArrayLike) -> NDArray[np.int64]:
        """Return the nodes of the cells of a kind."""
        space = self.points.shape[1]
        if kind not in KINDS or KINDS[kind].dimension != space:
            taken = [name for name, one in KINDS.items() if one.dimension == space]
            raise self._refusal(
                "cells", f"{kind!r} is no kind of cell in {space}D; {known(kind, taken)}"
            )
        array, width = np.asarray(cells), len(KINDS[kind].mirror)
        if array.ndim != 2 or array.shape[1] != width or array.dtype.kind not in "iu":
            raise self._refusal(
                "cells",
                f"{kind!r} has shape {shown(array.shape)} and type {array.dtype}; must be integers "
                f"of shape [cell_count, {width}]",
            )
        return np.ascontiguousarray(array, dtype=np.int64)

    @property
    def dof_count(self) -> int:
        """Number of unknowns."""
        return self.points.size

    def energy_at(self, u: NDArray[np.float64]) -> float:
        """Return E [J] at displacements of the nodes [m], shape [point_count, D].

        Raises
        ------
        InputError
            If the answer is no finite number.
        """
        answer = numbers(self._key("energy"), self._energy(self._vector(u)), finite=False)
        if answer.shape != () or not np.isfinite(answer):
            raise self._refusal(
                "energy", f"returned {answer.tolist()!r:.60}; must be one finite number [J]"
            )
        return float(answer)

    def force_at(self, u: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the forces on the nodes [N] at their displacements [m], shape [point_count, D].

        Raises
        ------
        InputError
            If the answer has another shape or is not finite.
        """
        answer = numbers(self._key("force"), self._force(self._vector(u)), finite=False)
        if answer.shape != (self.dof_count,):
            raise self._refusal(
                "force",
                f"returned shape {shown(answer.shape)}; must be [{self.dof_count}], a number for "
                "each unknown",
            )
        if not np.isfinite(answer).all():
            where = int(np.flatnonzero(~np.isfinite(answer))[0])
            raise self._refusal(
                "force",
                f"returned {answer[where]} at [{where}]; must be finite, so take shorter steps if "
                "cells invert",
            )
        return np.ascontiguousarray(answer[self._dofs])

    def stiffness_at(self, u: NDArray[np.float64]) -> Entries:
        """Return the entries of the stiffness [N/m] between nodes at their displacements [m].

        Raises
        ------
        InputError
            If the answer has another shape or is not finite.
        """
        return self._entries("stiffness", self._stiffness(self._vector(u)))

    def _vector(self, u: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return displacements of nodes by the unknowns of the other code."""
        return u.ravel()[self._place]

    def _entries(self, what: str, values: Any) -> Entries:  # noqa: ANN401 (as of `mass`)
        entries = sp.coo_array(matrix(self._key(what), values))
        if entries.shape != (self.dof_count, self.dof_count):
            raise self._refusal(
                what,
                f"has shape {shown(entries.shape)}; must be [{self.dof_count}, {self.dof_count}], "
                f"{self.points.shape[1]} unknowns for each point",
            )
        rows, columns = self._place[entries.row], self._place[entries.col]
        dimension = self.points.shape[1]
        order = np.lexsort((columns // dimension, rows // dimension))
        return rows[order], columns[order], entries.data[order]

    def _moving(self, velocity: ArrayLike | None) -> NDArray[np.float64]:
        given = numbers(self._key("velocity"), 0.0 if velocity is None else velocity)
        if given.shape not in {(), self.points.shape, self.points.shape[1:]}:
            raise self._refusal(
                "velocity",
                f"has shape {shown(given.shape)}; must be {shown(self.points.shape)} or "
                f"{shown(self.points.shape[1:])}",
            )
        return np.array(np.broadcast_to(given, self.points.shape))

    def _held(self, fixed: ArrayLike | None) -> NDArray[np.bool_]:
        if fixed is None:
            return np.zeros(self.points.shape, dtype=np.bool_)
        array = np.asarray(fixed)
        if array.shape != self.points.shape or array.dtype != np.bool_:
            raise self._refusal(
                "fixed",
                f"has shape {shown(array.shape)} and type {array.dtype}; must be true or false, of "
                f"shape {shown(self.points.shape)}",
            )
        return array

    def _numbered(self, dofs: ArrayLike | None) -> NDArray[np.int64]:
        every = np.arange(self.points.size, dtype=np.int64)
        if dofs is None:
            return every.reshape(self.points.shape)
        array = np.asarray(dofs)
        if array.shape != self.points.shape or not np.array_equal(np.sort(array.ravel()), every):
            raise self._refusal(
                "dofs",
                f"must have shape {shown(self.points.shape)} and every number from 0 to "
                f"{len(every) - 1} once",
            )
        return array.astype(np.int64)

    def _key(self, what: str) -> str:
        return f"bodies.{self.name}.{what}"

    def _refusal(self, what: str, message: str) -> InputError:
        return InputError(f"{self._key(what)}: {message}", self._key(what))

    def __repr__(self) -> str:
        return f"<ForeignBody {self.name!r}: {len(self.points)} points>"
