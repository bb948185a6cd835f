"""The rigid obstacles of a case as plain data for the page, and where they are over time."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.errors import InputError
from carom.mesh_file import read_surface
from carom.obstacle import Obstacle, RigidSurface
from carom.report.codec import pack
from carom.scenario import Scenario
from carom.signal import Signal, Table


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
            travel = _travel(obstacle, times, scenario.dimension, notes)
            shown.append({"name": obstacle.name, **shape, "travel": travel.tolist()})
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


def _travel(
    obstacle: Obstacle, times: NDArray[np.float64], dimension: int, notes: list[str]
) -> NDArray[np.float64]:
    """Return how far an obstacle has moved [m], shape [frame_count, D]."""
    travel = np.zeros((len(times), dimension))
    if obstacle.velocity is not None:
        return travel + np.outer(times, obstacle.velocity)
    if obstacle.motion is not None:
        for index, name in enumerate("xyz"[:dimension]):
            signal = getattr(obstacle.motion, name)
            if signal is not None:
                travel[:, index] = _values(signal, times, obstacle.name, notes)
    return travel


def _values(
    signal: Signal, times: NDArray[np.float64], name: str, notes: list[str]
) -> NDArray[np.float64]:
    if isinstance(signal, Table):
        return np.interp(times, signal.time, signal.value)
    if isinstance(signal, str):
        notes.append(f"The obstacle {name} moves by a formula and is drawn where it starts.")
        return np.zeros(len(times))
    return np.full(len(times), float(signal))
