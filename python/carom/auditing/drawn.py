"""What a case says of the mesh of a body: how large it is, and which of it has names."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from carom.auditing.arrays import Array, Indices, Mask
from carom.case.body import AnyBody
from carom.case.mesh import Disc, MeshFile, Rectangle, Ring
from carom.errors import InputError
from carom.mesh_file import read_body_mesh

ON_SIDE = 1e-9
"""Nodes this close to a side, relative to its length, are on it."""


class Drawn(Protocol):
    """A mesh as the case draws it.

    Points are reference positions of all nodes [m], shape [node_count, 2], and outlines the facets
    of the boundary, shape [facet_count, 2].
    """

    @property
    def cell_count(self) -> int:
        """How many cells it has."""

    def misfit(self, points: Array, outline: Indices) -> float:
        """Return how far a mesh is from it [m]."""

    def facets(self, name: str, points: Array, outline: Indices) -> Mask | None:
        """Return which facets of a boundary are of a set; None if there is no such set."""

    def cells(self, name: str) -> Indices:
        """Return the cells of a set."""


def drawn(entry: AnyBody) -> Drawn:
    """Return the mesh of a body as the case draws it.

    Raises
    ------
    InputError
        A file cannot be read.
    """
    mesh = entry.mesh
    if isinstance(mesh, Disc):
        return _Round(mesh, {"surface": mesh.radius}, _cells_of_disc(mesh))
    if isinstance(mesh, Ring):
        radii = {"inner": mesh.inner_radius, "outer": mesh.outer_radius}
        return _Round(mesh, radii, mesh.divisions[0] * mesh.divisions[1])
    if isinstance(mesh, Rectangle):
        return _Upright(mesh)
    assert isinstance(mesh, MeshFile), "all others are in space"
    return _Read.of(entry.name, mesh)


def nodes_of(mesh: Drawn, name: str, points: Array, outline: Indices, cells: Indices) -> Indices:
    """Return the nodes of a set: those of its facets, of its cells, and those that it names."""
    if name == "all":
        return np.arange(len(points))
    parts = []
    chosen = mesh.facets(name, points, outline)
    if chosen is not None:
        parts.append(outline[chosen].ravel())
    if isinstance(mesh, _Read):
        parts.append(mesh.nodes.get(name, _NONE))
        parts.append(cells[mesh.named_cells.get(name, _NONE)].ravel())
    nodes: Indices = np.unique(np.concatenate([_NONE, *parts]))
    if len(nodes) == 0:
        raise unknown(name)
    return nodes


def unknown(name: str) -> InputError:
    """Return the error of a set that a mesh does not have."""
    return InputError(f"cannot audit the set {name!r}: the mesh that the case names has none")


_NONE: Indices = np.zeros(0, dtype=np.int64)


def _cells_of_disc(mesh: Disc) -> int:
    n, rings = mesh.divisions, mesh.rings or mesh.divisions // 2
    return n * n + 4 * n * rings


def _with(cell: str, quadrilaterals: int) -> int:
    return quadrilaterals * (2 if cell == "tri3" else 1)


@dataclass(frozen=True)
class _Round:
    """A disc or a ring, with the radii of its circles by their names [m]."""

    mesh: Disc | Ring
    radii: Mapping[str, float]
    quadrilaterals: int

    @property
    def cell_count(self) -> int:
        return _with(self.mesh.cell, self.quadrilaterals)

    def misfit(self, points: Array, outline: Indices) -> float:
        rim = np.linalg.norm(points[np.unique(outline)] - np.array(self.mesh.centre), axis=1)
        return float(np.abs(rim[:, None] - list(self.radii.values())).min(axis=1).max())

    def facets(self, name: str, points: Array, outline: Indices) -> Mask | None:
        if name not in self.radii:
            return None
        rim = np.linalg.norm(points - np.array(self.mesh.centre), axis=1)
        off = np.abs(rim - self.radii[name])[outline].max(axis=1)
        return np.asarray(off <= ON_SIDE * self.radii[name])

    def cells(self, name: str) -> Indices:
        raise unknown(name)


@dataclass(frozen=True)
class _Upright:
    """A rectangle."""

    mesh: Rectangle

    @property
    def cell_count(self) -> int:
        return _with(self.mesh.cell, self.mesh.divisions[0] * self.mesh.divisions[1])

    def misfit(self, points: Array, outline: Indices) -> float:
        del outline
        low, high = points.min(axis=0), points.max(axis=0)
        corner = np.array(self.mesh.corner)
        return float(np.abs([low - corner, high - corner - np.array(self.mesh.size)]).max())

    def facets(self, name: str, points: Array, outline: Indices) -> Mask | None:
        if name not in ("left", "right", "bottom", "top"):
            return None
        axis = 0 if name in ("left", "right") else 1
        length = self.mesh.size[axis]
        at = self.mesh.corner[axis] + (length if name in ("right", "top") else 0.0)
        off = np.abs(points[:, axis] - at)[outline].max(axis=1)
        return np.asarray(off <= ON_SIDE * length)

    def cells(self, name: str) -> Indices:
        raise unknown(name)


@dataclass(frozen=True)
class _Read:
    """A mesh from a file, whose nodes and cells have the numbers of the file."""

    points: Array
    cell_count: int
    nodes: Mapping[str, Indices]
    named_facets: Mapping[str, Indices]
    named_cells: Mapping[str, Indices] = field(default_factory=dict)

    @classmethod
    def of(cls, name: str, mesh: MeshFile) -> _Read:
        arrays = read_body_mesh(
            mesh.file, body=mesh.body, scale=mesh.scale, space=2, key=f"the mesh of body {name!r}"
        )
        move = np.zeros(2) if mesh.move is None else np.array(mesh.move)
        return cls(
            points=arrays.points + move,
            cell_count=sum(len(nodes) for _, nodes in arrays.blocks),
            nodes=arrays.node_sets,
            named_facets={
                key: np.concatenate([facets[:, :2] for facets in several])
                for key, several in arrays.facet_sets.items()
            },
            named_cells=arrays.cell_sets,
        )

    def misfit(self, points: Array, outline: Indices) -> float:
        del outline
        if points.shape != self.points.shape:
            return np.inf
        return float(np.abs(points - self.points).max())

    def facets(self, name: str, points: Array, outline: Indices) -> Mask | None:
        del points
        if name not in self.named_facets:
            return None
        known = {tuple(sorted(facet)) for facet in self.named_facets[name].tolist()}
        return np.array([tuple(sorted(facet)) in known for facet in outline.tolist()], dtype=bool)

    def cells(self, name: str) -> Indices:
        if name not in self.named_cells:
            raise unknown(name)
        return self.named_cells[name]
