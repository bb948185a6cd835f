"""The energy of the bodies at a moment."""

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
