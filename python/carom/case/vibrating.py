"""Which bodies have modes that their energy can be split over."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from carom.case.body import AnyBody, Body, ReducedBody, materials_of
from carom.case.material import Material
from carom.case.mesh import Rectangle
from carom.messages import problem

if TYPE_CHECKING:
    from carom.case.scenario import Scenario
MOST = 5
"""Bodies that a message names, at most."""


def without_modes(body: AnyBody, materials: Mapping[str, Material]) -> str:
    """Return why the energy of a body cannot be split over modes; nothing if it can."""
    if not isinstance(body, Body):
        return "" if isinstance(body, ReducedBody) else f"it is {body.kind}"
    if any(materials[name].kind == "j2-plasticity" for name in materials_of(body)):
        return "its material flows"
    if body.growth is not None:
        return "it grows"
    if body.initial_stress is not None:
        return "it is under an initial stress"
    if isinstance(body.mesh, Rectangle) and body.mesh.periodic:
        return "it is periodic"
    return ""


def check_modes(scenario: Scenario) -> None:
    """Refuse to split the energy of a case over modes that it does not have.

    Raises
    ------
    PydanticCustomError
        See `carom.messages.problem`.
    """
    if scenario.output.modes is None:
        return
    if scenario.stages:
        raise problem(
            "modes are of a case of one analysis, as stages may change what holds a body; leave it "
            "out",
            key="output.modes",
            value=scenario.output.modes,
        )
    reasons = {body.name: without_modes(body, scenario.materials) for body in scenario.bodies}
    if all(reasons.values()):
        told = ", ".join(f"{name}: {reason}" for name, reason in [*reasons.items()][:MOST])
        raise problem(
            f"no body has modes ({told or 'there is none'}); leave it out",
            key="output.modes",
            value=scenario.output.modes,
        )
