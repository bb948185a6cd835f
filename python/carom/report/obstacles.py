"""The rigid obstacles of a case as plain data for the page, and where they are over time."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.case.obstacle import Obstacle, RigidSurface
from carom.case.scenario import Scenario
from carom.case.travel import travel
from carom.errors import InputError
from carom.mesh_file import read_surface
from carom.report.codec import pack


def obstacles(
    scenario: Scenario, times: NDArray[np.float64], notes: list[str]
) -> list[dict[str, Any]]:
    """Return shape and travel of every obstacle.

    Parameters
    ----------
    scenario
        The case.
    times
        Times of the frames [s], shape [frame_count].
    notes
        What could not be shown is added here.
    """
    shown = []
    for index, obstacle in enumerate(scenario.obstacles):
        shape = _shape(obstacle, f"obstacles.{index}", notes)
        if shape is not None:
            moved = travel(obstacle, times, dimension=scenario.dimension)
            shown.append({"name": obstacle.name, **shape, "travel": moved.tolist()})
    return shown


def _shape(obstacle: Obstacle, key: str, notes: list[str]) -> dict[str, Any] | None:
    if not isinstance(obstacle, RigidSurface):
        return obstacle.model_dump(mode="json", exclude={"name", "velocity", "motion"})
    try:
        surface = read_surface(obstacle.file, scale=obstacle.scale, key=key)
    except InputError as error:
        notes.append(f"The obstacle {obstacle.name} is not drawn: {error}.")
        return None
    return {
        "kind": "surface",
        "points": pack(surface.points, "f4"),
        "triangles": pack(surface.triangles, "u4"),
    }
