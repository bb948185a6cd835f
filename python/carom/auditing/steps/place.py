"""Where a contact is, and the nodes of either side."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from carom.auditing.arrays import Array
from carom.auditing.steps.sites import AT_NODE

ALIKE = 1e-6
"""Shares of nodes that differ by no more are as large as one another."""


@dataclass
class Place:
    """Where a contact is.

    Parameters
    ----------
    gap, normal
        Gap [m] and normal, shape [D].
    misfit
        How far these are from what is stored, in sizes of the model.
    site, facet
        What it is, and the facet of its foot.
    sources, followed
        Nodes of either side, in the numbering of the model, with their weights.
    depth
        How deep it was inside as drawn [m]; None where that is the depth of its node.
    node, area
        Of a multiplier its node, and what of it the target covers: an area [m²], in the plane a
        length [m].
    """

    gap: float
    normal: Array
    misfit: float = np.inf
    site: int = AT_NODE
    facet: int = -1
    sources: list[tuple[int, float]] = field(default_factory=list)
    followed: list[tuple[int, float]] = field(default_factory=list)
    depth: float | None = None
    node: int = -1
    area: float = 0.0

    def named_by(self, node: int) -> bool:
        """Return whether a node is the one that takes most of what presses on the source."""
        weights: dict[int, float] = {}
        for own, weight in self.sources:
            weights[own] = weights.get(own, 0.0) + weight
        return weights.get(node, 0.0) >= max(weights.values()) - ALIKE
