"""The energy of bodies and springs at a moment."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Energy:
    """Energy of bodies and springs at a moment.

    Parameters
    ----------
    kinetic, strain
        Kinetic and strain energy of the bodies [J].
    springs
        Energy of springs [J].
    """

    kinetic: float
    strain: float
    springs: float = 0.0

    @property
    def total(self) -> float:
        """All of it [J]."""
        return self.kinetic + self.strain + self.springs
