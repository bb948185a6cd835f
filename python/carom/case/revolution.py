"""Bodies of revolution and slices of the plane, which cannot touch one another."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product
from typing import TYPE_CHECKING

from carom.messages import problem

if TYPE_CHECKING:
    from carom.case.scenario import Scenario


def check_revolution(scenario: Scenario) -> None:
    """Refuse that a body of revolution may touch one that is none.

    Forces of the one are of a whole circumference, those of the other of a slice.

    Raises
    ------
    PydanticCustomError
        See `carom.messages.problem`.
    """
    for axial, plane in _may_touch(scenario):
        first, second = scenario.bodies[axial], scenario.bodies[plane]
        raise problem(
            f"{first.name} is a body of revolution and {second.name} a slice of the plane, and "
            "they may touch: a ring does not press on a slice; give both the hypothesis "
            '"axisymmetric" or neither, or disable their pair in contact.pairs',
            key=f"bodies.{plane}.hypothesis",
            value=second.hypothesis,
        )


def _may_touch(scenario: Scenario) -> Iterator[tuple[int, int]]:
    """Yield the indices of every body of revolution and slice of which a pair may touch."""
    axial = [k for k, b in enumerate(scenario.bodies) if b.hypothesis == "axisymmetric"]
    plane = [k for k, b in enumerate(scenario.bodies) if b.hypothesis != "axisymmetric"]
    disabled = {frozenset(pair.between) for pair in scenario.contact.pairs if not pair.enabled}
    for one, other in product(axial, plane):
        names = frozenset((scenario.bodies[one].name, scenario.bodies[other].name))
        if names not in disabled:
            yield one, other
