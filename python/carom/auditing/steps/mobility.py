"""By how much impulses move the nodes of bodies, each alone."""

from __future__ import annotations

import numpy as np

from carom.auditing.arrays import Array, turned
from carom.auditing.bodies.body import AuditBody
from carom.auditing.drives.guides import Guiding
from carom.auditing.steps.states import States


def mobilities(states: States, body: AuditBody) -> Array:
    """Return by how much an impulse on each node alone moves it [1/kg], shape [node_count]."""
    if not body.moves_as_a_whole:
        mass = body.folded(body.mass.sizes)[body.masters]
        return np.where(mass > 0.0, 1.0 / np.where(mass > 0.0, mass, 1.0), 0.0)
    # In the mean over the directions, as drawn.
    arms = body.arms(0.0 * body.points)
    guiding = states.rigid(body).guiding if body.rigid else Guiding.none(body.dimension)
    mobility = np.full(len(arms), float((~guiding.along).sum()) / body.mass.total)
    if body.modes is not None:
        mobility += (body.vibrations.shapes**2).sum(axis=(1, 2))
    about = np.flatnonzero(~guiding.about)
    if len(about):
        inertia = body.inertia(0.0 * body.points)
        inverse = np.linalg.inv(inertia[np.ix_(about, about)])
        axes = np.eye(len(inertia))[about]
        fields = np.stack([turned(arms, axis) for axis in axes])
        mobility += np.einsum("ani,ab,bni->n", fields, inverse, fields)
    return mobility / body.dimension
