"""What a results directory holds, as the auditor reads it."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from carom.audit.arrays import Array
from carom.audit.model import AuditModel
from carom.errors import InputError
from carom.io import layout
from carom.io.audit import read_steps
from carom.io.history import read_history
from carom.io.summary import read_summary
from carom.io.vtkhdf import CELL_FIELDS, POINT_FIELDS
from carom.scenario import Scenario


@dataclass(frozen=True)
class Frame:
    """The fields of one output time.

    Parameters
    ----------
    time
        Time [s].
    displacement, velocity, reaction
        Nodal vectors [m], [m/s], [N], shape [node_count, 2].
    stress, energy_density
        Cauchy stress xx yy zz xy yz xz [Pa] and stored energy [J/m³] of the cells.
    flat
        Largest component out of the plane, which must be zero.
    """

    time: float
    displacement: Array
    velocity: Array
    reaction: Array
    stress: Array
    energy_density: Array
    flat: float


class Files:
    """A results directory.

    Parameters
    ----------
    path
        The directory.

    Raises
    ------
    InputError
        A file is missing, or is not one of carom.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        for name in (layout.CASE, layout.SUMMARY, layout.HISTORY, layout.FIELDS):
            if not (path / name).exists():
                raise InputError(
                    f"{path}: has no {name}; name a directory that `carom run` has finished"
                )
        self.scenario = Scenario.from_toml(path / layout.CASE)
        try:
            self.summary: dict[str, Any] = read_summary(path / layout.SUMMARY)
        except json.JSONDecodeError as error:
            raise InputError(f"{path / layout.SUMMARY}: not JSON: {error}") from error
        self.history = read_history(path / layout.HISTORY)
        self.has_steps = (path / layout.AUDIT).exists()
        if self.scenario.output.audit and not self.has_steps:
            raise InputError(f"{path}: has no {layout.AUDIT}, which its case asks for")

    def model(self) -> AuditModel:
        """Build the model of the case on the mesh of the fields."""
        with self._fields() as root:
            points = root["Points"][:, :2]
            connectivity, offsets = root["Connectivity"][:], root["Offsets"][:]
            types, body = root["Types"][:], root["CellData/body"][:]
        cells, kinds = [], []
        for index, entry in enumerate(self.scenario.bodies):
            mine = np.flatnonzero(body == index)
            sizes, kind = np.diff(offsets)[mine], np.unique(types[mine])
            if len(mine) == 0 or len(kind) != 1 or len(np.unique(sizes)) != 1:
                raise InputError(
                    f"{self.path}: body {entry.name!r} has no mesh of one kind of cell"
                )
            cells.append(connectivity[offsets[mine][:, None] + np.arange(sizes[0])])
            kinds.append(int(kind[0]))
        return AuditModel(self.scenario, points, cells, kinds)

    def row(self, index: int) -> dict[str, float]:
        """Return a row of the history by column."""
        return {column: float(values[index]) for column, values in self.history.items()}

    def frames(self) -> Iterator[Frame]:
        """Yield the fields of one output time after the other."""
        with self._fields() as root:
            steps = root["Steps"]
            points, cells = len(root["Points"]), len(root["Types"])
            for index in range(int(steps.attrs["NSteps"])):
                arrays: dict[str, Array] = {}
                for kind, names, rows in (
                    ("PointData", POINT_FIELDS, points),
                    ("CellData", tuple(CELL_FIELDS), cells),
                ):
                    for name in names:
                        at = int(steps[f"{kind}Offsets/{name}"][index])
                        arrays[name] = root[f"{kind}/{name}"][at : at + rows]
                vectors = {name: arrays.pop(name) for name in POINT_FIELDS}
                yield Frame(
                    time=float(steps["Values"][index]),
                    flat=max(float(np.abs(v[:, 2]).max()) for v in vectors.values()),
                    **{name: v[:, :2] for name, v in vectors.items()},
                    **{name: a.reshape(cells, -1).squeeze() for name, a in arrays.items()},
                )

    def steps(self) -> Iterator[dict[str, Any]]:
        """Yield the stored steps, of which there are none without ``output.audit``."""
        if self.has_steps:
            yield from read_steps(self.path / layout.AUDIT)

    def _fields(self) -> _Fields:
        return _Fields(self.path / layout.FIELDS)


class _Fields:
    """Opens the fields, and says it in words where they are not what carom writes."""

    def __init__(self, path: Path) -> None:
        self._path = path

    def __enter__(self) -> h5py.Group:
        try:
            self._file = h5py.File(self._path, "r")
        except OSError as error:
            raise InputError(f"{self._path}: not a VTKHDF file: {error}") from error
        if "VTKHDF" not in self._file:
            self._file.close()
            raise InputError(f"{self._path}: not a VTKHDF file of carom")
        return self._file["VTKHDF"]

    def __exit__(self, kind: object, error: object, trace: object) -> None:
        self._file.close()
        if isinstance(error, KeyError):
            raise InputError(f"{self._path}: not fields of carom: {error}") from error
