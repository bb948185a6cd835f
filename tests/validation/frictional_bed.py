"""A thin elastic bar on a rough floor, pulled and pushed at one end.

Under a force F the bar slides over the length F/q from its end, with q the friction per length.
Between turning points that are ΔF apart, u = ΔF²/(4 E A q) as the force goes either way (Masing),
and what is between the two parabolas, the dissipation per cycle, is

    ΔF³/(12 E A q):    2 F³/(3 E A q) for ±F,    F³/(12 E A q) for 0 and F.

Goodman & Klumpp, J. Appl. Mech. 23 (1956) 421–429; Johnson, Contact Mechanics (1985), section 7.6.
"""

from __future__ import annotations

import numpy as np
from compared import Compared, iterations_per_step
from runs import Run, simulate

import carom

YOUNG = 1e9  # Pa
PRESSURE, FRICTION = 1e4, 0.5
LENGTH = 1.0  # m
SLIP = 0.5  # the part of the length that slides
TRACTION = FRICTION * PRESSURE  # N/m of a bar 1 m wide
FORCE = TRACTION * SLIP * LENGTH
SOURCE = "Masing's rule on u = F²/(2EAq)"


def cycled(cycles: int, cells: int, height: float, *, low: float = -1.0, steps: int = 1) -> Run:
    """Pull the bar with F, and then go to `low` F and back to F so many times.

    Parameters
    ----------
    cells
        Along the bar, one through its height.
    height
        Of the bar [m].
    low
        The lowest force, in terms of F.
    steps
        Load steps from one turning point to the next.
    """
    turns = 2 * cycles + 1
    force = [0.0] + [(1.0 if k % 2 == 0 else low) * FORCE / height for k in range(turns)]
    course = carom.Table(time=tuple(map(float, range(turns + 1))), value=tuple(force))
    return simulate(
        carom.Scenario(
            analysis=carom.Static(end_time=float(turns), time_step=1.0 / steps),
            output=carom.Output(history_every=1.0 / steps),
            materials={"elastic": carom.LinearElastic(young=YOUNG, poisson=0.0, density=1.0)},
            bodies=[
                carom.Body(
                    name="bar",
                    material="elastic",
                    mesh=carom.Rectangle(
                        corner=(0.0, 0.0), size=(LENGTH, height), divisions=(cells, 1)
                    ),
                )
            ],
            loads=[
                carom.Pressure(body="bar", on="top", pressure=PRESSURE),
                carom.Traction(body="bar", on="right", traction=(course, 0.0)),
            ],
            obstacles=[carom.Plane(name="floor", point=(0.0, 0.0), normal=(0.0, 1.0))],
            contact=carom.Contact(friction=FRICTION),
        )
    )


def dissipation(
    cycles: int, cells: int, *, low: float = -1.0, height: float = 0.002
) -> tuple[Compared, Compared]:
    """Return what friction takes in the first and in the last cycle [J].

    Every node slides one way between turning points, so that a load step may be as long as that.
    """
    run = cycled(cycles, cells, height, low=low)
    # Rows at the turning points: 0, F, low, F, low …; a cycle ends where the force is F again.
    taken = np.diff(run.history["friction"][1::2])
    exact = (FORCE * (1.0 - low)) ** 3 / (12.0 * YOUNG * height * TRACTION)
    load = "±F" if low < 0.0 else "0 and F"

    def compared(cycle: int) -> Compared:
        return Compared(
            f"bar of {cells} cells on a rough bed, {load}, cycle {cycle}: friction [J]",
            float(taken[cycle - 1]),
            exact,
            SOURCE,
            iterations_per_step(run),
        )

    return compared(1), compared(cycles)
