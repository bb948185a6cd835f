"""A field of a run over time, read when it is asked for."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Literal

import numpy as np
from numpy.typing import DTypeLike, NDArray

from carom.io.frames import Frames

ABOUT = {
    "displacement": ("displacement", "m"),
    "velocity": ("velocity", "m/s"),
    "reaction": ("contact force on the node", "N"),
    "stress": ("Cauchy stress", "Pa"),
    "strain": ("Green–Lagrange strain", ""),
    "energy_density": ("strain energy per reference volume", "J/m³"),
    "plastic_strain": ("equivalent plastic strain", ""),
    "material": ("number of the material among those of the case, from 0; -1 of a rigid body", ""),
    "friction_energy": ("energy dissipated by friction per reference area", "J/m²"),
    "slip": ("distance slid", "m"),
    "pressure": ("contact pressure per reference area", "Pa"),
    "area": ("reference area", "m²"),
}
"""What the fields are, and their units."""

AXES = ("x", "y", "z")
TENSOR = ("xx", "yy", "zz", "xy", "yz", "xz")
"""Components of vectors and of symmetric tensors, in the order of the files."""


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
