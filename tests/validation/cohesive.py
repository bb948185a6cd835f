"""Blocks that hold on to floors and to one another, and their closed forms."""

from __future__ import annotations

import numpy as np

import carom

GRAVITY = 10.0
LENGTH, HEIGHT, WIDTH = 1.0, 0.5, 0.4
YOUNG = 1e6
NEAR = 1e-6
"""How near to the limit loads come, relative to it, from both sides."""


def rectangle(dimension, divisions, *, lift=0.0, height=HEIGHT):
    """A block of the same length in the plane and in space, whose foot is at `lift`."""
    if dimension == 2:
        return carom.Rectangle(
            corner=[0.0, lift], size=[LENGTH, height], divisions=list(divisions[:2])
        )
    return carom.Box(
        corner=[0.0, 0.0, lift], size=[LENGTH, WIDTH, height], divisions=list(divisions)
    )


def up(dimension, value):
    """A vector of the height alone."""
    return [*([0.0] * (dimension - 1)), value]


def area(dimension):
    """Area of a foot [m²]."""
    return LENGTH * (1.0 if dimension == 2 else WIDTH)


def floor(dimension, angle=0.0):
    """A plane through the origin, that falls along x."""
    normal = up(dimension, np.cos(angle))
    normal[0] = np.sin(angle)
    return carom.Plane(name="floor", point=[0.0] * dimension, normal=normal)


def pulled_off(dimension, cohesion, limit, **contact):
    """An elastic block whose top is pulled up to just below, then just above a force `limit` [N].

    ν = 0, so that the stress is uniform.
    """
    stretch = limit / area(dimension) / YOUNG * HEIGHT
    held = dict.fromkeys("xy" if dimension == 3 else "x", 0.0)
    held["xyz"[dimension - 1]] = carom.Table(
        time=[0.0, 1.0, 2.0], value=[0.0, (1 - NEAR) * stretch, (1 + NEAR) * stretch]
    )
    return carom.Scenario(
        dimension=dimension,
        analysis=carom.Static(end_time=2.0, time_step=1.0),
        materials={"soft": carom.LinearElastic(young=YOUNG, poisson=0.0, density=1000.0)},
        bodies=[
            carom.Body(name="block", material="soft", mesh=rectangle(dimension, [4, 2, 3]))
        ],
        obstacles=[floor(dimension)],
        motions=[carom.Prescribed(body="block", on="top", **held)],
        contact=carom.Contact(cohesion=cohesion, **contact),
        output=carom.Output(history_every=1.0, fields_every=1.0),
    )


def flat(dimension, mass=1.0, **given):
    """A flat rigid block on the floor."""
    return carom.RigidBody(
        name="block", mass=mass, mesh=rectangle(dimension, [4, 2, 1], height=0.05), **given
    )


def hanging(dimension, cohesion, condition):
    """A rigid block of 1 kg under a ceiling, which is a floor with gravity upwards."""
    return carom.Scenario(
        dimension=dimension,
        analysis=carom.Dynamic(
            end_time=0.1,
            time_step=1e-3,
            scheme=carom.Conserving(),
            gravity=up(dimension, GRAVITY),
        ),
        bodies=[flat(dimension)],
        obstacles=[floor(dimension)],
        contact=carom.Contact(condition=condition, cohesion=cohesion),
        output=carom.Output(history_every=1e-3, fields_every=0.1, checkpoint_every=0.01),
    )


def on_an_incline(dimension, angle, friction, stress, **given):
    """A rigid block of 1 kg on a floor, where gravity falls by an angle [rad] against it."""
    gravity = up(dimension, -GRAVITY * np.cos(angle))
    gravity[0] = GRAVITY * np.sin(angle)
    return carom.Scenario(
        dimension=dimension,
        analysis=carom.Dynamic(
            end_time=0.2, time_step=1e-3, scheme=carom.Conserving(), gravity=gravity
        ),
        bodies=[flat(dimension)],
        obstacles=[floor(dimension)],
        contact=carom.Contact(friction=friction, cohesion=stress, **given),
        output=carom.Output(history_every=1e-3, fields_every=0.2),
    )


def sheared(dimension, friction, cohesion, **contact):
    """An elastic block whose top is pressed down, then pushed along the floor until it slides."""
    press, along = dict.fromkeys("xy"[: dimension - 1], 0.0), 2e-2
    press["x"] = carom.Table(time=[0.0, 1.0, 6.0], value=[0.0, 0.0, along])
    press["xyz"[dimension - 1]] = carom.Table(time=[0.0, 1.0, 6.0], value=[0.0, -1e-3, -1e-3])
    return carom.Scenario(
        dimension=dimension,
        analysis=carom.Static(end_time=6.0, time_step=0.5),
        materials={"soft": carom.LinearElastic(young=YOUNG, poisson=0.3, density=1000.0)},
        bodies=[
            carom.Body(
                name="block", material="soft", mesh=rectangle(dimension, [4, 2, 2], height=0.2)
            )
        ],
        obstacles=[floor(dimension)],
        motions=[carom.Prescribed(body="block", on="top", **press)],
        contact=carom.Contact(friction=friction, cohesion=cohesion, **contact),
        output=carom.Output(history_every=0.5, fields_every=6.0),
    )


def bouncing(dimension, condition, cohesion, **given):
    """An elastic block that falls obliquely on a floor and holds on to it."""
    velocity = up(dimension, -1.0)
    velocity[0] = 0.7
    return carom.Scenario(
        dimension=dimension,
        analysis=carom.Dynamic(
            end_time=given.pop("end_time", 0.1),
            time_step=5e-4,
            scheme=carom.Conserving(),
            gravity=up(dimension, -GRAVITY),
        ),
        materials={"soft": carom.SaintVenantKirchhoff(young=YOUNG, poisson=0.3, density=1000.0)},
        bodies=[
            carom.Body(
                name="block",
                material="soft",
                mesh=rectangle(dimension, [5, 3, 2], lift=0.01, height=0.3),
                velocity=velocity,
            )
        ],
        obstacles=[floor(dimension)],
        contact=carom.Contact(condition=condition, friction=0.3, cohesion=cohesion),
        output=carom.Output(history_every=5e-4, fields_every=0.1, checkpoint_every=0.01),
    )
