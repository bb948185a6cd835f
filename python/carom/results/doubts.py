"""What speaks against the results of a run, or against its case: the warnings of ``summary.json``.

Every doubt has a code, which stays the same from version to version;
docs/how-to/results-in-python.md lists them.
"""

from __future__ import annotations

import inspect
import math
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

from carom.errors import CaromWarning
from carom.io.summary_types import WarningSummary
from carom.results.penetration import depth_of, too_deep

if TYPE_CHECKING:
    from carom.case.scenario import Scenario
    from carom.mesh_file import Note

LARGE_DEFECT = 0.02
"""Defect of the ledger, relative to the energy that the run had or was given, to be warned of."""

MUCH_REPAID = 0.02
"""What vibrations took or gave in all, relative to the same energy, to be warned of."""

WAITED = 0.25
"""Part of the largest defect that vibrations have had in the end, if it waited for them."""

ROUND_OFF = 1e-9
"""Part of the work that the reactions of a step prevent that is round-off in every respect."""

_NOT_THE_CALLER = ("carom", "contextlib")
"""Packages in which nobody looks for what a warning is about."""


@dataclass(frozen=True)
class Doubt:
    """One thing that a user should know of.

    Parameters
    ----------
    code
        What it is, in a word.
    message
        What it is, in a line, with its remedy.
    where
        What it is about: a dotted key of the case file or of ``summary.json``, or a file.
    value
        The number that gave rise to it, in the unit that the message names; None if none did.
    allowed
        What the number may be at most, or at least, without a word.
    """

    code: str
    message: str
    where: str
    value: float | None = None
    allowed: float | None = None

    def as_summary(self) -> WarningSummary:
        """Return what ``summary.json`` has of it."""
        return {
            "code": self.code,
            "message": self.message,
            "where": self.where,
            "value": self.value,
            "allowed": self.allowed,
        }

    def as_warning(self) -> CaromWarning:
        """Return what Python's `warnings` are given."""
        return CaromWarning(**asdict(self))


def written_doubts(data: Mapping[str, Any]) -> list[Doubt]:
    """Return the doubts of ``summary.json``; none of versions that did not write them down."""
    return [Doubt(**one) for one in data.get("warnings", ())]


def of_mesh(note: Note) -> Doubt:
    """Return the doubt about something in a mesh out of a file, or that was done to it."""
    what = f"{note.message}; {note.remedy}" if note.remedy else note.message
    return Doubt(note.code, what, note.where, note.value, note.allowed)


def warn(doubt: Doubt) -> None:
    """Tell Python of a doubt, as one about the line outside of carom that led here."""
    level, frame = 1, inspect.currentframe()
    while frame is not None:
        if frame.f_globals.get("__name__", "").partition(".")[0] not in _NOT_THE_CALLER:
            break
        level, frame = level + 1, frame.f_back
    warnings.warn(doubt.as_warning(), stacklevel=level)


def doubts(summary: Mapping[str, Any], scenario: Scenario) -> Iterator[Doubt]:
    """Yield what a user should know of the results of a run, by what its summary has else."""
    share = defect_share(summary["energy"])
    repaid = _over_energy(summary.get("repaid", 0.0), summary["energy"])
    if not share <= LARGE_DEFECT and not _is_round_off(summary):
        yield Doubt(
            "ledger-defect",
            f"the ledger missed {share:.2g} of the energy until vibrations had it, for nodes "
            "without mass give way at once where a load sets in or cells fold: mesh more finely, "
            'or compare with contact.condition = "midpoint"'
            if repaid > WAITED * share
            else f"the ledger misses {share:.2g} of the energy: the time step is too long for this "
            "deformation; take a smaller analysis.time_step",
            "energy.max_defect",
            share,
            LARGE_DEFECT,
        )
    if repaid > MUCH_REPAID:
        yield Doubt(
            "much-repaid",
            f"vibrations took or gave {repaid:.2g} of the energy, as loads set in or cells fold "
            "where nodes have no mass: mesh more finely, or compare with "
            'contact.condition = "midpoint"',
            "repaid",
            repaid,
            MUCH_REPAID,
        )
    if (worst := too_deep(summary)) is not None:
        yield Doubt(
            "penetration",
            depth_of(worst, scenario),
            "penetration.worst",
            worst["depth"],
            worst["allowed"],
        )
    if (free := summary.get("free_motion")) is not None:
        yield Doubt(
            "free-motion",
            f"body {free['body']!r} is free to {free['motion']}: it was left where it is, as no "
            f"more than {free['driving']:.1g} of what presses drives it; support it, or give "
            "friction",
            "free_motion.driving",
            free["driving"],
            0.0,
        )
    if (check := summary["cross_check"]) is not None:
        yield from _unconfirmed(check)


def _is_round_off(summary: Mapping[str, Any]) -> bool:
    """Return whether the largest defect is round-off of what the reactions of a step hold.

    What rests on one another has no energy to speak of, and large reactions where it is stiff.
    """
    reference = summary["certificate"].get("reference_joule")
    return reference is not None and summary["energy"]["max_defect"] <= ROUND_OFF * reference


def defect_share(energy: Mapping[str, float]) -> float:
    """Return the largest defect of the ledger relative to the energy that the run had."""
    return _over_energy(energy["max_defect"], energy)


def _over_energy(part: float, energy: Mapping[str, float]) -> float:
    """Return a part of the energy that a run had.

    That is what came in, from the start on, by loads and by what is moved, or the largest change
    of the energy, if that is more. A load that is taken off again leaves nothing at the end. Of no
    energy at all, any part is infinitely much, and none is nothing.
    """
    supplied = abs(energy["initial"]) + abs(energy["external"]) + abs(energy["prescribed"])
    reference = max(supplied, energy["max_drift"])
    if reference > 0.0:
        return part / reference
    return math.inf if part > 0.0 else 0.0


def _unconfirmed(check: Mapping[str, Any]) -> Iterator[Doubt]:
    problems, differing = check["problems"], check["disagreements"]
    if differing:
        yield Doubt(
            "contact-not-unique",
            f"{differing} of {problems} contact problems have a second answer with other motions, "
            f"the most different at t = {check['time_of_max']:g} s: Coulomb's law does not decide "
            "between them",
            "cross_check.disagreements",
            float(differing),
            0.0,
        )
    if check["unsolved"]:
        yield Doubt(
            "contact-unchecked",
            f"{check['unsolved']} of {problems} contact problems were not solved by the second "
            "solver and remain unchecked",
            "cross_check.unsolved",
            float(check["unsolved"]),
            0.0,
        )
