"""A case as the checks look at it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom._carom import Simulation
from carom.building.simplices import Boundary, boundaries
from carom.case.full_stage import FullStage
from carom.case.scenario import Scenario


@dataclass(frozen=True)
class Grid:
    """The cells of a body.

    Parameters
    ----------
    points
        Reference positions of its nodes [m], shape [node_count, D].
    cells
        By VTK's cell type, the nodes of its cells, shape [cell_count, nodes per cell].
    """

    points: NDArray[np.float64]
    cells: dict[int, NDArray[np.int64]]


@dataclass(frozen=True)
class Patient:
    """A case that can be built.

    Parameters
    ----------
    scenario
        The case.
    simulation
        What was built of it, at its start.
    """

    scenario: Scenario
    simulation: Simulation

    @cached_property
    def description(self) -> dict[str, Any]:
        """What the native core says of the model."""
        return self.simulation.describe()

    @cached_property
    def stages(self) -> tuple[FullStage, ...]:
        """The analyses of the case, one as a rule."""
        return self.scenario.full_stages()

    @cached_property
    def grids(self) -> list[Grid]:
        """The cells of every body."""
        mesh = self.simulation.mesh()
        ends = np.cumsum([body["nodes"] for body in self.description["bodies"]])
        cells = np.split(mesh["connectivity"], mesh["offsets"][1:-1])
        grids = []
        for index, end in enumerate(ends):
            first = end - self.description["bodies"][index]["nodes"]
            mine = np.flatnonzero(mesh["body"] == index)
            kinds = {
                int(kind): np.array([cells[c] for c in mine if mesh["types"][c] == kind]) - first
                for kind in np.unique(mesh["types"][mine])
            }
            grids.append(Grid(mesh["points"][first:end], kinds))
        return grids

    @cached_property
    def boundaries(self) -> list[Boundary]:
        """The boundary of every body, or what of it may touch."""
        points, bodies = self.simulation.mesh()["points"], len(self.scenario.bodies)
        found = boundaries(self.simulation.surface(), points, bodies)
        return [boundary for boundary, _ in found]

    def contact_duration(self, index: int) -> float:
        """Return about how long a body's impact takes [s]: a wave through it, there and back."""
        body = self.description["bodies"][index]
        return float(2.0 * body["diameter"] / body["wave_speed"])
