"""What a results directory holds, as the auditor reads it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from carom.auditing.arrays import Array, Indices
from carom.auditing.bodies.code import Code, NoCode
from carom.auditing.model import AuditModel
from carom.auditing.records.codes import codes_of
from carom.case.scenario import Scenario
from carom.errors import InputError
from carom.io import layout
from carom.io.audit import read_steps
from carom.io.damage import DAMAGE
from carom.io.history import read_history
from carom.io.ledger import read_ledger
from carom.io.summary import read_summary
from carom.io.vtkhdf import (
    CELL_FIELDS,
    POINT_FIELDS,
    SURFACE_CELL_FIELDS,
    SURFACE_POINT_FIELDS,
)

_NEEDED = (
    layout.CASE,
    layout.SUMMARY,
    layout.HISTORY,
    layout.LEDGER,
    layout.FIELDS,
    layout.SURFACE,
)


@dataclass(frozen=True)
class Frame:
    """The fields of one output time.

    Parameters
    ----------
    time
        Time [s].
    displacement, velocity, reaction
        Nodal vectors [m], [m/s], [N], shape [node_count, D].
    stress, energy_density
        Cauchy stress xx yy zz xy yz xz [Pa] and stored energy [J/m³] of the cells.
    strain
        Green–Lagrange strain of the cells, which no check needs.
    plastic_strain
        Equivalent plastic strain of the cells.
    flat
        Largest component out of the plane, which must be zero.
    """

    time: float
    displacement: Array
    velocity: Array
    reaction: Array
    stress: Array
    strain: Array
    energy_density: Array
    plastic_strain: Array
    flat: float


@dataclass(frozen=True)
class SurfaceFrame:
    """The fields on the boundaries at one output time.

    Parameters
    ----------
    time
        Time [s].
    displacement
        Of all nodes [m], shape [node_count, D].
    friction_energy, slip, pressure, area
        Of the facets, see `carom.io.vtkhdf`, shape [facet_count].
    flat
        Largest component out of the plane, which must be zero.
    """

    time: float
    displacement: Array
    friction_energy: Array
    slip: Array
    pressure: Array
    area: Array
    flat: float


@dataclass(frozen=True)
class Facets:
    """The mesh of the boundaries.

    Parameters
    ----------
    nodes
        Nodes of each facet, shape [facet_count, a]; of those that have fewer the first again.
    body
        Index of its body, shape [facet_count].
    points
        Reference positions of all nodes [m], shape [node_count, D].
    """

    nodes: Indices
    body: Indices
    points: Array


class Files:
    """A results directory.

    Parameters
    ----------
    path
        The directory.
    bodies
        Bodies of other codes, whose law no file holds.

    Raises
    ------
    InputError
        A file is missing, or is not one of carom; or a body is not of the case.
    """

    def __init__(self, path: Path, bodies: Sequence[Code] = ()) -> None:
        self.path = path
        for name in _NEEDED:
            if not (path / name).exists():
                raise InputError(
                    f"{path}: has no {name}; name a directory that `carom run` has finished"
                )
        self.scenario = Scenario.from_toml(path / layout.CASE)
        self._codes = codes_of(self.scenario, bodies)
        self.summary: dict[str, Any] = read_summary(path / layout.SUMMARY)
        self.history = read_history(path / layout.HISTORY)
        self.ledger = read_ledger(path / layout.LEDGER)
        self.has_steps = (path / layout.AUDIT).exists()
        if self.scenario.output.audit and not self.has_steps:
            raise InputError(f"{path}: has no {layout.AUDIT}, which its case asks for")

    def models(self) -> list[AuditModel]:
        """Build the models of the case, one a stage, on the mesh of the fields."""
        with _Fields(self.path / layout.FIELDS) as root:
            points = root["Points"][:, : self.scenario.dimension]
            connectivity, offsets = root["Connectivity"][:], root["Offsets"][:]
            types, body = root["Types"][:], root["CellData/body"][:]
        nodes = _even(connectivity, offsets)
        cells, kinds = [], []
        for index, entry in enumerate(self.scenario.bodies):
            mine = np.flatnonzero(body == index)
            if len(mine) == 0:
                raise InputError(f"{self.path}: body {entry.name!r} has no cells")
            cells.append(nodes[mine, : int(np.diff(offsets)[mine].max())])
            kinds.append(types[mine].astype(np.int64))
        # Every body may touch itself, and few do: these alone have books for it.
        pairs = [pair["between"] for pair in self.summary["pairs"]]
        own = {a for a, b in pairs if a == b}
        codes = self._all_codes(points, cells)
        models = [
            AuditModel(
                self.scenario, stage, points, cells, kinds, touching_themselves=own, codes=codes
            )
            for stage in self.scenario.full_stages()
        ]
        for before, model in pairwise(models):
            model.before = before
        return models

    def _all_codes(self, points: Array, cells: Sequence[Indices]) -> dict[str, Code]:
        """Return the codes of all bodies that have one; no code of those that none came with."""
        codes, facets = {}, self.facets()
        for index, (entry, nodes) in enumerate(zip(self.scenario.bodies, cells, strict=True)):
            if entry.kind != "foreign":
                continue
            first, last = int(nodes.min()), int(nodes.max()) + 1
            touching = facets.nodes[facets.body == index] - first
            stored = NoCode(entry.name, points[first:last], touching, nodes - first)
            code = codes[entry.name] = self._codes.get(entry.name, stored)
            if code.points.shape != stored.points.shape:
                raise InputError(
                    f"bodies: {entry.name!r} has points of shape {list(code.points.shape)}, and of "
                    f"shape {list(stored.points.shape)} in the run; give it as it was run"
                )
        return codes

    def materials(self) -> Indices | None:
        """Return the number of the material of each cell, where the fields say it."""
        with _Fields(self.path / layout.FIELDS) as root:
            return root["CellData/material"][:] if "material" in root["CellData"] else None

    def row(self, index: int) -> dict[str, float]:
        """Return a row of the history by column."""
        return {column: float(values[index]) for column, values in self.history.items()}

    def facets(self) -> Facets:
        """Return the mesh of the boundaries."""
        with _Fields(self.path / layout.SURFACE) as root:
            return Facets(
                nodes=_even(root["Connectivity"][:], root["Offsets"][:]),
                body=root["CellData/body"][:],
                points=root["Points"][:, : self.scenario.dimension],
            )

    def frames(self) -> Iterator[Frame]:
        """Yield the fields of one output time after the other."""
        for fields in self._frames(layout.FIELDS, POINT_FIELDS, CELL_FIELDS):
            yield Frame(**fields)

    def surface_frames(self) -> Iterator[SurfaceFrame]:
        """Yield the fields on the boundaries of one output time after the other."""
        for fields in self._frames(layout.SURFACE, SURFACE_POINT_FIELDS, SURFACE_CELL_FIELDS):
            yield SurfaceFrame(**fields)

    def _frames(
        self, name: str, point_fields: Sequence[str], cell_fields: Mapping[str, int]
    ) -> Iterator[dict[str, Any]]:
        with _Fields(self.path / name) as root:
            steps, dimension = root["Steps"], self.scenario.dimension
            points, cells = len(root["Points"]), len(root["Types"])
            of_points = _stored(root, "PointData", point_fields)
            of_cells = _stored(root, "CellData", cell_fields)
            times = steps["Values"][:]
            for index in range(int(steps.attrs["NSteps"])):
                fields: dict[str, Any] = {"time": float(times[index]), "flat": 0.0}
                for field, (stored, offsets) in of_points.items():
                    vectors = stored[offsets[index] : offsets[index] + points]
                    out = float(np.abs(vectors[:, dimension:]).max(initial=0.0))
                    fields["flat"] = max(fields["flat"], out)
                    fields[field] = vectors[:, :dimension]
                for field, (stored, offsets) in of_cells.items():
                    rows = stored[offsets[index] : offsets[index] + cells]
                    fields[field] = rows[:, 0] if rows.shape[1] == 1 else rows
                yield fields

    def steps(self) -> Iterator[dict[str, Any]]:
        """Yield the stored steps, of which there are none without ``output.audit``."""
        if self.has_steps:
            yield from read_steps(self.path / layout.AUDIT)


def _stored(
    root: h5py.Group, kind: str, fields: Iterable[str]
) -> dict[str, tuple[h5py.Dataset, Indices]]:
    """Return where fields are stored, and the row of each at which the output times begin."""
    return {
        field: (root[f"{kind}/{field}"], root[f"Steps/{kind}Offsets/{field}"][:].astype(np.int64))
        for field in fields
    }


def _even(connectivity: Indices, offsets: Indices) -> Indices:
    """Return the nodes of cells as rows; shorter ones end with their first node."""
    sizes = np.diff(offsets)
    column = np.arange(int(sizes.max(initial=0)))
    within = np.where(column < sizes[:, None], column, 0)
    nodes: Indices = connectivity[offsets[:-1, None] + within]
    return nodes


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
        if isinstance(error, DAMAGE) and not isinstance(error, InputError):
            raise InputError(f"{self._path}: not fields of carom: {error}") from error
