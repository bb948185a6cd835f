"""Whether solids intersect, as geometry libraries see it that know nothing of carom.

In the plane outlines are polygons of shapely, in space closed surfaces of manifold3d. What is not
flat is cut into pieces: a facet of four nodes into 32 triangles, one of six into 16.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import Any

import meshio
import numpy as np

import carom

try:
    from manifold3d import Manifold, Mesh64
    from shapely import Point, Polygon, box
except ImportError:
    Manifold = None

PIECES = 4
"""Into how many parts the sides of a facet are cut."""

FAR = 1e3
"""How large a half space is drawn [m]."""

ROUND = 64
"""Corners of a quarter of what is round, which are on it: its sides are a little inside."""


class Judge:
    """The solids of a scene."""

    def __init__(self, scenario: carom.Scenario, surface: Mapping[str, Any]) -> None:
        if Manifold is None:
            raise SystemExit("a library is not installed: pip install shapely manifold3d")
        self._space = scenario.dimension == 3
        self._facets = list(facets(surface))
        self._obstacles = [self._obstacle(obstacle) for obstacle in scenario.obstacles]
        self._moves = [obstacle.velocity for obstacle in scenario.obstacles]

    def depth(self, x: np.ndarray) -> float:
        """Return how thick the thickest intersection is [m]; infinite if a body crosses itself.

        In the plane that is twice its area over its length, in space twice its volume over its
        surface: the thickness of what is thin, and less than the depth of what is not.
        """
        bodies = [self._body(x, own) for own in self._facets]
        if any(body is None for body in bodies):
            return np.inf
        solids = [*bodies, *self._obstacles]
        pairs = ((a, b) for i, a in enumerate(bodies) for b in solids[i + 1 :])
        return max((self._thickness(a, b) for a, b in pairs), default=0.0)

    def blur(self, x: np.ndarray) -> float:
        """Return what it cannot see [m]."""
        return 2.0 * max(coarseness(x, own) for own in self._facets)

    def _body(self, x: np.ndarray, own: list[np.ndarray]) -> Any:
        if not self._space:
            polygon = Polygon(outline(x, own))
            return polygon if polygon.is_valid else None
        return solid(x, own)

    def _thickness(self, a: Any, b: Any) -> float:
        if self._space:
            parts = [part for part in (a ^ b).decompose() if part.volume() > 0.0]
            return max((2.0 * part.volume() / part.surface_area() for part in parts), default=0.0)
        common = a.intersection(b)
        parts = [part for part in getattr(common, "geoms", [common]) if part.area > 0.0]
        return max((2.0 * part.area / part.length for part in parts), default=0.0)

    def _obstacle(self, obstacle: Any) -> Any:
        if obstacle.kind == "box":
            low, size = np.array(obstacle.corner), np.array(obstacle.size)
            if self._space:
                return Manifold.cube(tuple(size)).translate(tuple(low))
            return box(*low, *(low + size))
        if obstacle.kind in {"sphere", "cylinder"}:
            return self._round(obstacle)
        if obstacle.kind == "polygon":
            return Polygon(obstacle.points)
        if obstacle.kind == "plane":
            return self._half_space(np.array(obstacle.point), np.array(obstacle.normal))
        mesh = meshio.read(obstacle.file)
        points, local = np.unique(mesh.points, axis=0, return_inverse=True)
        return manifold(points, local.reshape(-1)[mesh.cells_dict["triangle"]])

    def _round(self, obstacle: Any) -> Any:
        if not self._space:
            return Point(obstacle.centre).buffer(obstacle.radius, quad_segs=ROUND)
        if obstacle.kind == "sphere":
            return Manifold.sphere(obstacle.radius, 4 * ROUND).translate(tuple(obstacle.centre))
        bar = Manifold.cylinder(2 * FAR, obstacle.radius, circular_segments=4 * ROUND, center=True)
        axis = np.array(obstacle.axis) / np.linalg.norm(obstacle.axis)
        frame = np.stack([*np.linalg.svd(axis[None])[2][1:], axis])
        if np.linalg.det(frame) < 0:
            frame[0] *= -1
        return bar.transform(np.column_stack([frame.T, np.array(obstacle.point)]))

    def _half_space(self, point: np.ndarray, normal: np.ndarray) -> Any:
        normal = normal / np.linalg.norm(normal)
        if self._space:
            aside = np.linalg.svd(normal[None])[2][1:]
            frame = np.stack([*aside, normal])
            if np.linalg.det(frame) < 0:
                frame[0] *= -1
            cube = Manifold.cube((2 * FAR, 2 * FAR, FAR)).translate((-FAR, -FAR, -FAR))
            return cube.transform(np.column_stack([frame.T, point]))
        aside = np.array([-normal[1], normal[0]])
        ways = ((1, 0), (-1, 0), (-1, 1), (1, 1))
        return Polygon([point + FAR * (s * aside - d * normal) for s, d in ways])


def facets(surface: Mapping[str, Any]) -> Iterator[list[np.ndarray]]:
    """Yield the facets of every body, by their nodes."""
    ends = surface["offsets"]
    all_facets = [surface["connectivity"][a:b] for a, b in pairwise(ends)]
    for body in np.unique(surface["body"]):
        yield [f for f, b in zip(all_facets, surface["body"], strict=True) if b == body]


def outline(x: np.ndarray, segments: list[np.ndarray]) -> np.ndarray:
    """Return the outline of a body, [count, 2]; segments of three nodes are parabolas."""
    following = {int(segment[0]): segment for segment in segments}
    start = node = next(iter(following))
    points = []
    while not points or node != start:
        segment = following[node]
        node = int(segment[1])
        if len(segment) == 2:
            points.append(x[segment[:1]])
        else:
            t = np.linspace(0.0, 1.0, PIECES + 1)[:-1, None]
            a, b, middle = x[segment]
            points.append(
                (1 - t) * (1 - 2 * t) * a + t * (2 * t - 1) * b + 4 * t * (1 - t) * middle
            )
    return np.concatenate(points)


def solid(x: np.ndarray, own: list[np.ndarray]) -> Any:
    """Return the body within facets."""
    corners = [pieces(x[f]) for f in own]
    points = np.concatenate(corners).reshape(-1, 3)
    size = np.ptp(points, axis=0).max()
    _, first, local = np.unique(
        np.round(points / size, 12), axis=0, return_index=True, return_inverse=True
    )
    return manifold(points[first], local.reshape(-1, 3))


def pieces(corners: np.ndarray) -> np.ndarray:
    """Return the triangles of a facet of three, four or six nodes, [count, 3, 3]."""
    if len(corners) == 3:
        return corners[None]
    if len(corners) == 6:
        return bent(corners)
    p, s = corners, np.linspace(0.0, 1.0, PIECES + 1)
    a, b = s[:, None, None], s[None, :, None]
    grid = (1 - a) * (1 - b) * p[0] + a * (1 - b) * p[1] + a * b * p[2] + (1 - a) * b * p[3]
    low, right, far, up = grid[:-1, :-1], grid[1:, :-1], grid[1:, 1:], grid[:-1, 1:]
    triangles = np.stack([np.stack([low, right, far], 2), np.stack([low, far, up], 2)], 2)
    return triangles.reshape(-1, 3, 3)


def bent(p: np.ndarray) -> np.ndarray:
    """Return the triangles of a facet of six nodes, those of the sides last."""

    def at(i: int, j: int) -> np.ndarray:
        r, s = i / PIECES, j / PIECES
        t = 1 - r - s
        weights = (
            t * (2 * t - 1),
            r * (2 * r - 1),
            s * (2 * s - 1),
            4 * t * r,
            4 * r * s,
            4 * s * t,
        )
        return np.asarray(np.array(weights) @ p)

    steps = [(i, j) for i in range(PIECES) for j in range(PIECES - i)]
    up = [[at(i, j), at(i + 1, j), at(i, j + 1)] for i, j in steps]
    down = [[at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)] for i, j in steps if i + j < PIECES - 1]
    return np.array(up + down)


def coarseness(x: np.ndarray, own: list[np.ndarray]) -> float:
    """Return how far the pieces are from facets that are not flat, at most [m]."""
    warps = [np.linalg.norm(x[f[0]] - x[f[1]] + x[f[2]] - x[f[3]]) for f in own if len(f) == 4]
    for f in own:
        if len(f) == 6:
            sides = [(f[0], f[1], f[3]), (f[1], f[2], f[4]), (f[2], f[0], f[5])]
        else:
            sides = [tuple(f)] if x.shape[1] == 2 and len(f) == 3 else []
        warps += [np.linalg.norm(x[a] + x[b] - 2 * x[c]) for a, b, c in sides]
    return max(warps, default=0.0) / (4 * PIECES**2)


def manifold(vertices: np.ndarray, triangles: np.ndarray) -> Any:
    """Return a body of triangles, in double precision."""
    mesh = Mesh64(
        vert_properties=np.asarray(vertices, float), tri_verts=np.asarray(triangles, np.uint64)
    )
    return Manifold(mesh)
