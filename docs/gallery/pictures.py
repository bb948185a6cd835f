"""Pictures of bodies for the gallery: in the plane by Matplotlib, in space by ``carom view``."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PolyCollection
from matplotlib.colors import Normalize
from matplotlib.patches import Rectangle
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

import carom
from carom.io.frames import Frames
from carom.view import View, screenshot, shown


def draw(
    result: carom.Result,
    times: Sequence[float],
    *,
    field: str,
    magnification: float = 1.0,
) -> None:
    """Draw the bodies of a run at some times [s], side by side, in the colours of a field."""
    frames = Frames(result.fields_path)
    view = View(frames, shown(frames, field), result.scenario, magnification=magnification)
    size = (4.0 * len(times), 4.0 if result.scenario.dimension == 2 else 3.4)
    figure, places = plt.subplots(1, len(times), squeeze=False, figsize=size, layout="constrained")
    for axes, time in zip(places[0], times, strict=True):
        frame = frames.nearest(time)
        axes.set_title(f"t = {frames.times[frame]:.4g} s")
        if result.scenario.dimension == 2:
            cells: ScalarMappable = _draw_plane(axes, view, frame)
        else:
            axes.imshow(_picture(view, frame))
            axes.set_axis_off()
            values = view.shown.values(frames, frame)
            cells = ScalarMappable(Normalize(values.min(), values.max()), "viridis")
        figure.colorbar(
            cells,
            ax=axes,
            label=view.shown.title,
            location="bottom",
            shrink=0.8,
            ticks=MaxNLocator(4),
        )


def _draw_plane(axes: Axes, view: View, frame: int) -> PolyCollection:
    """Draw the cells, and the planes and boxes that stay where they are."""
    frames = view.frames
    cells = np.split(frames.connectivity, frames.offsets[1:-1])
    values = view.shown.values(frames, frame)
    if view.shown.on_points:
        values = np.array([values[cell].mean() for cell in cells])
    where = view.positions(frame)[:, :2]
    drawn = PolyCollection(
        [where[cell] for cell in cells], array=values, edgecolors="#00000040", linewidths=0.2
    )
    axes.add_collection(drawn)
    axes.set_aspect("equal")
    axes.autoscale_view()
    for obstacle in view.scenario.obstacles:
        if isinstance(obstacle, carom.Plane) and obstacle.motion is None:
            x, y = obstacle.point
            along = (x - obstacle.normal[1], y + obstacle.normal[0])
            axes.axline((x, y), along, color="0.6", linewidth=1.0)
        elif isinstance(obstacle, carom.RigidBox) and obstacle.motion is None:
            (x, y), (width, height) = obstacle.corner, obstacle.size
            axes.add_patch(Rectangle((x, y), width, height, color="0.8"))
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    return drawn


def _picture(view: View, frame: int) -> NDArray[np.float32]:
    """Return what ``carom view`` draws, without its texts and axes, and cut to what is drawn."""
    with TemporaryDirectory() as folder:
        file = Path(folder) / "frame.png"
        screenshot(view, frame, file)
        picture: NDArray[np.float32] = plt.imread(file)[..., :3].copy()
    height, width = picture.shape[:2]
    picture[: height // 12, : width // 3] = picture[0, -1]
    picture[-height // 5 :, : width // 6] = picture[0, -1]
    picture[-height // 7 :] = picture[0, -1]  # its colour bar
    drawn = (picture != picture[0, -1]).any(axis=-1)
    rows, columns = np.flatnonzero(drawn.any(axis=1)), np.flatnonzero(drawn.any(axis=0))
    return picture[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
