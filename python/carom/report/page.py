"""The page: what the directory holds, the libraries and our scripts in one piece of HTML."""

from __future__ import annotations

from string import Template
from typing import Any

from carom import __version__
from carom.display.markup import Html, element, embedded, join
from carom.report.assembly import asset, elements, policy
from carom.report.attached import mass_table, spring_table
from carom.report.case_text import coloured
from carom.report.curves import curves
from carom.report.fields import Bodies
from carom.report.figures import key_figures
from carom.report.flow import energy_flow
from carom.report.modal import ringing_table, spectrograms
from carom.report.number_tables import (
    all_numbers,
    body_table,
    contact_table,
    energy_table,
    impact_table,
    pair_table,
    stage_table,
)
from carom.report.scene import scene_data, shown_bodies
from carom.report.source import UNFINISHED, Source

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
    "connections.js",
    "scene.js",
    "colour_bar.js",
    "stage.js",
    "charts.js",
    "timeline.js",
    "modal.js",
    "explorer.js",
    "transport.js",
    "picture.js",
    "film.js",
    "printing.js",
    "main.js",
)
"""In the order in which they need one another."""

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
    shown = shown_bodies(source, notes)
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
        modes=_section(
            "Vibration by modes",
            "modes-table",
            ringing_table(source.modes, source.summary),
            spectrograms(source.modes),
        ),
        springs=_section("Springs and dampers", "spring-table", spring_table(source)),
        masses=_section("Point masses", "mass-table", mass_table(source)),
        case=_case(source),
        numbers=_folded("All numbers of summary.json", "numbers", all_numbers(source.summary))
        if source.summary
        else "",
        licences=_licences(),
        notes=element("ul", *(element("li", note) for note in notes), id="notes"),
        scene=asset("assets", "scene.html"),
        transport=asset("assets", "transport.html"),
        time_unit=join(data["time_unit"]["symbol"]),
        data=embedded(data, id="data"),
        scripts=join(*elements(scripts)),
    )


def _data(source: Source, shown: Bodies | None, notes: list[str]) -> dict[str, Any]:
    drawn = curves(source)
    if drawn["rows"] < drawn["recorded"]:
        notes.append(
            f"Curves have {drawn['rows']} of {drawn['recorded']} rows of history.csv, evenly "
            "spaced."
        )
    return {"curves": drawn, **scene_data(source, shown, notes)}


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
