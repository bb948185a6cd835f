"""Bodies in contact as groups: the blend that they share, and what waits to be given back."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property

import numpy as np

from carom.auditing.arrays import Array, Indices
from carom.auditing.steps.contact_work import Works
from carom.auditing.steps.contacts import Contacts
from carom.auditing.steps.forces import Forces
from carom.auditing.steps.states import States
from carom.auditing.steps.touching import Touching


class Groups:
    """The groups of a step.

    Parameters
    ----------
    states, touching, forces, work
        The states of the step, what touches in it, its forces, and the work of its contacts.
    """

    def __init__(self, states: States, touching: Touching, forces: Forces, work: Works) -> None:
        self._states, self._touching = states, touching
        self._forces, self._work = forces, work

    @cached_property
    def blends(self) -> Indices:
        """The first body of the group of bodies that share a blend with each, [body_count]."""
        found = self._touching
        return self._connected([found.balanced, found.first, found.moved])

    @cached_property
    def books(self) -> Indices:
        """The first body of the group of bodies in contact that each belongs to, [body_count]."""
        return self._connected(
            [self._touching.balanced, self._touching.first, self._touching.moved]
        )

    def _connected(self, contacts: Sequence[Contacts]) -> Indices:
        leader = np.arange(len(self._states.model.bodies))
        for found in contacts:
            for pair in zip(found.source, found.target, strict=True):
                if min(pair) >= 0 and max(pair) < len(leader):
                    members = np.isin(leader, leader[list(pair)])
                    leader[members] = leader[members].min()
        return leader

    def balance(self) -> tuple[Array, Array]:
        """Return what the blend of each group has to make up for, and what it can move [J].

        Both are of shape [body_count], at the first body of every group.
        """
        missing, available = self._start_debt(self.blends), np.zeros(len(self._states.model.bodies))
        for f, leader in zip(self._forces.of, self.blends, strict=True):
            missing[leader] += f.missing
            available[leader] += f.available
        for sign, work in zip((1.0, -1.0), self._work.rubbing, strict=True):
            known = work.found.source < len(self.blends)
            leader = self.blends[work.found.source[known]]
            np.add.at(missing, leader, 0.5 * work.whole[known])
            np.add.at(available, leader, -sign * work.whole[known])
        return missing, available

    def blend_range(self, largest: float) -> tuple[Array, Array]:
        """Return the least and the largest α of each group, of shape [body_count].

        Up to `largest`, no mean normal reaction ½ (r₀ + r₁) + α (r₁ − r₀) pulls.
        """
        ends: dict[tuple[int, ...], list[float]] = {}
        source = {}
        for end, found in enumerate((self._touching.first, self._touching.balanced)):
            for k, key in enumerate(found.keys):
                ends.setdefault(key, [0.0, 0.0])[end] = max(float(found.normal_force[k]), 0.0)
                source[key] = int(found.source[k])
        lower = np.full(len(self.blends), -largest)
        upper = np.full(len(self.blends), largest)
        for key, (r0, r1) in ends.items():
            if source[key] >= len(self.blends) or r0 == r1:
                continue
            leader = self.blends[source[key]]
            bound = 0.5 * (r0 + r1) / (r0 - r1)
            if bound > 0:
                upper[leader] = min(upper[leader], bound)
            else:
                lower[leader] = max(lower[leader], bound)
        return lower, upper

    def left_over(self, body_terms: Sequence[Mapping[str, float]]) -> Array:
        """Return what the groups have yet to give back after the step, [body_count] [J]."""
        left = self._start_debt(self.books)
        for terms, leader in zip(body_terms, self.books, strict=True):
            left[leader] += terms["kinetic"] + terms["strain"]
            left[leader] += terms["viscous"] + terms["plastic"]
            left[leader] -= terms["external"] + terms["connections"]
            left[leader] -= terms["prescribed"]
        for work in self._work.all:
            known = work.found.source < len(self.books)
            leader = self.books[work.found.source[known]]
            nothing = np.zeros(len(work.found))
            taken = -work.terms["prescribed"]
            for name in ("friction", "normal_contact", "settling"):
                taken = taken + work.terms.get(name, nothing)
            np.add.at(left, leader, taken[known])
        return left

    def _start_debt(self, groups: Indices) -> Array:
        """Return what groups had yet to give back before the step, [body_count] [J]."""
        debt = np.zeros(len(self._states.model.bodies))
        np.add.at(debt, groups, self._states.start["energy_debt"])
        return debt
