"""What the scene of a run is made of, on the page of its report and alone in a notebook."""

from __future__ import annotations

import base64
from typing import Any

import matplotlib as mpl
import numpy as np

from carom.display.colours import DIVERGING, SEQUENTIAL
from carom.display.time_unit import TimeUnit, time_unit
from carom.errors import InputError
from carom.report.attached import attached, attached_data
from carom.report.fields import BUDGET, Bodies, bodies
from carom.report.obstacles import obstacles
from carom.report.source import Source
from carom.view.colouring import SIGNED

COLOUR_MAPS = {"sequential": SEQUENTIAL, "diverging": DIVERGING}
"""Of matplotlib: for sizes, and for what has a sign."""


def shown_bodies(
    source: Source, notes: list[str], *, budget: int = BUDGET, most_fields: int | None = None
) -> Bodies | None:
    """Return the bodies of a run, None if they cannot be drawn.

    Parameters
    ----------
    source
        What the run has left.
    notes
        What was left out is added here.
    budget, most_fields
        What their fields may take in the page, and how many there may be; see `bodies`.
    """
    if source.frames is None:
        if source.history:
            notes.append("There are no fields, so that the bodies are not drawn.")
        return None
    try:
        shown = bodies(source.frames, source.surface, budget=budget, most_fields=most_fields)
    except (InputError, KeyError, IndexError, OSError, ValueError) as error:
        notes.append(f"The bodies are not drawn: fields.vtkhdf cannot be read: {error}.")
        return None
    taken = len(shown.frames)
    notes.append(
        f"The scene has {'all' if taken == shown.recorded else f'{taken} of'} "
        f"{shown.recorded} frames of fields.vtkhdf"
        + (", evenly spaced, to keep the page small. " if taken < shown.recorded else ". ")
        + "Values in it are rounded to one part in 65,534 of their range, "
        f"displacements to within {_rounding(shown):.2g} m."
    )
    return shown


def _rounding(shown: Bodies) -> float:
    return float(max(shown.data["arrays"]["displacement"]["step"])) / 2


def scene_data(source: Source, shown: Bodies | None, notes: list[str]) -> dict[str, Any]:
    """Return what the scripts of the scene need, as plain data for JSON."""
    unit = _time_unit(source)
    data: dict[str, Any] = {
        "contacts": source.summary.get("contacts") or [],
        "end": source.summary.get("end_time"),
        "time_unit": {"symbol": unit.symbol, "seconds": unit.seconds},
        "colour_maps": {name: _colours(map_) for name, map_ in COLOUR_MAPS.items()},
        "scene": None,
    }
    if shown is not None and source.frames is not None:
        times = source.frames.times[shown.frames]
        case = source.scenario
        for field in shown.data["fields"]:
            field["map"] = "diverging" if field["key"] in SIGNED else "sequential"
        low, high, connections = shown.low, shown.high, None
        if case is not None and (case.springs or case.masses):
            found, moved = attached(case, source.frames, shown.frames, notes)
            places = (found.drawn + moved).reshape(-1, found.dimension)
            low = np.vstack([low, places]).min(axis=0)
            high = np.vstack([high, places]).max(axis=0)
            connections = attached_data(
                found,
                moved,
                history=source.history,
                taken=shown.frames,
                size=float(np.linalg.norm(high - low)),
            )
        data["scene"] = {
            **shown.data,
            "connections": connections,
            "low": low.tolist(),
            "high": high.tolist(),
            "bodies": [body.name for body in case.bodies] if case else [],
            "obstacles": obstacles(case, times, notes) if case else [],
        }
    return data


def _time_unit(source: Source) -> TimeUnit:
    """Return the unit of the times that are drawn, by the last that there is."""
    times = [*source.history.get("time", ())[-1:]]
    if source.frames is not None:
        times += [*source.frames.times[-1:]]
    return time_unit(max(map(float, times), default=0.0))


def _colours(name: str) -> str:
    """Return a colour map of matplotlib as 256 RGBA colours in base64."""
    table = mpl.colormaps[name](np.linspace(0.0, 1.0, 256), bytes=True)
    return base64.b64encode(np.asarray(table, dtype=np.uint8).tobytes()).decode()
