"""The page: what the directory holds, the libraries and our scripts in one piece of HTML."""

from __future__ import annotations

import base64
from string import Template
from typing import Any

import matplotlib as mpl
import numpy as np

from carom import __version__
from carom.display.colours import DIVERGING, SEQUENTIAL
from carom.display.markup import Html, element, embedded, join
from carom.display.time_unit import TimeUnit, time_unit
from carom.errors import InputError
from carom.report.assembly import asset, elements, policy
from carom.report.case_text import coloured
from carom.report.curves import curves
from carom.report.fields import Bodies, bodies
from carom.report.figures import key_figures
from carom.report.flow import energy_flow
from carom.report.number_tables import (
    all_numbers,
    body_table,
    contact_table,
    energy_table,
    impact_table,
    pair_table,
    stage_table,
)
from carom.report.obstacles import obstacles
from carom.report.source import UNFINISHED, Source
from carom.view.colouring import SIGNED

LIBRARIES = ("three.min.js", "uPlot.iife.min.js")

SCRIPTS = (
    "codec.js",
    "theme.js",
    "clock.js",
    "format.js",
    "colours.js",
    "save.js",
    "drawing.js",
    "shapes.js",
    "scene.js",
    "colour_bar.js",
    "charts.js",
    "timeline.js",
    "explorer.js",
    "transport.js",
    "picture.js",
    "film.js",
    "printing.js",
    "main.js",
)
"""In the order in which they need one another."""

COLOUR_MAPS = {"sequential": SEQUENTIAL, "diverging": DIVERGING}
"""Of matplotlib: for sizes, and for what has a sign."""

COLOURS = (
    "Colours: YlGnBu and RdBu by Cynthia Brewer (colorbrewer2.org, Apache License 2.0), by way of "
    "matplotlib."
)

_STATUS = {
    "completed": "The run came to its end.",
    "uncertified": "The run came to its end, but a step was too far from Coulomb’s law.",
    "intersecting": "The run came to its end, but something went into something else.",
    "failed": "The run failed. What follows is what it has left up to there.",
    "stopped": "An observer stopped the run. What follows is what it has left up to there.",
    "interrupted": "The run was interrupted. What follows is what it has left up to there.",
    UNFINISHED: "The run has not ended, or was killed. What follows is what it has left so far.",
}


def page(source: Source) -> str:
    """Return the whole page."""
    notes = list(source.notes)
    shown = _bodies(source, notes)
    scripts = [asset("vendor", name) for name in LIBRARIES]
    scripts.append("\n".join(asset("assets", name) for name in SCRIPTS))
    data = _data(source, shown, notes)
    return Template(asset("assets", "page.html")).substitute(
        version=join(__version__),
        policy=join(policy(scripts)),
        title=join(source.title),
        style=asset("vendor", "uPlot.min.css") + asset("assets", "style.css"),
        status=join(source.status),
        head=_head(source),
        figures=key_figures(source.summary) if source.summary else "",
        energy=_energy(source),
        stages=_section("Books of the stages", "stage-table", stage_table(source.summary)),
        contacts=_section("Contact events", "contact-table", contact_table(source.summary)),
        impacts=_section(
            "What impacts did to the energy", "impact-table", impact_table(source.summary)
        ),
        bodies=_section("Books of the bodies", "body-table", body_table(source.summary)),
        pairs=_section("Books of the pairs", "pair-table", pair_table(source.summary)),
        case=_case(source),
        numbers=_folded("All numbers of summary.json", "numbers", all_numbers(source.summary))
        if source.summary
        else "",
        licences=_licences(),
        notes=element("ul", *(element("li", note) for note in notes), id="notes"),
        time_unit=join(data["time_unit"]["symbol"]),
        data=embedded(data, id="data"),
        scripts=join(*elements(scripts)),
    )


def _bodies(source: Source, notes: list[str]) -> Bodies | None:
    if source.frames is None:
        if source.history:
            notes.append("There are no fields, so that the bodies are not drawn.")
        return None
    try:
        shown = bodies(source.frames, source.surface)
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


def _data(source: Source, shown: Bodies | None, notes: list[str]) -> dict[str, Any]:
    drawn = curves(source)
    if drawn["rows"] < drawn["recorded"]:
        notes.append(
            f"Curves have {drawn['rows']} of {drawn['recorded']} rows of history.csv, evenly "
            "spaced."
        )
    unit = _time_unit(source)
    data: dict[str, Any] = {
        "curves": drawn,
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
        data["scene"] = {
            **shown.data,
            "low": shown.low.tolist(),
            "high": shown.high.tolist(),
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


def _head(source: Source) -> Html:
    """Return what is said at the head of a run that did not complete, or not without warnings."""
    completed, reason = source.status == "completed", source.summary.get("reason")
    warnings = source.summary.get("warnings", ())
    said = [element("p", f"Warning: {warning['message']}.") for warning in warnings]
    if completed and not said:
        return join()
    ended = _STATUS.get(source.status, f"The run ended as {source.status}.")
    return element(
        "div",
        None if completed else element("strong", ended),
        element("p", str(reason)) if reason else None,
        *said,
        class_="alert doubts" if completed else "alert",
        role="alert",
    )


def _energy(source: Source) -> Html:
    """Return where the energy went: drawn by the books of all steps, and as numbers."""
    drawn = energy_flow(source.history, source.ledger)
    return _section("Where the energy went", "energy-table", energy_table(source.summary), drawn)


def _section(title: str, id: str, table: Html | None, above: Html | None = None) -> Html:
    if table is None and above is None:
        return join()
    scrolled = {"class_": "scroll", "tabindex": "0", "role": "region", "aria_label": title}
    return element(
        "section",
        element("h2", title),
        above,
        element("div", table, **scrolled) if table is not None else None,
        id=id,
        class_="card",
    )


def _folded(title: str, id: str, content: Html) -> Html:
    return element("details", element("summary", title), content, id=id, class_="card")


def _licences() -> Html:
    """Return the licences of what the page holds of others, whole, as they ask for."""
    parts = []
    for name in ("three", "uPlot"):
        title = {"three": "three.js"}.get(name, name)
        parts.append(element("h3", title))
        parts.append(element("pre", asset("vendor", f"LICENSE-{name}")))
    parts.append(element("p", COLOURS))
    summary = element("summary", "Licences of what is inside this page")
    return element("details", summary, *parts, id="licences")


def _case(source: Source) -> Html:
    if source.case_text is None:
        return join()
    text = element("pre", element("code", coloured(source.case_text)), tabindex="0")
    return _folded("The case as it was run: case.toml", "case", text)
