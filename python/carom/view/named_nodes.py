"""The nodes that the named sets of a body have, found again from where nodes are drawn."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from carom.case.mesh import Ball, Box, Cylinder, Disc, Mesh, MeshFile, Rectangle, Ring, Tube
from carom.errors import InputError
from carom.mesh_file import MeshArrays, read_body_mesh

Points = NDArray[np.float64]
Indices = NDArray[np.int64]

ON = 1e-6
"""How far a node may be from a side that it is on, relative to the size of the mesh."""

MOVED = 1e-3
"""How far a node may be from where the file has it, relative to the same."""


def named_nodes(mesh: Mesh, name: str, points: Points) -> Indices:
    """Return the nodes of a set of a mesh, ascending.

    Results hold no sets. Those of a mesh that carom generates are known by where nodes are; those
    of a file are read from it once more.

    Parameters
    ----------
    mesh
        The mesh.
    name
        Of the set.
    points
        Reference positions of its nodes [m], shape [node_count, D].

    Raises
    ------
    InputError
        The file is not there or another one by now, or there is no such set.
    """
    if name == "all":
        return np.arange(len(points))
    if isinstance(mesh, MeshFile):
        return _of_file(mesh, name, points)
    found = np.flatnonzero(_is_on(mesh, name, points))
    if not len(found):
        raise InputError(f"{name}: no node is on this set")
    return found


def _of_file(mesh: MeshFile, name: str, points: Points) -> Indices:
    space = points.shape[1]
    arrays = read_body_mesh(
        mesh.file, body=mesh.body, scale=mesh.scale, space=space, key="bodies.mesh"
    )
    if not _are_alike(arrays.points + np.array(mesh.move or 0.0), points):
        raise InputError(f"{mesh.file}: is another mesh than the one that was run")
    parts = [arrays.node_sets.get(name, np.empty(0, dtype=np.int64))]
    parts += [facets.ravel() for facets in arrays.facet_sets.get(name, ())]
    if name in arrays.cell_sets:
        parts.append(_nodes_of_cells(arrays, arrays.cell_sets[name]))
    nodes = np.unique(np.concatenate(parts))
    if not len(nodes):
        raise InputError(f"{mesh.file}: has no set {name!r}")
    return nodes


def _are_alike(read: Points, points: Points) -> bool:
    """Whether nodes are where they were, but for what `building.closing` may have moved them."""
    if read.shape != points.shape:
        return False
    return bool(np.abs(read - points).max() <= MOVED * np.ptp(points, axis=0).max())


def _nodes_of_cells(arrays: MeshArrays, cells: Indices) -> Indices:
    """Return the nodes of cells, which are numbered block after block."""
    found, first = [], 0
    for _, nodes in arrays.blocks:
        mine = cells[(cells >= first) & (cells < first + len(nodes))] - first
        found.append(nodes[mine].ravel())
        first += len(nodes)
    return np.concatenate(found)


def _is_on(mesh: Mesh, name: str, points: Points) -> NDArray[np.bool_]:
    """Return of every point whether it is on a side of a generated mesh."""
    match mesh, name:
        case (Rectangle() | Box(), _):
            return _is_on_side(mesh.corner, mesh.size, name, points)
        case (Disc() | Ball(), "surface"):
            return _is_near(_length(points - mesh.centre), mesh.radius, mesh.radius)
        case (Ring(), "inner" | "outer"):
            radius = mesh.inner_radius if name == "inner" else mesh.outer_radius
            return _is_near(_length(points - mesh.centre), radius, mesh.outer_radius)
        case (Cylinder() | Tube(), _):
            axis = np.array(mesh.axis) / np.linalg.norm(mesh.axis)
            arms = points - mesh.base
            height = arms @ axis
            if name in ("bottom", "top"):
                return _is_near(height, mesh.height if name == "top" else 0.0, mesh.height)
            largest = mesh.radius if isinstance(mesh, Cylinder) else mesh.outer_radius
            radius = mesh.inner_radius if isinstance(mesh, Tube) and name == "inner" else largest
            return _is_near(_length(arms - np.outer(height, axis)), radius, largest)
    return np.zeros(len(points), dtype=np.bool_)


_SIDES = (("left", "right"), ("front", "back"), ("bottom", "top"))


def _is_on_side(
    corner: Sequence[float], size: Sequence[float], name: str, points: Points
) -> NDArray[np.bool_]:
    sides = _SIDES if len(size) == 3 else (_SIDES[0], _SIDES[2])
    for axis, names in enumerate(sides):
        if name in names:
            at = corner[axis] + size[axis] * names.index(name)
            return _is_near(points[:, axis], at, size[axis])
    return np.zeros(len(points), dtype=np.bool_)


def _is_near(values: Points, at: float, size: float) -> NDArray[np.bool_]:
    return np.asarray(np.abs(values - at) <= ON * size)


def _length(vectors: Points) -> Points:
    return np.asarray(np.linalg.norm(vectors, axis=1))
