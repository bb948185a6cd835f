"""A sphere meshed ever finer towards the point where it touches, for the examples that need one.

Inversion maps a half space to a ball and keeps angles: a fine block of cells where the half space
is touched, with shells around it that grow, becomes half a ball that is graded likewise. The other
half is meshed with the same pattern, only coarser.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

FAR = 0.35  # size of the block around the upper pole, in the half space of that half


@dataclass(frozen=True)
class GradedSphere:
    """A sphere that stands on the origin with its lowest point; the last coordinate goes up.

    Parameters
    ----------
    points
        Nodes [m], shape [node_count, 2] for the half section of a body of revolution, x its
        radius, or [node_count, 3] for the quarter of the sphere with x ≥ 0 and y ≥ 0.
    cells
        Nodes of each quadrilateral or hexahedron.
    radius
        Radius [m].
    """

    points: Array
    cells: Indices
    radius: float

    @classmethod
    def make(
        cls,
        radius: float,
        *,
        patch: float,
        divisions: int,
        dimension: int,
        half: bool = False,
        growth: float = 1.0,
    ) -> GradedSphere:
        """Mesh a sphere, or its lower half.

        Parameters
        ----------
        radius
            Radius [m].
        patch
            Size of the fine block at the lowest point, along each axis [m].
        divisions
            Cells along a side of that block.
        dimension
            2 or 3.
        half
            Whether only the lower half is wanted.
        growth
            Thickness of the shells around the block, in terms of their cells' width.
        """
        lattice = Lattice(divisions, dimension, growth)
        # Distances double where the half space becomes a ball.
        points, cells = lattice.half(0.5 * patch / radius)
        points = _inverted(points)
        if not half:
            upper, upper_cells = lattice.half(FAR)
            upper = _inverted(upper)
            upper[:, -1] *= -1.0
            # The halves share the nodes of the plane between them, which both list last.
            own, shared = len(upper) - lattice.rim, len(points) - lattice.rim
            number = np.append(
                np.arange(len(points), len(points) + own), np.arange(shared, len(points))
            )
            points, cells = (
                np.vstack([points, upper[:own]]),
                np.vstack([cells, number[upper_cells]]),
            )
        points[np.abs(points) < 1e-14] = 0.0
        cells = _outside_out(points, cells)
        points[:, -1] += 1.0
        return cls(radius * points, cells, radius)

    def mirrored(self, axis: int = 0) -> GradedSphere:
        """Return this and its mirror image in the plane x = 0, or y = 0 where the axis is 1."""
        on_plane = self.points[:, axis] == 0.0
        image = np.arange(len(self.points))
        image[~on_plane] = len(self.points) + np.arange(int((~on_plane).sum()))
        turned = self.points[~on_plane]
        turned[:, axis] *= -1.0
        points = np.vstack([self.points, turned])
        cells = np.vstack([self.cells, image[self.cells][:, [0, 3, 2, 1, 4, 7, 6, 5]]])
        return GradedSphere(points, cells, self.radius)

    @property
    def dimension(self) -> int:
        """Dimension of space."""
        return int(self.points.shape[1])

    def sets(self) -> dict[str, Indices]:
        """Return nodes on the planes of symmetry ``x`` and ``y``, and ``equator``."""
        planes = {
            axis: self.points[:, k] == 0.0 for k, axis in enumerate("xy"[: self.dimension - 1])
        }
        planes["equator"] = np.abs(self.points[:, -1] - self.radius) < 1e-12 * self.radius
        return {name: np.flatnonzero(on) for name, on in planes.items()}

    def write(self, file: Path) -> Path:
        """Write an Abaqus input file with the sets."""
        lines = ["*NODE"]
        lines += [f"{n}, {', '.join(map(repr, x))}" for n, x in enumerate(self.points.tolist(), 1)]
        kind = "CAX4" if self.dimension == 2 else "C3D8"
        lines += [f"*ELEMENT, TYPE={kind}, ELSET=sphere"]
        lines += [
            f"{e}, {', '.join(map(str, c))}" for e, c in enumerate((self.cells + 1).tolist(), 1)
        ]
        for name, nodes in self.sets().items():
            lines += [f"*NSET, NSET={name}", *(str(n + 1) for n in nodes)]
        file.write_text("\n".join(lines) + "\n", encoding="utf-8")
        return file

    def pressures(self, forces: Array) -> tuple[Array, Array]:
        """Return distances from the axis [m] and pressures [Pa] of the nodes that carry forces."""
        areas = self._areas()
        touching = np.flatnonzero((forces[:, -1] > 0.0) & (areas > 0.0))
        distance = np.linalg.norm(self.points[touching, :-1], axis=1)
        return distance, forces[touching, -1] / areas[touching]

    def _areas(self) -> Array:
        """Share every node has in the area of the sphere [m²]."""
        arm = self.points - self.radius * np.eye(self.dimension)[-1]
        on = np.abs(np.linalg.norm(arm, axis=1) - self.radius) < 1e-9 * self.radius
        areas = np.zeros(len(self.points))
        sides = ["01", "12", "23", "30"]
        if self.dimension == 3:
            sides = ["0321", "4567", "0154", "1265", "2376", "3047"]
        for side in sides:
            nodes = self.cells[:, [int(k) for k in side]]
            nodes = nodes[on[nodes].all(axis=1)]
            x = self.points[nodes]
            if self.dimension == 2:
                length = np.linalg.norm(x[:, 1] - x[:, 0], axis=1)
                for k in (0, 1):
                    mean = (2.0 * x[:, k, 0] + x[:, 1 - k, 0]) / 3.0
                    np.add.at(areas, nodes[:, k], np.pi * length * mean)
            else:
                size = np.linalg.norm(np.cross(x[:, 2] - x[:, 0], x[:, 3] - x[:, 1]), axis=1)
                np.add.at(areas, nodes, np.repeat(size[:, None] / 8.0, 4, axis=1))
        return areas


def ellipsoid(distance: Array, pressure: Array) -> tuple[float, float]:
    """Return radius and height of Hertz's pressure p₀ √(1 − r²/a²) from p², linear in r²."""
    inside = pressure > 0.5 * pressure.max()
    slope, square = np.polyfit(distance[inside] ** 2, pressure[inside] ** 2, 1)
    return float(np.sqrt(-square / slope)), float(np.sqrt(square))


