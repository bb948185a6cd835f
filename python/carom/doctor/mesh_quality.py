"""The meshes: slender and distorted cells."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from carom.doctor.finding import Finding
from carom.doctor.patient import Grid, Patient
from carom.mesh_file.cells import KINDS

POOR_JACOBIAN, BAD_JACOBIAN = 0.3, 0.1
"""Scaled Jacobians below which cells are poor, and bad."""

POOR_ASPECT, BAD_ASPECT = 20.0, 100.0
"""Ratios of longest to shortest edge above which cells are poor, and bad."""

VTK_KINDS = {
    **{9: "quad", 23: "quad8", 28: "quad9", 5: "triangle", 22: "triangle6"},
    **{12: "hexahedron", 25: "hexahedron20", 29: "hexahedron27", 10: "tetra", 24: "tetra10"},
    **{13: "wedge", 26: "wedge15"},
}
"""The kinds of cells by VTK's numbers, as `carom.mesh_file.cells.KINDS` names them."""

_IDEAL = {"triangle": np.sqrt(3.0) / 2.0, "tetra": np.sqrt(0.5), "wedge": np.sqrt(3.0) / 2.0}
"""Determinant of unit edges at a corner of the regular cell, where that is not 1."""


def mesh_quality(patient: Patient) -> Iterator[Finding]:
    """Look at the worst cell of every body."""
    for index, (body, grid) in enumerate(zip(patient.scenario.bodies, patient.grids, strict=True)):
        aspect, jacobian = quality(grid)
        worst = int(np.argmin(jacobian))
        fact = (
            f"the worst of {len(jacobian):,} cells of {body.name} has a scaled Jacobian of "
            f"{jacobian[worst]:.2g} (1 is best) and the slenderest edges in a ratio of "
            f"{aspect.max():.3g}"
        )
        key = f"bodies.{index}.mesh"
        poor = int(np.sum((jacobian < POOR_JACOBIAN) | (aspect > POOR_ASPECT)))
        if not poor:
            yield Finding("ok", key, fact)
            continue
        bad = jacobian[worst] < BAD_JACOBIAN or aspect.max() > BAD_ASPECT
        yield Finding(
            "warning" if bad else "advice",
            key,
            f"{fact}; {poor:,} are poor",
            "mesh that part again: stresses there are wrong, and the shortest edge rules the step",
        )


def quality(grid: Grid) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return the ratio of the longest to the shortest edge and the scaled Jacobian of each cell.

    The scaled Jacobian is the least determinant of the unit vectors along the edges at a corner,
    over that of the regular cell. Edges of second order count by their ends.
    """
    aspects, jacobians = [], []
    for vtk, cells in grid.cells.items():
        name = VTK_KINDS[vtk].rstrip("0123456789")
        corners = KINDS[name].edges
        x = grid.points[cells]  # [cells, nodes, D]
        lengths, determinants = [], []
        for corner, neighbours in enumerate(corners if name != "tetra" else _TETRAHEDRON):
            edges = np.stack([x[:, n] - x[:, corner] for n in neighbours], axis=1)
            length = np.linalg.norm(edges, axis=2)
            lengths.append(length)
            determinants.append(np.linalg.det(edges / length[..., None]))
        length = np.concatenate(lengths, axis=1)
        aspects.append(length.max(axis=1) / length.min(axis=1))
        jacobians.append(np.min(determinants, axis=0) / _IDEAL.get(name, 1.0))
    return np.concatenate(aspects), np.concatenate(jacobians)


_TETRAHEDRON = ((1, 2, 3), (2, 0, 3), (0, 1, 3), (0, 2, 1))
"""Neighbours of every corner; that of one is all that a volume needs."""
