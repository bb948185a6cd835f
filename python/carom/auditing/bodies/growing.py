"""How bodies grow, as the auditor sees it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.auditing.arrays import Array
from carom.auditing.functions.signals import AuditSignal
from carom.case.body import AnyBody, Body


@dataclass(frozen=True)
class Growth:
    """The linear strain γ that a body would have if nothing held it.

    F = F_e (1 + γ), and what has grown is of the same material: E = ∫(1 + γ)³ ψ(F_e) dV. A law of
    small displacements has E = ∫ψ(F − γ I) dV.

    Parameters
    ----------
    signal
        γ over time.
    large
        Whether the law is one of large displacements.
    """

    signal: AuditSignal
    large: bool

    @classmethod
    def of(cls, entry: AnyBody, *, large: bool) -> Growth:
        """Return that of a body, whose law is one of large displacements or not."""
        return cls(AuditSignal(entry.growth if isinstance(entry, Body) else None), large)

    @property
    def acts(self) -> bool:
        """Whether the body grows."""
        return self.signal.given

    def at(self, time: float) -> float:
        """Return γ at a time [s]; a run starts from bodies that have not grown."""
        return self.signal.at(time)[0] if time > 0.0 else 0.0

    def elastic(self, f: Array, grown: float) -> Array:
        """Return F_e of F, shape [..., 3, 3]."""
        return f / (1.0 + grown) if self.large else f - grown * np.eye(3)

    def factor(self, grown: float, power: int) -> float:
        """Return (1 + γ)ⁿ, by which energies (3) and stresses (2) of F_e count; 1 if small."""
        return (1.0 + grown) ** power if self.large else 1.0
