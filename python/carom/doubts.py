"""What speaks against the results of a run that ended as it should."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

LARGE_DEFECT = 0.02
"""Defect of the ledger, relative to the energy that the run had or was given, to be warned of."""

DEEP = 0.01
"""Penetration, relative to the diameter of the largest body, to be warned of."""


def doubts(summary: Mapping[str, Any]) -> Iterator[str]:
    """Yield a sentence for everything in ``summary.json`` that a user should know of."""
    energy = summary.get("energy")
    if energy is not None and (share := defect_share(energy)) > LARGE_DEFECT:
        yield (
            f"the ledger misses {share:.2g} of the energy: the time step is too long for this "
            "deformation; take a smaller analysis.time_step"
        )
    gap, size = summary.get("min_gap"), summary.get("size")
    if gap is not None and size is not None and gap < -DEEP * size:
        yield (
            f"nodes were up to {-gap:.2g} m inside what they touch, having slid past its edges or "
            "come too fast: mesh more finely, take a smaller analysis.time_step, or have the nodes "
            'of both bodies checked, contact.sources = "both"'
        )
    if (check := summary.get("cross_check")) is not None:
        yield from _unconfirmed(check)


def defect_share(energy: Mapping[str, float]) -> float:
    """Return the largest defect of the ledger relative to the energy that came in."""
    supplied = energy["initial"] + abs(energy["external"])
    return energy["max_defect"] / supplied if supplied > 0.0 else 0.0


def _unconfirmed(check: Mapping[str, Any]) -> Iterator[str]:
    problems, differing = check["problems"], check["disagreements"]
    if differing:
        yield (
            f"{differing} of {problems} contact problems have a second answer with other motions, "
            f"the most different at t = {check['time_of_max']:g} s: Coulomb's law does not decide "
            "between them"
        )
    if check["unsolved"]:
        yield (
            f"{check['unsolved']} of {problems} contact problems were not solved by the second "
            "solver and remain unchecked"
        )
