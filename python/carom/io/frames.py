"""Reading ``fields.vtkhdf`` and ``surface.vtkhdf`` back, frame by frame."""

from __future__ import annotations

from collections.abc import Sequence
from numbers import Real
from pathlib import Path

import h5py
import numpy as np
from numpy.typing import NDArray

from carom.errors import InputError
from carom.io.damage import DAMAGE


class Frames:
    """The mesh and the fields of a file that a run has written.

    Parameters
    ----------
    path
        The file.

    Attributes
    ----------
    times
        Times of the frames [s], shape [frame_count].
    points
        Reference positions [m], shape [point_count, 3].
    connectivity, offsets, types, body
        Cells as VTK numbers them, and the index of the body of each.

    Raises
    ------
    InputError
        The file is not there, or is none of carom's.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        try:
            with h5py.File(path, "r") as file:
                root = file["VTKHDF"]
                count = int(root["Steps"].attrs["NSteps"])
                self.times: NDArray[np.float64] = root["Steps/Values"][:count]
                self.points: NDArray[np.float64] = root["Points"][:]
                self.connectivity: NDArray[np.int64] = root["Connectivity"][:]
                self.offsets: NDArray[np.int64] = root["Offsets"][:]
                self.types: NDArray[np.uint8] = root["Types"][:]
                self.body: NDArray[np.int32] = root["CellData/body"][:]
                self._point_fields = list(root["PointData"])
                self._cell_fields = [name for name in root["CellData"] if name != "body"]
                self._widths = {
                    name: int(np.prod(entry.shape[1:]))
                    for group in ("PointData", "CellData")
                    for name, entry in root[group].items()
                }
        except (FileNotFoundError, NotADirectoryError):
            raise InputError(
                f"{path}: no such file; name a results directory of `carom run`"
            ) from None
        except DAMAGE as error:
            raise InputError(f"{path}: no fields of carom: {error}") from None
        if not count:
            raise InputError(f"{path}: has no frames yet")

    @property
    def names(self) -> list[str]:
        """The fields at points, then those on cells."""
        return [*self._point_fields, *self._cell_fields]

    def is_on_points(self, name: str) -> bool:
        """Whether a field has its values at points."""
        return name in self._point_fields

    def nearest(self, time: float | None) -> int:
        """Return the frame nearest to a time [s]; the last if that is None.

        Raises
        ------
        InputError
            The time is none of the run: farther before its first frame, or after its last one, than
            frames are apart.
        """
        if time is None:
            return len(self.times) - 1
        first, last = float(self.times[0]), float(self.times[-1])
        apart = float(np.diff(self.times).max(initial=0.0))
        if not isinstance(time, Real):
            raise InputError(f"time {time!r}: must be a number of seconds")
        if not first - apart <= time <= last + apart:
            raise InputError(
                f"time {time} s: no frame is near; those of the run are from {first:g} to "
                f"{last:g} s"
            )
        return int(np.abs(self.times - time).argmin())

    def width(self, name: str) -> int:
        """Return how many components a field has."""
        return self._widths[name]

    def field(self, name: str, frame: int) -> NDArray[np.float64]:
        """Return the values of a field, shape [point_count or cell_count, components]."""
        everything = slice(0, len(self.points if self.is_on_points(name) else self.types))
        values: NDArray[np.float64] = self.read(name, [frame], everything)[0]
        return values

    def read(self, name: str, frames: Sequence[int], rows: slice) -> NDArray[np.float64]:
        """Return some rows of a field in some frames, shape [frames, rows, components]."""
        group = "PointData" if self.is_on_points(name) else "CellData"
        width = self.width(name)
        values = np.empty((len(frames), rows.stop - rows.start, width))
        try:
            with h5py.File(self._path, "r") as file:
                stored = file[f"VTKHDF/{group}/{name}"]
                starts = file[f"VTKHDF/Steps/{group}Offsets/{name}"]
                for into, frame in zip(values, frames, strict=True):
                    start = int(starts[frame])
                    into[:] = stored[start + rows.start : start + rows.stop].reshape(-1, width)
        except DAMAGE as error:
            raise InputError(f"{self._path}: no fields of carom: {error}") from None
        return values
