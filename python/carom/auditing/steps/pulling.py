"""What springs and dampers do in a step: their mean force, and its work."""

from __future__ import annotations

import numpy as np

from carom.auditing.arrays import Array
from carom.auditing.drives.springs import AuditSpring
from carom.auditing.steps.states import States


class Pulling:
    """What springs and dampers do in a step.

    Parameters
    ----------
    states
        The states of the step.
    """

    def __init__(self, states: States) -> None:
        self._states = states
        self.terms = dict.fromkeys(("springs", "dampers", "scheme", "prescribed"), 0.0)
        """Terms of the ledger that are of no body [J]."""
        self.force: Array = np.zeros_like(states.u0)
        """Their mean force on every node of the model [N], shape [node_count, D]."""
        self.end_force: Array = np.zeros_like(states.u0)
        """That of springs at the end of the step [N], shape [node_count, D]."""
        for spring in states.model.springs:
            self._pull(spring)

    def _pull(self, spring: AuditSpring) -> None:
        """Add the force and the terms of a spring.

        With g = (r + r₊)/(ℓ + ℓ₊) the work of the mean tension along g is the change of ψ, for
        g·(r₊ − r) = ℓ₊ − ℓ (Gonzalez 1996).
        """
        s, xi = self._states, self._states.model.xi
        start = float(s.start["time"])
        ends = [spring.span(s.u0, start)]
        driven = sum(
            (
                sign * (travel.displacement(s.time) - travel.displacement(start))
                for sign, travel in spring.carried
            ),
            np.zeros_like(ends[0]),
        )
        ends.append(ends[0] + spring.shares @ s.d[spring.nodes] + driven)
        lengths = [float(np.linalg.norm(r)) for r in ends]
        longer = lengths[1] - lengths[0]
        elongations = [length - spring.free_length for length in lengths]
        resisted = 0.0 if s.model.static else spring.damping * longer / s.dt
        gradient = (ends[0] + ends[1]) / (sum(lengths) or 1.0)
        pull = gradient * (spring.tension.mean(*elongations) + resisted)
        tensions = spring.tension.at(np.array(elongations))
        before, after = (
            force * r / (length or 1.0)
            for force, r, length in zip(tensions, ends, lengths, strict=True)
        )
        beside = (0.0 if s.model.static else xi - 0.5) * (after - before)
        np.add.at(self.end_force, spring.nodes, -spring.shares[:, None] * after)
        pull = pull + beside
        np.add.at(self.force, spring.nodes, -spring.shares[:, None] * pull)
        self.terms["springs"] += spring.tension.work(*elongations)
        self.terms["dampers"] += resisted * longer
        self.terms["scheme"] += float(beside @ (ends[1] - ends[0]))
        self.terms["prescribed"] += float(pull @ driven)
