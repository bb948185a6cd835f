"""Blocks that hold on to floors and to one another, and their closed forms."""

from __future__ import annotations

import numpy as np

import carom

GRAVITY = 10.0
LENGTH, HEIGHT, WIDTH = 1.0, 0.5, 0.4
YOUNG, POISSON, LOAD = 1e6, 0.3, 1e3
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
        bodies=[carom.Body(name="block", material="soft", mesh=rectangle(dimension, [4, 2, 3]))],
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


GLUED = carom.Cohesion(unbreakable=True)


def glued(dimension, divisions, *, analysis, material, velocity=None, **other):
    """Two blocks of half the height, one on the other, glued; of these cells in either."""
    bodies = [
        carom.Body(
            name=name,
            material="soft",
            mesh=rectangle(dimension, own, lift=lift, height=HEIGHT / 2),
            **({} if velocity is None else velocity(lift)),
        )
        for name, own, lift in zip(("lower", "upper"), divisions, (0.0, HEIGHT / 2), strict=True)
    ]
    return carom.Scenario(
        dimension=dimension,
        analysis=analysis,
        materials={"soft": material},
        bodies=bodies,
        **other,
    )


def glued_beam(*, discretisation, loads_end, thickness=0.05):
    """A clamped beam of 1 m of two pieces of other cells, glued, under a force at its end."""
    bodies = [
        carom.Body(
            name=f"piece-{number}",
            material="soft",
            hypothesis="plane-stress",
            mesh=carom.Rectangle(
                corner=[0.5 * number, 0.0],
                size=[0.5, thickness],
                divisions=[10, 2 + number],
                cell="quad9",
            ),
        )
        for number in range(2)
    ]
    names = [body.name for body in bodies]
    return carom.Scenario(
        analysis=carom.Static(end_time=1.0, time_step=0.5),
        materials={"soft": carom.LinearElastic(young=1e6, poisson=0.0, density=1e3)},
        bodies=bodies,
        motions=[carom.Fixed(body=names[0], on="left")],
        loads=[carom.Traction(body=names[-1], on="right", traction=[0.0, f"{loads_end:g}*t"])],
        contact=carom.Contact(
            pairs=[carom.Pair(between=names, cohesion=GLUED, discretisation=discretisation)]
        ),
        output=carom.Output(track=[carom.Track(name="tip", body=names[-1], point=[1.0, 0.0])]),
    )


UNLIKE = {2: ([5, 2], [4, 3]), 3: ([4, 3, 2], [3, 2, 2])}
"""Cells of two blocks that do not match."""


def patch(dimension, kind, discretisation="mortar"):
    """Glued blocks under uniform tension or shear by loads alone."""
    up_axis = "xyz"[dimension - 1]
    sides = "xy"[: dimension - 1]
    motions, loads = [], []
    if kind == "tension":
        motions.append(carom.Fixed(body="lower", on="bottom", components=[up_axis]))
        for body in ("lower", "upper"):
            for axis, side in zip(sides, ("left", "front"), strict=False):
                motions.append(carom.Fixed(body=body, on=side, components=[axis]))
        loads.append(carom.Traction(body="upper", on="top", traction=up(dimension, LOAD)))
    else:
        along = [LOAD, *([0.0] * (dimension - 1))]
        motions.append(carom.Fixed(body="lower", on="bottom"))
        loads.append(carom.Traction(body="upper", on="top", traction=along))
        for body in ("lower", "upper"):
            for side, sign in (("left", -1.0), ("right", 1.0)):
                traction = up(dimension, sign * LOAD)
                loads.append(carom.Traction(body=body, on=side, traction=traction))
    return glued(
        dimension,
        UNLIKE[dimension],
        analysis=carom.Static(end_time=1.0, time_step=1.0, newton=carom.Newton(tolerance=1e-13)),
        material=carom.LinearElastic(young=YOUNG, poisson=POISSON, density=1000.0),
        motions=motions,
        loads=loads,
        contact=carom.Contact(
            condition="gap",
            cohesion=GLUED,
            solver=carom.FrictionSolver(tolerance=1e-15),
            discretisation=discretisation,
            targets="faceted",
        ),
        output=carom.Output(fields_every=1.0),
    )


