"""Closed surfaces of triangles, such as STL files hold."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from carom.display.counting import count
from carom.mesh_file.arrays import Indices, Refused
from carom.mesh_file.formats import read_file


@dataclass(frozen=True)
class SurfaceArrays:
    """A closed surface.

    Parameters
    ----------
    points
        Vertices [m], shape [point_count, 3].
    triangles
        Vertices of each triangle, counter-clockwise as seen from outside, shape
        [triangle_count, 3].
    """

    points: NDArray[np.float64]
    triangles: Indices


def read_surface(file: str | Path, *, scale: float, key: str) -> SurfaceArrays:
    """Read the surface of a rigid obstacle.

    Parameters
    ----------
    file
        The file, as a rule STL.
    scale
        What coordinates are multiplied by to be in metres.
    key
        Where in the case file the surface is described, for messages.

    Raises
    ------
    MeshError
        The file cannot be read, or its triangles do not close.
    """
    try:
        mesh = read_file(Path(file), 3)
        triangles = [nodes for kind, nodes in mesh.blocks if kind == "triangle"]
        if not triangles:
            kinds = ", ".join(dict.fromkeys(kind for kind, _ in mesh.blocks)) or "nothing"
            raise Refused(f"has no triangles, but {kinds}; save the surface as triangles")
        return _closed(mesh.points * scale, np.concatenate(triangles))
    except Refused as refused:
        raise refused.at(key, str(file)) from None


def _closed(points: NDArray[np.float64], triangles: Indices) -> SurfaceArrays:
    used, triangles = np.unique(triangles, return_inverse=True)
    points, triangles = points[used], triangles.reshape(-1, 3)
    wrong = np.flatnonzero(~np.isfinite(points).all(axis=1))
    if len(wrong):
        vertices = count(len(wrong), "vertex", "vertices")
        raise Refused(f"has {vertices} with a coordinate that is not a finite number")
    # Formats such as STL repeat the vertices of each triangle.
    points, same = np.unique(points, axis=0, return_inverse=True)
    triangles = same.reshape(-1)[triangles]
    corners = np.sort(triangles, axis=1)
    triangles = triangles[(corners[:, 0] != corners[:, 1]) & (corners[:, 1] != corners[:, 2])]
    _refuse_open_edges(points, triangles)
    if np.einsum("ij,ij", *_volumes(points, triangles)) < 0.0:
        triangles = triangles[:, ::-1]
    return SurfaceArrays(points, np.ascontiguousarray(triangles, dtype=np.int64))


def _volumes(
    points: NDArray[np.float64], triangles: Indices
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return two vectors of each triangle whose product is six times its volume above the mean."""
    a, b, c = np.moveaxis((points - points.mean(axis=0))[triangles], 1, 0)
    return a, np.cross(b, c)


def _refuse_open_edges(points: NDArray[np.float64], triangles: Indices) -> None:
    """Refuse edges that do not belong to two triangles that run through them in opposite ways."""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    names, number = np.unique(np.sort(edges, axis=1), axis=0, return_inverse=True)
    number = number.reshape(-1)
    sharing = np.bincount(number)
    sense = np.bincount(number, weights=np.where(edges[:, 0] < edges[:, 1], 1.0, -1.0))
    for bad, what, remedy in (
        (sharing == 1, "on one triangle only", "it is not closed; fill its holes"),
        (sharing > 2, "on more than two triangles", "it is no manifold; keep the outside only"),
        (sense != 0.0, "through which two triangles run the same way", "turn one of them"),
    ):
        if np.any(bad):
            x = points[names[np.flatnonzero(bad)[0], 0]]
            place = ", ".join(f"{c:g}" for c in x)
            raise Refused(
                f"has {count(int(bad.sum()), 'edge')} {what} (the first at ({place}) m); {remedy}"
            )
