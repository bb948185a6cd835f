"""What a mesh file says, before and after a body is made of it."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
import tomlkit
from numpy.typing import NDArray

from carom.errors import MeshError

Indices = NDArray[np.int64]


@dataclass(frozen=True)
class Note:
    """What was done to a mesh, or left out of it, that its owner should know of.

    Parameters
    ----------
    code
        Name of what happened.
    message
        The fact, in one line.
    where
        Key of the case file that it is about.
    value, allowed
        The number that was met and the one that would have needed no note; None without a number.
    remedy
        What to do about it.
    is_grave
        Whether results are wrong if that was not meant.
    """

    code: str
    message: str
    where: str = ""
    value: float | None = None
    allowed: float | None = None
    remedy: str = ""
    is_grave: bool = False

    def at(self, key: str, file: str) -> Note:
        """Return the note with its place, and the file there."""
        return replace(
            self, where=f"{key}.file", message=f"{_place(f'{key}.file', file)}: {self.message}"
        )


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
    notes
        What was left out.
    backwards
        Whether the format has the nodes of every cell against VTK's sense.
    """

    points: NDArray[np.float64]
    blocks: list[tuple[str, Indices]]
    point_sets: dict[str, Indices] = field(default_factory=dict)
    cell_sets: dict[str, list[Indices]] = field(default_factory=dict)
    notes: list[Note] = field(default_factory=list)
    backwards: bool = False


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
    notes
        What its owner should know of.
    precision
        How far a point may be from where it is meant to be, as the digits of its numbers tell [m].
    """

    points: NDArray[np.float64]
    blocks: list[tuple[str, Indices]]
    node_sets: dict[str, Indices] = field(default_factory=dict)
    facet_sets: dict[str, list[Indices]] = field(default_factory=dict)
    cell_sets: dict[str, Indices] = field(default_factory=dict)
    notes: list[Note] = field(default_factory=list)
    precision: float = 0.0


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
        return MeshError(f"{_place(place, value)}: {self.what}", place)


def _place(key: str, value: str) -> str:
    """Return a value as the case file would write it: it may have line breaks, a message not."""
    return f"{key} = {tomlkit.item(value).as_string()}"


def first_few(indices: NDArray[np.integer]) -> str:
    """Return the first few of some numbers as text."""
    shown = ", ".join(str(i) for i in indices[:5])
    return shown if len(indices) <= 5 else f"{shown}, …"
