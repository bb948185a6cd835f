"""Rigid obstacles in a scene."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.scenario import Scenario

_LOOK = {"color": "lightgrey", "opacity": 0.5}


def draw_obstacles(
    plotter: Any,  # noqa: ANN401 (PyVista is optional)
    scenario: Scenario,
    low: NDArray[np.float64],
    high: NDArray[np.float64],
    time: float,
) -> None:
    """Draw planes as large as the bodies between `low` and `high` [m], where they are at a time."""
    import pyvista  # noqa: PLC0415 (an extra)

    size = 1.3 * float(np.linalg.norm(high - low))
    middle = (low + high) / 2
    for obstacle in scenario.obstacles:
        if obstacle.kind != "plane":
            continue
        velocity = _spatial(obstacle.velocity or (0.0,))
        normal = _spatial(obstacle.normal) / np.linalg.norm(obstacle.normal)
        point = _spatial(obstacle.point) + velocity * time
        centre = middle - normal * float((middle - point) @ normal)
        if scenario.dimension == 2:
            along = np.array([-normal[1], normal[0], 0.0]) * size / 2
            plotter.add_mesh(
                pyvista.Line(centre - along, centre + along), color="grey", line_width=2
            )
        else:
            plane = pyvista.Plane(center=centre, direction=normal, i_size=size, j_size=size)
            plotter.add_mesh(plane, **_LOOK)


def _spatial(vector: tuple[float, ...]) -> NDArray[np.float64]:
    """Return a vector with the missing components as zeros, shape [3]."""
    return np.array([*vector, *[0.0] * (3 - len(vector))])
