"""Linear combinations of nodes."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from carom.auditing.arrays import Array


@dataclass(frozen=True)
class Combination:
    """Weights of nodes: a point of a body where they sum to 1, a difference where they sum to 0.

    Parameters
    ----------
    weights
        The weight of each node that counts.
    """

    weights: dict[int, float] = field(default_factory=dict)

    @classmethod
    def of(cls, node: int) -> Combination:
        """Return the place of a node."""
        return cls({node: 1.0})

    @classmethod
    def between(cls, start: int, end: int) -> Combination:
        """Return the way from a node to another."""
        return cls({start: -1.0, end: 1.0})

    def __add__(self, other: Combination) -> Combination:
        weights = dict(self.weights)
        for node, weight in other.weights.items():
            weights[node] = weights.get(node, 0.0) + weight
        return Combination(weights)

    def __mul__(self, factor: float) -> Combination:
        return Combination({node: factor * weight for node, weight in self.weights.items()})

    __rmul__ = __mul__

    def __neg__(self) -> Combination:
        return -1.0 * self

    def __sub__(self, other: Combination) -> Combination:
        return self + -other

    def at(self, position: Array) -> Array:
        """Return what it is where nodes are at `position` [m], shape [D]."""
        place: Array = np.array(list(self.weights.values())) @ position[list(self.weights)]
        return place
