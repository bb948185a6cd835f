"""Where the camera stands: as near to the bodies as shows all of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

AZIMUTH, ELEVATION = -58.0, 22.0
"""Where from bodies in space are seen, unless it is said: around z from x, and above [degrees]."""

ANGLE = 24.0
"""Between the upper and the lower edge of the picture, in space [degrees]."""


@dataclass(frozen=True)
class Sight:
    """The axes of the picture: to the right, up, and from the bodies to the camera."""

    right: NDArray[np.float64]
    up: NDArray[np.float64]
    back: NDArray[np.float64]

    @classmethod
    def of_plane(cls) -> Sight:
        """Return the axes of pictures of the plane."""
        return cls(*np.eye(3))

    @classmethod
    def towards(cls, azimuth: float = AZIMUTH, elevation: float = ELEVATION) -> Sight:
        """Return the axes as seen from an azimuth and an elevation [degrees]; z points up."""
        a, e = np.radians([azimuth, elevation])
        right = np.array([-np.sin(a), np.cos(a), 0.0])
        back = np.array([np.cos(a) * np.cos(e), np.sin(a) * np.cos(e), np.sin(e)])
        return cls(right, np.cross(back, right), back)

    def seen(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return points in these axes, shape [point_count, 3] [m]."""
        return np.asarray(points @ np.array([self.right, self.up, self.back]).T)

    def aspect(self, points: NDArray[np.float64]) -> float:
        """Return the width of what is seen of points, in its height; between a fifth and five."""
        width, height = np.ptp(self.seen(points)[:, :2], axis=0)
        return float(np.clip(width / height, 0.2, 5.0)) if height > 0.0 else 5.0


def aim(
    plotter: Any,  # noqa: ANN401 (PyVista is optional)
    points: NDArray[np.float64],
    sight: Sight,
    *,
    flat: bool,
    share: float,
) -> None:
    """Turn the camera to points, such that they fill the picture; obstacles may reach out of it.

    Parameters
    ----------
    plotter
        PyVista's plotter.
    points
        What has to be seen [m], shape [point_count, 3]. Where all are one point, a metre is shown.
    sight
        The axes of the picture.
    flat
        Whether the scene is in the plane.
    share
        Of the picture's width and height, that points may fill.
    """
    seen = sight.seen(points)
    low, high = seen.min(axis=0), seen.max(axis=0)
    size = float(np.linalg.norm(high - low)) or 1.0
    width, height = plotter.window_size
    shares = share * np.array([width / height, 1.0])
    slope = np.tan(np.radians(ANGLE / 2))
    middle = (low + high) / 2
    for _ in range(1 if flat else 4):
        here = seen - middle
        half = float(np.abs(here[:, :2] / shares).max()) or size / 2
        # What is nearer to the camera looks larger, so that it counts where each point is.
        away = (np.abs(here[:, :2]) / (shares * slope) + here[:, 2:]).max()
        away = max(float(away), 1e-3 * size)
        if not flat:
            # The middle of what is seen, which perspective moves.
            at = here[:, :2] * (away / (away - here[:, 2:]))
            middle[:2] += (at.min(axis=0) + at.max(axis=0)) / 2
    target = middle @ np.array([sight.right, sight.up, sight.back])
    camera = plotter.camera
    camera.focal_point = tuple(target)
    camera.position = tuple(target + (size if flat else away) * sight.back)
    camera.up = tuple(sight.up)
    if flat:
        plotter.enable_parallel_projection()
        camera.parallel_scale = half
    else:
        camera.view_angle = ANGLE
