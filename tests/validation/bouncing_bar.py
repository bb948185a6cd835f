"""A bar that falls on a floor and bounces under gravity: the case, and its exact solution.

The case is that of the bouncing bar of D. Doyen, A. Ern & S. Piperno, *Time-integration schemes for
the finite element dynamic Signorini problem*, SIAM J. Sci. Comput. 33 (2011) 223; the solution for
any number of bounces is derived in `exact_height`.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

import numpy as np
from runs import Array, Run, simulate

import carom

LENGTH = 10.0  # m
WAVE_SPEED = 30.0  # m/s
GRAVITY = 10.0  # m/s²
DROP = 5.0  # m
DENSITY = 1.0  # kg/m³
TOUCH = math.sqrt(2.0 * DROP / GRAVITY)  # s
SPEED = GRAVITY * TOUCH  # m/s, at the touch
FALL = DENSITY * LENGTH * GRAVITY * DROP  # J, of a bar of 1 m²
CONTACT = 2.0 * LENGTH / WAVE_SPEED  # s
FLIGHT = 2.0 * SPEED / GRAVITY  # s, three times as long as the contact
FIRST_BOUNCES = 8.0  # s: three contacts
AFTER = 2.6  # s, between the first contact and the second


def exact_height(time: Array) -> Array:
    """Return the height of the lower end over the floor [m], by d'Alembert's solution.

    With the wave r = v₋ + s that runs down and s₊ = v₋ − s that runs up, where v₋ is the velocity
    [m/s] and s the stress over ρ c, either changes by −g per second along its way. Bar at v = −V
    and s = 0 meets the floor at τ = 0. At the floor v = 0; at the free end s = 0. The front is back
    at τ = 2 L/c. There the bar moves at +V everywhere, and its stress is −2 ρ g (L − x): the energy
    of gravity that the compressed bar has lost. The floor lets go, for the wave that comes down
    would pull: V > 2 g L/c.

    The bar flies, and the stress that is left vibrates about zero with the period 2 L/c. The lower
    end is where the flight of a point would be, and ∫ v dτ of the vibration below it, with
    v = −2 g (L − cτ)/c until the wave from the upper end is there, and its reverse until the period
    is over. The flight lasts 2 V/g, three periods: the bar comes down as it left, but for the sign
    of v. What follows is the first bounce backwards in time, and the bar leaves it without stress.
    From the third contact on everything repeats itself.
    """
    since = np.mod(time - TOUCH, 2.0 * (CONTACT + FLIGHT))
    bounce, local = np.divmod(since, CONTACT + FLIGHT)
    flown = local - CONTACT
    height = SPEED * flown - 0.5 * GRAVITY * flown**2
    phase = np.mod(flown, CONTACT)
    from_middle = np.abs(phase - 0.5 * CONTACT)
    sag = GRAVITY * (from_middle**2 - (0.5 * CONTACT) ** 2)
    height = np.where(bounce == 0.0, height + sag, height)
    height = np.where(local < CONTACT, 0.0, height)
    return np.where(time < TOUCH, DROP - 0.5 * GRAVITY * time**2, height)


def run(cells: int, *, bounces: float = FIRST_BOUNCES, overrides: Sequence[str] = ()) -> Run:
    """Let the bar fall, with the time step of least dispersion or the next that meets the touch."""
    size = LENGTH / cells
    step = TOUCH / math.ceil(TOUCH * WAVE_SPEED * math.sqrt(2.0) / size)
    scenario = carom.Scenario(
        title="Bouncing bar",
        dimension=2,
        analysis=carom.Dynamic(
            end_time=step * round(bounces / step), time_step=step, gravity=[0.0, -GRAVITY]
        ),
        materials={
            "elastic": carom.LinearElastic(
                young=DENSITY * WAVE_SPEED**2, poisson=0.0, density=DENSITY
            )
        },
        bodies=[
            carom.Body(
                name="bar",
                material="elastic",
                mesh=carom.Rectangle(corner=[0, DROP], size=[1.0, LENGTH], divisions=[1, cells]),
                contact_sets=["bottom"],
            )
        ],
        obstacles=[carom.Plane(name="floor", point=[0, 0], normal=[0, 1])],
        output=carom.Output(
            history_every=step,
            fields_every=bounces,
            track=[carom.Track(name="end", body="bar", point=[0.0, DROP])],
        ),
    )
    return simulate(scenario.with_overrides(overrides))


def errors(done: Run, times: Sequence[float]) -> list[float]:
    """Return the root of the mean square error of the height over the drop, between the times."""
    time = done.history["time"]
    error = (DROP + done.history["end.u_y"] - exact_height(time)) / DROP
    return [
        float(np.sqrt(np.mean(error[(time >= start) & (time < end)] ** 2)))
        for start, end in itertools.pairwise(times)
    ]
