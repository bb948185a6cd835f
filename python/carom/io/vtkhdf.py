"""``fields.vtkhdf``: a temporal VTKHDF unstructured grid, for ParaView and PyVista.

The layout is that of the VTKHDF file format 2.0 [1]_. Mesh and body index are stored once, each
frame appends its fields, and ``Steps`` says where the fields of each frame begin.

References
----------
.. [1] https://docs.vtk.org/en/latest/vtk_file_formats/vtkhdf_file_format/index.html
"""

from __future__ import annotations

import io
from collections.abc import Mapping, Sequence
from pathlib import Path

import h5py
import numpy as np
from numpy.typing import NDArray

from carom.io.atomic import write_whole
from carom.io.journal import changed, going_on, shorter

POINT_FIELDS = ("displacement", "velocity", "reaction")
"""Vectors at the points [m], [m/s], [N]; stored with 3 components."""

CELL_FIELDS = {"stress": 6, "strain": 6, "energy_density": 1, "plastic_strain": 1}
"""Cauchy stress [Pa] and Green–Lagrange strain, both xx yy zz xy yz xz, strain energy density
[J/m³] and equivalent plastic strain, with components."""

SURFACE_POINT_FIELDS = ("displacement",)
"""Vectors at the points of a boundary [m]."""

SURFACE_CELL_FIELDS = {"friction_energy": 1, "slip": 1, "pressure": 1, "area": 1}
"""On facets: energy dissipated by friction [J/m²], distance slid [m], contact pressure [Pa], area
[m²]. Energy and pressure are per area of the reference configuration, so energy times area sums
to the ledger's friction."""

_OF_MESH = ("body", "material")
"""On cells: what never changes, and is there once for all frames."""

_CHUNK_ROWS = 16_384


