"""Places that springs and masses are attached to: points that move as nodes do."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from carom.auditing.arrays import Array, Indices
from carom.auditing.bodies.mass import affine_weights
from carom.case.body import AnyBody, RigidBody


class Attached(Protocol):
    """What is attached to a body, at a point or to a set of nodes."""

    @property
    def body(self) -> str | None:
        """Name of the body."""

    @property
    def on(self) -> str | None:
        """Name of the set."""

    @property
    def point(self) -> tuple[float, ...] | None:
        """The point [m]."""


@dataclass(frozen=True)
class Place:
    """A point that moves as the mean of nodes.

    Parameters
    ----------
    nodes, shares
        Nodes, and shares of them that add up to one; none of a point that moves with no body.
    at
        Where it is in the reference configuration [m], shape [D].
    """

    nodes: Indices
    shares: Array
    at: Array


def place_on(entry: AnyBody, points: Array, point: Array) -> Place:
    """Return the place of a point of a body: of one that deforms its nearest node.

    Of a rigid body it is the mean of all nodes with the weights of least norm that have it there.
    """
    arms = points - point
    nearest = np.array([np.linalg.norm(arms, axis=1).argmin()])
    if not isinstance(entry, RigidBody):
        return Place(nearest, np.ones(1), points[nearest[0]])
    shares = affine_weights(arms)
    assert shares is not None, "the nodes of a body are not on one line"
    return Place(np.arange(len(points)), shares, point)


def mean_of(places: Sequence[Place]) -> Place:
    """Return the mean of places."""
    share = 1.0 / len(places)
    return Place(
        nodes=np.concatenate([place.nodes for place in places]),
        shares=np.concatenate([share * place.shares for place in places]),
        at=np.mean([place.at for place in places], axis=0),
    )
