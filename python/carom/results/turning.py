"""Bodies of a law that takes rotations for strains, and how far they have turned."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from carom.case.body import Body, materials_of
from carom.case.mesh import Rectangle
from carom.results.doubts import Doubt

if TYPE_CHECKING:
    from carom._carom import Simulation
    from carom.case.body import AnyBody
    from carom.case.scenario import Scenario

TURNED = 10.0
"""Angle from which a law of small strains sees a strain of 1 − cos 10° = 0.015 in it [degrees]."""

CODE = "linear-elastic-turned"
REMEDY = "take saint-venant-kirchhoff, the same law for small strains, which turns with the body"


def not_objective(body: AnyBody, scenario: Scenario) -> str | None:
    """Return the name of a material of a body that takes its rotation for strain, if it may turn.

    Bodies of revolution and periodic ones do not. Reduced ones are linear in a frame that turns
    with them.
    """
    if not isinstance(body, Body) or body.hypothesis == "axisymmetric":
        return None
    if isinstance(body.mesh, Rectangle) and body.mesh.periodic:
        return None
    names = (n for n in materials_of(body) if scenario.materials[n].kind == "linear-elastic")
    return next(names, None)


class Turning:
    """Watches from frame to frame how far bodies of a law of small strains have turned.

    Parameters
    ----------
    scenario
        What is run.
    simulation
        What was built of it.
    told
        What was doubted before.
    """

    def __init__(self, scenario: Scenario, simulation: Simulation, told: Sequence[Doubt]) -> None:
        known = {doubt.where for doubt in told if doubt.code == CODE}
        self._watched: dict[str, tuple[str, str, int]] = {}
        for index, body in enumerate(scenario.bodies):
            where, material = f"bodies.{index}.material", not_objective(body, scenario)
            if material is not None and where not in known:
                self._watched[where] = (body.name, material, index)
        if self._watched:
            self._points = simulation.mesh()["points"]
            counts = [body["nodes"] for body in simulation.describe()["bodies"]]
            self._ends = np.cumsum([0, *counts])

    def look(self, displacement: NDArray[np.float64], time: float) -> Iterator[Doubt]:
        """Yield a doubt of each body that has turned too far, once.

        Parameters
        ----------
        displacement
            That of all nodes [m], shape [node_count, D or 3].
        time
            When that is [s].
        """
        for where, (name, material, index) in list(self._watched.items()):
            nodes = slice(self._ends[index], self._ends[index + 1])
            points = self._points[nodes]
            angle = math.degrees(turned(points, displacement[nodes, : points.shape[1]]))
            if angle <= TURNED:
                continue
            del self._watched[where]
            strain = 1.0 - math.cos(math.radians(angle))
            yield Doubt(
                CODE,
                f"body {name} has turned by {angle:.2g}° at t = {time:.3g} s, which linear-elastic "
                f"of materials.{material} takes for a strain of {strain:.2g}: {REMEDY}",
                where,
                angle,
                TURNED,
            )


def turned(points: NDArray[np.float64], displacement: NDArray[np.float64]) -> float:
    """Return by which angle a body has turned [rad], by the rotation that fits its nodes best.

    That is the polar factor of Σ (x − x̄) ⊗ (X − X̄) (Kabsch, Acta Cryst. A32, 1976).

    Parameters
    ----------
    points, displacement
        Reference positions and displacements of its nodes [m], shape [n, D].
    """
    arms = points - points.mean(axis=0)
    now = points + displacement
    left, _, right = np.linalg.svd((now - now.mean(axis=0)).T @ arms)
    signs = np.ones(len(left))
    signs[-1] = np.sign(np.linalg.det(left @ right))
    rotation = (left * signs) @ right
    if len(rotation) == 2:
        return abs(math.atan2(rotation[1, 0], rotation[0, 0]))
    return math.acos(min(1.0, max(-1.0, 0.5 * (float(np.trace(rotation)) - 1.0))))
