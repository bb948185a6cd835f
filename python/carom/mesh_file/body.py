"""The mesh of a body out of what a file holds."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from carom.display.counting import count
from carom.mesh_file.arrays import FileMesh, Indices, MeshArrays, Note, Refused, first_few
from carom.mesh_file.cells import KINDS, dimension
from carom.mesh_file.conformity import comes_apart
from carom.mesh_file.formats import read_file
from carom.mesh_file.precision import precision
from carom.mesh_file.upright import Upright, upright
from carom.messages import known

_FLAT = 1e-9
"""Largest difference of z in a plane mesh, relative to its size."""


def body_dimension(file: str | Path, *, key: str) -> int:
    """Return the dimension of the case that a mesh file is for: that of its cells, 2 or 3.

    Raises
    ------
    MeshError
        The file cannot be read.
    """
    try:
        mesh = read_file(Path(file), 3)
    except Refused as refused:
        raise refused.at(key, str(file)) from None
    return max([2, *(dimension(kind) for kind, nodes in mesh.blocks if len(nodes))])


def read_body_mesh(
    file: str | Path, *, body: str | None, scale: float, space: int, key: str
) -> MeshArrays:
    """Read the mesh of one body.

    Parameters
    ----------
    file
        The file, of a format that its ending tells.
    body
        Name of a set of cells, such as a physical group; None takes all cells.
    scale
        What coordinates are multiplied by to be in metres.
    space
        Dimension of space, 2 or 3. In 2D the mesh lies in a plane z = constant, and z is dropped.
    key
        Where in the case file the mesh is described, for messages.

    Raises
    ------
    MeshError
        The file cannot be read, or its cells make no body.
    """
    try:
        arrays = _body(read_file(Path(file), space), body, scale, space)
        return replace(arrays, notes=[note.at(key, str(file)) for note in arrays.notes])
    except Refused as refused:
        value = body if refused.entry == "body" and body is not None else str(file)
        raise refused.at(key, value) from None


def _body(mesh: FileMesh, body: str | None, scale: float, space: int) -> MeshArrays:
    _refuse_wrong_dimension(mesh, space)
    chosen = _chosen_cells(mesh, body, space)
    for (kind, nodes), cells in zip(mesh.blocks, chosen, strict=True):
        if len(cells) and kind not in KINDS:
            taken = ", ".join(k.name for k in KINDS.values() if k.dimension == space)
            raise Refused(
                f"has {count(len(cells), f'{kind} cell')}, which carom does not know; use {taken}"
            )
        if len(cells) and nodes.shape[1] != len(KINDS[kind].mirror):
            raise Refused(f"its {kind} cells have {nodes.shape[1]} points; repair the file")
        outside = nodes[(nodes < 0) | (nodes >= len(mesh.points))]
        if outside.size:
            raise Refused(f"a {kind} cell refers to point {outside[0]} of {len(mesh.points)}")
    used = np.unique(
        np.concatenate(
            [nodes[c].ravel() for (_, nodes), c in zip(mesh.blocks, chosen, strict=True)]
        )
    )
    points = _positions(mesh.points, used, scale, space)
    number = np.full(len(mesh.points), -1, dtype=np.int64)
    number[used] = np.arange(len(used))
    blocks = [
        (kind, number[nodes[cells]])
        for (kind, nodes), cells in zip(mesh.blocks, chosen, strict=True)
        if len(cells)
    ]
    _refuse_duplicates(blocks)
    right = upright(points, blocks)
    return MeshArrays(
        points=points,
        blocks=[(KINDS[kind].name, nodes) for kind, nodes in right.blocks],
        node_sets=_node_sets(mesh, number, space),
        facet_sets=_facet_sets(mesh, number, space),
        cell_sets=_cell_sets(mesh, chosen),
        precision=scale * precision(mesh.points[used][:, :space]),
        notes=[
            *mesh.notes,
            *_turned(right, backwards=mesh.backwards),
            *comes_apart(points, right.blocks),
        ],
    )


def _turned(right: Upright, *, backwards: bool) -> list[Note]:
    """Return the note that cells were turned, unless the format has it so."""
    total = sum(len(nodes) for _, nodes in right.blocks)
    if not right.turned or (backwards and right.turned == total):
        return []
    what = f"{right.which} are numbered the other way round and were turned"
    remedy = "look whether the program that wrote the file meant these cells"
    return [Note("turned-cells", what, value=right.turned, allowed=0, remedy=remedy)]


def _kinds(mesh: FileMesh, wanted: int | None = None) -> str:
    """Return how many cells of which kinds there are, of one dimension or of all."""
    numbers: dict[str, int] = {}
    for kind, nodes in mesh.blocks:
        if wanted is None or dimension(kind) == wanted:
            numbers[kind] = numbers.get(kind, 0) + len(nodes)
    return ", ".join(f"{number:,} {kind}" for kind, number in numbers.items()) or "no cells"


def _refuse_wrong_dimension(mesh: FileMesh, space: int) -> None:
    highest = max((dimension(kind) for kind, nodes in mesh.blocks if len(nodes)), default=-1)
    if highest < 0:
        but = f": {mesh.notes[0].message}" if mesh.notes else ""
        raise Refused(f"holds no cells{but}")
    if highest > space:
        raise Refused(
            f"has cells of {highest} dimensions ({_kinds(mesh, highest)}) in a case of {space}; "
            f"set dimension = {highest}, or save the plane cells alone"
        )
    if highest < space:
        what = "volume cells" if space == 3 else "plane cells"
        remedy = (
            "set dimension = 2, or mesh the volume" if highest == 2 else f"mesh the {what[:-6]}"
        )
        raise Refused(f"has no {what}, only {_kinds(mesh)}; {remedy}")


def _chosen_cells(mesh: FileMesh, body: str | None, space: int) -> list[Indices]:
    """Return for each block the cells that make the body."""
    of_space = [dimension(kind) == space for kind, _ in mesh.blocks]
    if body is None:
        return [
            np.arange(len(nodes) if takes else 0)
            for (_, nodes), takes in zip(mesh.blocks, of_space, strict=True)
        ]
    filled = [
        name
        for name, cells in mesh.cell_sets.items()
        if any(len(c) for c, takes in zip(cells, of_space, strict=True) if takes)
    ]
    if body not in mesh.cell_sets:
        raise Refused(f"no such set of cells; {known(body, filled)}", entry="body")
    if body not in filled:
        what = "volume" if space == 3 else "plane"
        raise Refused(f"this set has no {what} cells; {known(body, filled)}", entry="body")
    return [
        np.unique(cells) if takes else np.arange(0)
        for cells, takes in zip(mesh.cell_sets[body], of_space, strict=True)
    ]


def _positions(
    points: NDArray[np.float64], used: Indices, scale: float, space: int
) -> NDArray[np.float64]:
    """Return the positions of the points that cells use [m], shape [used_count, D]."""
    positions = points[used] * scale
    wrong = used[~np.isfinite(positions).all(axis=1)]
    if len(wrong):
        raise Refused(
            f"{count(len(wrong), 'point')} with a coordinate that is not a finite number "
            f"({first_few(wrong)} from 0); repair the file"
        )
    if positions.shape[1] < space:
        raise Refused(f"its points have {positions.shape[1]} coordinates, not {space}")
    if space == 2 and positions.shape[1] == 3:
        low, high = positions.min(axis=0), positions.max(axis=0)
        if high[2] - low[2] > _FLAT * np.max(high - low):
            raise Refused(
                f"is not plane: z goes from {low[2]:g} m to {high[2]:g} m; "
                "a case of dimension 2 needs a mesh in the plane of x and y"
            )
    return np.ascontiguousarray(positions[:, :space])


def _refuse_duplicates(blocks: list[tuple[str, Indices]]) -> None:
    for kind in dict.fromkeys(kind for kind, _ in blocks):
        cells = np.sort(np.concatenate([nodes for k, nodes in blocks if k == kind]), axis=1)
        _, first = np.unique(cells, axis=0, return_index=True)
        again = np.setdiff1d(np.arange(len(cells)), first)
        if len(again):
            raise Refused(
                f"{count(len(again), f'{KINDS[kind].name} cell')} with the nodes of another one "
                f"({first_few(again)} from 0 in their order in the file); keep each cell once "
                "(Gmsh's format 2 repeats cells that are in two physical groups, format 4 does not)"
            )


def _node_sets(mesh: FileMesh, number: Indices, space: int) -> dict[str, Indices]:
    """Return the sets of points, and of the points of cells that are no facets."""
    points = {name: [nodes] for name, nodes in mesh.point_sets.items()}
    for name, cells in mesh.cell_sets.items():
        for (kind, nodes), members in zip(mesh.blocks, cells, strict=True):
            if dimension(kind) < space - 1 and len(members):
                points.setdefault(name, []).append(nodes[members].ravel())
    sets = {name: number[np.unique(np.concatenate(parts))] for name, parts in points.items()}
    return {name: nodes[nodes >= 0] for name, nodes in sets.items() if np.any(nodes >= 0)}


def _facet_sets(mesh: FileMesh, number: Indices, space: int) -> dict[str, list[Indices]]:
    """Return the sets of facets whose nodes all belong to the body."""
    sets: dict[str, list[Indices]] = {}
    for name, cells in mesh.cell_sets.items():
        for (kind, nodes), members in zip(mesh.blocks, cells, strict=True):
            if dimension(kind) != space - 1 or kind not in KINDS:
                continue
            facets = number[nodes[members]]
            facets = facets[(facets >= 0).all(axis=1)]
            if len(facets):
                sets.setdefault(name, []).append(facets)
    return sets


def _cell_sets(mesh: FileMesh, chosen: list[Indices]) -> dict[str, Indices]:
    """Return the sets of the body's cells, which are numbered block after block."""
    starts = np.cumsum([0, *(len(cells) for cells in chosen)])
    sets = {}
    for name, cells in mesh.cell_sets.items():
        members = [
            start + np.flatnonzero(np.isin(mine, theirs))
            for start, mine, theirs in zip(starts, chosen, cells, strict=False)
        ]
        if any(map(len, members)):
            sets[name] = np.concatenate(members).astype(np.int64)
    return sets