def _inverted(points: Array) -> Array:
    """Map a half space, the last coordinate its depth, to the unit ball; 0 to the lowest point."""
    arm = points + np.eye(points.shape[1])[-1]
    ball: Array = 2.0 * arm / (arm**2).sum(axis=1)[:, None] - np.eye(points.shape[1])[-1]
    ball[:, -1] *= -1.0
    return ball


def _outside_out(points: Array, cells: Indices) -> Indices:
    """Return the cells with those that are inside out listed the other way round."""
    plane = points.shape[1] == 2
    edges = points[cells[:, [1, 3] if plane else [1, 3, 4]]] - points[cells[:, [0]]]
    wrong = np.linalg.det(edges) < 0
    out: Indices = cells.copy()
    out[wrong] = cells[wrong][:, [0, 3, 2, 1] if plane else [0, 3, 2, 1, 4, 7, 6, 5]]
    return out


class Lattice:
    """A block of n^d cells and shells of cells around it, in the part without negative coordinates.

    Parameters
    ----------
    divisions
        Cells along a side of the block.
    dimension
        2 or 3.
    growth
        Thickness of the shells, in terms of the width of their cells.
    """

    def __init__(self, divisions: int, dimension: int, growth: float) -> None:
        self.n, self.d, self.growth = divisions, dimension, growth
        self.nodes = list(itertools.product(range(divisions + 1), repeat=dimension))
        self.outer = [i for i, node in enumerate(self.nodes) if max(node) == divisions]
        self.rim = len(self.outer)

    def half(self, block: float) -> tuple[Array, Indices]:
        """Return nodes and cells of a block of this size and the shells out to the unit sphere."""
        lattice = np.array(self.nodes, dtype=np.float64) / self.n
        box = lattice[self.outer]
        distance = block * np.linalg.norm(box, axis=1)[:, None]
        straight, even = box, np.tan(0.25 * np.pi * box)
        straight, even = (v / np.linalg.norm(v, axis=1)[:, None] for v in (straight, even))
        ratio = 1.0 + self.growth * 0.25 * np.pi / self.n
        shells = max(2, round(-np.log(block) / np.log(ratio)))
        layers = [block * lattice]
        for k in range(1, shells + 1):
            # Rays bend from those through the nodes of the block to evenly spread ones.
            way = k / shells
            ray = (1.0 - way) * straight + way * even
            ray /= np.linalg.norm(ray, axis=1)[:, None]
            layers.append(distance ** (1.0 - way) * ray)
        return np.vstack(layers), self._cells(shells)

    def _cells(self, shells: int) -> Indices:
        index = {node: i for i, node in enumerate(self.nodes)}
        place = {i: k for k, i in enumerate(self.outer)}
        square = [(0, 0), (1, 0), (1, 1), (0, 1)]
        plane = self.d == 2
        corners = square if plane else [(*c, z) for z in (0, 1) for c in square]
        cells = [
            [index[tuple(a + b for a, b in zip(low, corner, strict=True))] for corner in corners]
            for low in itertools.product(range(self.n), repeat=self.d)
        ]
        # Every facet of the block that faces outward begins a column of cells through the shells.
        facet = [(0,), (1,)] if plane else square
        for axis, low in itertools.product(
            range(self.d), itertools.product(range(self.n), repeat=self.d - 1)
        ):
            inner = []
            for corner in facet:
                node = [a + b for a, b in zip(low, corner, strict=True)]
                outward = (*node[:axis], self.n, *node[axis:])
                inner.append(index[outward])
            places = [place[i] for i in inner]
            for k in range(shells):
                outer = [len(self.nodes) + k * self.rim + p for p in places]
                cells.append(inner + (outer[::-1] if plane else outer))
                inner = outer
        return np.array(cells, dtype=np.int64)
