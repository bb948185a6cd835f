"""Where meshes that carom generates are, how large they are, and the same ones elsewhere."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from carom.case.mesh import (
    Ball,
    Box,
    Cylinder,
    Disc,
    Mesh,
    MeshFile,
    Rectangle,
    Ring,
    Tube,
)

Place = tuple[float, ...]


def centre(mesh: Mesh, dimension: int) -> Place:
    """Return the middle of a mesh [m]; of one from a file the origin of that, where it is moved."""
    match mesh:
        case Disc() | Ring() | Ball():
            return mesh.centre
        case Rectangle() | Box():
            return _sum(mesh.corner, mesh.size, 0.5)
        case Cylinder() | Tube():
            half = 0.5 * mesh.height / math.hypot(*mesh.axis)
            return _sum(mesh.base, mesh.axis, half)
        case MeshFile():
            return mesh.move or (0.0,) * dimension


def reach(mesh: Mesh) -> float | None:
    """Return how far a mesh reaches from its centre [m]; None of a file, which is not read here."""
    match mesh:
        case Disc() | Ball():
            return mesh.radius
        case Ring():
            return mesh.outer_radius
        case Rectangle() | Box():
            return 0.5 * math.hypot(*mesh.size)
        case Cylinder():
            return math.hypot(mesh.radius, 0.5 * mesh.height)
        case Tube():
            return math.hypot(mesh.outer_radius, 0.5 * mesh.height)
        case MeshFile():
            return None


def placed(mesh: Mesh, at: Place, scale: float = 1.0) -> Mesh:
    """Return the same mesh, so many times as large, with its centre elsewhere [m]."""
    here = centre(mesh, len(at))
    new: dict[str, Any]
    match mesh:
        case Disc() | Ball():
            new = {"centre": at, "radius": scale * mesh.radius}
        case Ring():
            inner, outer = scale * mesh.inner_radius, scale * mesh.outer_radius
            new = {"centre": at, "inner_radius": inner, "outer_radius": outer}
        case Rectangle() | Box():
            size = tuple(scale * side for side in mesh.size)
            new = {"corner": _sum(at, size, -0.5), "size": size}
        case Cylinder() | Tube():
            arm = _sum(mesh.base, here, -1.0)
            new = {"base": _sum(at, arm, scale), "height": scale * mesh.height}
            if isinstance(mesh, Cylinder):
                new["radius"] = scale * mesh.radius
            else:
                new["inner_radius"] = scale * mesh.inner_radius
                new["outer_radius"] = scale * mesh.outer_radius
        case MeshFile():
            new = {"move": at, "scale": scale * mesh.scale}
    return mesh.model_copy(update=new)


def _sum(a: Sequence[float], b: Sequence[float], weight: float) -> Place:
    return tuple(x + weight * y for x, y in zip(a, b, strict=True))
