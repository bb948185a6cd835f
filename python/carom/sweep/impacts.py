"""What the impacts of a study did: coefficients of restitution over what was varied."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from carom.case.scenario import Scenario
from carom.errors import InputError
from carom.io import layout
from carom.io.summary import read_summary
from carom.messages import known
from carom.sweep.axis import Axis
from carom.sweep.study import points
from carom.sweep.table import write_table

IMPACTS, CURVES = "restitution.csv", "restitution.png"
"""Files of a study of impacts beside those that every study has."""

OF_IMPACT = (
    "approach",
    "sliding",
    "restitution",
    "tangential_restitution",
    "impulse",
    "friction_impulse",
    "translation",
    "rotation",
    "vibration",
    "strain",
    "plastic",
    "viscous",
)
"""Columns that are of the summary's ``impact``: speeds [m/s], impulses [N s], changes of energy and
what was dissipated [J]."""


def names_of(scenario: Scenario, between: str | None) -> frozenset[str] | None:
    """Return the two whose impact is asked for; None for the first that meet.

    Raises
    ------
    InputError
        They are not two names of the case.
    """
    if between is None:
        return None
    names = [name.strip() for name in between.split(",")]
    here = [entry.name for entry in (*scenario.bodies, *scenario.obstacles)]
    for name in names:
        if name not in here:
            raise InputError(f"--between {name}: no such body or obstacle; {known(name, here)}")
    if len(names) != 2:
        raise InputError(f"--between {between}: give two names, such as {here[0]},{here[-1]}")
    return frozenset(names)


def impact_rows(
    scenario: Scenario,
    axes: Sequence[Axis],
    out: Path,
    *,
    between: frozenset[str] | None = None,
    number: int = 1,
) -> list[dict[str, Any]]:
    """Return a row with one impact of every run of a study that was made, and write the table.

    Parameters
    ----------
    scenario, axes, out
        Of the study, as `carom.sweep.sweep` was given them.
    between
        The names of the two; None for the first that meet.
    number
        Which of their impacts that have ended, from 1.
    """
    rows = []
    for point in points(scenario, axes, out):
        try:
            summary = read_summary(point.directory / layout.SUMMARY)
        except (OSError, ValueError):
            summary = {"status": "failed"}
        rows.append({**point.values, **_row(summary, between, number)})
    write_table(out / IMPACTS, rows)
    return rows


def _row(summary: Mapping[str, Any], between: frozenset[str] | None, number: int) -> dict[str, Any]:
    """Return the figures of an impact; None where there is no such."""
    events = [
        event
        for event in summary.get("contacts", ())
        if event.get("impact") and between in (None, frozenset(event["pair"]))
    ]
    pair = events[0]["pair"] if events else None
    events = [event for event in events if event["pair"] == pair]
    event = events[number - 1] if number <= len(events) else None
    if event is None:
        figures: dict[str, Any] = dict.fromkeys(
            ("pair", "onset", "duration", "angle", *OF_IMPACT, "friction")
        )
    else:
        impact = event["impact"]
        figures = {
            "pair": "|".join(event["pair"]),
            "onset": event["onset"],
            "duration": event["release"] - event["onset"],
            "angle": math.degrees(math.atan2(impact["sliding"], impact["approach"])),
            **{name: impact[name] for name in OF_IMPACT},
            "friction": event["friction_work"],
        }
    return {"status": summary["status"], **figures}
