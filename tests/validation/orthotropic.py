"""A block pulled across a floor whose friction depends on the direction, and its closed form.

What is pulled from rest by F slides straight on along the d of length 1 with

    F − N M² d/|M d| = m a d,  M = diag(μ₁, μ₂) in the directions of friction,

if F is outside the ellipse |M⁻¹ F| ≤ N; else it stays. Friction takes N |M d| s over the way s.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from runs import simulate
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import carom

MASS, GRAVITY, ALONG, ACROSS = 2.0, 10.0, 0.15, 0.45
LOAD = MASS * GRAVITY
GRAIN = math.radians(25.0)
"""Of the direction of ALONG with x, as it is drawn on the block or the floor."""

END, STEP = 0.4, 0.01
REST = 0.1
"""For so long nothing pulls or presses, and the block may turn [s]."""


@dataclass(frozen=True)
class Slide:
    """Where a block went: way [m], its angle with x [rad], and what friction took [J]."""

    way: float
    angle: float
    taken: float


def closed_form(angle: float, pull: float, grain: float = GRAIN) -> Slide:
    """Return the slide of a block that is pulled with `pull` [N] at this angle with x."""
    across = np.array([[-math.sin(grain), math.cos(grain)], [math.cos(grain), math.sin(grain)]])
    frame = across[::-1]
    force = pull * (frame @ [math.cos(angle), math.sin(angle)])
    limits = np.array([ALONG, ACROSS])
    if np.linalg.norm(force / limits) <= LOAD:
        return Slide(0.0, 0.0, 0.0)

    def left(direction: float) -> np.ndarray:
        d = np.array([math.cos(direction), math.sin(direction)])
        return force - LOAD * limits**2 * d / np.linalg.norm(limits * d)

    def aside(direction: float) -> float:
        x, y = left(direction)
        return float(x * math.sin(direction) - y * math.cos(direction))

    # Friction that is stronger across turns the slide away from the pull, by less than π/2.
    guess = math.atan2(force[1], force[0])
    found = brentq(aside, guess - math.pi / 2, guess + math.pi / 2, xtol=1e-14)
    d = np.array([math.cos(found), math.sin(found)])
    # Forces of a step are the mean of both its ends: half of all there is in the first one.
    speeding, rest = float(left(found) @ d) / MASS, END - STEP
    first = speeding * STEP**2 / 4
    way = first + speeding * (rest**2 + rest * STEP) / 2
    sliding = frame.T @ d
    taken = LOAD * float(np.linalg.norm(limits * d)) * (way - first / 2)
    return Slide(way, math.atan2(sliding[1], sliding[0]), taken)


def pulled(
    angle: float,
    pull: float,
    *,
    of: str = "floor",
    turned: float = 0.0,
    condition: str = "midpoint",
) -> tuple[Slide, dict[str, np.ndarray]]:
    """Pull the block, after it has turned by `turned` about z, and return its history too."""
    corners = 4

    def after(value: float) -> str:
        return f"where(t > {REST}, {value / corners!r}, 0)"

    force = [after(pull * math.cos(angle)), after(pull * math.sin(angle)), after(-LOAD)]
    direction = [math.cos(GRAIN), math.sin(GRAIN), 0.0]
    friction = carom.OrthotropicFriction(along=ALONG, across=ACROSS, direction=direction, of=of)
    turn = carom.Table(time=[0.0, REST, 1.0], value=[0.0, turned, turned])
    case = carom.Scenario(
        dimension=3,
        analysis=carom.Dynamic(
            end_time=REST + END,
            time_step=STEP,
            scheme=carom.Conserving(),
            newton=carom.Newton(tolerance=1e-13),
        ),
        output=carom.Output(history_every=STEP, fields_every=1.0),
        bodies=[
            carom.RigidBody(
                name="block",
                mass=MASS,
                mesh=carom.Box(corner=[-0.5, -0.5, 0.0], size=[1.0, 1.0, 0.5], divisions=[1, 1, 1]),
            )
        ],
        motions=[carom.Guided(body="block", turn_x=0.0, turn_y=0.0, turn_z=turn)],
        loads=[carom.Force(body="block", on="bottom", force=force)],
        obstacles=[carom.Plane(name="floor", point=[0.0] * 3, normal=[0.0, 0.0, 1.0])],
        contact=carom.Contact(
            condition=condition,
            pairs=[carom.Pair(between=["block", "floor"], friction=friction)],
        ),
    )
    run = simulate(case)
    history = run.history
    x, y = (history[f"block.{k}"][-1] - history[f"block.{k}"][0] for k in "xy")
    slide = Slide(math.hypot(x, y), math.atan2(y, x), float(history["friction"][-1]))
    return slide, history


def errors(angle: float, pull: float, **given) -> tuple[float, float, float]:
    """Errors of way and friction, relative to them, and of the direction [rad]."""
    grain = GRAIN + (given.get("turned", 0.0) if given.get("of") == "block" else 0.0)
    found, wanted = pulled(angle, pull, **given)[0], closed_form(angle, pull, grain)
    turned = math.remainder(found.angle - wanted.angle, 2 * math.pi)
    return found.way / wanted.way - 1.0, found.taken / wanted.taken - 1.0, turned


def thrown(
    friction: carom.OrthotropicFriction, velocity: list[float], step: float
) -> carom.Scenario:
    """A block that slides on the floor from rest of its turn, and is slowed by friction alone."""
    return carom.Scenario(
        dimension=3,
        analysis=carom.Dynamic(
            end_time=0.1,
            time_step=step,
            scheme=carom.Conserving(),
            gravity=[0.0, 0.0, -GRAVITY],
        ),
        output=carom.Output(history_every=0.01, fields_every=1.0),
        bodies=[
            carom.RigidBody(
                name="block",
                mass=MASS,
                mesh=carom.Box(corner=[-0.5, -0.5, 0.0], size=[1.0, 1.0, 0.1], divisions=[1, 1, 1]),
                velocity=[*velocity, 0.0],
            )
        ],
        obstacles=[carom.Plane(name="floor", point=[0.0] * 3, normal=[0.0, 0.0, 1.0])],
        contact=carom.Contact(
            condition="midpoint",
            pairs=[carom.Pair(between=["block", "floor"], friction=friction)],
        ),
    )


def slowed(along, across, velocity: list[float], times: np.ndarray) -> np.ndarray:
    """Velocities of what friction slows whose coefficients are functions of the speed.

    v' = −g M² d/|M d| by an independent integrator, shape [count, 2].
    """
    turn = np.array([[math.cos(GRAIN), math.sin(GRAIN)], [-math.sin(GRAIN), math.cos(GRAIN)]])

    def rate(_time, v):
        speed = float(np.linalg.norm(v))
        d = turn @ v / speed
        limits = np.array([along(speed), across(speed)])
        return -GRAVITY * turn.T @ (limits**2 * d) / np.linalg.norm(limits * d)

    found = solve_ivp(rate, (0.0, times[-1]), velocity, t_eval=times, rtol=1e-12, atol=1e-13)
    return found.y.T
