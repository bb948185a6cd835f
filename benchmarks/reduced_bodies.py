"""Reduced bodies against whole ones: a steel bar that hits a wall askew.

    .venv/bin/python benchmarks/reduced_bodies.py [modes | speed] [divisions along the bar]

Prints

- for numbers of modes, how far the free end is from where the whole linear body has it, over the
  largest of its displacements, and the drift of the energy,
- time per step of the whole body and of the reduced one, and the time that reducing it takes.
"""

from __future__ import annotations

import sys
import tempfile
import warnings
from time import process_time

import numpy as np

import carom

STEEL = carom.LinearElastic(young=210e9, poisson=0.3, density=7800.0)
SIZE = (1.0, 0.05, 0.05)


def main() -> None:
    """Print what is asked for."""
    warnings.simplefilter("ignore")
    words = sys.argv[1:]
    along = next((int(word) for word in words if word.isdigit()), None)
    if "speed" not in words:
        modes(along or 40)
    if "modes" not in words:
        speed(along or 400)


def bar(along: int, across: int, modes: int | None) -> carom.Body | carom.ReducedBody:
    """Return the bar, whole or reduced to so many modes, that flies at the wall x = 0."""
    mesh = carom.Box(corner=[0.0, 0.0, 0.0], size=SIZE, divisions=[along, across, across])
    given = {
        **{"name": "bar", "material": "steel", "mesh": mesh, "contact_sets": ("left",)},
        **{"velocity": [-1.0, 0.0, 0.0], "spin": [0.0, 0.5, 1.0]},
    }
    return carom.Body(**given) if modes is None else carom.ReducedBody(modes=modes, **given)


def scenario(body: carom.Body | carom.ReducedBody, steps: int, step: float) -> carom.Scenario:
    """Return the case of a bar, with its free end tracked."""
    return carom.Scenario(
        dimension=3,
        analysis=carom.Dynamic(end_time=steps * step, time_step=step),
        materials={"steel": STEEL},
        bodies=[body],
        obstacles=[carom.Plane(name="wall", point=[0.0] * 3, normal=[1.0, 0.0, 0.0])],
        contact=carom.Contact(condition="midpoint", friction=0.2),
        output=carom.Output(
            history_every=step,
            fields_every=steps * step,
            track=[carom.Track(name="end", body="bar", point=SIZE)],
        ),
    )


def modes(along: int) -> None:
    """Compare the motion of the free end."""
    step = 2e-6
    print(f"bar of {along} x 2 x 2 cells, steps of {step:g} s")
    whole: np.ndarray | None = None
    for count in (None, 0, 4, 8, 16, 32, 64):
        with tempfile.TemporaryDirectory() as place:
            history = carom.run(scenario(bar(along, 2, count), 400, step), out=f"{place}/r").history
            end = np.column_stack([history[f"end.u_{axis}"] for axis in "xyz"])
            kept = history["total"] + history["friction"]
        whole = end if whole is None else whole
        off = np.linalg.norm(end - whole, axis=1).max() / np.linalg.norm(whole, axis=1).max()
        drift = np.abs(kept - kept[0]).max() / kept[0]
        print(f"  modes {count}: error {off:.1e}, energy drifts by {drift:.1e}")


def speed(along: int) -> None:
    """Compare the time of steps in contact."""
    step = 1e-6
    for count, steps in ((None, 10), (20, 200)):
        start = process_time()
        simulation = carom.Simulation(scenario(bar(along, 8, count), steps, step))
        made = process_time() - start
        simulation.step()
        start = process_time()
        for _ in range(steps - 1):
            simulation.step()
        took = (process_time() - start) / (steps - 1)
        unknowns = 3 * 81 * (along + 1)
        print(
            f"{'whole' if count is None else 'reduced'}: {unknowns} displacements, set up in "
            f"{made:.1f} s, {1e3 * took:.2f} ms per step"
        )


if __name__ == "__main__":
    main()
