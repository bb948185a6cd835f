"""Make the thumbnails of the gallery: ``python docs/images/make_gallery_thumbnails.py [NAME …]``.

Runs the scripts, each as the site does, draws one instant of the result of each (bodies and colour,
and nothing else) and says how long it took. A script of more than a minute is refused.
"""

from __future__ import annotations

import runpy
import sys
import time
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Polygon, Rectangle
from scipy.spatial import ConvexHull

import carom

HERE = Path(__file__).resolve().parent
SCRIPTS = HERE.parent / "gallery"
sys.path[:0] = [str(SCRIPTS), str(HERE.parents[1] / "examples")]

LONGEST = 60.0
"""Processor time that a case may take [s]: machines are shared, and their clocks count that too."""

LOOKS: dict[str, dict[str, Any]] = {
    "01_bars": {"times": 0.02, "field": "velocity", "edges": False},
    "02_cylinders": {"times": 2.9, "field": "von-mises"},
    "03_oblique_layer": {"field": "von-mises"},
    "04_hertz": {},
    "05_incline": {"strobe": (0.0, 0.3, 0.45, 0.6), "turn": 25.0},
    "06_billiard": {"times": 0.02, "field": "velocity"},
    "07_ring": {"times": 0.8, "field": "von-mises"},
    "08_bracket": {},
    "09_fclib": {},
    "10_post": {"times": 1.0, "field": "von-mises"},
    "11_stack": {"times": 0.2, "field": "von-mises"},
    "12_bullet": {"times": 6e-3, "field": "von-mises"},
    "13_corners": {"field": "von-mises"},
    "14_wedge": {"field": "von-mises"},
    "15_thrown_ring": {},
    "16_arch": {},
    "17_pile": {},
    "18_press_fit": {},
    "19_seal": {"field": "von-mises"},
    "20_cradle": {"times": 0.04, "field": "velocity"},
    "21_racket": {"times": 1.2, "field": "body"},
    "22_dominoes": {"times": 0.3, "field": "body"},
    "23_stick_slip": {"times": 0.5, "field": "body", "edges": False},
    "24_two_drop": {"strobe": (0.0, 0.012, 0.03, 0.045)},
    "25_taylor": {},
    "26_scikit_fem": {},
    "27_backspin": {"strobe": tuple(0.03 * k for k in range(30))},
    "28_bowling": {"strobe": tuple(0.15 * k for k in range(4))},
    "29_wall": {"times": 0.25, "field": "body"},
    "30_marimba": {"times": 4e-4, "field": "von-mises", "magnification": 100.0, "edges": False},
}
"""How the result of each script is drawn; those with nothing have a picture of the README."""


PALE = ("#8FB8DE", "#F2B98A", "#A9D3B8")
"""Colours of bodies that have nothing else to show."""


def file_of(name: str) -> Path:
    """Return the file of a thumbnail, which the script names in a comment."""
    return HERE / "gallery" / f"{name.partition('_')[2].replace('_', '-')}.png"


def blocks(left: dict[str, Any]) -> Figure:
    """Draw the wall of which the page about FCLIB has the contacts alone."""
    figure = Figure(figsize=(4.8, 3.6))
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    width, height = left["WIDTH"], left["HEIGHT"]
    for row, x in left["blocks"]:
        colour = ("#8FB8DE", "#F2B98A", "#A9D3B8")[(row + round(2.0 * x / width)) % 3]
        corner = (x - 0.5 * width, row * height)
        axes.add_patch(Rectangle(corner, width, height, facecolor=colour, edgecolor="#1B2230"))
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.autoscale()
    return figure


def strobe(result: carom.Result, times: Sequence[float], turn: float = 0.0) -> Figure:
    """Draw bodies at several times upon one another, as by a flash that goes on and off.

    Parameters
    ----------
    result
        What is drawn, seen along y where it is in space.
    times
        When [s], the palest first.
    turn
        By how much the picture is turned, clockwise [degrees].
    """
    figure = Figure(figsize=(4.8, 3.6))
    FigureCanvasAgg(figure)
    axes = figure.add_axes((0.03, 0.03, 0.94, 0.94))
    fields, up = result.fields, result.scenario.dimension - 1
    angle = np.radians(-turn)
    turned = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    lowest = np.inf
    for order, when in enumerate(times):
        frame = int(np.argmin(np.abs(fields.times - when)))
        for number, body in enumerate(result.scenario.bodies):
            own = fields.body(body.name)
            places = (own.points + own["displacement"][frame])[:, [0, up]]
            hull = places[ConvexHull(places).vertices]
            lowest = min(lowest, hull[:, 1].min())
            axes.add_patch(
                Polygon(
                    hull @ turned.T,
                    facecolor=PALE[number % len(PALE)],
                    edgecolor="#1B2230",
                    alpha=0.25 + 0.75 * (order + 1) / len(times),
                )
            )
            if getattr(body, "round", False):  # a line by which one sees it turn
                spoke = np.array([hull.mean(axis=0), places[len(places) - 1]]) @ turned.T
                axes.plot(*spoke.T, color="#1B2230", linewidth=0.8)
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.autoscale()
    left, right = axes.get_xlim()
    ground = np.array([[left - right, lowest], [2.0 * right - left, lowest]]) @ turned.T
    limits = axes.get_xlim(), axes.get_ylim()
    axes.plot(*ground.T, color="#8A94A6", linewidth=2.0, zorder=0)
    axes.set(xlim=limits[0], ylim=limits[1])
    return figure


def main(names: list[str]) -> int:
    """Make the thumbnails of these names, or all."""
    mpl.use("agg")
    from make_thumbnails import thumbnail  # noqa: PLC0415 (of images/)

    warnings.simplefilter("ignore")
    (HERE / "gallery").mkdir(exist_ok=True)
    slow = False
    for name in names or LOOKS:
        begun, wall = time.process_time(), time.perf_counter()
        left = runpy.run_path(str(SCRIPTS / f"plot_{name}.py"))
        took, wall = time.process_time() - begun, time.perf_counter() - wall
        slow |= took > LONGEST
        print(f"{name}: {took:.1f} s of processor time, {wall:.1f} s", flush=True)
        if name == "09_fclib":
            thumbnail(blocks(left), file_of(name))
        elif "strobe" in LOOKS[name]:
            look = LOOKS[name]
            drawn = strobe(left["result"], look["strobe"], look.get("turn", 0.0))
            thumbnail(drawn, file_of(name))
        elif LOOKS[name]:
            drawn = carom.picture(left["result"], bare=True, width=120.0, **LOOKS[name])
            thumbnail(drawn, file_of(name))
    return int(slow)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
