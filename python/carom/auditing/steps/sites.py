"""Where the stored contacts of a state say that they are."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from carom.auditing.arrays import Indices, Mask
from carom.auditing.contact.edges import Edges

AT_NODE, AT_EDGES, BEFORE_ROUND, AT_CORNER, AT_MULTIPLIER, BETWEEN_NODES = range(6)
"""Where contacts are: at a node, where edges cross, on a facet or edge before what is round, on a
facet at a corner of an obstacle, in the mean under the multiplier of a node, or at a point of an
edge between its nodes."""

PARTS = 16
"""Points of an edge between its nodes cut it into so many parts."""

_NUMBERS = {AT_NODE: 1, AT_EDGES: 4, AT_CORNER: 1, AT_MULTIPLIER: 2, BETWEEN_NODES: 3}
"""How many numbers follow what a contact is, at least."""


@dataclass(frozen=True)
class Sites:
    """What of a state says where its contacts are.

    Parameters
    ----------
    kind
        What they are, shape [count].
    numbers
        What tells them apart: a node; two edges by their ends, of an obstacle by its corners; an
        edge, or nothing, before what is round; a corner; the node of a multiplier and its side; an
        edge and how many of its parts the point is from the first end. Then −1. Shape [count, 4].
    facets
        The nodes of the facets that they are on, or corners of an obstacle, then −1, shape
        [count, n].
    """

    kind: Indices
    numbers: Indices
    facets: Indices

    @classmethod
    def of(cls, state: Mapping[str, Any]) -> Sites:
        """Return those of a stored state."""
        stored: Indices = state["contact_site"]
        return cls(stored[:, 0], stored[:, 1:], state["contact_facet"])

    def __getitem__(self, chosen: Mask) -> Sites:
        """Return those of some contacts."""
        return Sites(self.kind[chosen], self.numbers[chosen], self.facets[chosen])

    def edge(self, contact: int) -> Indices:
        """Return the ends of the edge of the source."""
        return self.numbers[contact, :2]

    def crossed(self, contact: int) -> Indices:
        """Return the ends of the edge that this crosses."""
        return self.numbers[contact, 2:]

    def point(self, contact: int, mine: Edges) -> list[tuple[int, float]]:
        """Return what the point of an edge follows that is between its nodes."""
        first, _, part = self.numbers[contact, :3].tolist()
        s = part / PARTS if int(mine.ends[0, 0]) == first else 1.0 - part / PARTS
        return mine.stencil(0, s)

    def on(self, contact: int, facets: Indices, first: int) -> Indices:
        """Return which of these facets, or parts of one, it is on; nodes count from the first."""
        nodes = self.facets[contact]
        found: Indices = np.flatnonzero(np.isin(facets + first, nodes[nodes >= 0]).all(axis=1))
        return found

    def key(self, contact: int) -> tuple[int, ...]:
        """Return what tells a contact from the others of its target."""
        kind, numbers = int(self.kind[contact]), self.numbers[contact].tolist()
        if kind == AT_EDGES:
            numbers = [*sorted(numbers[:2]), *sorted(numbers[2:])]
        if kind == BEFORE_ROUND and numbers[0] < 0:
            numbers = sorted(self.facets[contact].tolist())
        return (kind, *numbers)

    def says(self, contact: int) -> bool:
        """Return whether it has the numbers that one of its kind has."""
        count = _NUMBERS.get(int(self.kind[contact]), 0)
        return bool((self.numbers[contact, :count] >= 0).all())
