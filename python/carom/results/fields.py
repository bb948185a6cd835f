"""The fields of a run over time, read when they are asked for."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray
from typing_extensions import Self

from carom.errors import InputError
from carom.io.frames import Frames
from carom.messages import known
from carom.results.field import Field
from carom.system.extras import needed

if TYPE_CHECKING:
    import xarray


@dataclass(frozen=True)
class Part:
    """The nodes and cells of a body among those of all.

    Parameters
    ----------
    nodes, cells
        Where they are; bodies come one after the other.
    """

    nodes: slice
    cells: slice


class Fields(Mapping[str, Field]):
    """The fields of a file over time, by name, on the mesh that they belong to.

    Opening reads the mesh and the times; a field is read where it is indexed. Positions and vectors
    have as many components as space has dimensions.

    Parameters
    ----------
    frames
        The file.
    parts
        The nodes and cells of each body by name.
    body
        The one that is meant; all of them by default.
    dimension
        Dimension of space.
    cell
        What its cells are called: ``"cell"``, or ``"facet"`` on boundaries.
    """

    def __init__(
        self,
        frames: Frames,
        parts: Mapping[str, Part],
        *,
        dimension: int,
        cell: Literal["cell", "facet"] = "cell",
        body: str | None = None,
    ) -> None:
        self._frames, self._all = frames, parts
        self._dimension = dimension
        self._body = body
        whole = Part(slice(0, len(frames.points)), slice(0, len(frames.types)))
        self._part = whole if body is None else parts[body]
        self.cell: Literal["cell", "facet"] = cell
        """What its cells are called."""

    @property
    def times(self) -> NDArray[np.float64]:
        """Times of the frames [s], shape [frame_count]."""
        return self._frames.times

    @property
    def points(self) -> NDArray[np.float64]:
        """Reference positions of the nodes [m], shape [node_count, D]."""
        return self._frames.points[self._part.nodes, : self._dimension]

    @property
    def parts(self) -> dict[str, Part]:
        """The nodes and cells of each body, by name."""
        if self._body is None:
            return dict(self._all)
        here = Part(slice(0, len(self.points)), slice(0, len(self.cell_types)))
        return {self._body: here}

    @property
    def cell_types(self) -> NDArray[np.uint8]:
        """Types of the cells as VTK numbers them, shape [cell_count]."""
        return self._frames.types[self._part.cells]

    @property
    def connectivity(self) -> NDArray[np.int64]:
        """Nodes of the cells in VTK's order, shape [cell_count, nodes of the largest cell].

        Rows of cells with fewer nodes end with -1.
        """
        ends = self._frames.offsets[1:][self._part.cells]
        starts = self._frames.offsets[:-1][self._part.cells]
        counts = ends - starts
        width = int(counts.max(initial=0))
        places = starts[:, None] + np.arange(width)
        is_there = np.arange(width) < counts[:, None]
        nodes = self._frames.connectivity[np.where(is_there, places, 0)] - self._part.nodes.start
        return np.where(is_there, nodes, -1)

    def body(self, name: str) -> Self:
        """Return the fields of one body; its nodes and cells count from 0.

        Raises
        ------
        InputError
            There is no such body.
        """
        if name not in self._all:
            raise InputError(f"{name}: no such body; {known(name, list(self._all))}")
        return type(self)(
            self._frames, self._all, dimension=self._dimension, cell=self.cell, body=name
        )

    def to_xarray(self) -> xarray.Dataset:
        """Return the fields as a dataset, whose variables are read when they are used.

        Dimensions are ``time``, ``node``, ``cell`` (or ``facet``), ``axis`` of vectors and
        ``component`` of tensors; units are in the attributes of each variable.

        Raises
        ------
        InputError
            xarray is not installed.
        """
        needed("xarray", of="to_xarray", extra="data")
        from carom.results.dataset import dataset  # noqa: PLC0415 (imports xarray)

        return dataset(self)

    def __getitem__(self, name: str) -> Field:
        if name not in self._frames.names:
            raise KeyError(f"{name}: no such field; {known(name, self._frames.names)}")
        on_nodes = self._frames.is_on_points(name)
        return Field(
            name,
            self._frames,
            rows=self._part.nodes if on_nodes else self._part.cells,
            dimension=self._dimension,
            on="node" if on_nodes else self.cell,
        )

    def __iter__(self) -> Iterator[str]:
        return iter(self._frames.names)

    def __len__(self) -> int:
        return len(self._frames.names)

    def __repr__(self) -> str:
        whose = "" if self._body is None else f"{self._body!r}, "
        count = f"{len(self.times)} frames, {len(self.points)} nodes, {len(self.cell_types)}"
        return f"Fields({whose}{count} {self.cell}s: {', '.join(self)})"


def parts(
    frames: Frames, names: Sequence[str], *, surface: Frames | None = None
) -> dict[str, Part]:
    """Return the nodes and cells of each body, or its nodes and facets on a boundary.

    Parameters
    ----------
    frames
        The file with the bodies.
    names
        Their names, in the order of the case.
    surface
        The file with the boundaries, on the same nodes.
    """
    found: dict[str, Part] = {}
    end = 0
    for index, name in enumerate(names):
        cells = _run_of(frames.body, index)
        corners = frames.connectivity[frames.offsets[cells.start] : frames.offsets[cells.stop]]
        start, end = end, int(corners.max()) + 1
        found[name] = Part(
            slice(start, end), cells if surface is None else _run_of(surface.body, index)
        )
    return found


def _run_of(body: NDArray[np.int32], index: int) -> slice:
    """Return where the cells of a body are; they come together."""
    first, last = np.searchsorted(body, [index, index + 1])
    return slice(int(first), int(last))
