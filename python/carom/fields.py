"""The fields of a run over time, read when they are asked for."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import DTypeLike, NDArray
from typing_extensions import Self

from carom.errors import InputError
from carom.extras import needed
from carom.io.frames import Frames
from carom.messages import known

if TYPE_CHECKING:
    import xarray

ABOUT = {
    "displacement": ("displacement", "m"),
    "velocity": ("velocity", "m/s"),
    "reaction": ("contact force on the node", "N"),
    "stress": ("Cauchy stress", "Pa"),
    "strain": ("Green–Lagrange strain", ""),
    "energy_density": ("strain energy per reference volume", "J/m³"),
    "plastic_strain": ("equivalent plastic strain", ""),
    "friction_energy": ("energy dissipated by friction per reference area", "J/m²"),
    "slip": ("distance slid", "m"),
    "pressure": ("contact pressure per reference area", "Pa"),
    "area": ("reference area", "m²"),
}
"""What the fields are, and their units."""

AXES = ("x", "y", "z")
TENSOR = ("xx", "yy", "zz", "xy", "yz", "xz")
"""Components of vectors and of symmetric tensors, in the order of the files."""


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


class Field:
    """One field over all frames of a run, as an array that lies in a file.

    Indexing reads what is asked for and no more frames than that: ``field[-1]`` is the last frame,
    ``field[::10]`` every tenth, ``field[:, 5]`` node 5 over time. `numpy.asarray` reads everything.

    Parameters
    ----------
    name
        Its name in the file.
    frames
        The file.
    rows
        The nodes or cells that are meant.
    dimension
        Dimension of space.
    on
        What has its values: ``"node"``, ``"cell"`` or, on boundaries, ``"facet"``.
    """

    dtype = np.dtype(np.float64)

    def __init__(
        self,
        name: str,
        frames: Frames,
        *,
        rows: slice,
        dimension: int,
        on: Literal["node", "cell", "facet"],
    ) -> None:
        self.name = name
        self.on = on
        self._frames, self._rows = frames, rows
        widths = {1: (), 3: AXES[:dimension], 6: TENSOR}
        self.components: tuple[str, ...] = widths[frames.width(name)]

    @property
    def about(self) -> str:
        """What it is."""
        return ABOUT.get(self.name, (self.name, ""))[0]

    @property
    def unit(self) -> str:
        """Its unit; empty for a number."""
        return ABOUT.get(self.name, (self.name, ""))[1]

    @property
    def shape(self) -> tuple[int, ...]:
        """Frames, nodes or cells, and components if there are several."""
        rows = len(range(*self._rows.indices(self._rows.stop)))
        several = (len(self.components),) if self.components else ()
        return (len(self._frames.times), rows, *several)

    @property
    def ndim(self) -> int:
        """Number of axes."""
        return len(self.shape)

    def __len__(self) -> int:
        return len(self._frames.times)

    def __getitem__(self, key: Any) -> NDArray[np.float64]:  # noqa: ANN401 (as NumPy's)
        first, *rest = key if isinstance(key, tuple) else (key,)
        if first is Ellipsis:
            first, rest = slice(None), [Ellipsis, *rest]
        numbers = np.arange(len(self))[first]
        values = self._frames.read(self.name, np.atleast_1d(numbers).tolist(), self._rows)
        values = values[..., : len(self.components)] if self.components else values[..., 0]
        taken: NDArray[np.float64]
        if np.ndim(numbers) == 0:
            taken = values[0][tuple(rest)]
        else:
            each = (slice(None), *rest)
            taken = values[each]
        return taken

    def __iter__(self) -> Iterator[NDArray[np.float64]]:
        return (self[frame] for frame in range(len(self)))

    def __array__(
        self, dtype: DTypeLike | None = None, *, copy: bool | None = None
    ) -> NDArray[Any]:
        if copy is False:
            raise ValueError(f"{self.name}: lies in a file, so that an array of it is a copy")
        return self[:].astype(dtype or self.dtype, copy=False)

    def at(self, time: float) -> NDArray[np.float64]:
        """Return the frame nearest to a time [s]."""
        return self[self._frames.nearest(time)]

    def __repr__(self) -> str:
        unit = f" [{self.unit}]" if self.unit else ""
        return f"Field({self.name!r}: {self.about}{unit}, shape {self.shape}, not read)"


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
        from carom.dataset import dataset  # noqa: PLC0415 (imports xarray)

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
