"""Rigid obstacles in space."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.case.obstacle import (
    Obstacle,
    Plane,
    RigidBox,
    RigidCylinder,
    RigidSphere,
    RigidSurface,
)
from carom.case.scenario import Scenario
from carom.display.colours import SOLID, SOLID_LINE
from carom.mesh_file import read_surface
from carom.view.solids import FINE, solid

WALL, WALL_LINE = "#EDF0F4", "#D3D9E2"

_LOOK = {"color": SOLID, "opacity": 0.45, "ambient": 0.35, "diffuse": 0.65}
"""Of what has an inside: translucent, for bodies may be behind it or in it."""

LINES = 10
"""Into how many parts lines cut the longer side of a wall."""


def add_obstacles(
    plotter: Any,  # noqa: ANN401 (PyVista is optional)
    scenario: Scenario,
    low: NDArray[np.float64],
    high: NDArray[np.float64],
) -> list[list[Any]]:
    """Draw the obstacles where they have not moved, and return the actors of each.

    What has no end is drawn as large as the bodies. A wall is drawn if the camera, which is set
    already, stands on its free side.

    Parameters
    ----------
    plotter
        PyVista's plotter.
    scenario
        The case.
    low, high
        Corners of the box around the bodies [m], shape [3].
    """
    if scenario.dimension == 2:
        return [list(_flat(plotter, obstacle, low, high)) for obstacle in scenario.obstacles]
    planes = [obstacle for obstacle in scenario.obstacles if isinstance(obstacle, Plane)]
    low, high = _with_walls(planes, low, high)
    return [
        list(
            _wall(plotter, obstacle, planes, low, high)
            if isinstance(obstacle, Plane)
            else _solid(plotter, obstacle, low, high, f"obstacles.{index}")
        )
        for index, obstacle in enumerate(scenario.obstacles)
    ]


def _flat(
    plotter: Any,  # noqa: ANN401
    obstacle: Obstacle,
    low: NDArray[np.float64],
    high: NDArray[np.float64],
) -> Iterator[Any]:
    """Draw the edge of an obstacle of the plane."""
    import pyvista  # noqa: PLC0415 (an extra)

    middle, size = (low + high)[:2] / 2, 2.0 * float(np.linalg.norm(high - low))
    edge = solid(obstacle, middle, size).edge
    line = pyvista.lines_from_points(np.column_stack([edge, np.zeros(len(edge))]))
    yield plotter.add_mesh(line, color=SOLID_LINE, line_width=2, lighting=False)


def _solid(
    plotter: Any,  # noqa: ANN401
    obstacle: Obstacle,
    low: NDArray[np.float64],
    high: NDArray[np.float64],
    key: str,
) -> Iterator[Any]:
    """Draw the surface of an obstacle in space."""
    import pyvista  # noqa: PLC0415 (an extra)

    middle, size = (low + high) / 2, 1.3 * float(np.linalg.norm(high - low))
    if isinstance(obstacle, RigidSphere):
        shape = pyvista.Sphere(
            radius=obstacle.radius,
            center=obstacle.centre,
            theta_resolution=FINE,
            phi_resolution=FINE // 2,
        )
    elif isinstance(obstacle, RigidCylinder):
        axis = np.array(obstacle.axis) / np.linalg.norm(obstacle.axis)
        point = np.array(obstacle.point)
        shape = pyvista.Cylinder(
            center=point + axis * float((middle - point) @ axis),
            direction=axis,
            radius=obstacle.radius,
            height=size,
            resolution=FINE,
            capping=False,
        )
    elif isinstance(obstacle, RigidBox):
        corner, sides = np.array(obstacle.corner), np.array(obstacle.size)
        shape = pyvista.Box(np.column_stack([corner, corner + sides]).ravel())
    else:
        assert isinstance(obstacle, RigidSurface), f"{obstacle.kind} is no obstacle of space"
        surface = read_surface(obstacle.file, scale=obstacle.scale, key=key)
        triangles: Any = surface.triangles
        shape = pyvista.PolyData.from_regular_faces(surface.points, triangles)
    is_cavity = getattr(obstacle, "cavity", False)
    round_ = isinstance(obstacle, (RigidSphere, RigidCylinder))
    yield plotter.add_mesh(
        shape, smooth_shading=round_, culling="front" if is_cavity else False, **_LOOK
    )
    edges = shape.extract_feature_edges(30.0)
    if edges.n_points:
        yield plotter.add_mesh(edges, color=SOLID_LINE, line_width=1.5, lighting=False)


def _wall(
    plotter: Any,  # noqa: ANN401
    plane: Plane,
    planes: Sequence[Plane],
    low: NDArray[np.float64],
    high: NDArray[np.float64],
) -> Iterator[Any]:
    """Draw a wall with lines on it as far as others, if it is seen from its free side."""
    import pyvista  # noqa: PLC0415 (an extra)

    normal = _unit(plane)
    middle, extent = (low + high) / 2, high - low
    foot = _foot(plane, middle)
    if float((np.array(plotter.camera.position) - foot) @ normal) <= 0.0:
        return
    helper = np.array([0.0, 0.0, 1.0]) if abs(normal[2]) < 0.9 else np.array([1.0, 0.0, 0.0])
    first = np.cross(helper, normal)
    first /= np.linalg.norm(first)
    second = np.cross(normal, first)
    margin = 0.04 * float(np.linalg.norm(extent))
    u, v = (0.5 * float(extent @ np.abs(axis)) + margin for axis in (first, second))
    square = ((-1, -1), (1, -1), (1, 1), (-1, 1))
    corners = np.array([foot + a * u * first + b * v * second for a, b in square])
    others = [other for other in planes if abs(float(_unit(other) @ normal)) < 0.99]
    corners = _cut_off(corners, others)
    if len(corners) < 3:
        return
    sheet = pyvista.PolyData(corners, [len(corners), *range(len(corners))])
    yield plotter.add_mesh(sheet, color=WALL, lighting=False)
    step = 2.0 * max(u, v) / LINES
    ends = []
    for along, across, half, other in ((first, second, u, v), (second, first, v, u)):
        count = int(half / step)
        for place in step * np.arange(-count, count + 1):
            line = [foot + place * along + sign * other * across for sign in (-1, 1)]
            ends += [*_cut_off(np.array(line), others)]
    if ends:
        lines = pyvista.line_segments_from_points(np.array(ends))
        yield plotter.add_mesh(lines, color=WALL_LINE, line_width=1, lighting=False)
    rim = pyvista.lines_from_points(corners, close=True)
    yield plotter.add_mesh(rim, color=SOLID_LINE, line_width=1.2, lighting=False)


def _with_walls(
    planes: Sequence[Plane], low: NDArray[np.float64], high: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the corners of the box around the bodies and the walls that are not far from them."""
    near = 0.6 * float(np.linalg.norm(high - low))
    middle = (low + high) / 2
    feet = [_foot(plane, middle) for plane in planes]
    feet = [foot for foot in feet if np.abs(foot - np.clip(foot, low, high)).max() <= near]
    everything = np.array([low, high, *feet])
    return everything.min(axis=0), everything.max(axis=0)


def _cut_off(points: NDArray[np.float64], planes: Sequence[Plane]) -> NDArray[np.float64]:
    """Return what of a convex polygon, or a line, is on the free side of all planes."""
    for plane in planes:
        height = (points - np.array(plane.point)) @ _unit(plane)
        kept: list[NDArray[np.float64]] = []
        count = len(points)
        for k in range(count):
            if height[k] >= 0.0:
                kept.append(points[k])
            after = (k + 1) % count
            if (height[k] < 0.0) != (height[after] < 0.0) and (count > 2 or k == 0):
                share = height[k] / (height[k] - height[after])
                kept.append(points[k] + share * (points[after] - points[k]))
        points = np.array(kept).reshape(-1, 3)
    return points


def _unit(plane: Plane) -> NDArray[np.float64]:
    return np.asarray(np.array(plane.normal) / np.linalg.norm(plane.normal))


def _foot(plane: Plane, middle: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the point of a plane that is nearest to another."""
    normal = _unit(plane)
    return np.asarray(middle - normal * float((middle - np.array(plane.point)) @ normal))
