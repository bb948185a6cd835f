"""Meshes of quadrilaterals in rows and columns, as files: graded, or with sides that slope."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from runs import Array


def write(file: Path, x: Array, y: Array) -> Path:
    """Write an Abaqus input file of a grid; its sides are the sets left, right, bottom and top.

    Parameters
    ----------
    x, y
        Places of the nodes [m], row by row from below, shape [row_count, column_count].
    """
    number = np.arange(x.size).reshape(x.shape) + 1
    a, b = number[:-1, :-1].ravel(), number[:-1, 1:].ravel()
    c, d = number[1:, 1:].ravel(), number[1:, :-1].ravel()
    lines = ["*NODE"]
    nodes = zip(number.ravel().tolist(), x.ravel().tolist(), y.ravel().tolist(), strict=True)
    lines += [f"{n}, {x!r}, {y!r}" for n, x, y in nodes]
    lines += ["*ELEMENT, TYPE=CPE4, ELSET=body"]
    cells = np.stack([a, b, c, d], axis=-1).tolist()
    lines += [f"{e}, {', '.join(map(str, cell))}" for e, cell in enumerate(cells, 1)]
    element = np.arange(len(cells)).reshape(x.shape[0] - 1, x.shape[1] - 1) + 1
    # Sides of a CPE4 from its first node on: below, right, above, left.
    sides = {
        "bottom": (element[0], 1),
        "right": (element[:, -1], 2),
        "top": (element[-1], 3),
        "left": (element[:, 0], 4),
    }
    for name, (elements, side) in sides.items():
        lines += [f"*SURFACE, NAME={name}", *(f"{e}, S{side}" for e in elements.tolist())]
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return file


def away_from(first: float, growth: float, reach: float) -> Array:
    """Return distances [m] from 0 to `reach`: cells that begin with `first` [m] and grow."""
    count = int(np.ceil(np.log1p(reach * (growth - 1.0) / first) / np.log(growth)))
    places = np.append(0.0, np.cumsum(growth ** np.arange(count)))
    result: Array = places * (reach / places[-1])
    return result
