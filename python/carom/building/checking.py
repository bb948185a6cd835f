"""Looking at a scenario without running it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from carom.building.build import build
from carom.case.body import Body, materials_of
from carom.case.mesh import MeshFile
from carom.case.scenario import Scenario
from carom.case.vibrating import MOST, without_modes
from carom.mesh_file import Note
from carom.results.doubts import Doubt, of_mesh

COARSE_STEP = 5.0
"""Time step, in suggested ones, above which waves are no longer resolved."""

SPLIT = 1e-6
"""Rest of a step at the end of the run, in steps, that is more than round-off."""

WAVE_SPEEDS = (10.0, 2e4)
"""Speeds of pressure waves [m/s] between that of the softest foam and that of diamond."""

LARGE = 100.0
"""Size of a body out of a file above which millimetres are likely [m]."""


@dataclass(frozen=True)
class Check:
    """What would run.

    Parameters
    ----------
    description
        Numbers of the built scenario: ``dofs``, ``steps``, ``energy`` [J],
        ``suggested_time_step`` [s], which is None where all bodies are rigid, and lists of
        ``bodies`` and ``pairs``.
    warnings
        What is allowed but probably not meant, a line each.
    """

    description: dict[str, Any]
    warnings: tuple[str, ...]


def check(scenario: Scenario) -> Check:
    """Build a scenario and say what would run.

    Raises
    ------
    InputError
        The scenario cannot be run.
    """
    notes: list[Note] = []
    description = build(scenario, notes).describe()
    found = (*first_doubts(scenario, description, notes), *_unlikely(scenario, description))
    return Check(description=description, warnings=tuple(doubt.message for doubt in found))


def first_doubts(
    scenario: Scenario, description: Mapping[str, Any], notes: Iterable[Note] = ()
) -> Iterator[Doubt]:
    """Yield what a case gives rise to doubt before its first step.

    Parameters
    ----------
    scenario
        The case.
    description
        What the native simulation says of it.
    notes
        What `build` did to meshes.
    """
    yield from map(of_mesh, notes)
    yield from _doubts_of_units(scenario, description)
    yield from _bodies_without_modes(scenario)
    suggested = description["suggested_time_step"]
    for stage in scenario.full_stages():
        step, key = stage.analysis.time_step, f"{stage.key}analysis.time_step"
        if suggested is not None and stage.is_dynamic and step > COARSE_STEP * suggested:
            yield Doubt(
                "coarse-step",
                f"{key} = {step:g} s is {step / suggested:.3g} times the suggested "
                f"{suggested:.3g} s: waves will not be resolved",
                key,
                step,
                COARSE_STEP * suggested,
            )


def _bodies_without_modes(scenario: Scenario) -> Iterator[Doubt]:
    """Yield that bodies vibrate whose energy will not be split over modes, though that is wanted.

    Rigid ones do not vibrate, so that nothing of theirs is missing.
    """
    if scenario.output.modes is None:
        return
    told = [
        f"{body.name} ({reason})"
        for body in scenario.bodies
        if body.kind != "rigid" and (reason := without_modes(body, scenario.materials))
    ]
    if told:
        more = f" and {len(told) - MOST} more" if len(told) > MOST else ""
        yield Doubt(
            "body-without-modes",
            f"vibration is not split over modes of {', '.join(told[:MOST])}{more}",
            "output.modes",
            scenario.output.modes,
        )


def _doubts_of_units(scenario: Scenario, description: Mapping[str, Any]) -> Iterator[Doubt]:
    """Yield what points to units that are not SI."""
    slowest, fastest = WAVE_SPEEDS
    for index, (body, built) in enumerate(zip(scenario.bodies, description["bodies"], strict=True)):
        size = built["diameter"]
        for name, of in zip(materials_of(body), built["materials"], strict=True):
            speed = of["wave_speed"]
            if not isinstance(body, Body) or slowest <= speed <= fastest:
                continue
            density = scenario.materials[name].density
            yield Doubt(
                "wave-speed",
                f"body {body.name}: waves run at {speed:.3g} m/s in materials.{name}, no "
                f"solid between foam and diamond has that; give moduli in Pa and density "
                f"({density:g}) in kg/m³",
                f"materials.{name}",
                speed,
                slowest if speed < slowest else fastest,
            )
        if isinstance(body.mesh, MeshFile) and size > LARGE:
            yield Doubt(
                "body-size",
                f"body {body.name} is {size:.4g} m large; if its file is in millimetres, set scale "
                f"= {body.mesh.scale * 1e-3:g}",
                f"bodies.{index}.mesh.scale",
                size,
                LARGE,
            )


def _unlikely(scenario: Scenario, description: Mapping[str, Any]) -> Iterator[Doubt]:
    """Yield what is probably not meant, though the results are as good as others."""
    for stage in scenario.full_stages():
        step, key = stage.analysis.time_step, f"{stage.key}analysis.end_time"
        rest = stage.duration / step - round(stage.duration / step)
        if abs(rest) > SPLIT:
            since = f" after {stage.start_time:g} s" if stage.start_time else ""
            yield Doubt(
                "partial-step",
                f"{key} = {stage.end_time:g} s is not a whole number of time steps of {step:g} s"
                f"{since}",
                key,
                rest,
                SPLIT,
            )
    if not description["pairs"]:
        yield Doubt(
            "nothing-touches",
            "nothing can touch: there is one body and no obstacle, or no pair enabled",
            "contact.pairs",
        )
