"""Energy and momentum of a motion, by one routine for all codes and by none of theirs."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from compare.meshes import Points
from compare.problems import Problem

_CORNERS = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])


class Energy:
    """Energies of quadrilaterals of four nodes in plane strain, 2 × 2 Gauss points.

    The mass is consistent, the material of Saint-Venant–Kirchhoff.

    Parameters
    ----------
    problem
        Mesh and material.
    """

    def __init__(self, problem: Problem) -> None:
        self._cells = problem.cells
        self._density = problem.density
        young, poisson = problem.young, problem.poisson
        self._first = young * poisson / ((1 + poisson) * (1 - 2 * poisson))
        self._second = young / (2 * (1 + poisson))
        corners = problem.points[self._cells]
        self._gauss = []
        for point in _CORNERS / np.sqrt(3):
            shape = np.prod(1 + _CORNERS * point, axis=1) / 4
            slope = _CORNERS * (1 + _CORNERS * point)[:, ::-1] / 4
            jacobian = np.einsum("cni,nk->cik", corners, slope)
            gradient = np.einsum("cki,nk->cni", np.linalg.inv(jacobian), slope)
            self._gauss.append((shape, gradient, np.linalg.det(jacobian)))
        self.mass = np.zeros(len(problem.points))
        """Mass of each node, of 1 m thickness [kg]."""
        for shape, _, area in self._gauss:
            np.add.at(self.mass, self._cells, self._density * area[:, None] * shape)

    def kinetic(self, velocities: Points) -> float:
        """Return the kinetic energy [J]."""
        return sum(
            0.5 * self._density * float(area @ ((shape @ velocities[self._cells]) ** 2).sum(axis=1))
            for shape, _, area in self._gauss
        )

    def strain(self, displacements: Points) -> float:
        """Return the strain energy ½ λ (tr E)² + μ E : E, summed over the bodies [J]."""
        total = 0.0
        for _, gradient, area in self._gauss:
            h = np.einsum("cni,cnk->cik", displacements[self._cells], gradient)
            strain = (h + h.transpose(0, 2, 1) + h.transpose(0, 2, 1) @ h) / 2
            trace = np.trace(strain, axis1=1, axis2=2)
            density = self._first / 2 * trace**2 + self._second * (strain**2).sum(axis=(1, 2))
            total += float(area @ density)
        return total


@dataclass(frozen=True)
class Motion:
    """What a run did.

    Parameters
    ----------
    times
        When it was looked at; the first is the start [s].
    energies
        Kinetic and strain energy [J].
    velocities
        Mean velocities of the bodies [m/s], shape [time_count, 2, 2].
    """

    times: list[float]
    energies: list[float]
    velocities: list[Any]

    @property
    def change(self) -> float:
        """Change of the energy over the run, relative to that at the start."""
        return self.energies[-1] / self.energies[0] - 1

    @property
    def excursion(self) -> float:
        """Largest change of the energy at any time, relative to that at the start."""
        return float(np.abs(np.array(self.energies) / self.energies[0] - 1).max())

    @property
    def touches(self) -> tuple[float, float]:
        """When the mean velocity of each body first changes [s]; NaN is never."""
        velocities = np.array(self.velocities)
        changes = np.linalg.norm(velocities - velocities[0], axis=2)
        changed = changes > 1e-3 * np.linalg.norm(velocities[0], axis=1).max()
        first, second = (
            self.times[int(column.argmax())] if column.any() else float("nan")
            for column in changed.T
        )
        return first, second

    @property
    def last_velocity(self) -> tuple[float, float]:
        """Mean velocity of the second body at the end [m/s]."""
        x, y = self.velocities[-1][1]
        return x, y

    def plain(self) -> dict[str, Any]:
        """Return the same as lists and numbers."""
        return asdict(self)


class Sampler:
    """Keeps what the displacements and velocities of a run say.

    Parameters
    ----------
    problem
        What is run.
    """

    def __init__(self, problem: Problem) -> None:
        self._problem = problem
        self._energy = Energy(problem)
        self.motion = Motion([], [], [])
        self.take(0.0, np.zeros_like(problem.points), problem.velocities)

    def take(
        self, time: float, displacements: NDArray[np.float64], velocities: NDArray[np.float64]
    ) -> None:
        """Look at the run at this time [s]; displacements [m] and velocities [m/s] of all nodes."""
        energy = self._energy.kinetic(velocities) + self._energy.strain(displacements)
        mass = self._energy.mass
        means = [mass[nodes] @ velocities[nodes] / mass[nodes].sum() for nodes in self._nodes]
        self.motion.times.append(time)
        self.motion.energies.append(energy)
        self.motion.velocities.append([mean.tolist() for mean in means])

    @property
    def _nodes(self) -> tuple[slice, slice]:
        return self._problem.of_body
