"""What is refused of the stages of a case, and of the state that it starts from."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING

from carom.case.full_stage import Given, full_stages
from carom.case.stage import GivenVelocity, RemovedLoad, RemovedMotion, Stage
from carom.messages import known, problem

if TYPE_CHECKING:
    from carom.case.scenario import Scenario

MOST_STEPS = 1e10
"""Steps of an analysis, at most; a computer takes them in years."""

SLACK = 1e-6
"""Part of a time step that is round-off of its end."""


def check_stages(scenario: Scenario) -> None:
    """Refuse stages that contradict the case or one another.

    Raises
    ------
    PydanticCustomError
        The first thing that is wrong, see `carom.messages.problem`.
    """
    if scenario.analysis is None and not scenario.stages:
        raise problem("required key is missing", key="analysis")
    if scenario.analysis is not None and scenario.stages:
        raise problem("every stage has its own analysis; leave this one out", key="analysis")
    _check_start(scenario)
    first_use: dict[str, str] = {}
    for index, stage in enumerate(scenario.stages):
        key = f"stages.{index}.name"
        if stage.name in first_use:
            raise problem(
                f"name already used by {first_use[stage.name]}", key=key, value=stage.name
            )
        first_use[stage.name] = key
    _check_clock(scenario)
    _check_conditions(scenario)
    before: tuple[Sequence[Given], Sequence[Given]] = _given_by_case(scenario)
    for index, (stage, full) in enumerate(
        zip(scenario.stages, full_stages(scenario), strict=False)
    ):
        key = f"stages.{index}"
        _check_removed(stage, before, key)
        _check_pairs(scenario, stage, f"{key}.contact.pairs")
        _check_velocities(scenario, stage, index)
        before = (full.loads, full.motions)


def _given_by_case(scenario: Scenario) -> tuple[Sequence[Given], Sequence[Given]]:
    return (
        [Given(load, "", 0.0) for load in scenario.loads],
        [Given(motion, "", 0.0) for motion in scenario.motions],
    )


def _check_start(scenario: Scenario) -> None:
    """Refuse velocities where they are not given at the start, or would be given twice."""
    analysis = scenario.analysis or scenario.stages[0].analysis
    goes_on = scenario.initial is not None and scenario.initial.result is not None
    for index, body in enumerate(scenario.bodies):
        for name in ("velocity", "spin"):
            value = getattr(body, name)
            if value is None:
                continue
            key = f"bodies.{index}.{name}"
            if goes_on:
                raise problem(
                    "the case goes on from a result, with the velocities of that; leave it out, or "
                    "give it in the velocities of a stage",
                    key=key,
                    value=value,
                )
            if scenario.stages and analysis.kind == "static":
                raise problem(
                    "the first stage is static and knows no velocities; give it in the velocities "
                    "of the stage in which the body sets out",
                    key=key,
                    value=value,
                )
    if goes_on and (scenario.contact.resolve_overlap or _resolving(scenario)):
        raise problem(
            "overlaps were taken up by the run that the case goes on from; leave it out",
            key="contact.resolve_overlap",
        )


def _resolving(scenario: Scenario) -> bool:
    return any(pair.resolve_overlap for pair in scenario.contact.pairs)


def _check_clock(scenario: Scenario) -> None:
    """Refuse analyses that end before their first step does, or never."""
    where = "the case starts" if scenario.initial is None else "the result ends"
    for full in full_stages(scenario):
        least = full.start_time + full.analysis.time_step
        if full.end_time < least - SLACK * full.analysis.time_step:
            raise problem(
                f"must be at least one time_step after {full.start_time:g} s, where {where}: it is "
                "on the clock of the case; "
                f"for a duration of {full.end_time:g} s give {full.start_time + full.end_time:g}",
                key=f"{full.key}analysis.end_time",
                value=full.end_time,
            )
        lasts = full.end_time - full.start_time
        if lasts / MOST_STEPS > full.analysis.time_step:
            raise problem(
                f"more than {MOST_STEPS:g} steps of that length go into {lasts:g} s; take a "
                "longer one, or an earlier end_time",
                key=f"{full.key}analysis.time_step",
                value=full.analysis.time_step,
            )
        where = f"stage {full.name!r} ends"


def _check_conditions(scenario: Scenario) -> None:
    """Refuse a condition that no stage has, and nodes without mass in some of them."""
    dynamic = [full for full in full_stages(scenario) if full.is_dynamic]
    condition = scenario.contact.condition
    if scenario.stages and not dynamic and condition not in ("massless", "gap"):
        raise problem(
            "is of dynamic stages, and there is none; static ones rule the gap at the end of the "
            "step; leave it out",
            key="contact.condition",
            value=condition,
        )
    for full in dynamic:
        conditions = {dynamic[0].contact.condition, full.contact.condition}
        if len(conditions) > 1 and "massless" in conditions:
            raise problem(
                "contact nodes have mass in some dynamic stages and none in others, so that the "
                'energy would jump between them; take "massless" in all of them or in none',
                key=f"{full.key}contact.condition",
                value=full.contact.condition,
            )


def _check_removed(stage: Stage, before: tuple[Sequence[Given], Sequence[Given]], key: str) -> None:
    """Refuse to remove what is not there, or what is replaced anyway."""
    loads, motions = ({one.place for one in given} for given in before)
    given = {Given(load, "", 0.0).place for load in stage.loads}
    for index, load in enumerate(stage.removed_loads):
        _check_one(
            load, (load.kind, load.body, load.on), loads, given, f"{key}.removed_loads.{index}"
        )
    given = {Given(motion, "", 0.0).place for motion in stage.motions}
    for index, motion in enumerate(stage.removed_motions):
        _check_one(
            motion, (motion.body, motion.on), motions, given, f"{key}.removed_motions.{index}"
        )


def _check_one(
    what: RemovedLoad | RemovedMotion,
    place: tuple[str, ...],
    there: Collection[tuple[str, ...]],
    given: Collection[tuple[str, ...]],
    key: str,
) -> None:
    noun = "load" if isinstance(what, RemovedLoad) else "motion"
    if place not in there:
        names = [" ".join(one) for one in sorted(there)]
        raise problem(
            f"there is no such {noun} to remove: {known(' '.join(place), names)}",
            key=key,
        )
    if place in given:
        raise problem(
            f"the {noun} that this stage gives there takes its place; leave one of the two out",
            key=key,
        )


def _check_pairs(scenario: Scenario, stage: Stage, key: str) -> None:
    """Refuse friction of pairs that are not there."""
    pairs = () if stage.contact is None else stage.contact.pairs
    bodies = [body.name for body in scenario.bodies]
    obstacles = [obstacle.name for obstacle in scenario.obstacles]
    disabled = {frozenset(pair.between) for pair in scenario.contact.pairs if not pair.enabled}
    seen: set[frozenset[str]] = set()
    for index, pair in enumerate(pairs):
        place, two = f"{key}.{index}.between", frozenset(pair.between)
        for name in pair.between:
            if name not in (*bodies, *obstacles):
                names = known(name, [*bodies, *obstacles])
                raise problem(f"no such body or obstacle; {names}", key=place, value=name)
        if two.issubset(obstacles):
            what = "two obstacles never touch; name a body"
        elif two in disabled:
            what = "the pair is disabled in contact.pairs; leave it out"
        elif len(two) == 1 and _touches_not_itself(scenario, pair.between[0]):
            what = "the body has self_contact = false; name two"
        elif two in seen:
            what = "the pair is given already in this stage"
        else:
            seen.add(two)
            continue
        raise problem(what, key=place, value=pair.between)


def _touches_not_itself(scenario: Scenario, name: str) -> bool:
    return any(
        body.name == name and (body.kind != "deformable" or body.self_contact is False)
        for body in scenario.bodies
    )


def _check_velocities(scenario: Scenario, stage: Stage, index: int) -> None:
    """Refuse velocities of bodies that are not there, or have theirs elsewhere."""
    bodies = [body.name for body in scenario.bodies]
    goes_on = index > 0 or (scenario.initial is not None and scenario.initial.result is not None)
    seen: set[str] = set()
    for number, given in enumerate(stage.velocities):
        key = f"stages.{index}.velocities.{number}"
        if given.body not in bodies:
            raise problem(
                f"no such body; {known(given.body, bodies)}", key=f"{key}.body", value=given.body
            )
        if given.body in seen:
            raise problem(
                "the body has a velocity already in this stage", key=f"{key}.body", value=given.body
            )
        if not goes_on:
            raise problem(
                f"what moves when the case starts is given in bodies.{bodies.index(given.body)}",
                key=key,
            )
        seen.add(given.body)
        _check_spin(scenario, given, key)


def _check_spin(scenario: Scenario, given: GivenVelocity, key: str) -> None:
    spin = given.spin
    if spin is not None and isinstance(spin, tuple) != (scenario.dimension == 3):
        form = "three components" if scenario.dimension == 3 else "a number"
        raise problem(f"a spin in {scenario.dimension}D is {form}", key=f"{key}.spin", value=spin)
