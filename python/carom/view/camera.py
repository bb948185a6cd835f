"""Where the camera stands: as near to the bodies as shows all of them."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

DIRECTION = (1.0, -1.6, 0.7)
"""From a body in space to the camera."""

ANGLE = 30.0
"""Between the upper and the lower edge of the picture, in space [degrees]."""

ACROSS, UP = 0.92, 0.72
"""Shares of the picture that bodies may fill: there is a line above them, and the colours below."""

RAISED = 0.05
"""What the middle of that part is above the middle of the picture, in its height."""


def aim(plotter: Any, points: NDArray[np.float64], *, flat: bool) -> None:  # noqa: ANN401
    """Turn the camera to points, such that they fill the picture; obstacles may reach out of it.

    Parameters
    ----------
    plotter
        PyVista's plotter.
    points
        What has to be seen [m], shape [point_count, 3]. Where all are one point, a metre is shown.
    flat
        Whether the scene is in the plane.
    """
    back = np.array([0.0, 0.0, 1.0]) if flat else np.array(DIRECTION) / np.linalg.norm(DIRECTION)
    right = np.array([1.0, 0.0, 0.0]) if flat else np.cross([0.0, 0.0, 1.0], back)
    right /= np.linalg.norm(right)
    up = np.cross(back, right)
    axes = np.array([right, up, back])
    seen = points @ axes.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    middle, size = (low + high) / 2, float(np.linalg.norm(high - low)) or 1.0
    seen = seen - middle
    width, height = plotter.window_size
    shares = np.array([ACROSS * width / height, UP])
    half = (
        float(np.abs(seen[:, :2] / shares).max()) or size
    )  # of the picture's height, at the middle
    slope = np.tan(np.radians(ANGLE / 2))
    # What is nearer to the camera looks larger, so that it counts where each point is.
    away = size if flat else float((np.abs(seen[:, :2]) / (shares * slope) + seen[:, 2:]).max())
    away = max(away, 1e-3 * size)
    shift = -2 * RAISED * (half if flat else away * slope) * up
    target = middle @ axes + shift
    camera = plotter.camera
    camera.focal_point = tuple(target)
    camera.position = tuple(target + away * back)
    camera.up = tuple(up)
    if flat:
        plotter.enable_parallel_projection()
        camera.parallel_scale = half
    else:
        camera.view_angle = ANGLE
    plotter.renderer.ResetCameraClippingRange()
