"""What scenes are made of: their register, bodies, obstacles and shapes."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import meshio
import numpy as np

Case = dict[str, Any]
Map = Callable[[np.ndarray], np.ndarray]

SCENES: dict[str, Callable[[Path], Case]] = {}
"""All scenes by name; each is given a folder for its meshes."""

MATERIAL = {"kind": "neo-hookean", "young": 1e6, "poisson": 0.3, "density": 1000.0}
DAMPING = {"mass": 5.0, "stiffness": 1e-3}
SPEEDS = (10, 100, 1000)
"""Of bullets, in their sizes per second."""


def scene(make: Callable[[Path], Case]) -> Callable[[Path], Case]:
    """Enter a scene under its name."""
    SCENES[make.__name__.replace("_", " ")] = make
    return make


def case(
    bodies: list[Case],
    obstacles: list[Case],
    end: float = 1.0,
    step: float = 2e-3,
    *,
    friction: float = 0.3,
    damped: bool = True,
    gravity: bool = True,
) -> Case:
    """Return a case of these bodies."""
    parts = [body["mesh"] for body in bodies] + obstacles
    places = [[part[k] for k in ("corner", "point") if k in part] for part in parts]
    places += [part["points"] for part in parts if "points" in part]
    dimension = next(len(place[0]) for place in places if place)
    down = [0.0] * (dimension - 1) + [-9.81]
    return {
        "dimension": dimension,
        "analysis": {
            "kind": "dynamic",
            "end_time": end,
            "time_step": step,
            "gravity": down if gravity else None,
        },
        "materials": {"m": {**MATERIAL, **({"damping": DAMPING} if damped else {})}},
        "bodies": [{"name": f"body-{k}", "material": "m", **body} for k, body in enumerate(bodies)],
        "obstacles": obstacles,
        "contact": {"friction": friction},
    }


def block(corner: list[float], size: list[float], divisions: list[int], **more: Any) -> Case:
    """Return a box of cells, in the plane a rectangle."""
    kind = "rectangle" if len(corner) == 2 else "box"
    return {"mesh": {"kind": kind, "corner": corner, "size": size, "divisions": divisions}, **more}


def shaped(folder: Path, form: Map, divisions: list[int], **more: Any) -> Case:
    """Return a body whose cells are those of a unit square or cube, moved by `form`."""
    axes = [np.linspace(0.0, 1.0, n + 1) for n in divisions]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    number = np.arange(grid[..., 0].size).reshape(grid.shape[:-1])
    if len(divisions) == 2:
        corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
        kind = "quad"
    else:
        corners = [(*xy, z) for z in (0, 1) for xy in ((0, 0), (1, 0), (1, 1), (0, 1))]
        kind = "hexahedron"
    part = [
        number[tuple(slice(c, c + n) for c, n in zip(corner, divisions, strict=True))].ravel()
        for corner in corners
    ]
    points = form(grid.reshape(-1, len(divisions)))
    if len(divisions) == 2:
        points = np.pad(points, ((0, 0), (0, 1)))
    file = folder / f"mesh{len(list(folder.iterdir()))}.vtu"
    meshio.write_points_cells(file, points, [(kind, np.stack(part, axis=1))])
    return {"mesh": {"kind": "file", "file": str(file)}, **more}


def stl(folder: Path, vertices: list[list[float]], triangles: list[list[int]], name: str) -> Case:
    """Return an obstacle of triangles."""
    file = folder / f"{name}.stl"
    meshio.write_points_cells(file, np.array(vertices, float), [("triangle", np.array(triangles))])
    return {"name": name, "kind": "surface", "file": str(file)}


def floor(dimension: int, height: float = 0.0) -> Case:
    """Return a floor."""
    up = [0.0] * (dimension - 1)
    return {"name": "floor", "kind": "plane", "point": [*up, height], "normal": [*up, 1.0]}


def fixed(name: str, corner: list[float], size: list[float]) -> Case:
    """Return a box that does not move."""
    return {"name": name, "kind": "box", "corner": corner, "size": size}


def turned(centre: list[float], angle: float, size: list[float]) -> Map:
    """Return a map from the unit square to a rectangle about its centre."""
    c, s = np.cos(angle), np.sin(angle)
    return lambda x: ((x - 0.5) * size) @ np.array([[c, s], [-s, c]]) + centre


def on_corner(centre: list[float], size: float) -> Map:
    """Return a map from the unit cube to a cube that stands on a corner."""
    up = np.ones(3) / np.sqrt(3)
    aside = np.array([1.0, -1.0, 0.0]) / np.sqrt(2)
    axes = np.stack([aside, np.cross(up, aside), up])
    return lambda x: ((x - 0.5) * size) @ axes.T + centre
