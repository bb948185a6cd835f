"""The input of CalculiX, and what it prints.

One layer of bricks with uz = 0 everywhere stands for plane strain. Faces 3 to 6 of a brick are the
edges of the quadrilateral that it stands on.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from compare.meshes import Indices, Points
from compare.problems import Problem

ALPHA = -0.05
"""Numerical damping of the scheme of Hilber, Hughes and Taylor; CalculiX' own value."""

STIFFNESS = {"bars": 5e4, "cylinders": 1.35e6}
"""Pressure per penetration of the contact [Pa/m]: so stiff that times of contact agree."""

THICKNESS = {"bars": 0.1, "cylinders": 0.2}
"""Of the layer [m], about the size of a cell."""


def deck(problem: Problem) -> str:
    """Return the input file, without friction."""
    return "\n".join(_lines(problem)) + "\n"


def _lines(problem: Problem) -> Iterator[str]:
    walls = wall_corners(problem)
    points = np.vstack([problem.points, *walls])
    own, total = len(problem.points), len(points)
    cells = problem.cells
    blocks = np.arange(own, total).reshape(-1, 4)
    thickness = THICKNESS[problem.name]

    yield "*NODE,NSET=NALL"
    for layer in (0, 1):
        for number, (x, y) in enumerate(points.tolist(), 1 + layer * total):
            yield f"{number},{x:.12g},{y:.12g},{layer * thickness:g}"
    yield "*ELEMENT,TYPE=C3D8,ELSET=EBODIES"
    yield from _bricks(cells, 1, total)
    if walls:
        yield "*ELEMENT,TYPE=C3D8,ELSET=EWALLS"
        yield from _bricks(blocks, 1 + len(cells), total)
    for name, nodes in zip(("NLEFT", "NRIGHT"), problem.of_body, strict=True):
        yield f"*NSET,NSET={name},GENERATE"
        for layer in (0, total):
            yield f"{layer + nodes.start + 1},{layer + nodes.stop}"
    yield from ("*NSET,NSET=NPRINTED,GENERATE", f"1,{own}", "*BOUNDARY", "NALL,3,3")
    if walls:
        yield "*NSET,NSET=NWALLS,GENERATE"
        yield from (f"{own + 1},{total}", f"{total + own + 1},{2 * total}")
        yield from ("*BOUNDARY", "NWALLS,1,2")
    yield from ("*MATERIAL,NAME=M", "*ELASTIC", f"{problem.young:g},{problem.poisson:g}")
    yield from ("*DENSITY", f"{problem.density:g}", "*SOLID SECTION,ELSET=EBODIES,MATERIAL=M")
    if walls:
        yield "*SOLID SECTION,ELSET=EWALLS,MATERIAL=M"

    for name, facets in zip(("SLEFT", "SRIGHT"), problem.surfaces, strict=True):
        yield f"*SURFACE,NAME={name},TYPE=ELEMENT"
        yield from _faces(cells, facets)
    for wall, face in enumerate(("S5", "S6", "S3", "S4")[: len(walls)]):
        yield f"*SURFACE,NAME=SWALL{wall},TYPE=ELEMENT"
        yield f"{len(cells) + 1 + wall},{face}"
    yield "*SURFACE INTERACTION,NAME=SI"
    yield from ("*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=LINEAR", f"{STIFFNESS[problem.name]:g}")
    pairs = [("SLEFT", "SRIGHT")]
    pairs += [(body, f"SWALL{k}") for body in ("SLEFT", "SRIGHT") for k in range(len(walls))]
    for source, target in pairs:
        yield "*CONTACT PAIR,INTERACTION=SI,TYPE=SURFACE TO SURFACE"
        yield f"{source},{target}"

    yield "*INITIAL CONDITIONS,TYPE=VELOCITY"
    for name, body in zip(("NLEFT", "NRIGHT"), problem.bodies, strict=True):
        yield from (f"{name},{axis},{value:g}" for axis, value in enumerate(body.velocity, 1))
    yield from ("*STEP,NLGEOM,INC=1000000", f"*DYNAMIC,DIRECT,ALPHA={ALPHA:g}")
    yield f"{problem.time_step:g},{problem.end_time:.10g}"
    yield f"*NODE PRINT,NSET=NPRINTED,FREQUENCY={problem.sample_every}"
    yield from ("U,V", "*END STEP")


def wall_corners(problem: Problem) -> list[Points]:
    """Return the corners of blocks, 1 m thick, around the box: floor, east, ceiling, west."""
    if problem.box is None:
        return []
    left, bottom, right, top = problem.box
    blocks = (
        (left - 1, bottom - 1, right + 1, bottom),
        (right, bottom - 1, right + 1, top + 1),
        (left - 1, top, right + 1, top + 1),
        (left - 1, bottom - 1, left, top + 1),
    )
    return [np.array([(a, b), (c, b), (c, d), (a, d)]) for a, b, c, d in blocks]


def _bricks(cells: Indices, first: int, layer: int) -> Iterator[str]:
    """Yield bricks on these cells, numbered from `first`; the upper nodes are `layer` further."""
    for number, cell in enumerate((cells + 1).tolist(), first):
        yield ",".join(map(str, (number, *cell, *(node + layer for node in cell))))


def _faces(cells: Indices, facets: Indices) -> Iterator[str]:
    """Yield the bricks and their faces over these facets."""
    edges = {
        (cell[edge], cell[(edge + 1) % 4]): f"{number},S{edge + 3}"
        for number, cell in enumerate(cells.tolist(), 1)
        for edge in range(4)
    }
    yield from (edges[start, end] for start, end in facets.tolist())


Field = NDArray[np.float64]


def printed(text: str, nodes: int) -> Iterator[tuple[float, Field, Field]]:
    """Yield time, displacements and velocities, shape [nodes, 2], from what CalculiX printed."""
    heading = re.compile(r"^ *(displacements|velocities) .* time +(\S+)\s*$")
    found: dict[float, dict[str, Field]] = {}
    field: Field | None = None
    for line in text.splitlines():
        if match := heading.match(line):
            field = np.zeros((nodes, 2))
            found.setdefault(float(match[2]), {})[match[1]] = field
        elif field is not None and (words := line.split()):
            field[int(words[0]) - 1] = float(words[1]), float(words[2])
    for time, fields in sorted(found.items()):
        if len(fields) == 2:
            yield time, fields["displacements"], fields["velocities"]
