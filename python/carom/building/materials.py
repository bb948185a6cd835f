"""Which cells are of which material."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from carom.case.body import materials_of
from carom.case.scenario import Scenario


def with_materials(
    mesh: Mapping[str, NDArray[np.generic]], scenario: Scenario
) -> dict[str, NDArray[np.generic]]:
    """Return the native mesh of a case with the ``material`` of each cell.

    It is the number of the material among those of the case, from 0, and -1 in a rigid body. Where
    every body is of one material, the mesh says nothing of it.

    Parameters
    ----------
    mesh
        What the native simulation gives: ``body`` and, if some body has regions, ``region``, which
        is 0 in the rest of it.
    scenario
        The case.
    """
    known = {name: number for number, name in enumerate(scenario.materials)}
    own = dict(mesh)
    region = own.pop("region", None)
    if region is None:
        return own
    material = np.full(len(region), -1, dtype=np.int32)
    for index, body in enumerate(scenario.bodies):
        numbers = np.array([known[name] for name in materials_of(body)] or [-1], dtype=np.int32)
        mine = np.asarray(mesh["body"]) == index
        material[mine] = numbers[np.asarray(region, dtype=np.int64)[mine]]
    return {**own, "material": material}
