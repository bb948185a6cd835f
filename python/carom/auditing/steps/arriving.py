"""Contacts that come to their target with the end of a step: they land in the next one."""

from __future__ import annotations

import numpy as np

from carom.auditing.arrays import Array, Mask
from carom.auditing.model import AuditModel
from carom.auditing.steps.mobility import mobilities
from carom.auditing.steps.scales import Scales
from carom.auditing.steps.step import Step

LANDED = 1e-8
"""A contact that was open has landed once it has taken more than this part of the impulse that it
would take to stop what is in its way."""


def arriving(step: Step, scales: Scales) -> tuple[Mask, Mask]:
    """Return which contacts of a step surely only arrive, and which perhaps do, shape [count].

    With impulses of landing a contact that was open at the start by g would take m b g, b of
    v₊ = a v + b d. What took next to nothing of that presses in the next step, where it is counted.
    """
    found, model = step.touching.pressed, step.model
    none = np.zeros(len(found), dtype=bool)
    if model.static or not (model.condition == "midpoint" or model.mixed):
        return none, none
    # What holds is closed as it is, and has nothing to land on.
    ruled = ~found.massless & (found.adhesion == 0.0)
    gap, off = step.touching.start_gaps, scales.geometry(step)
    whole = LANDED * _masses(step, scales) / (model.theta * step.dt)
    impulse = step.dt * found.normal_force
    doubt = step.dt * scales.least_reaction(step.dt)
    perhaps = ruled & (gap > -off) & (impulse <= whole * np.maximum(gap + off, 0.0) + doubt)
    surely = ruled & (gap > off) & (impulse <= whole * (gap - off) - doubt)
    # What is in the way where a body is not known is at most all of it.
    unknown = [index for index, body in enumerate(model.bodies) if not body.known]
    surely &= ~(np.isin(found.source, unknown) | np.isin(found.target, unknown))
    # A reaction that is round-off is one beside a gap, too.
    return surely, perhaps | (ruled & (np.abs(impulse) <= doubt) & (gap > off))


def _masses(step: Step, scales: Scales) -> Array:
    """Return the masses in the way of contacts [kg], if every node moved alone, shape [count]."""
    found, model = step.touching.pressed, step.model
    mobility = np.zeros(len(model.points))
    for body, mass in zip(model.bodies, scales.masses, strict=True):
        if body.known:
            mobility[body.span] = mobilities(step, body)
        elif mass > 0.0:
            mobility[body.span] = 1.0 / mass
    # Nodes may be in a stencil twice; images are what their masters are.
    yields = np.zeros(len(found))
    for nodes, weights in ((found.sources, found.shares), (found.followed, found.weights)):
        yields += (weights**2 * mobility[nodes]).sum(axis=1)
    return 1.0 / np.where(yields > 0.0, yields, np.inf)


def most_uncounted(model: AuditModel, scales: Scales, dt: float) -> float:
    """Return how much all reactions after a step of this length [s] may be if none is counted [N].

    A node closes no wider gap in a step than what two of the fastest nodes do.
    """
    most = scales.least_reaction(dt)
    if not model.static and (model.condition == "midpoint" or model.mixed):
        counts = [len(body.sources) if body.rigid else 1 for body in model.bodies]
        heavy = float(scales.masses @ counts)
        most += LANDED * heavy * 4.0 * scales.speed / (model.theta * dt)
    return most