class FieldsWriter:
    """Writes frames of fields on a mesh that keeps its cells.

    The file is closed in between, so it can be opened during the run and after a crash.

    Parameters
    ----------
    path
        File to write.
    mesh
        ``points`` [m], shape [point_count, D]; ``connectivity``; ``offsets``, shape
        [cell_count + 1]; ``types``, VTK cell types; ``body``, index of each cell's body; if there
        is one, ``material``, index of each cell's material among those of the case.
    point_fields, cell_fields
        Names of the vectors at points, and of the fields on cells with their components.
    frames
        Frames of a file that is there and goes on; what it has beyond these is dropped. None starts
        a new one.
    """

    def __init__(
        self,
        path: Path,
        mesh: Mapping[str, NDArray[np.generic]],
        *,
        point_fields: Sequence[str] = POINT_FIELDS,
        cell_fields: Mapping[str, int] = CELL_FIELDS,
        frames: int | None = None,
    ) -> None:
        self._path = path
        self._point_fields = point_fields
        self._cell_fields = cell_fields
        self._of_mesh = [name for name in _OF_MESH if name in mesh]
        points, cells = len(mesh["points"]), len(mesh["types"])
        if frames is not None:
            self._cut(frames, points, cells)
            return
        content = io.BytesIO()
        with h5py.File(content, "w") as file:
            root = file.create_group("VTKHDF")
            root.attrs["Version"] = np.array([2, 0], dtype=np.int64)
            root.attrs["Type"] = np.bytes_("UnstructuredGrid")
            root["NumberOfPoints"] = np.array([points], dtype=np.int64)
            root["NumberOfCells"] = np.array([cells], dtype=np.int64)
            root["NumberOfConnectivityIds"] = np.array([len(mesh["connectivity"])], dtype=np.int64)
            root["Points"] = _spatial(mesh["points"])
            root["Connectivity"] = mesh["connectivity"].astype(np.int64)
            root["Offsets"] = mesh["offsets"].astype(np.int64)
            root["Types"] = mesh["types"].astype(np.uint8)

            steps = root.create_group("Steps")
            steps.attrs["NSteps"] = np.int64(0)
            _growing(steps, "Values", dtype=np.float64)
            for name in ("PartOffsets", "NumberOfParts", "PointOffsets"):
                _growing(steps, name, dtype=np.int64)
            for name in ("CellOffsets", "ConnectivityIdOffsets"):
                _growing(steps, name, dtype=np.int64, components=1)

            for name in self._point_fields:
                _growing(root, f"PointData/{name}", dtype=np.float64, components=3, rows=points)
                _growing(steps, f"PointDataOffsets/{name}", dtype=np.int64)
            for name, components in self._cell_fields.items():
                _growing(
                    root, f"CellData/{name}", dtype=np.float64, components=components, rows=cells
                )
                _growing(steps, f"CellDataOffsets/{name}", dtype=np.int64)
            for name in self._of_mesh:
                root[f"CellData/{name}"] = mesh[name].astype(np.int32)
                _growing(steps, f"CellDataOffsets/{name}", dtype=np.int64)
        write_whole(path, content.getvalue())

    def append(
        self, times: Sequence[float], frames: Sequence[Mapping[str, NDArray[np.float64]]]
    ) -> None:
        """Add frames, all of them or, if there is no room, none.

        Parameters
        ----------
        times
            Times of the frames [s].
        frames
            Of each frame arrays by name: vectors at points, shape [point_count, D], and fields on
            cells, shape [cell_count, components].
        """
        count = len(frames)
        zero = np.zeros(count, dtype=np.int64)
        with changed(self._path) as file:
            root = file["VTKHDF"]
            steps = root["Steps"]
            entries: dict[str, NDArray[np.generic]] = {
                "Values": np.asarray(times),
                "NumberOfParts": np.ones(count, dtype=np.int64),
                "PartOffsets": zero,
                "PointOffsets": zero,
                "CellOffsets": zero,
                "ConnectivityIdOffsets": zero,
                **{f"CellDataOffsets/{name}": zero for name in self._of_mesh},
            }
            for name in self._point_fields:
                rows = [_spatial(fields[name]) for fields in frames]
                entries[f"PointDataOffsets/{name}"] = _extend(root[f"PointData/{name}"], rows)
            for name in self._cell_fields:
                rows = [fields[name] for fields in frames]
                entries[f"CellDataOffsets/{name}"] = _extend(root[f"CellData/{name}"], rows)
            for name, entry in entries.items():
                _extend(steps[name], entry)
            steps.attrs["NSteps"] += count

    def _cut(self, frames: int, points: int, cells: int) -> None:
        """Drop the frames after the first so many."""
        with going_on(self._path) as file:
            root = file["VTKHDF"]
            steps = root["Steps"]
            there = int(steps.attrs["NSteps"])
            if there < frames:
                raise shorter(self._path, there, frames)
            for name in self._point_fields:
                root[f"PointData/{name}"].resize(frames * points, axis=0)
            for name in self._cell_fields:
                root[f"CellData/{name}"].resize(frames * cells, axis=0)
            steps.visititems(
                lambda _, entry: (
                    entry.resize(frames, axis=0) if isinstance(entry, h5py.Dataset) else None
                )
            )
            steps.attrs["NSteps"] = np.int64(frames)


def _growing(
    group: h5py.Group,
    name: str,
    *,
    dtype: type[np.generic],
    components: int | None = None,
    rows: int = 256,
) -> None:
    """Create an empty dataset that grows along its first axis, in chunks of about `rows`."""
    width = () if components is None else (components,)
    group.create_dataset(
        name,
        shape=(0, *width),
        maxshape=(None, *width),
        chunks=(min(rows, _CHUNK_ROWS), *width),
        dtype=dtype,
        compression="gzip",
        compression_opts=1,
        shuffle=True,
    )


def _extend(
    dataset: h5py.Dataset, blocks: Sequence[NDArray[np.float64]] | NDArray[np.generic]
) -> NDArray[np.int64]:
    """Append blocks of rows, or single values; return the rows at which they begin."""
    rows = np.reshape(blocks, (-1, *dataset.shape[1:]))
    start, each = len(dataset), len(rows) // max(len(blocks), 1)
    dataset.resize(start + len(rows), axis=0)
    dataset[start:] = rows
    return start + each * np.arange(len(blocks))


def _spatial(vectors: NDArray[np.generic]) -> NDArray[np.float64]:
    """Return vectors with the missing components as zeros, shape [row_count, 3]."""
    spatial = np.zeros((len(vectors), 3))
    spatial[:, : vectors.shape[1]] = vectors
    return spatial
