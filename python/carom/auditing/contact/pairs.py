"""Pairs of the case as the auditor sees them: whose nodes are checked, and by which laws."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from carom.auditing.bodies.body import AuditBody
from carom.auditing.contact.friction import Law
from carom.auditing.contact.grain import Grain
from carom.auditing.contact.holding import Holding
from carom.auditing.contact.interference import Interference
from carom.case.body import Body
from carom.case.cohesion import holds
from carom.case.contact import Pair
from carom.case.full_stage import FullStage
from carom.case.scenario import Scenario

ALIKE = 1e-6
"""Facets and masses apart by no more than this part are alike."""


@dataclass(frozen=True)
class Side:
    """Nodes of a body against a body, or against an obstacle.

    Parameters
    ----------
    source
        Index of the body whose nodes are checked.
    target
        Index of a body, or −1 − that of an obstacle.
    law
        Friction.
    two_sided
        Whether the pair is checked from the other side too.
    restitution
        Coefficient of restitution of what is rigid where velocities are ruled; None elsewhere.
    massless
        Whether nodes of either body are without mass.
    interference
        By how much their surfaces are pushed apart.
    grain
        The direction that friction depends on; None where it is the same in all.
    holding
        What holds them together; None where nothing does.
    mortar
        Whether gaps are means under multipliers of the source.
    """

    source: int
    target: int
    law: Law
    two_sided: bool
    restitution: float | None = None
    massless: bool = False
    interference: Interference = field(default_factory=Interference)
    grain: Grain | None = None
    holding: Holding | None = None
    mortar: bool = False

    @property
    def ruled_by_gaps(self) -> bool:
        """Whether no node is let in where gaps are ruled.

        What is checked from both sides may keep a penetration, and means of gaps say nothing of
        single nodes.
        """
        return not (self.two_sided or self.mortar)


class Pairs:
    """What the case says of pairs.

    Parameters
    ----------
    scenario
        The case.
    stage
        The analysis of it whose law of contact holds.
    touching_themselves
        Names of the bodies that have touched themselves, of those that deform.
    """

    def __init__(
        self, scenario: Scenario, stage: FullStage, touching_themselves: Collection[str] = ()
    ) -> None:
        self._scenario, self._stage = scenario, stage
        self._contact = stage.contact
        names = [body.name for body in scenario.bodies]
        planes = [obstacle.name for obstacle in scenario.obstacles]
        own = {
            body.name
            for body in scenario.bodies
            if isinstance(body, Body) and body.self_contact is not False
        }
        own &= set(touching_themselves)
        self.names = [
            (first, second)
            for a, first in enumerate(names)
            for second in (*([first] if first in own else []), *names[a + 1 :], *planes)
            if self.enabled(first, second)
        ]
        """The names of all that may touch, two and two, in the order of the case."""

    def of(self, a: str, b: str) -> Pair | None:
        """Return what the case says of a pair by name."""
        return next((entry for entry in self._contact.pairs if {a, b} == set(entry.between)), None)

    def enabled(self, a: str, b: str) -> bool:
        """Return whether two may touch."""
        entry = self.of(a, b)
        return entry is None or entry.enabled

    def may_touch_others(self, name: str) -> bool:
        """Return whether there is anything else that a body may touch."""
        return any(name in pair and set(pair) != {name} for pair in self.names)

    def obstacle(self, name: str) -> int:
        """Return the number of an obstacle."""
        return [obstacle.name for obstacle in self._scenario.obstacles].index(name)

    def law(self, a: str, b: str) -> Law:
        """Return the friction of two by name."""
        entry = self.of(a, b)
        own = None if entry is None else entry.friction
        return Law(self._contact.friction if own is None else own)

    def rubs_by_law(self, name: str) -> bool:
        """Return whether friction of a body is no coefficient, or not everywhere."""
        given = [self._contact.friction]
        own = (entry for entry in self._contact.pairs if name in entry.between)
        given += [entry.friction for entry in own if entry.friction is not None]
        return not all(Law(friction).constant for friction in given)

    def restitution(self, a: str, b: str) -> float:
        """Return that of two rigid solids by name."""
        entry = self.of(a, b)
        own = None if entry is None else entry.restitution
        return self._contact.restitution or 0.0 if own is None else own

    def holding(self, a: str, b: str) -> Holding | None:
        """Return what holds two together."""
        entry = self.of(a, b)
        own = None if entry is None else entry.cohesion
        return None if a == b else Holding.of(self._contact.cohesion if own is None else own)

    def holds(self, name: str) -> bool:
        """Return whether a body holds on to something, or would if it were there."""
        given = [self._contact.cohesion]
        given += [entry.cohesion for entry in self._contact.pairs if name in entry.between]
        return any(map(holds, given))

    def is_mortar(self, a: str, b: str) -> bool:
        """Return whether gaps of two are means; obstacles are checked node by node."""
        entry = self.of(a, b)
        own = None if entry is None else entry.discretisation
        bodies = {body.name for body in self._scenario.bodies}
        of_two = a != b and {a, b} <= bodies
        return of_two and (own or self._contact.discretisation) == "mortar"

    def interference(self, a: str, b: str) -> Interference:
        """Return by how much the surfaces of two are pushed apart."""
        end, static = self._stage.end_time, not self._stage.is_dynamic
        return Interference.of(self._contact, self.of(a, b), end, static=static)

    def sources(self, a: str, b: str) -> tuple[str, bool]:
        """Return whose nodes are checked, and whether that is seen from the second."""
        entry = self.of(a, b)
        if entry is None or entry.sources is None:
            # What holds, and multipliers, are on one side.
            one_sided = self.is_mortar(a, b) or self.holding(a, b) is not None
            usual = "finer" if one_sided else "both"
            return self._contact.sources or usual, False
        return entry.sources, entry.between[0] == b


def build_sides(pairs: Pairs, bodies: Sequence[AuditBody], *, impacts: bool) -> Iterator[Side]:
    """Yield the sides of all pairs; `impacts` says whether velocities are ruled."""
    number = {body.name: index for index, body in enumerate(bodies)}
    obstacles = [second for pair in pairs.names for second in pair if second not in number]
    number |= {name: -1 - pairs.obstacle(name) for name in obstacles}
    for first, second in pairs.names:
        a, b = number[first], number[second]
        met = [bodies[index] for index in (a, b) if index >= 0]
        ruled = impacts and all(body.rigid for body in met)
        law = pairs.law(first, second)
        make = partial(
            Side,
            law=law,
            grain=_grain(law, met),
            restitution=pairs.restitution(first, second) if ruled else None,
            massless=any(len(body.massless) > 0 for body in met),
            interference=pairs.interference(first, second),
            holding=pairs.holding(first, second),
            mortar=pairs.is_mortar(first, second),
        )
        if b < 0:
            yield make(a, b, two_sided=False)
            continue
        if a == b:
            # Its nodes are checked against its facets: both sides at once.
            yield make(a, a, two_sided=True)
            continue
        sources, swapped = pairs.sources(first, second)
        if sources == "finer":
            sources = "second" if _is_finer(bodies[b], bodies[a]) else "first"
            swapped = False
        forward, backward = sources in ("first", "both"), sources in ("second", "both")
        if swapped:
            forward, backward = backward, forward
        both = forward and backward
        if forward:
            yield make(a, b, two_sided=both)
        if backward:
            yield make(b, a, two_sided=both)


def _grain(law: Law, met: Sequence[AuditBody]) -> Grain | None:
    """Return the direction that the friction of bodies depends on, or of one and an obstacle."""
    if law.grain is None:
        return None
    carrier = next((body for body in met if body.name == law.grain.of), None)
    return Grain(np.array(law.grain.direction), carrier)


def _is_finer(body: AuditBody, other: AuditBody) -> bool:
    wide, wide_other = _mean_facet(body), _mean_facet(other)
    if abs(wide - wide_other) > ALIKE * max(wide, wide_other):
        return wide < wide_other
    return body.mass.total < (1 - ALIKE) * other.mass.total


def _mean_facet(body: AuditBody) -> float:
    sizes = np.linalg.norm(body.faces(body.facets).vectors(body.points), axis=1) / body.thickness
    return float((sizes ** (1 / (body.dimension - 1))).mean())
