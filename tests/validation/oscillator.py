"""Two damped motions with an exact solution that a case file can describe.

Both bodies are a square of side 1 m made of one cell, with Rayleigh damping C = α M + β K:

- `coasting`: it flies freely. Stiffness damping must not act on a translation, so the velocity is
  v(t) = v₀ e^(−αt).
- `column`: it stands on a rigid floor, unstressed, when gravity sets in. With ν = 0 its upper edge
  moves straight up and down, a damped oscillator with the mass m = ρ A L / 3 (consistent), the
  stiffness k = E A / L, the damping c = α m + β k and the load f = ρ A L g / 2. The reaction of the
  floor stays positive, so the lower edge never moves.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from runs import Array, Run, observed_order, simulate

import carom

YOUNG = 100.0  # Pa
DENSITY = 3.0  # kg/m³
DAMPING = carom.Damping(mass=1.0, stiffness=0.02)  # 1/s, s
GRAVITY = 1.0  # m/s²
SPEED = 1.0  # m/s
END = 1.0  # s

STEPS = (200, 400, 800, 1600)
"""Numbers of steps of the convergence study."""


def coasting(*, steps: int, theta: float) -> Run:
    """Throw the square; its velocity decays by mass-proportional damping."""
    return simulate(_scenario(steps=steps, theta=theta, velocity=[SPEED, 0.0]))


def coasting_velocity(time: Array) -> Array:
    """Return the exact velocity of the thrown square [m/s]."""
    velocity: Array = SPEED * np.exp(-DAMPING.mass * time)
    return velocity


def column(*, steps: int, theta: float) -> Run:
    """Let gravity act on the square that stands on a floor."""
    floor = carom.Plane(name="floor", point=[0.0, 0.0], normal=[0.0, 1.0])
    return simulate(_scenario(steps=steps, theta=theta, gravity=[0.0, -GRAVITY], obstacles=[floor]))


def column_displacement(time: Array) -> Array:
    """Return the exact vertical displacement of the column's upper edge [m]."""
    mass, stiffness, load = DENSITY / 3.0, YOUNG, DENSITY * GRAVITY / 2.0
    frequency = np.sqrt(stiffness / mass)
    ratio = (DAMPING.mass / frequency + DAMPING.stiffness * frequency) / 2.0
    damped = frequency * np.sqrt(1.0 - ratio**2)
    decay = np.exp(-ratio * frequency * time)
    phase = damped * time
    swing = np.cos(phase) + ratio * frequency / damped * np.sin(phase)
    displacement: Array = -load / stiffness * (1.0 - decay * swing)
    return displacement


def coasting_error(run: Run) -> float:
    """Return the largest error of the velocity, relative to the largest exact value."""
    return _error(run, "square.v_x", coasting_velocity)


def column_error(run: Run) -> float:
    """Return the largest error of the upper edge, relative to the largest exact value."""
    return _error(run, "top.u_y", column_displacement)


def order(runs: Sequence[Run], error: Callable[[Run], float]) -> float:
    """Return the order in Δt at which an error of runs with `STEPS` vanishes."""
    return observed_order([END / steps for steps in STEPS], [error(run) for run in runs])


def _error(run: Run, column: str, exact: Callable[[Array], Array]) -> float:
    expected = exact(run.history["time"])
    return float(np.abs(run.history[column] - expected).max() / np.abs(expected).max())


def _scenario(
    *,
    steps: int,
    theta: float,
    velocity: Sequence[float] = (0.0, 0.0),
    gravity: Sequence[float] | None = None,
    obstacles: Sequence[carom.Plane] = (),
) -> carom.Scenario:
    step = END / steps
    return carom.Scenario(
        analysis=carom.Dynamic(
            end_time=END,
            time_step=step,
            scheme=carom.Theta(theta=theta, xi=theta),
            gravity=gravity,
        ),
        output=carom.Output(
            history_every=step, track=[carom.Track(name="top", body="square", point=[0.0, 1.0])]
        ),
        materials={
            "damped": carom.LinearElastic(
                young=YOUNG, poisson=0.0, density=DENSITY, damping=DAMPING
            )
        },
        bodies=[
            carom.Body(
                name="square",
                material="damped",
                mesh=carom.Rectangle(corner=[0.0, 0.0], size=[1.0, 1.0], divisions=[1, 1]),
                velocity=velocity,
            )
        ],
        obstacles=obstacles,
        # One cell has no nodes inside that could carry the mass of its boundary.
        contact=carom.Contact(condition="gap"),
    )
