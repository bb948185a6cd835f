"""Looking at a case before it runs, and saying in plain language what is to be expected of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from carom.building.build import build
from carom.case.scenario import Scenario
from carom.doctor.contact_setup import contact_setup
from carom.doctor.cost import cost
from carom.doctor.finding import LEVELS, Diagnosis, Finding, Level
from carom.doctor.meeting import meeting
from carom.doctor.mesh_quality import mesh_quality
from carom.doctor.patient import Patient
from carom.doctor.reduced import reduced
from carom.doctor.time_step import time_step
from carom.doctor.turning import turning
from carom.doctor.units import units
from carom.errors import InputError
from carom.mesh_file import Note

__all__ = ["LEVELS", "Diagnosis", "Finding", "Level", "examine"]

CHECKS: tuple[Callable[[Patient], Iterator[Finding]], ...] = (
    units,
    mesh_quality,
    meeting,
    contact_setup,
    reduced,
    turning,
    time_step,
    cost,
)
"""What is checked, in this order; the last one takes steps."""


def examine(scenario: Scenario) -> Diagnosis:
    """Examine a case.

    A case that cannot be built, such as one whose bodies overlap, has one finding, an error.
    """
    notes: list[Note] = []
    try:
        patient = Patient(scenario, build(scenario, notes))
    except InputError as error:
        return Diagnosis(scenario.title, (Finding("error", error.key or "", _what(error)),))
    findings = [
        Finding("warning" if note.is_grave else "advice", note.where, note.message, note.remedy)
        for note in notes
    ]
    findings += [finding for check in CHECKS for finding in check(patient)]
    return Diagnosis(scenario.title, tuple(findings))


def _what(error: InputError) -> str:
    """Return the message without the key, which has a place of its own."""
    return str(error).removeprefix(error.key or "").removeprefix(": ")
