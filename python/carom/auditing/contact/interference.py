"""By how much the surfaces of a pair are pushed apart, as the auditor sees it."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from carom.auditing.arrays import Array
from carom.auditing.functions.signals import AuditSignal
from carom.case.contact import Contact, Pair


@dataclass(frozen=True)
class Interference:
    """h of a pair: the law of contact sees its gaps less h, and h < 0 is clearance.

    Parameters
    ----------
    signal
        What all its contacts have in common over time [m].
    until
        When overlaps at t = 0 have been taken up [s]: until then what is left of the depth of a
        contact is clearance, which falls linearly to zero. None if there are none to take up.
    from_nothing
        Whether it is that of a load step analysis that begins at t = 0: its first step pushes apart
        what is there at t = 0.
    """

    signal: AuditSignal = field(default_factory=lambda: AuditSignal(None))
    until: float | None = None
    from_nothing: bool = False

    @classmethod
    def of(cls, contact: Contact, pair: Pair | None, end: float, *, static: bool) -> Interference:
        """Return that of a pair, of which the case may say nothing, up to an end [s]."""
        given = None if pair is None else pair.interference
        own = None if pair is None else pair.resolve_overlap
        resolves = contact.resolve_overlap if own is None else own
        until = contact.overlap_resolved_at or end
        return cls(AuditSignal(given), until if resolves else None, static)

    @property
    def acts(self) -> bool:
        """Whether surfaces are ever apart or inside one another as they press."""
        return self.signal.given or self.until is not None

    def left(self, time: float) -> float:
        """Return the part of overlaps that is left at a time [s]."""
        return 0.0 if self.until is None else max(1.0 - time / self.until, 0.0)

    def at(self, time: float, depth: Array | float = 0.0) -> Array:
        """Return h [m] at a time [s] of contacts that were as deep as this at t = 0 [m]."""
        h: Array = self.signal.at(time)[0] - np.asarray(depth) * self.left(time)
        return h

    def as_state(self, time: float, depth: Array | float = 0.0) -> Array:
        """Return the same of a state: where load steps begin nothing is pushed apart yet."""
        h = self.at(time, depth)
        return np.minimum(h, 0.0) if self.from_nothing and time == 0.0 else h
