"""Energies, and what became of them."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Energy:
    """Energy of the bodies at a moment.

    Parameters
    ----------
    kinetic, strain
        Kinetic and strain energy [J].
    """

    kinetic: float
    strain: float

    @property
    def total(self) -> float:
        """Kinetic plus strain energy [J]."""
        return self.kinetic + self.strain


@dataclass(frozen=True)
class Ledger:
    """What happened to the energy in a step, or since the start [J].

    Every term is computed from its own definition:
    kinetic + strain = external + prescribed − friction − viscous − plastic − scheme
    − normal_contact + defect.

    Parameters
    ----------
    kinetic, strain
        Change of kinetic and of strain energy.
    external
        Work of gravity and loads.
    prescribed
        Work of supports and obstacles that move.
    friction, viscous, plastic, scheme
        Dissipated by friction, by damping and viscosity, by plastic flow, by the time scheme.
    normal_contact
        Taken by normal reactions.
    """

    kinetic: float
    strain: float
    external: float
    prescribed: float
    friction: float
    viscous: float
    plastic: float
    scheme: float
    normal_contact: float

    @property
    def defect(self) -> float:
        """What the other terms do not explain [J]."""
        gained = self.external + self.prescribed
        lost = self.friction + self.viscous + self.plastic + self.scheme + self.normal_contact
        return self.kinetic + self.strain - gained + lost
