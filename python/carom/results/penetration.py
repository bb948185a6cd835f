"""What was too deep in what else, and what of its case can be done about it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from carom.case.cohesion import holds
from carom.case.motion import Fixed, Guided
from carom.messages import listed

if TYPE_CHECKING:
    from carom.case.full_stage import FullStage, Given
    from carom.case.scenario import Scenario


def too_deep(summary: Mapping[str, Any]) -> Mapping[str, Any] | None:
    """Return where something was deeper in something else than it may be; none in old results."""
    worst: Mapping[str, Any] | None = summary.get("penetration", {}).get("worst")
    return None if worst is None or worst["depth"] <= worst["allowed"] else worst


def depth_of(worst: Mapping[str, Any], scenario: Scenario) -> str:
    """Return who was how deep in whom, and what to do."""
    first, second = worst["between"]
    who = f"{first} was" if first == second else f"{first} and {second} were"
    whom = "itself" if first == second else "one another"
    stage = next(s for s in reversed(scenario.full_stages()) if s.start_time <= worst["time"])
    fact = (
        f"{who} up to {worst['depth']:.2g} m inside {whom} at t = {worst['time']:.3g} s, more than "
        f"the {worst['allowed']:.2g} m of contact.penetration_tolerance{_crushed(worst)}"
    )
    sides = [_Side(name, scenario, stage) for name in dict.fromkeys(worst["between"])]
    driven = [key for side in sides for key in side.moves]
    if driven and len(sides) == 2 and all(side.is_driven for side in sides):
        return (
            f"{fact}: {listed(driven)} {'drives' if len(driven) == 1 else 'drive'} them into one "
            "another, and no contact moves what is prescribed; change that, or disable the pair in "
            "contact.pairs"
        )
    step = f"take a smaller {stage.key}analysis.time_step"
    remedies = ["mesh more finely", step, *_remedies(sides, scenario)]
    return f"{fact}: {', '.join(remedies[:-1])}, or {remedies[-1]}"


def _crushed(worst: Mapping[str, Any]) -> str:
    """Return what of the two was crushed as they went in; nothing in old results."""
    crushed = worst.get("crushed")
    if crushed is None:
        return ""
    cells = f"{crushed['cells']} cell{'s' if crushed['cells'] > 1 else ''}"
    return (
        f", with {cells} of {crushed['body']} crushed to less than half, the worst to "
        f"{crushed['least']:.2f} of what it was"
    )


class _Side:
    """One of two that were in one another."""

    def __init__(self, name: str, scenario: Scenario, stage: FullStage) -> None:
        self.index = next((k for k, b in enumerate(scenario.bodies) if b.name == name), None)
        self.moves: list[str] = []
        """Keys of what is prescribed and moves."""
        self.is_driven = self.is_body = self.index is not None
        """Whether all of it moves as prescribed."""
        if self.index is None:
            self.is_driven = True
            for number, obstacle in enumerate(scenario.obstacles):
                if obstacle.name == name:
                    given = (("velocity", obstacle.velocity), ("motion", obstacle.motion))
                    keys = [key for key, value in given if value is not None]
                    self.moves = [f"obstacles.{number}.{key}" for key in keys]
            return
        self.body = scenario.bodies[self.index]
        motions = [given for given in stage.motions if given.what.body == name]
        self.moves = [given.key for given in motions if not isinstance(given.what, Fixed)]
        self.held = [given.key for given in motions]
        self.is_driven = any(_holds_all(given, scenario.dimension) for given in motions)


def _holds_all(given: Given, dimension: int) -> bool:
    """Return whether a motion leaves nothing of its body free to give way."""
    motion, axes = given.what, "xyz"[:dimension]
    if not isinstance(motion, Guided) and motion.on != "all":
        return False
    if isinstance(motion, Fixed):
        return motion.components is None or set(axes) <= set(motion.components)
    return all(getattr(motion, axis, None) is not None for axis in axes)


def _remedies(sides: list[_Side], scenario: Scenario) -> Iterator[str]:
    """Yield what else may help these two, or this one, than finer meshes and steps."""
    bodies = [side for side in sides if side.is_body]
    for side in bodies:
        if side.body.contact_sets is not None:
            yield (
                f"name all sides that meet in bodies.{side.index}.contact_sets, which leaves "
                "others out"
            )
    if len(sides) == 1:
        body, index = sides[0].body, sides[0].index
        if body.kind != "deformable":
            yield f'leave bodies.{index}.kind out: a body of kind "{body.kind}" cannot touch itself'
        elif body.self_contact is False:
            yield f"let it touch itself, which bodies.{index}.self_contact = false forbids"
        return
    held = [side.held for side in bodies if side.held and not side.is_driven]
    if held and all(side.is_driven or side.held for side in sides):
        keys = [key for keys in held for key in keys]
        yield f"leave free in {listed(keys)} the nodes that meet something"
    if len(bodies) == 2 and (key := _one_sided(scenario, [side.body.name for side in bodies])):
        yield f'check both sides, {key} = "both"'


def _one_sided(scenario: Scenario, names: list[str]) -> str | None:
    """Return the key by which one side of a pair of bodies alone is checked, if both could be."""
    contact = scenario.contact
    sources, key = contact.sources, "contact.sources"
    discretisation, cohesion = contact.discretisation, contact.cohesion
    for number, pair in enumerate(contact.pairs):
        if set(pair.between) == set(names):
            if pair.sources is not None:
                sources, key = pair.sources, f"contact.pairs.{number}.sources"
            discretisation = pair.discretisation or discretisation
            cohesion = cohesion if pair.cohesion is None else pair.cohesion
    # Mortar pairs and those that hold together are checked from one side for good.
    if sources in (None, "both") or discretisation == "mortar" or holds(cohesion):
        return None
    return key
