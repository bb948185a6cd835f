"""What a case says of the mesh of a body: how large it is, and which of it has names."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Protocol

import numpy as np

from carom.auditing.arrays import Array, Indices, Mask
from carom.auditing.mesh.facets import corners_of
from carom.case.body import DescribedBody
from carom.case.mesh import Ball, Box, Cylinder, Disc, MeshFile, Rectangle, Ring
from carom.errors import InputError
from carom.mesh_file import MeshArrays, read_body_mesh

ON_SIDE = 1e-9
"""Nodes this close to a side, relative to its length, are on it."""


class Drawn(Protocol):
    """A mesh as the case draws it.

    Points are reference positions of all nodes [m], shape [node_count, D], and outlines the facets
    of the boundary, shape [facet_count, a].
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


def drawn(entry: DescribedBody, dimension: int) -> Drawn:
    """Return the mesh of a body as the case draws it.

    Raises
    ------
    InputError
        A file cannot be read.
    """
    mesh = entry.mesh
    if isinstance(mesh, MeshFile):
        return _Read.of(entry.name, mesh, dimension)
    if isinstance(mesh, Rectangle | Box):
        return _Upright(mesh)
    if isinstance(mesh, Disc | Ball):
        return _Round(mesh.centre, None, {"surface": mesh.radius}, {}, _cells_within(mesh))
    if isinstance(mesh, Ring):
        radii = {"inner": mesh.inner_radius, "outer": mesh.outer_radius}
        count = mesh.divisions[0] * mesh.divisions[1] * _PARTS[mesh.cell]
        return _Round(mesh.centre, None, radii, {}, count)
    if isinstance(mesh, Cylinder):
        radii, layers = {"side": mesh.radius}, mesh.layers * _in_disc(mesh.divisions, mesh.rings)
    else:
        radii = {"inner": mesh.inner_radius, "outer": mesh.outer_radius}
        layers = mesh.divisions[0] * mesh.divisions[1] * mesh.divisions[2]
    ends = {"bottom": 0.0, "top": mesh.height}
    return _Round(mesh.base, mesh.axis, radii, ends, layers * _PARTS[mesh.cell])


def given(arrays: MeshArrays) -> Drawn:
    """Return a mesh that is there as arrays."""
    return _Read.given(arrays)


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


_PARTS = {
    **dict.fromkeys(("quad4", "quad8", "quad9", "hex8", "hex20", "hex27"), 1),
    **dict.fromkeys(("tri3", "tri6", "wedge6", "wedge15"), 2),
    **dict.fromkeys(("tet4", "tet10"), 6),
}
"""Into how many cells a quadrilateral or a hexahedron is cut."""


