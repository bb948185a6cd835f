"""Meshes of quadrilaterals that every code gets, node by node the same."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Points = NDArray[np.float64]
Indices = NDArray[np.int64]

CORE = 0.5
"""Half the side of a disc's core, relative to the radius."""
BULGE = 0.15
"""How much the sides of the core bulge towards the circle, relative to half its side."""


@dataclass(frozen=True)
class Mesh:
    """Cells of four nodes, and the facets that may touch something.

    Parameters
    ----------
    points
        Coordinates [m], shape [point_count, 2].
    cells
        Nodes of the cells, counter-clockwise, shape [cell_count, 4].
    surface
        Nodes of the facets, the body on their left, shape [facet_count, 2].
    """

    points: Points
    cells: Indices
    surface: Indices


def bar(start: float, length: float, height: float, cells: int, *, touching: str) -> Mesh:
    """Return a bar along x, one cell high, that may touch with its ``left`` or ``right`` end."""
    x = np.repeat(start + np.linspace(0.0, length, cells + 1), 2)
    y = np.tile([-height / 2, height / 2], cells + 1)
    columns = 2 * np.arange(cells)[:, None] + np.array([0, 2, 3, 1])
    end = [[2 * cells, 2 * cells + 1]] if touching == "right" else [[1, 0]]
    return Mesh(np.column_stack([x, y]), columns, np.array(end))


def disc(centre: tuple[float, float], radius: float, divisions: int, rings: int) -> Mesh:
    """Return a disc: a core of `divisions` × `divisions` cells with `rings` of cells around it."""
    n = divisions
    t = np.linspace(-1.0, 1.0, n + 1)

    def bulge(w: NDArray[np.float64]) -> NDArray[np.float64]:
        return (1 + BULGE * (1 - w**2)) / (1 + BULGE)

    u, v = np.meshgrid(t, t)
    core = CORE * radius * np.stack([u * bulge(v), v * bulge(u)], axis=-1).reshape(-1, 2)
    number = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    corners = (number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1])
    core_cells = np.stack(corners, axis=-1).reshape(-1, 4)

    # The perimeter of the core, counter-clockwise from its lower right corner.
    sides = (number[:-1, -1], number[-1, :0:-1], number[:0:-1, 0], number[0, :-1])
    perimeter = np.concatenate(sides)
    angle = (np.arange(4 * n) / n - 0.5) * np.pi / 2
    circle = radius * np.column_stack([np.cos(angle), np.sin(angle)])
    weights = np.arange(1, rings + 1)[:, None, None] / rings
    outside = (1 - weights) * core[perimeter] + weights * circle
    loops = np.vstack([perimeter, len(core) + np.arange(rings * 4 * n).reshape(rings, 4 * n)])
    following = np.roll(loops, -1, axis=1)
    around = (loops[:-1], loops[1:], following[1:], following[:-1])
    ring_cells = np.stack(around, axis=-1).reshape(-1, 4)

    points = np.vstack([core, outside.reshape(-1, 2)]) + np.array(centre)
    surface = np.column_stack([loops[-1], following[-1]])
    return Mesh(points, np.vstack([core_cells, ring_cells]), surface)
