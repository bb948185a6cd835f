"""The law of contact: what is left out, and what does not go well together."""

from __future__ import annotations

from collections.abc import Iterator

from carom.case.analysis import Dynamic
from carom.doctor.finding import Finding
from carom.doctor.patient import Patient


def contact_setup(patient: Patient) -> Iterator[Finding]:
    """Look at friction, at bodies without partners and at the scheme."""
    scenario, contact = patient.scenario, patient.scenario.contact
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
    if pairs and all(pair["friction"] == 0.0 for pair in pairs):
        yield Finding(
            "advice",
            "contact.friction",
            "there is no friction: everything slides freely",
            "set contact.friction, if the real surfaces have any (0.2 to 0.6 for most dry ones)",
        )
    if not isinstance(scenario.analysis, Dynamic):
        return
    scheme = scenario.analysis.scheme.kind
    if contact.condition == "massless":
        yield Finding(
            "advice",
            "contact.condition",
            "massless contact is quiet and exact, but takes two to three times as long and does "
            "not bear every case yet",
            'if steps fail, take condition = "midpoint"',
        )
    elif scheme == "theta" and contact.condition == "midpoint":
        yield Finding(
            "advice",
            "analysis.scheme",
            "the scheme theta keeps the energy of linear elasticity only; the rest is in the "
            "defect of the ledger",
            "take the default scheme, conserving, unless the paper's is wanted",
        )
    if all(body.velocity is None and not body.spin for body in scenario.bodies):
        still = scenario.analysis.gravity is None and not scenario.loads and not scenario.motions
        moved = any(o.velocity is not None or o.motion is not None for o in scenario.obstacles)
        if still and not moved:
            yield Finding(
                "warning",
                "bodies",
                "nothing moves: no velocity, spin, gravity, load or motion is given",
                "give bodies a velocity, or set analysis.gravity",
            )
