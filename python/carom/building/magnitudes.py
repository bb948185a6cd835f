"""Quantities that no floating-point number holds, though every number of the case does."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from carom.case.body import RigidBody, materials_of
from carom.case.foreign_body import ForeignEntry
from carom.case.scenario import Scenario
from carom.errors import InputError

OF_BODIES = {
    "diameter": "size",
    "smallest_edge": "shortest edge",
    "volume": "volume",
    "mass": "mass",
    "wave_speed": "wave speed",
    "suggested_time_step": "time of a wave through its shortest edge",
}
"""Numbers of a body that must be finite and more than zero, and what they are called."""

OF_WAVES = ("wave_speed", "suggested_time_step")
"""Those that a rigid body has none of."""


def refuse_unbounded(scenario: Scenario, description: Mapping[str, Any]) -> None:
    """Refuse a case whose masses, waves or distances are infinite or vanish.

    Parameters
    ----------
    scenario
        The case.
    description
        What the native simulation says of it; a number that is not finite is None.

    Raises
    ------
    InputError
        A product or a quotient of its numbers is above 1.8e308, or too small to be more than zero.
    """
    for index, (body, built) in enumerate(zip(scenario.bodies, description["bodies"], strict=True)):
        for key, what in OF_BODIES.items():
            value = built[key]
            if isinstance(body, RigidBody | ForeignEntry):
                if key not in OF_WAVES and (value is None or not value > 0.0):
                    raise _vanishing(
                        index,
                        body.name,
                        what,
                        value,
                        "its mass" if isinstance(body, ForeignEntry) else "its density or mass",
                    )
                continue
            if value is None or not value > 0.0:
                made_of = " and ".join(
                    f"the constants and the density ({scenario.materials[name].density:g} kg/m³) "
                    f"of materials.{name}"
                    for name in dict.fromkeys(materials_of(body))
                )
                raise _vanishing(index, body.name, what, value, made_of)
    for pair in description["pairs"]:
        if pair["initial_gap"] is None or None in pair["at"]:
            one, other = pair["between"]
            raise InputError(
                f"contact: the distance of {one} and {other} is infinite for a computer; check "
                "where they are, and the sizes of both",
                "contact",
            )


def _vanishing(index: int, name: str, what: str, value: float | None, made_of: str) -> InputError:
    place, how = f"bodies.{index}", "zero" if value == 0.0 else "infinite"
    return InputError(
        f"{place}: the {what} of {name} is {how} for a computer; check {made_of}, and the size of "
        "the mesh",
        place,
    )
