"""What a mesh file says, before and after a body is made of it."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import tomlkit
from numpy.typing import NDArray

from carom.errors import MeshError

Indices = NDArray[np.int64]


@dataclass(frozen=True)
class FileMesh:
    """Everything a file holds, in its own units and numbering from 0.

    Parameters
    ----------
    points
        Coordinates, shape [point_count, 2 or 3].
    blocks
        Cells of every dimension: their kind as meshio names it, and their points in the order of
        VTK, shape [cell_count, points per cell].
    point_sets
        Points by the name of their set.
    cell_sets
        By the name of the set, for each block the cells of it that belong.
    """

    points: NDArray[np.float64]
    blocks: list[tuple[str, Indices]]
    point_sets: dict[str, Indices] = field(default_factory=dict)
    cell_sets: dict[str, list[Indices]] = field(default_factory=dict)


@dataclass(frozen=True)
class MeshArrays:
    """The mesh of one body, as the native core reads it.

    Parameters
    ----------
    points
        Reference positions [m], shape [point_count, D].
    blocks
        Kind of cell and its nodes, shape [cell_count, nodes per cell].
    node_sets, cell_sets
        Nodes and cells by the name of their set; cells are numbered block after block.
    facet_sets
        By the name of the set, the nodes of its facets, one array for each kind of facet.
    """

    points: NDArray[np.float64]
    blocks: list[tuple[str, Indices]]
    node_sets: dict[str, Indices] = field(default_factory=dict)
    facet_sets: dict[str, list[Indices]] = field(default_factory=dict)
    cell_sets: dict[str, Indices] = field(default_factory=dict)


class Refused(Exception):  # noqa: N818 (an answer, which becomes an error with its place)
    """A file that makes no body.

    Parameters
    ----------
    what
        The fact and the remedy.
    entry
        The key of the mesh table that is to blame.
    """

    def __init__(self, what: str, *, entry: str = "file") -> None:
        super().__init__(what)
        self.what = what
        self.entry = entry

    def at(self, key: str, value: str) -> MeshError:
        """Return the error that the user sees: its place, the value there, and what is wrong."""
        place = f"{key}.{self.entry}"
        # As the case file would write it: a name may have line breaks, a message may not.
        return MeshError(f"{place} = {tomlkit.item(value).as_string()}: {self.what}", place)


def first_few(indices: NDArray[np.integer]) -> str:
    """Return the first few of some numbers as text."""
    shown = ", ".join(str(i) for i in indices[:5])
    return shown if len(indices) <= 5 else f"{shown}, …"
