"""A mesh in the format of Abaqus, which carom reads."""

from __future__ import annotations

from compare.meshes import Mesh


def abaqus_mesh(mesh: Mesh) -> str:
    """Return the nodes and the cells, numbered from 1."""
    lines = ["*NODE"]
    lines += [f"{number}, {x!r}, {y!r}" for number, (x, y) in enumerate(mesh.points.tolist(), 1)]
    lines.append("*ELEMENT, TYPE=CPE4")
    lines += [
        ", ".join(map(str, (number, *cell)))
        for number, cell in enumerate((mesh.cells + 1).tolist(), 1)
    ]
    return "\n".join(lines) + "\n"
