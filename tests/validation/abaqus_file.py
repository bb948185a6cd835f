"""Meshes of validations as Abaqus input files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from numpy.typing import NDArray
from runs import Array


def written(
    file: Path,
    points: Array,
    cells: NDArray[Any],
    *,
    kind: str,
    name: str,
    surfaces: Mapping[str, Sequence[str]] | None = None,
    sets: Mapping[str, NDArray[Any]],
) -> Path:
    """Write a mesh; what is numbered is so from 0, and from 1 in the file.

    Parameters
    ----------
    file
        Where to.
    points
        Its nodes [m], shape [node_count, D].
    cells, kind, name
        Nodes of its cells, shape [cell_count, n], their type and the set that they are.
    surfaces
        Lines of named surfaces.
    sets
        Nodes of named sets.
    """
    lines = ["*NODE"]
    lines += [f"{n}, {', '.join(map(repr, row))}" for n, row in enumerate(points.tolist(), 1)]
    lines += [f"*ELEMENT, TYPE={kind}, ELSET={name}"]
    lines += [f"{e}, {', '.join(map(str, row))}" for e, row in enumerate((cells + 1).tolist(), 1)]
    for surface, sides in (surfaces or {}).items():
        lines += [f"*SURFACE, NAME={surface}", *sides]
    for of_nodes, nodes in sets.items():
        lines += [f"*NSET, NSET={of_nodes}", *(str(n + 1) for n in nodes)]
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return file
