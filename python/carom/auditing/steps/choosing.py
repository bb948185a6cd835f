"""Which of the places that fit a contact alike it has, by the forces that are stored on nodes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from itertools import combinations, product
from typing import Any

import numpy as np

from carom.auditing.arrays import Array, Indices
from carom.auditing.steps.place import Place
from carom.auditing.targets.feet import CORNER, Feet, Target

BALANCED = 1e-9
"""What is left of forces on nodes below this part of all reactions needs no other places."""

SWEEPS = 6
"""As often contacts are placed again in turn, each as the others leave it."""

MOST_AT_ONCE = 12
"""Of no more contacts that are not yet placed well every two are placed together."""


def settle(
    state: Mapping[str, Any],
    places: list[Place],
    alike: dict[int, list[Place]],
    others: Callable[[int], list[Place]],
) -> None:
    """Choose among places that are alike, as on flat sides, by the stored forces on nodes.

    Parameters
    ----------
    state
        The state, with forces on nodes and the reactions of the contacts [N].
    places
        The places of the contacts, which are replaced by those that are chosen.
    alike
        Places of contacts that are as good as one another.
    others
        Where else a contact may be: faces that lie on one another touch with edges where nodes
        would do as well.
    """
    chooser = _Chooser(state, places, alike)
    for sweep in range(SWEEPS):
        if chooser.balanced:
            return
        if sweep == 1:
            for contact, place in enumerate(places):
                alike.setdefault(contact, [place]).extend(others(contact))
        off = [contact for contact in alike if chooser.leaves(contact)]
        for contact in off:
            chooser.choose([contact])
        if sweep > 1 and len(off) <= MOST_AT_ONCE:
            # Two that lie on the same edge may have changed places.
            for pair in combinations(off, 2):
                chooser.choose(list(pair))


class _Chooser:
    def __init__(
        self, state: Mapping[str, Any], places: list[Place], alike: dict[int, list[Place]]
    ) -> None:
        self._places, self._alike = places, alike
        self._reactions: Array = state["contact_reaction"]
        self._least = BALANCED * float(np.abs(self._reactions).sum())
        self._left: Array = state["contact_force"].copy()
        """What the contacts leave of the forces on nodes [N]."""
        for contact, place in enumerate(places):
            self._press(contact, place, -1.0)

    @property
    def balanced(self) -> bool:
        """Whether the contacts account for all forces."""
        return not np.abs(self._left).max(initial=0.0) > self._least

    def leaves(self, contact: int) -> bool:
        """Return whether forces are left on nodes where a contact may be."""
        nodes = _nodes(self._alike[contact])
        return bool(np.abs(self._left[nodes]).max() > self._least)

    def choose(self, contacts: list[int]) -> None:
        """Choose the places of contacts together that leave least of the forces on nodes."""
        alike = [self._alike[contact] for contact in contacts]
        self._press_all(contacts, [self._places[contact] for contact in contacts], 1.0)
        nodes = _nodes([place for places in alike for place in places])
        choices, errors = list(product(*alike)), []
        for places in choices:
            self._press_all(contacts, places, -1.0)
            errors.append(float((self._left[nodes] ** 2).sum()))
            self._press_all(contacts, places, 1.0)
        best = choices[int(np.argmin(errors))]
        self._press_all(contacts, best, -1.0)
        for contact, place in zip(contacts, best, strict=True):
            self._places[contact] = place

    def _press_all(self, contacts: list[int], places: Sequence[Place], sign: float) -> None:
        for contact, place in zip(contacts, places, strict=True):
            self._press(contact, place, sign)

    def _press(self, contact: int, place: Place, sign: float) -> None:
        """Add the reaction of a contact at a place to what is left, or take it off."""
        reaction = sign * self._reactions[contact]
        for node, weight in place.sources:
            self._left[node] += weight * reaction
        for node, weight in place.followed:
            self._left[node] -= weight * reaction


def _nodes(places: Sequence[Place]) -> list[int]:
    """Return the nodes of places."""
    return sorted({n for place in places for n, _ in (*place.sources, *place.followed)})


def goes_on(
    feet: Feet, mine: Indices, known: tuple[int, Array], target: Target, *, otherwise: int
) -> int:
    """Return which of the feet `mine` of a point goes on from a known one.

    It stays on its facet. On a smooth target it goes on to the next one where the foot is on that;
    beyond an edge, beside both, it stays.

    Parameters
    ----------
    feet
        Feet of points.
    mine
        Those of the point.
    known
        Facet of the known foot, and its normal.
    target
        The target.
    otherwise
        What to return where none goes on from it.
    """
    facet, normal = known
    own = feet.facet[mine] == facet
    on = feet.beyond[mine] == 0.0
    walks = facet >= 0 and bool(target.smooth[facet])
    choices = [own & on] if walks else [own]
    if walks:
        # Sides beyond a corner are not beside it.
        beside = np.isin(target.facets[feet.facet[mine]], target.facets[facet]).any(axis=1)
        beside &= feet.normal[mine] @ normal > CORNER
        beside &= target.smooth[feet.facet[mine]]
        choices += [beside & on, own]
    found = next((chosen for chosen in choices if chosen.any()), None)
    return otherwise if found is None else int(mine[found.argmax()])