def tumbling(dimension, divisions, condition="midpoint", **contact):
    """Glued blocks that fly, turn and vibrate: the upper half sets out faster."""

    def velocity(lift):
        speed = [0.5, *([0.2] * (dimension - 1))]
        speed[0] += 2.0 * (lift > 0.0)
        spin = 4.0 if dimension == 2 else [1.0, 3.0, -2.0]
        return {"velocity": speed, "spin": spin}

    return glued(
        dimension,
        divisions,
        analysis=carom.Dynamic(
            end_time=0.1,
            time_step=1e-3,
            scheme=carom.Conserving(),
            newton=carom.Newton(tolerance=1e-12),
        ),
        material=carom.SaintVenantKirchhoff(young=YOUNG, poisson=0.3, density=1000.0),
        velocity=velocity,
        # Meshes that do not match are inside one another between their nodes.
        contact=carom.Contact(
            condition=condition, cohesion=GLUED, penetration_tolerance=0.1, **contact
        ),
        output=carom.Output(history_every=1e-3, fields_every=0.1, checkpoint_every=0.01),
    )


def patch_error(result, dimension, kind):
    """The largest error of a component of the stress in a cell, relative to the load."""
    last = dimension - 1
    # P of the loads, and the F that goes with it: the stress of Cauchy is P Fᵀ/J.
    load, deformed = np.zeros((3, 3)), np.eye(3)
    if kind == "tension":
        load[last, last] = LOAD
        # Plane strain holds the third direction.
        load[2, 2] = LOAD if dimension == 3 else POISSON * LOAD
        strain = ((1 + POISSON) * load - POISSON * np.trace(load) * np.eye(3)) / YOUNG
        deformed += strain
    else:
        load[0, last] = load[last, 0] = LOAD
        deformed[0, last] = 2.0 * (1 + POISSON) * LOAD / YOUNG
    exact = load @ deformed.T / np.linalg.det(deformed)
    stress = np.asarray(result.fields["stress"][-1]) / LOAD
    order = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)]
    wanted = np.array([exact[pair] for pair in order]) / LOAD
    return np.abs(stress - wanted[: stress.shape[1]]).max()


def thrown(dimension, *, is_glued):
    """A block that is thrown on a floor, as one or as two halves that are glued at their nodes.

    With `gap`, as impulses of landing are shared by the masses of bodies.
    """
    half = [4, 2] if dimension == 2 else [3, 2, 2]
    material = carom.SaintVenantKirchhoff(young=YOUNG, poisson=0.3, density=1000.0)
    velocity = up(dimension, -1.0)
    velocity[0] = 0.7
    if is_glued:
        parts = [("lower", half, 0.01, HEIGHT / 2), ("upper", half, 0.01 + HEIGHT / 2, HEIGHT / 2)]
    else:
        whole = [*half[:-1], 2 * half[-1]]
        parts = [("whole", whole, 0.01, HEIGHT)]
    return carom.Scenario(
        dimension=dimension,
        analysis=carom.Dynamic(
            end_time=0.04,
            time_step=5e-4,
            scheme=carom.Conserving(),
            newton=carom.Newton(tolerance=1e-13),
        ),
        materials={"soft": material},
        bodies=[
            carom.Body(
                name=name,
                material="soft",
                mesh=rectangle(dimension, cells, lift=lift, height=height),
                velocity=velocity,
            )
            for name, cells, lift, height in parts
        ],
        obstacles=[floor(dimension)],
        contact=carom.Contact(
            condition="gap",
            friction=0.3,
            pairs=[carom.Pair(between=["lower", "upper"], cohesion=GLUED)] if is_glued else [],
        ),
        output=carom.Output(history_every=5e-4, fields_every=0.04),
    )
