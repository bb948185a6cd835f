"""The boundary of a body in somebody else's mesh."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from carom.errors import InputError
from carom.friction.arrays import shown


class Surface:
    """The boundary of a body, or the part of it that may touch, as facets of your mesh.

    Facets may be turned either way. What is closed is turned so that the body is behind it; of what
    is open, most facets say where the outside is. Each body has one surface.

    Parameters
    ----------
    name
        What pairs and books call it.
    facets
        Your numbers of the nodes of every facet, from 0, shape [facet_count, node_count]: in the
        plane 2 or 3 nodes, in space 3, 4, 6, 8 or 9, in VTK's order. For several kinds, a sequence
        of such arrays.
    self_contact
        Whether it may touch itself.

    Raises
    ------
    InputError
        If facets are no array of node numbers.
    """

    def __init__(
        self, name: str, facets: ArrayLike | Sequence[ArrayLike], *, self_contact: bool = False
    ) -> None:
        self.name = name
        self.self_contact = self_contact
        self.facets = [self._checked(kind) for kind in _kinds(facets)]
        if not sum(map(len, self.facets)):
            raise InputError(f"surfaces.{name}.facets: there are none; give one at least", name)

    def _checked(self, facets: ArrayLike) -> NDArray[np.int64]:
        key = f"surfaces.{self.name}.facets"
        array = np.asarray(facets)
        if array.ndim != 2 or array.dtype.kind not in "iu":
            raise InputError(
                f"{key}: has shape {shown(array.shape)} and type {array.dtype}; must be integers "
                "of shape [facet_count, node_count]",
                key,
            )
        if array.size and array.min() < 0:
            row, column = np.argwhere(array < 0)[0]
            raise InputError(
                f"{key}: facet {row} has node {array[row, column]}; nodes are numbered from 0", key
            )
        return np.ascontiguousarray(array, dtype=np.int64)

    def __repr__(self) -> str:
        return f"<Surface {self.name!r}: {sum(map(len, self.facets))} facets>"


def _kinds(facets: Any) -> list[Any]:  # noqa: ANN401 (arrays, or sequences of them)
    """Return the facets kind by kind."""
    try:
        is_one = np.asarray(facets).ndim <= 2
    except ValueError:
        is_one = False
    return [facets] if is_one else list(facets)
