"""The law of contact: what is left out, and what does not go well together."""

from __future__ import annotations

from collections.abc import Iterator

from carom.case.analysis import Dynamic
from carom.case.full_stage import FullStage
from carom.doctor.finding import Finding
from carom.doctor.patient import Patient
from carom.messages import listed


def contact_setup(patient: Patient) -> Iterator[Finding]:
    """Look at friction, at bodies without partners and at the scheme."""
    scenario = patient.scenario
    pairs = patient.description["pairs"]
    partners = {name for pair in pairs for name in pair["between"]}
    for index, body in enumerate(scenario.bodies):
        if pairs and body.name not in partners:
            yield Finding(
                "warning",
                f"bodies.{index}",
                f"{body.name} can touch nothing: every pair with it is disabled",
                "enable one in contact.pairs, or leave the body out",
            )
    if pairs and not any(pair["friction"] for pair in pairs) and not _rubs_later(patient):
        yield Finding(
            "advice",
            "contact.friction",
            "there is no friction: everything slides freely",
            "set contact.friction, if the real surfaces have any (0.2 to 0.6 for most dry ones)",
        )
    for stage in patient.stages:
        if isinstance(stage.analysis, Dynamic):
            yield from _scheme(stage, stage.analysis)
    yield from _masses(patient, partners)
    first = patient.stages[0]
    stands = all(body.velocity is None and not body.spin for body in scenario.bodies)
    if not (first.is_dynamic and stands and scenario.initial is None):
        return
    driven = any(
        stage.analysis.gravity is not None or stage.loads or stage.motions or stage.velocities
        for stage in patient.stages
    )
    moved = any(o.velocity is not None or o.motion is not None for o in scenario.obstacles)
    if not driven and not moved:
        yield Finding(
            "warning",
            "bodies",
            "nothing moves: no velocity, spin, gravity, load or motion is given",
            "give bodies a velocity, or set analysis.gravity",
        )


MUCH_MOVED = 0.2
"""Share of its mass that a body may move inside before the doctor tells of it."""


def _rubs_later(patient: Patient) -> bool:
    """Return whether there is friction from a later stage on."""
    contacts = [stage.contact for stage in patient.stages]
    return any(c.friction or any(pair.friction for pair in c.pairs) for c in contacts[1:])


def _masses(patient: Patient, partners: set[str]) -> Iterator[Finding]:
    """Look at which bodies cannot do without mass where they touch."""
    if patient.stages[0].contact.condition != "massless":
        return
    keep = [
        body["name"]
        for body in patient.description["bodies"]
        if body["name"] in partners and not body["is_massless"]
    ]
    if keep:
        yield Finding(
            "ok",
            "contact.condition",
            f"keeping their mass where they touch: {listed(keep)}; pairs of these, and of these "
            "with obstacles, are ruled as with midpoint",
        )
    moved = [
        f"{100 * body['moved_mass'] / body['mass']:.0f} % of {body['name']}"
        for body in patient.description["bodies"]
        if body["name"] in partners and body["moved_mass"] > MUCH_MOVED * body["mass"]
    ]
    if moved:
        yield Finding(
            "ok",
            "contact.condition",
            f"mass moves inside from where bodies touch: {listed(moved)}; where waves matter, name "
            "the sides that meet in bodies.contact_sets, or mesh more finely",
        )


def _scheme(stage: FullStage, analysis: Dynamic) -> Iterator[Finding]:
    """Look at how the scheme and the contact condition go together."""
    if analysis.scheme.kind == "theta" and stage.contact.condition == "massless":
        yield Finding(
            "warning",
            f"{stage.key}contact.condition",
            "massless contact takes energy with the scheme theta, which gives none of it back",
            "take the default scheme, conserving, or the condition midpoint",
        )
    elif analysis.scheme.kind == "theta" and stage.contact.condition == "midpoint":
        yield Finding(
            "advice",
            f"{stage.key}analysis.scheme",
            "the scheme theta keeps the energy of linear elasticity only; the rest is in the "
            "defect of the ledger",
            "take the default scheme, conserving, unless the paper's is wanted",
        )
