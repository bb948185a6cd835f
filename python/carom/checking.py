"""Looking at a scenario without running it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from carom.scenario import Scenario
from carom.simulation import build

COARSE_STEP = 5.0
"""Time step, in suggested ones, above which waves are no longer resolved."""

SPLIT = 1e-6
"""Rest of a step at the end of the run, in steps, that is more than round-off."""


@dataclass(frozen=True)
class Check:
    """What would run.

    Parameters
    ----------
    description
        Numbers of the built scenario: ``dofs``, ``steps``, ``energy`` [J],
        ``suggested_time_step`` [s], and lists of ``bodies`` and ``pairs``.
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
    description = build(scenario).describe()
    return Check(description=description, warnings=tuple(_warnings(scenario, description)))


def _warnings(scenario: Scenario, description: dict[str, Any]) -> list[str]:
    warnings = []
    step, end = scenario.analysis.time_step, scenario.analysis.end_time
    suggested = description["suggested_time_step"]
    if step > COARSE_STEP * suggested:
        warnings.append(
            f"analysis.time_step = {step:g} s is {step / suggested:.3g} times the suggested "
            f"{suggested:.3g} s: waves will not be resolved"
        )
    rest = end / step - round(end / step)
    if abs(rest) > SPLIT:
        warnings.append(
            f"analysis.end_time = {end:g} s is not a whole number of time steps of {step:g} s"
        )
    if not description["pairs"]:
        warnings.append("nothing can touch: there is one body and no obstacle, or no pair enabled")
    return warnings
