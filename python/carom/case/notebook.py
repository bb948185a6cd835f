"""What notebooks show of a scenario, as HTML."""

from __future__ import annotations

from typing import TYPE_CHECKING

from carom.case.body import materials_of
from carom.case.friction import friction_text
from carom.display.markup import Html, element
from carom.display.tables import html_table

if TYPE_CHECKING:
    from carom.case.body import AnyBody
    from carom.case.scenario import Scenario


def scenario_html(scenario: Scenario) -> Html:
    """Return what a scenario consists of, and its case file to unfold."""
    contact = scenario.contact
    rows = [
        *(
            (
                f"stage {stage.name}" if stage.name else "analysis",
                f"{stage.analysis.kind}, {stage.end_time:g} s in steps of "
                f"{stage.analysis.time_step:g} s",
            )
            for stage in scenario.full_stages()
        ),
        *(("body", _body_text(body)) for body in scenario.bodies),
        *(("obstacle", f"{obstacle.name}: {obstacle.kind}") for obstacle in scenario.obstacles),
        *(("load", f"{load.kind} on {load.body}") for load in scenario.loads),
        *(("motion", f"{motion.kind}: {motion.body}") for motion in scenario.motions),
        ("contact", f"{contact.condition}, friction {friction_text(contact.friction)}"),
    ]
    case = element("details", element("summary", "case file"), element("pre", scenario.to_toml()))
    return element("div", element("strong", scenario.title or "Scenario"), html_table(rows), case)


def _body_text(body: AnyBody) -> str:
    made_of = ", ".join(dict.fromkeys(materials_of(body))) or body.kind
    return f"{body.name}: {body.mesh.kind}, {made_of}"
