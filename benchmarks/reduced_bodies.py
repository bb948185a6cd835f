"""Reduced bodies against whole ones: a steel bar that hits a wall askew, and a part of Gmsh.

    .venv/bin/python benchmarks/reduced_bodies.py [modes | part | speed] [divisions along the bar]
    RAYON_NUM_THREADS=1 .venv/bin/python benchmarks/reduced_bodies.py speed

Prints

- for numbers of modes, how far the free end is from where the whole linear body has it, over the
  largest of its displacements, and the largest defect of the books over the initial energy,
- the same of a bracket that lands on its feet, whose mesh Gmsh makes,
- the time of a step of the whole body and of the reduced one, where all of its end presses, where a
  corner of it does, and in flight: medians of several stretches of steps in one process, and the
  time that reducing it takes.
"""

from __future__ import annotations

import sys
import tempfile
import warnings
from collections.abc import Callable
from pathlib import Path
from statistics import median
from time import process_time

import numpy as np

import carom

STEEL = carom.LinearElastic(young=210e9, poisson=0.3, density=7800.0)
SIZE = (1.0, 0.05, 0.05)
PART = Path(__file__).parents[1] / "examples" / "standing_bracket.geo"
COUNTS = (None, 0, 4, 8, 16, 32, 64)


def main() -> None:
    """Print what is asked for."""
    warnings.simplefilter("ignore")
    words = sys.argv[1:]
    along = next((int(word) for word in words if word.isdigit()), None)
    asked = {"modes", "part", "speed"} & set(words) or {"modes", "part", "speed"}
    if "modes" in asked:
        along_bar, step = along or 40, 2e-6
        print(f"bar of {along_bar} x 2 x 2 cells, 400 steps of {step:g} s")
        track = [carom.Track(name="end", body="bar", point=SIZE)]
        compare(lambda modes: scenario(bar(along_bar, 2, modes), 400, step, track))
    if "part" in asked:
        print(f"{PART.name}, 200 steps of 2e-07 s")
        compare(part)
    if "speed" in asked:
        speed(along or 400)


def bar(along: int, across: int, modes: int | None) -> carom.Body | carom.ReducedBody:
    """Return the bar, whole or reduced to so many modes, that flies at the wall x = 0."""
    mesh = carom.Box(corner=[0.0, 0.0, 0.0], size=SIZE, divisions=[along, across, across])
    given = {
        **{"name": "bar", "material": "steel", "mesh": mesh, "contact_sets": ("left",)},
        **{"velocity": [-1.0, 0.0, 0.0], "spin": [0.0, 0.5, 1.0]},
    }
    return carom.Body(**given) if modes is None else carom.ReducedBody(modes=modes, **given)


def scenario(
    body: carom.Body | carom.ReducedBody,
    steps: int,
    step: float,
    track: list[carom.Track],
    obstacle: carom.Plane | None = None,
) -> carom.Scenario:
    """Return the case of a body that meets the wall, with a row for every step if it is tracked."""
    end = steps * step
    return carom.Scenario(
        dimension=3,
        analysis=carom.Dynamic(end_time=end, time_step=step),
        materials={"steel": STEEL},
        bodies=[body],
        obstacles=[obstacle or wall()],
        contact=carom.Contact(condition="midpoint", friction=0.2),
        output=carom.Output(history_every=step if track else end, fields_every=end, track=track),
    )


def part(modes: int | None) -> carom.Scenario:
    """Return the case of a bracket that lands on its feet, whole or reduced."""
    given = {
        **{"name": "bracket", "material": "steel", "contact_sets": ("feet",)},
        **{"mesh": carom.MeshFile(file=str(PART), body="bracket", scale=1e-3)},
        **{"velocity": [0.2, 0.0, -1.0], "spin": [5.0, 3.0, 0.0]},
    }
    body = carom.Body(**given) if modes is None else carom.ReducedBody(modes=modes, **given)
    floor = carom.Plane(name="floor", point=[0.0, 0.0, -2.01e-3], normal=[0.0, 0.0, 1.0])
    track = [carom.Track(name="end", body="bracket", point=[0.015, 0.029, 0.025])]
    return scenario(body, 200, 2e-7, track, floor)


def compare(case: Callable[[int | None], carom.Scenario]) -> None:
    """Compare the motion of the end that is tracked."""
    whole: np.ndarray | None = None
    for count in COUNTS:
        with tempfile.TemporaryDirectory() as place:
            result = carom.run(case(count), out=f"{place}/run")
            history = result.history
            end = np.column_stack([history[f"end.u_{axis}"] for axis in "xyz"])
            defect = np.abs(history["defect"]).max() / history["total"][0]
        whole = end if whole is None else whole
        off = np.linalg.norm(end - whole, axis=1).max() / np.linalg.norm(whole, axis=1).max()
        dofs = result.summary["dofs"]
        print(
            f"  modes {count}: {dofs} unknowns, error {off:.1e}, defect {defect:.1e} E0", flush=True
        )


def wall(place: float = 0.0, tilt: float = 0.0) -> carom.Plane:
    """Return the wall, moved back by `place` [m] and tilted."""
    return carom.Plane(name="wall", point=[-place, 0.0, 0.0], normal=[1.0, tilt, 0.5 * tilt])


def speed(along: int) -> None:
    """Compare the time of steps in contact and in flight."""
    step, stretches = 1e-6, 5
    walls = {"pressed by its end": wall(), "by a corner": wall(tilt=0.02), "in flight": wall(1.0)}
    for name, obstacle in walls.items():
        times = []
        for count, steps in ((None, 4), (20, 40)):
            start = process_time()
            case = scenario(bar(along, 8, count), 1 + steps * stretches, step, [], obstacle)
            simulation = carom.Simulation(case)
            made = process_time() - start
            simulation.step()
            taken = []
            for _ in range(stretches):
                start = process_time()
                for _ in range(steps):
                    last = simulation.step()
                taken.append((process_time() - start) / steps)
            times.append(median(taken))
            print(
                f"{'whole' if count is None else 'reduced'}, {name}: {243 * (along + 1)} "
                f"displacements, set up in {made:.1f} s, {1e3 * median(taken):.2f} ms per step "
                f"({1e3 * min(taken):.2f} to {1e3 * max(taken):.2f}), {last.contacts} contacts",
                flush=True,
            )
        print(f"{name} the reduced body is {times[0] / times[1]:.0f} times as fast", flush=True)


if __name__ == "__main__":
    main()
