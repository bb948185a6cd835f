"""What is asked of the mass of a body, whoever made it."""

from __future__ import annotations

from abc import ABC, abstractmethod

from carom.auditing.arrays import Array


class MassMatrix(ABC):
    """Multiplication by the mass matrix of a body."""

    plain = True
    """Whether it is the same in every direction."""

    nodal: Array
    """Row sums [kg], shape [node_count]."""

    sizes: Array
    """How much each node resists what moves it alone [kg]: row sums without signs."""

    moved: Array
    """What nodes without mass had before it moved inside, likewise [kg]."""

    total: float
    """Mass of the body [kg]."""

    @abstractmethod
    def times(self, v: Array) -> Array:
        """Return M v of nodal vectors, shape [node_count, D]."""

    def mean(self, v: Array) -> Array:
        """Return the mean of nodal vectors by mass, shape [D]."""
        return self.drift(v)

    def drift(self, v: Array) -> Array:
        """Return their mean by the masses of nodes, shape [D]."""
        return self.resultant(self.nodal[:, None] * v) / self.total

    def resultant(self, values: Array) -> Array:
        """Return the sum of vectors of nodes, shape [D]."""
        total: Array = values.sum(axis=0)
        return total
