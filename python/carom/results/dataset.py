"""Fields as an xarray dataset. Import only where xarray is known to be there."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from xarray.backends import BackendArray
from xarray.core import indexing

from carom.results.field import AXES, TENSOR, Field

if TYPE_CHECKING:
    from carom.results.fields import Fields


class _InFile(BackendArray):
    """A field as xarray's lazy indexing wants it: what is indexed is read."""

    def __init__(self, field: Field) -> None:
        self.field = field
        self.shape, self.dtype = field.shape, field.dtype

    def __getitem__(self, key: indexing.ExplicitIndexer) -> Any:  # noqa: ANN401 (as xarray's)
        return indexing.explicit_indexing_adapter(
            key, self.shape, indexing.IndexingSupport.BASIC, self.field.__getitem__
        )


def dataset(fields: Fields) -> xr.Dataset:
    """Return fields as a dataset; see `Fields.to_xarray`."""
    variables = {name: _variable(field) for name, field in fields.items()}
    axes = list(AXES[: fields.points.shape[1]])
    cell = fields.cell
    coordinates: dict[str, Any] = {
        "time": ("time", fields.times, {"units": "s", "long_name": "time"}),
        "axis": ("axis", axes),
        "position": (
            ("node", "axis"),
            fields.points,
            {"units": "m", "long_name": "reference position"},
        ),
        "connectivity": (
            (cell, "corner"),
            fields.connectivity,
            {"long_name": "nodes in VTK's order, -1 where a cell has fewer"},
        ),
        "type": (cell, fields.cell_types, {"long_name": "type of cell as VTK numbers it"}),
        "node_body": ("node", _names(fields, "nodes", len(fields.points))),
        f"{cell}_body": (cell, _names(fields, "cells", len(fields.cell_types))),
    }
    if any("component" in variable.dims for variable in variables.values()):
        coordinates["component"] = ("component", list(TENSOR))
    return xr.Dataset(variables, coordinates)


def _variable(field: Field) -> xr.Variable:
    dims = ["time", field.on]
    if field.components:
        dims.append("component" if field.components == TENSOR else "axis")
    attributes = {"units": field.unit or "1", "long_name": field.about}
    return xr.Variable(dims, indexing.LazilyIndexedArray(_InFile(field)), attributes)


def _names(fields: Fields, what: str, count: int) -> NDArray[np.str_]:
    """Return the body of each node or cell."""
    longest = max(map(len, fields.parts))
    names = np.empty(count, dtype=f"U{longest}")
    for name, part in fields.parts.items():
        names[getattr(part, what)] = name
    return names
