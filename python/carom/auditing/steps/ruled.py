"""What the laws of contact are about: motions and velocities as the condition rules them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.auditing.arrays import Array
from carom.auditing.steps.contacts import Contacts
from carom.auditing.steps.step import Step


@dataclass(frozen=True)
class Ruled:
    """How contacts move in a step in the variables of their laws, as numbers and vectors.

    Parameters
    ----------
    normal
        w_n of Signorini's law by the contact condition [m].
    across
        w_t of Coulomb's law [m].
    slip
        How they slide in the step [m].
    rate
        What makes the speed of slip of w_t [1/s].
    """

    normal: Array
    across: Array
    slip: Array
    rate: Array

    @classmethod
    def of(cls, step: Step) -> Ruled:
        """Return the motions of the contacts of a step with the reactions that bore its motion."""
        found, model = step.touching.pressed, step.model
        w_n, w_t = found.relative(step.d, found.shift)
        w_n = w_n - found.widening
        # Where time stands still nothing has a speed.
        slip, rate = w_t, np.full(len(found), 0.0 if step.settles else 1.0 / step.dt)
        # What is open at the start may be closed, and what is as good as closed is.
        landed = w_n + np.maximum(step.touching.start_gaps, 0.0)
        ruled_by_motion = np.where(np.abs(landed) < np.abs(w_n), landed, w_n)
        if model.condition in ("gap", "massless"):
            # Pairs that are checked from both sides may keep a penetration.
            kept = np.array(
                [side is not None and side.two_sided for side in found.side], dtype=bool
            )
            w_n = np.where(kept, np.maximum(found.gap, 0.0), found.gap)
            if model.mixed:
                w_n = np.where(found.massless, w_n, ruled_by_motion)
        elif model.condition == "midpoint":
            w_n = ruled_by_motion
        elif model.condition == "endpoint":
            given = [None if side is None else side.restitution for side in found.side]
            ruled = np.array([e is not None for e in given], dtype=bool)
            driven = _driven(step, found)
            met, across = found.relative(step.met, driven)
            # Only impacts of what is rigid are about velocities half way.
            before = np.where(ruled, met, found.relative(step.v0, driven)[0])
            before = before - found.widening / step.dt
            w_n = w_n + (model.theta - 1) * step.dt * before
            bounce = np.array([0.0 if e is None else e for e in given])
            w_n = w_n + model.theta * step.dt * bounce * before
            w_t = np.where(ruled[:, None], w_t + (model.theta - 1) * step.dt * across, w_t)
            rate = np.where(ruled, rate / model.theta, rate)
        return cls(normal=w_n, across=w_t, slip=slip, rate=rate)


def _driven(step: Step, found: Contacts) -> Array:
    """Return the velocities of the obstacles of contacts at the start of a step [m/s]."""
    velocity, start = np.zeros_like(found.shift), float(step.start["time"])
    for k, target in enumerate(found.target):
        if target < 0 and -1 - target < len(step.model.obstacles):
            velocity[k] = step.model.obstacles[-1 - target].travel.velocity(start)
    return velocity
