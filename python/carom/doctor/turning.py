"""Bodies of a law of small strains that turn, or may."""

from __future__ import annotations

import math
from collections.abc import Iterator

from carom.case.body import AnyBody
from carom.case.stage import GivenVelocity
from carom.doctor.finding import Finding
from carom.doctor.patient import Patient
from carom.results.turning import REMEDY, TURNED, not_objective


def turning(patient: Patient) -> Iterator[Finding]:
    """Look at bodies that are of linear-elastic, which takes rotations for strains."""
    for index, body in enumerate(patient.scenario.bodies):
        if (material := not_objective(body, patient.scenario)) is None:
            continue
        key, of = f"bodies.{index}.material", f"linear-elastic of materials.{material}"
        spun, hit = _angles(patient, index)
        if spun > TURNED:
            yield Finding(
                "warning",
                key,
                f"{body.name} spins by {spun:.3g}° until the end, which {of} takes for strains",
                REMEDY,
            )
        elif hit > TURNED:
            yield Finding(
                "advice",
                key,
                f"{body.name} is so fast that it may turn by {hit:.3g}° when something hits it out "
                f"of its middle, which {of} takes for strains",
                REMEDY,
            )


def _angles(patient: Patient, index: int) -> tuple[float, float]:
    """Return how far a body turns until the end by its spin, and may by its speed [degrees].

    What hits something aside from its middle keeps about its speed where it is farthest from there.
    One that is held anywhere does neither.
    """
    body, radius = (
        patient.scenario.bodies[index],
        0.5 * patient.description["bodies"][index]["diameter"],
    )
    spun = hit = 0.0
    for stage in patient.stages:
        if not stage.is_dynamic or any(given.what.body == body.name for given in stage.motions):
            continue
        given: list[AnyBody | GivenVelocity]
        given = [one for one in stage.velocities if one.body == body.name]
        if stage is patient.stages[0]:
            given.append(body)
        lasts = patient.scenario.end_time - stage.start_time
        fall = math.hypot(*(stage.analysis.gravity or ())) * stage.duration
        for one in given:
            spin = one.spin if isinstance(one.spin, tuple) else (one.spin or 0.0,)
            spun = max(spun, lasts * math.hypot(*spin))
            hit = max(hit, lasts * (math.hypot(*(one.velocity or ())) + fall) / radius)
    return math.degrees(spun), math.degrees(hit)
