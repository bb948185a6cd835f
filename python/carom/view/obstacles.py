"""Rigid obstacles in a scene."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.case.obstacle import (
    Obstacle,
    Plane,
    RigidBox,
    RigidCylinder,
    RigidPolygon,
    RigidSphere,
    RigidSurface,
)
from carom.case.scenario import Scenario
from carom.case.travel import travel
from carom.mesh_file import read_surface

FINE = 180
"""Edges around what is round: beside a large obstacle a small body shows how round it is."""

_LOOK = {"color": "lightgrey", "opacity": 0.5}
_LINE = {"color": "grey", "line_width": 2}


def draw_obstacles(
    plotter: Any,  # noqa: ANN401 (PyVista is optional)
    scenario: Scenario,
    low: NDArray[np.float64],
    high: NDArray[np.float64],
    time: float,
) -> None:
    """Draw the obstacles where they have moved; what has no end, as large as the bodies.

    Parameters
    ----------
    plotter
        PyVista's plotter.
    scenario
        The case.
    low, high
        Corners of the box around the bodies [m], shape [3].
    time
        Time [s].
    """
    size = 1.3 * float(np.linalg.norm(high - low))
    flat = scenario.dimension == 2
    for index, obstacle in enumerate(scenario.obstacles):
        (moved,) = travel(obstacle, np.array([time]), dimension=scenario.dimension)
        moved = _spatial(tuple(moved))
        middle = (low + high) / 2 - moved
        if flat:
            shape = _line(obstacle, middle, size)
        else:
            shape = _solid(obstacle, middle, size, key=f"obstacles.{index}")
        plotter.add_mesh(shape.translate(moved), **(_LINE if flat else _LOOK))


def _line(obstacle: Obstacle, middle: NDArray[np.float64], size: float) -> Any:  # noqa: ANN401
    """Return the outline of an obstacle of the plane where it has not moved."""
    import pyvista  # noqa: PLC0415 (an extra)

    if isinstance(obstacle, Plane):
        normal, centre = _plane(obstacle, middle)
        along = np.array([-normal[1], normal[0], 0.0]) * size / 2
        return pyvista.Line(centre - along, centre + along)
    if isinstance(obstacle, RigidSphere):
        circle = pyvista.Circle(radius=obstacle.radius, resolution=2 * FINE).translate(
            _spatial(obstacle.centre)
        )
        return circle.extract_feature_edges()
    if isinstance(obstacle, RigidBox):
        return _box(obstacle).extract_feature_edges()
    if isinstance(obstacle, RigidPolygon):
        corners = [_spatial(corner) for corner in obstacle.points]
        return pyvista.lines_from_points(np.array(corners), close=True)
    raise AssertionError(f"{obstacle.kind} is no obstacle of the plane")


def _solid(obstacle: Obstacle, middle: NDArray[np.float64], size: float, *, key: str) -> Any:  # noqa: ANN401 (PyVista is optional)
    """Return the surface of an obstacle in space where it has not moved."""
    import pyvista  # noqa: PLC0415 (an extra)

    if isinstance(obstacle, Plane):
        normal, centre = _plane(obstacle, middle)
        return pyvista.Plane(center=centre, direction=normal, i_size=size, j_size=size)
    if isinstance(obstacle, RigidSphere):
        return pyvista.Sphere(
            radius=obstacle.radius,
            center=obstacle.centre,
            theta_resolution=FINE,
            phi_resolution=FINE,
        )
    if isinstance(obstacle, RigidCylinder):
        axis = np.array(obstacle.axis) / np.linalg.norm(obstacle.axis)
        point = np.array(obstacle.point)
        centre = point + axis * float((middle - point) @ axis)
        return pyvista.Cylinder(
            center=centre,
            direction=axis,
            radius=obstacle.radius,
            height=size,
            resolution=FINE,
            capping=False,
        )
    if isinstance(obstacle, RigidBox):
        return _box(obstacle)
    assert isinstance(obstacle, RigidSurface), f"{obstacle.kind} is no obstacle of space"
    surface = read_surface(obstacle.file, scale=obstacle.scale, key=key)
    triangles: Any = surface.triangles
    return pyvista.PolyData.from_regular_faces(surface.points, triangles)


def _plane(
    plane: Plane, middle: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the unit normal of a plane, and its point nearest to the middle of the bodies."""
    normal = _spatial(plane.normal) / np.linalg.norm(plane.normal)
    return normal, middle - normal * float((middle - _spatial(plane.point)) @ normal)


def _box(box: RigidBox) -> Any:  # noqa: ANN401 (PyVista is optional)
    import pyvista  # noqa: PLC0415 (an extra)

    low, size = _spatial(box.corner), _spatial(box.size)
    return pyvista.Box(np.column_stack([low, low + size]).ravel())


def _spatial(vector: tuple[float, ...]) -> NDArray[np.float64]:
    """Return a vector with the missing components as zeros, shape [3]."""
    return np.array([*vector, *[0.0] * (3 - len(vector))])
