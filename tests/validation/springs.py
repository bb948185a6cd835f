"""Masses on springs and dampers, and their closed forms.

A rigid block hangs between nothing but its spring, or slides on a floor, or lies on a belt. Under
the conserving scheme a linear oscillator turns in its phase plane by 2 arctan(ω Δt/2) in every
step, so that its places are known to round-off and not only to the order of the scheme.
"""

from __future__ import annotations

import math

import numpy as np
from runs import Run, observed_order, simulate

import carom

MASS, STIFFNESS, GRAVITY = 2.0, 50.0, 10.0
OMEGA = math.sqrt(STIFFNESS / MASS)
PERIOD = 2.0 * math.pi / OMEGA
SPEED = 0.5
LENGTH = 3.0
"""Of the springs as they are drawn, from the centre of the block to the wall [m]."""

BLOCK = carom.Rectangle(corner=[-0.5, -0.5], size=[1.0, 1.0], divisions=[1, 1])
CENTRE = carom.Place(body="block", point=[0.0, 0.0])
WALL = carom.Place(point=[-LENGTH, 0.0])


def block(**given):
    """A rigid block of 1 m around the origin."""
    return carom.RigidBody(name="block", mass=MASS, mesh=BLOCK, **given)


def scenario(bodies, springs, *, time_step, end_time, scheme=None, gravity=None, **given):
    """A case whose history has every step."""
    analysis = carom.Dynamic(
        end_time=end_time,
        time_step=time_step,
        scheme=scheme or carom.Conserving(),
        newton=carom.Newton(tolerance=1e-12),
        gravity=gravity,
    )
    output = carom.Output(history_every=time_step, fields_every=end_time)
    return carom.Scenario(
        dimension=2, analysis=analysis, bodies=bodies, springs=springs, output=output, **given
    )


FOOT = (carom.Place(point=[-LENGTH, -0.5]), carom.Place(body="block", point=[0.0, -0.5]))
"""The two ends of a spring along the floor, in line with friction: nothing tips the block."""


def spring(between=(WALL, CENTRE), **given):
    """A spring from the wall to the centre of the block."""
    return carom.Spring(name="spring", between=between, **given)


def oscillator(*, steps_per_period, periods, stiffness=STIFFNESS, damping=0.0, scheme=None):
    """The block leaves the place where its spring is slack."""
    step = PERIOD / steps_per_period
    case = scenario(
        [block(velocity=[SPEED, 0.0])],
        [spring(stiffness=stiffness, damping=damping)],
        time_step=step,
        end_time=periods * PERIOD,
        scheme=scheme,
    )
    return simulate(case)


def swing(run: Run):
    """Errors of a conserving oscillator over its amplitude.

    Of its places against the phase plane, of the same against the motion without steps, and the
    largest drift of its energy over the energy.
    """
    time, x = run.history["time"], run.history["block.x"]
    step, amplitude = time[1] - time[0], SPEED / OMEGA
    turned = 2.0 * math.atan(0.5 * OMEGA * step) * np.arange(len(time))
    drift = np.abs(run.curve("total") - 1.0).max()
    exact = amplitude * np.sin(OMEGA * time)
    places = np.abs(x - amplitude * np.sin(turned)).max() / amplitude
    return places, np.abs(x - exact).max() / amplitude, drift


RATIO = 0.05
"""Damping over the critical."""

DAMPING = 2.0 * RATIO * MASS * OMEGA
DECREMENT = 2.0 * math.pi * RATIO / math.sqrt(1.0 - RATIO**2)


def decrement(run: Run):
    """The mean logarithmic decrement of the swings to one side."""
    x = run.history["block.x"]
    peaks = [k for k in range(1, len(x) - 1) if x[k] > 0.0 and x[k - 1] < x[k] >= x[k + 1]]
    tops = [
        x[k] - (x[k + 1] - x[k - 1]) ** 2 / (8 * (x[k + 1] - 2 * x[k] + x[k - 1])) for k in peaks
    ]
    return math.log(tops[0] / tops[-1]) / (len(tops) - 1)


def decrements(steps=(50, 100, 200)):
    """Errors of the decrement over it, and their order in the step."""
    errors = [
        abs(decrement(oscillator(steps_per_period=n, periods=5.0, damping=DAMPING)) / DECREMENT - 1)
        for n in steps
    ]
    return errors, observed_order(1.0 / np.array(steps), errors)


FLOOR = carom.Plane(name="floor", point=[0.0, -0.5], normal=[0.0, 1.0])
FRICTION = 0.1
WEIGHT = MASS * GRAVITY
FALL = 2.0 * FRICTION * WEIGHT / STIFFNESS
"""Of the amplitude in every half cycle [m]."""


def rubbed(start=0.37, time_step=1e-4):
    """Amplitudes of every half cycle of a block that rubs on a floor [m], reached and wanted."""
    case = scenario(
        [block()],
        [spring(FOOT, stiffness=STIFFNESS, free_length=LENGTH - start)],
        time_step=time_step,
        end_time=4.0 * PERIOD,
        gravity=[0.0, -GRAVITY],
        obstacles=[FLOOR],
        contact=carom.Contact(friction=FRICTION),
    )
    history = simulate(case).history
    x = history["block.x"] + start
    wanted = [start]
    while wanted[-1] > 0.5 * FALL:
        wanted.append(abs(wanted[-1] - FALL))
    moving = np.flatnonzero(np.abs(np.diff(x)) > 1e-12)
    turns = moving[:-1][np.diff(np.sign(np.diff(x)[moving])) != 0.0] + 1
    reached = [start, *np.abs(x[turns])][: len(wanted) - 1]
    return np.array([*reached, abs(x[-1])]), np.array(wanted), history


STATIC, KINETIC, BELT = 0.6, 0.3, 0.1
EXCESS = (STATIC - KINETIC) * WEIGHT / STIFFNESS
STICK = 2.0 * EXCESS / BELT
SLIP = 2.0 / OMEGA * (math.pi - math.atan(OMEGA * EXCESS / BELT))
AMPLITUDE = math.hypot(EXCESS, BELT / OMEGA)


def stick_slip(time_step):
    """Relative errors of the times of sticking and sliding, and of the amplitude, on a belt."""
    case = scenario(
        [block(velocity=[BELT, 0.0])],
        [spring(FOOT, stiffness=STIFFNESS)],
        time_step=time_step,
        end_time=STICK + 2.2 * (STICK + SLIP),
        gravity=[0.0, -GRAVITY],
        # Held upright: what it does not turn by, its two feet bear alike.
        motions=[carom.Guided(body="block", turn_z=0.0)],
        obstacles=[FLOOR.model_copy(update={"name": "belt", "velocity": (BELT, 0.0)})],
        contact=carom.Contact(friction=carom.StaticKinetic(static=STATIC, kinetic=KINETIC)),
    )
    x = simulate(case).history["block.x"]
    stuck = np.abs(np.diff(x) - BELT * time_step) < 1e-7 * BELT * time_step
    turns = np.flatnonzero(np.diff(stuck.astype(int)))
    lengths = np.diff(turns) * time_step
    first_is_stuck = bool(stuck[turns[0] + 1])
    sticking, sliding = lengths[0 if first_is_stuck else 1 :: 2], lengths[int(first_is_stuck) :: 2]
    centre = KINETIC * WEIGHT / STIFFNESS
    return (
        abs(sticking[0] / STICK - 1.0),
        abs(sliding[0] / SLIP - 1.0),
        abs((x.max() - centre) / AMPLITUDE - 1.0),
        abs((centre - x[len(x) // 3 :].min()) / AMPLITUDE - 1.0),
    )
