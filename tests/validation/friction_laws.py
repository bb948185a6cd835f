"""Masses on springs and blocks with laws of friction, and their closed forms."""

from __future__ import annotations

import math

import numpy as np

import carom

MASS, GRAVITY = 1.0, 10.0
LOAD = MASS * GRAVITY


def on_a_spring(friction, *, stiffness, time_step, start=0.0, velocity=0.0, belt=0.0):
    """A mass on a belt that moves, held by a spring that is slack at x = 0."""

    def energy(u):
        x, y = u[0::2], u[1::2]
        return 0.25 * stiffness * np.sum((x + start) ** 2) + 0.5 * LOAD * np.sum(y)

    def force(u):
        f = np.empty(4)
        f[0::2] = 0.5 * stiffness * (u[0::2] + start)
        f[1::2] = 0.5 * LOAD
        return f

    body = carom.ForeignBody(
        "mass",
        [[0.0, 0.0], [1.0, 0.0]],
        [[0, 1]],
        mass=0.5 * MASS * np.eye(4),
        energy=energy,
        force=force,
        stiffness=lambda _: np.diag([0.5 * stiffness, 0.0] * 2),
        velocity=[velocity, 0.0],
    )
    floor = carom.Plane(name="belt", point=[0, 0], normal=[0, 1], velocity=[belt, 0.0])
    return carom.ForeignRun(
        [body], [floor], time_step=time_step, contact=carom.Contact(friction=friction)
    )


def travelled(simulation, steps, start=0.0):
    """Places of the mass after every step."""
    places = np.full(steps + 1, start)
    for k in range(1, steps + 1):
        simulation.step()
        places[k] = start + simulation.displacement("mass")[0, 0]
    return places


def spells(sticks):
    """Lengths of the spells of sticking and of sliding that begin and end, in steps."""
    turns = np.flatnonzero(np.diff(sticks.astype(int)))
    lengths = np.diff(turns)
    first_is_stuck = bool(sticks[turns[0] + 1])
    return lengths[0 if first_is_stuck else 1 :: 2], lengths[1 if first_is_stuck else 0 :: 2]


STATIC, KINETIC, STIFFNESS, BELT = 0.6, 0.3, 100.0, 0.1
OMEGA = math.sqrt(STIFFNESS / MASS)
EXCESS = (STATIC - KINETIC) * LOAD / STIFFNESS
STICK = 2.0 * EXCESS / BELT
SLIP = 2.0 / OMEGA * (math.pi - math.atan(OMEGA * EXCESS / BELT))
AMPLITUDE = math.hypot(EXCESS, BELT / OMEGA)


def stick_slip(time_step):
    """Relative errors of the times of sticking and sliding, and of the amplitude."""
    law = carom.StaticKinetic(static=STATIC, kinetic=KINETIC)
    simulation = on_a_spring(
        law, stiffness=STIFFNESS, time_step=time_step, velocity=BELT, belt=BELT
    )
    x = travelled(simulation, round((STICK + 3.2 * (STICK + SLIP)) / time_step))
    stuck, slid = spells(np.abs(np.diff(x) - BELT * time_step) < 1e-9 * BELT * time_step)
    centre = KINETIC * LOAD / STIFFNESS
    return (
        abs(stuck[:2].mean() * time_step / STICK - 1.0),
        abs(slid[:2].mean() * time_step / SLIP - 1.0),
        abs((x.max() - centre) / AMPLITUDE - 1.0),
        abs((centre - x[len(x) // 3 :].min()) / AMPLITUDE - 1.0),
    )


def oscillation(static, kinetic, *, time_step=1e-4, start=0.1):
    """Amplitudes of every half cycle of a mass on a spring [m], as reached and as wanted.

    They fall by 2 μ_k N/k until the spring no longer moves the mass, k |x| ≤ μ_s N.
    """
    law = kinetic if static == kinetic else carom.StaticKinetic(static=static, kinetic=kinetic)
    simulation = on_a_spring(law, stiffness=STIFFNESS, time_step=time_step, start=start)
    x = travelled(simulation, round(2.0 / time_step), start)
    wanted = [start]
    while wanted[-1] > static * LOAD / STIFFNESS:
        wanted.append(abs(wanted[-1] - 2.0 * kinetic * LOAD / STIFFNESS))
    turns = [k for k in range(1, len(x) - 1) if (x[k] - x[k - 1]) * (x[k + 1] - x[k]) < 0.0]
    assert np.ptp(x[-100:]) < 1e-12, "it rests"
    reached = [start, *np.abs(x[turns]), abs(x[-1])]
    return np.array([*reached[: len(wanted) - 1], abs(x[-1])]), np.array(wanted)


CRITICAL = 0.02
"""Distance of slip weakening [m]."""


def weakening(time_step):
    """What friction takes as it weakens [J], and by hand: N (μ_k S + (μ_s − μ_k) D_c/2).

    Besides the largest defect and certificate of a step [J].
    """
    static, kinetic = 0.6, 0.2
    law = carom.StaticKinetic(static=static, kinetic=kinetic, distance=CRITICAL)
    simulation = on_a_spring(law, stiffness=2000.0, time_step=time_step, velocity=BELT, belt=BELT)
    taken, slip, place, defect, certificate = 0.0, 0.0, 0.0, 0.0, 0.0
    for _ in range(round(0.5 / time_step)):
        step = simulation.step()
        now = simulation.displacement("mass")[0, 0]
        taken += step.friction
        slip += abs(now - place - BELT * time_step)
        place = now
        defect, certificate = max(defect, abs(step.defect)), max(certificate, step.certificate)
    assert slip > 1.5 * CRITICAL
    by_hand = LOAD * (kinetic * slip + 0.5 * (static - kinetic) * CRITICAL)
    return taken, by_hand, defect, certificate


def sliding_block(friction, **given):
    """A rigid block that slides on a floor."""
    step = given.pop("time_step", 1e-3)
    return carom.Scenario(
        dimension=2,
        analysis=carom.Dynamic(
            end_time=given.pop("end_time", 0.3),
            time_step=step,
            scheme=carom.Conserving(),
            gravity=[0.0, -GRAVITY],
        ),
        bodies=[
            carom.RigidBody(
                name="block",
                mass=MASS,
                mesh=carom.Rectangle(corner=[0.0, 0.0], size=[1.0, 0.1], divisions=[1, 1]),
                velocity=[1.0, 0.0],
            )
        ],
        obstacles=[carom.Plane(name="floor", point=[0, 0], normal=[0, 1])],
        contact=carom.Contact(friction=friction, **given),
        output=carom.Output(history_every=step, fields_every=0.1, checkpoint_every=0.1),
    )
