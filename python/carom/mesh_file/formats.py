"""Reading files of many formats through meshio, without what it prints."""

from __future__ import annotations

import io
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any

import numpy as np

from carom.mesh_file.abaqus import read_abaqus
from carom.mesh_file.arrays import FileMesh, Indices, Refused
from carom.mesh_file.cells import dimension
from carom.mesh_file.geometry import GEOMETRY, meshed
from carom.mesh_file.gmsh41 import any_number_of_groups

NASTRAN = (".bdf", ".fem", ".nas")
"""Endings of Nastran's files."""

NOTHING_TO_JOIN = "need at least one array to concatenate"
"""What NumPy says where meshio's readers find no cells."""

_MANY = 1000
"""Distinct values above which integer data of cells are no sets."""


def read_file(path: Path, space: int) -> FileMesh:
    """Read all that a mesh file holds; a geometry is meshed for that.

    Raises
    ------
    Refused
        The file is not there, of no known format, or not as its format asks.
    """
    try:
        is_there = path.is_file()
    except OSError as error:  # such as a name that is too long
        raise Refused(f"cannot be read: {error.strerror}") from None
    if not is_there:
        raise Refused("no such file; paths in a case file are relative to it")
    if path.suffix.lower() == ".inp":
        return read_abaqus(path)
    if path.suffix.lower() in GEOMETRY:
        with meshed(path, space) as mesh:
            return _by_meshio(mesh)
    if path.suffix.lower() in NASTRAN:
        _refuse_endless(path)
    return _by_meshio(path)


def _by_meshio(path: Path) -> FileMesh:
    import meshio  # noqa: PLC0415 (only cases with mesh files need it)
    from meshio._mesh import topological_dimension  # noqa: PLC0415

    # meshio 5.3 reads these cells and then misses their dimension.
    topological_dimension.setdefault("wedge15", 3)
    printed = io.StringIO()
    # Whether an STL file is binary meshio sees by its size, from a count that in text is any four
    # letters: times the 50 bytes of a triangle they do not fit into 32 bits.
    overflow = np.errstate(over="ignore")
    try:
        with redirect_stdout(printed), redirect_stderr(printed), overflow, any_number_of_groups():
            mesh = meshio.read(path)
    except ModuleNotFoundError as error:
        raise Refused(f"reading this format needs the package {error.name}; install it") from None
    except (Exception, SystemExit) as error:  # whatever a reader trips over, and meshio's way out
        said = [line.strip() for line in printed.getvalue().splitlines() if line.strip()]
        reason = (
            " ".join(said) if isinstance(error, SystemExit) else f"{error or type(error).__name__}"
        )
        if reason == NOTHING_TO_JOIN:
            raise Refused("holds no cells; mesh the part, and save its cells with it") from None
        raise Refused(f"cannot be read: {' '.join(reason.split())}") from None
    if any(block.type.startswith("polyhedron") for block in mesh.cells):
        raise Refused("has polyhedra, which carom does not know; mesh with tetrahedra or hexahedra")
    try:
        blocks = [(str(block.type), np.asarray(block.data, dtype=np.int64)) for block in mesh.cells]
        points = np.asarray(mesh.points, dtype=np.float64)
        point_sets, cell_sets = _point_sets(mesh), _cell_sets(mesh)
    except (ValueError, TypeError, IndexError, OverflowError) as error:
        raise Refused(f"cannot be read: {' '.join(str(error).split())}") from None
    if points.ndim != 2:  # meshio has None where a VTK file has lost its points
        raise Refused("has no points; repair the file")
    for name, cells in cell_sets.items():
        if len(cells) != len(blocks):
            raise Refused(f"its set {name!r} does not fit its cells; repair the file")
    return FileMesh(
        points=points,
        blocks=blocks,
        point_sets=point_sets,
        cell_sets=cell_sets,
        backwards=path.suffix.lower() == ".med",
    )


def _refuse_endless(path: Path) -> None:
    """Refuse a Nastran file without its last line, for which meshio would wait for ever."""
    lines = path.read_bytes().splitlines()
    bulk = next((n for n, line in enumerate(lines) if line.strip().startswith(b"BEGIN BULK")), 0)
    if not any(line.startswith(b"ENDDATA") for line in lines[bulk:]):
        raise Refused("has no ENDDATA; is the file cut short?")


def _cell_sets(mesh: Any) -> dict[str, list[Indices]]:  # noqa: ANN401 (meshio has no types)
    """Return sets, physical groups, families and the values of integer data, under their names."""
    sets = {
        str(name): [np.asarray([] if c is None else c, dtype=np.int64) for c in cells]
        for name, cells in mesh.cell_sets.items()
        if not name.startswith("gmsh:")
    }
    given = frozenset(sets)
    for title, data in mesh.cell_data.items():
        if title == "gmsh:geometrical" or not all(_is_integer(values) for values in data):
            continue
        if len(np.unique(np.concatenate(data))) > _MANY:
            continue
        for block, values in enumerate(data):
            for tag in np.unique(values):
                members = np.flatnonzero(values == tag)
                for name in _names(mesh, title, int(tag), dimension(mesh.cells[block].type)):
                    if name not in given:
                        empty = [np.arange(0) for _ in data]
                        cells = sets.setdefault(name, empty)
                        cells[block] = np.union1d(cells[block], members)
    return sets


def _names(mesh: Any, title: str, tag: int, of_dimension: int) -> list[str]:  # noqa: ANN401
    """Return the names of the cells of a dimension that have this number."""
    if title == "cell_tags":  # families of MED
        return [str(name) for name in getattr(mesh, "cell_tags", {}).get(tag, [])]
    if title == "gmsh:physical":  # 0 is no group, and a group without a name has its number
        named = [
            str(n) for n, entry in mesh.field_data.items() if tuple(entry) == (tag, of_dimension)
        ]
        return named or ([str(tag)] if tag else [])
    return [f"{title}:{tag}"]


def _is_integer(values: np.ndarray) -> bool:
    return bool(values.ndim == 1 and np.issubdtype(values.dtype, np.integer))


def _point_sets(mesh: Any) -> dict[str, Indices]:  # noqa: ANN401 (meshio has no types)
    sets = {str(name): np.asarray(nodes, dtype=np.int64) for name, nodes in mesh.point_sets.items()}
    tags = mesh.point_data.get("point_tags")
    for tag, names in getattr(mesh, "point_tags", {}).items():
        for name in names if tags is not None else ():
            nodes = np.flatnonzero(tags == tag)
            sets[name] = np.union1d(sets[name], nodes) if name in sets else nodes
    return sets