def _in_disc(divisions: int, rings: int | None) -> int:
    """Return the quadrilaterals of a disc: of its core, and of the rings around it."""
    return divisions * (divisions + 4 * (divisions // 2 if rings is None else rings))


def _cells_within(mesh: Disc | Ball) -> int:
    n = mesh.divisions
    if isinstance(mesh, Disc):
        return _in_disc(n, mesh.rings) * _PARTS[mesh.cell]
    shells = n // 2 if mesh.rings is None else mesh.rings
    return (n**3 + 6 * n * n * shells) * _PARTS[mesh.cell]


@dataclass(frozen=True)
class _Round:
    """A disc, a ring or a ball; with an axis a cylinder or a tube.

    Parameters
    ----------
    centre
        A point of the axis, or the centre [m], shape [D].
    axis
        Direction of the axis; None of what has none.
    radii
        Radii of its circles, or of its spheres or cylinders, by their names [m].
    ends
        Heights of its ends along the axis by their names [m].
    cell_count
        Number of cells.
    """

    centre: tuple[float, ...]
    axis: tuple[float, ...] | None
    radii: Mapping[str, float]
    ends: Mapping[str, float]
    cell_count: int

    def misfit(self, points: Array, outline: Indices) -> float:
        # Nodes within curved or straight sides are between others.
        corners = np.unique(corners_of(outline, points.shape[1]))
        off = [
            np.abs(self._measured(points[corners], name) - figure)
            for name, figure in (*self.radii.items(), *self.ends.items())
        ]
        return float(np.min(off, axis=0).max())

    def facets(self, name: str, points: Array, outline: Indices) -> Mask | None:
        figure = self.radii.get(name, self.ends.get(name))
        if figure is None:
            return None
        size = max(*self.radii.values(), *self.ends.values(), 0.0)
        corners = corners_of(outline, points.shape[1])
        off = np.abs(self._measured(points, name) - figure)[corners].max(axis=1)
        return np.asarray(off <= ON_SIDE * size)

    def _measured(self, points: Array, name: str) -> Array:
        """Return heights of points above the base, or distances from axis or centre [m]."""
        arms = points - np.array(self.centre)
        if self.axis is not None:
            axis = np.array(self.axis) / np.linalg.norm(self.axis)
            heights: Array = arms @ axis
            if name in self.ends:
                return heights
            arms = arms - heights[:, None] * axis
        distances: Array = np.linalg.norm(arms, axis=1)
        return distances

    def cells(self, name: str) -> Indices:
        raise unknown(name)


_SIDES = {
    2: (("left", "right"), ("bottom", "top")),
    3: (("left", "right"), ("front", "back"), ("bottom", "top")),
}
"""Names of the lower and the upper side along each axis, by dimension."""


@dataclass(frozen=True)
class _Upright:
    """A rectangle or a box."""

    mesh: Rectangle | Box

    @property
    def cell_count(self) -> int:
        return int(np.prod(self.mesh.divisions)) * _PARTS[self.mesh.cell]

    def misfit(self, points: Array, outline: Indices) -> float:
        del outline
        low, high = points.min(axis=0), points.max(axis=0)
        corner = np.array(self.mesh.corner)
        return float(np.abs([low - corner, high - corner - np.array(self.mesh.size)]).max())

    def facets(self, name: str, points: Array, outline: Indices) -> Mask | None:
        for axis, sides in enumerate(_SIDES[len(self.mesh.size)]):
            if name in sides:
                length = self.mesh.size[axis]
                at = self.mesh.corner[axis] + length * sides.index(name)
                off = np.abs(points[:, axis] - at)[outline].max(axis=1)
                return np.asarray(off <= ON_SIDE * length)
        return None

    def cells(self, name: str) -> Indices:
        raise unknown(name)


@dataclass(frozen=True)
class _Read:
    """A mesh that comes as arrays, whose nodes and cells have the numbers that they have there."""

    points: Array
    cell_count: int
    nodes: Mapping[str, Indices]
    named_facets: Mapping[str, set[frozenset[int]]]
    named_cells: Mapping[str, Indices] = field(default_factory=dict)

    @classmethod
    def of(cls, name: str, mesh: MeshFile, dimension: int) -> _Read:
        arrays = read_body_mesh(
            mesh.file,
            body=mesh.body,
            scale=mesh.scale,
            space=dimension,
            key=f"the mesh of body {name!r}",
        )
        move = np.zeros(dimension) if mesh.move is None else np.array(mesh.move)
        return cls.given(replace(arrays, points=arrays.points + move))

    @classmethod
    def given(cls, arrays: MeshArrays) -> _Read:
        """Return a mesh that is there as arrays."""
        return cls(
            points=arrays.points,
            cell_count=sum(len(nodes) for _, nodes in arrays.blocks),
            nodes=arrays.node_sets,
            named_facets={
                key: {
                    frozenset(corners)
                    for facets in several
                    for corners in corners_of(facets, arrays.points.shape[1]).tolist()
                }
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
        if name not in self.named_facets:
            return None
        known = self.named_facets[name]
        mine = corners_of(outline, points.shape[1]).tolist()
        return np.array([frozenset(facet) in known for facet in mine], dtype=bool)

    def cells(self, name: str) -> Indices:
        if name not in self.named_cells:
            raise unknown(name)
        return self.named_cells[name]
