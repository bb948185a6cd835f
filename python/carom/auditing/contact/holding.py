"""What holds two surfaces together, as the auditor sees it."""

from __future__ import annotations

from dataclasses import dataclass

from carom.case.cohesion import Cohesion, holds

OF_BONDS = 1.0
"""Friction coefficient of contacts that nothing breaks: what holds them grows until they stick."""


@dataclass(frozen=True)
class Holding:
    """By how much contacts of a pair hold together, and which do.

    Parameters
    ----------
    stress
        Tensile strength [Pa]; zero where it is not by area.
    force
        Adhesion of every contact [N]; zero where it is by area.
    unbreakable
        Whether a contact holds by whatever it takes.
    lasting
        Whether a contact that closes holds from then on; else only what is closed at the start.
    """

    stress: float
    force: float
    unbreakable: bool
    lasting: bool

    @classmethod
    def of(cls, given: float | Cohesion | None) -> Holding | None:
        """Return what a case says; None of what does not hold."""
        if not holds(given):
            return None
        if not isinstance(given, Cohesion):
            return cls(stress=float(given or 0.0), force=0.0, unbreakable=False, lasting=False)
        return cls(
            stress=given.stress or 0.0,
            force=given.force or 0.0,
            unbreakable=given.unbreakable,
            lasting=given.lasting,
        )
