"""The stages of a case with all that goes on from one to the next written out."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from carom.case.analysis import Analysis
from carom.case.contact import Contact, Pair
from carom.case.load import Load
from carom.case.motion import Motion
from carom.case.output import Output
from carom.case.stage import GivenVelocity, StageContact, StageOutput

if TYPE_CHECKING:
    from carom.case.scenario import Scenario

FRAMES = 200
"""Frames of fields in an analysis that does not say how often."""

ROWS = 1000
"""Rows of history in an analysis that does not say how often."""


@dataclass(frozen=True)
class Given:
    """A load or a prescribed motion, and where it was given.

    Parameters
    ----------
    what
        The load or motion.
    key
        Dotted path in the case, such as ``stages.1.loads.0``.
    since
        When it began [s].
    """

    what: Load | Motion
    key: str
    since: float

    @property
    def place(self) -> tuple[str, ...]:
        """What another that takes its place must share with it."""
        if self.what.kind in ("fixed", "prescribed", "guided"):
            return (self.what.body, self.what.on)
        return (self.what.kind, self.what.body, self.what.on)


@dataclass(frozen=True)
class FullStage:
    """An analysis of a case, with all that holds during it: one as a rule, or one per stage.

    Parameters
    ----------
    name
        Name of the stage; empty in a case without stages.
    key
        Dotted path of the stage with a dot behind it; empty in a case without stages.
    start_time
        When it starts [s].
    analysis
        How the motion is computed, with the gravity that acts.
    loads, motions
        What acts, those of before that go on first.
    contact
        The law of contact.
    velocities
        What bodies are given when it starts.
    fields_every, history_every
        Times between two frames and two rows [s], counted from its start.
    """

    name: str
    key: str
    start_time: float
    analysis: Analysis
    loads: tuple[Given, ...]
    motions: tuple[Given, ...]
    contact: Contact
    velocities: tuple[GivenVelocity, ...]
    fields_every: float
    history_every: float

    @property
    def end_time(self) -> float:
        """When it ends [s]."""
        return self.analysis.end_time

    @property
    def is_dynamic(self) -> bool:
        """Whether there are waves, velocities and impacts."""
        return self.analysis.kind == "dynamic"

    @property
    def duration(self) -> float:
        """How long it lasts [s]."""
        return self.end_time - self.start_time

    def to_data(self) -> dict[str, Any]:
        """Return it as the native core reads it."""

        def dumped(given: Sequence[Given]) -> list[dict[str, Any]]:
            return [{**one.what.model_dump(mode="json"), "since": one.since} for one in given]

        return {
            "name": self.name,
            "analysis": {**self.analysis.model_dump(mode="json"), "start_time": self.start_time},
            "history_every": self.history_every,
            "loads": [one.what.model_dump(mode="json") for one in self.loads],
            "motions": dumped(self.motions),
            "contact": self.contact.model_dump(mode="json"),
            "velocities": [one.model_dump(mode="json") for one in self.velocities],
        }


def full_stages(scenario: Scenario) -> Iterator[FullStage]:
    """Yield the analyses of a case one after the other."""
    loads = [Given(load, f"loads.{i}", 0.0) for i, load in enumerate(scenario.loads)]
    start = 0.0 if scenario.initial is None else scenario.initial.start_time
    motions = [Given(motion, f"motions.{i}", start) for i, motion in enumerate(scenario.motions)]
    if scenario.analysis is not None:
        yield FullStage(
            name="",
            key="",
            start_time=start,
            analysis=scenario.analysis,
            loads=tuple(loads),
            motions=tuple(motions),
            contact=scenario.contact,
            velocities=(),
            **_intervals(scenario.output, None, scenario.analysis, start),
        )
        return
    gravity: tuple[float, ...] | None = None
    contact = _of_all_stages(scenario)
    dynamic = contact.condition
    for index, stage in enumerate(scenario.stages):
        key = f"stages.{index}."
        gravity = stage.analysis.gravity or gravity
        analysis = stage.analysis.model_copy(update={"gravity": gravity})
        loads = _replaced(
            loads,
            [(one.kind, one.body, one.on) for one in stage.removed_loads],
            [Given(load, f"{key}loads.{i}", start) for i, load in enumerate(stage.loads)],
        )
        motions = _replaced(
            motions,
            [(one.body, one.on) for one in stage.removed_motions],
            [Given(motion, f"{key}motions.{i}", start) for i, motion in enumerate(stage.motions)],
        )
        if stage.contact is not None:
            contact = _changed(contact, stage.contact)
            dynamic = (stage.analysis.kind == "dynamic" and stage.contact.condition) or dynamic
        condition = "gap" if analysis.kind == "static" else dynamic
        contact = contact.model_copy(update={"condition": condition})
        yield FullStage(
            name=stage.name,
            key=key,
            start_time=start,
            analysis=analysis,
            loads=tuple(loads),
            motions=tuple(motions),
            contact=contact,
            velocities=stage.velocities,
            **_intervals(scenario.output, stage.output, analysis, start),
        )
        start = analysis.end_time


def _intervals(
    of_all: Output, own: StageOutput | None, analysis: Analysis, start: float
) -> dict[str, float]:
    """Return the times between frames and between rows [s], never less than a step."""
    found = {}
    for name, parts in (("fields_every", FRAMES), ("history_every", ROWS)):
        asked: float | None = getattr(own, name, None) or getattr(of_all, name)
        every = (analysis.end_time - start) / parts if asked is None else asked
        found[name] = max(every, analysis.time_step)
    return found


def _replaced(
    before: list[Given], removed: list[tuple[str, ...]], given: list[Given]
) -> list[Given]:
    """Return what goes on of what was given before, and what is given now."""
    gone = {*removed, *(one.place for one in given)}
    return [one for one in before if one.place not in gone] + given


def _of_all_stages(scenario: Scenario) -> Contact:
    """Return the law of contact with what must be the same in all stages, whatever their kind."""
    contact, stages = scenario.contact, scenario.stages
    changes: dict[str, Any] = {}
    resolves = contact.resolve_overlap or any(pair.resolve_overlap for pair in contact.pairs)
    if resolves and contact.overlap_resolved_at is None:
        changes["overlap_resolved_at"] = stages[0].analysis.end_time
    return contact.model_copy(update=changes)


def _changed(contact: Contact, change: StageContact) -> Contact:
    pairs = list(contact.pairs)
    for one in change.pairs:
        two = frozenset(one.between)
        found = [k for k, pair in enumerate(pairs) if frozenset(pair.between) == two]
        if found:
            own = pairs[found[0]]
            pairs[found[0]] = own.model_copy(update={"friction": one.friction})
        else:
            pairs.append(Pair(between=one.between, friction=one.friction))
    friction = contact.friction if change.friction is None else change.friction
    return contact.model_copy(update={"friction": friction, "pairs": tuple(pairs)})
