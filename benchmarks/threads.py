"""What two threads save where there are many bodies or contacts: wall time of one over theirs.

Runs of one and of two threads take turns; the least time of each counts. What both come to is
compared to the last bit.

    .venv/bin/python benchmarks/threads.py [--runs 3]
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from time import perf_counter

import many_bodies

import carom

CASES = ("discs", "balls", "block", "massless-block")
LAYERS = 8


def scenario(name: str) -> carom.Scenario:
    """Return a pile of 1,000 discs or 64 balls, or a block that lands on 5,041 nodes.

    Whether these nodes have mass is what the step's equations, and its work, depend on.
    """
    if name == "discs":
        return many_bodies.pile(2, 1000)
    if name == "balls":
        return many_bodies.pile(3, 64)
    cells = 70
    width = 1.0 / cells
    step = width / 63.0
    speed = 1e-3 * width / step
    return carom.Scenario(
        dimension=3,
        analysis=carom.Dynamic(end_time=20 * step, time_step=step, scheme=carom.Conserving()),
        output=carom.Output(fields_every=1e3, history_every=1e3),
        materials={"rubber": carom.SaintVenantKirchhoff(young=2700.0, poisson=0.33, density=1.0)},
        bodies=[
            carom.Body(
                name="block",
                material="rubber",
                mesh=carom.Box(
                    corner=[0.0, 0.0, 1.5 * speed * step],
                    size=[1.0, 1.0, LAYERS * width],
                    divisions=[cells, cells, LAYERS],
                ),
                velocity=[0.3 * speed, 0.0, -speed],
            )
        ],
        obstacles=[carom.Plane(name="floor", point=[0.0, 0.0, 0.0], normal=[0.0, 0.0, 1.0])],
        contact=carom.Contact(
            condition="massless" if name == "massless-block" else "midpoint",
            friction=0.2,
            sources="finer",
            targets="faceted",
        ),
    )


def measure(name: str) -> dict[str, object]:
    """Return energies, and the wall time of the steps after those that make factors."""
    case = scenario(name)
    simulation = carom.Simulation(case)
    simulation.step()
    simulation.step()
    begun = perf_counter()
    simulation.advance(case.analysis.end_time)
    wall = perf_counter() - begun
    energy = simulation.energy
    return {"wall": wall, "energies": [energy.kinetic.hex(), energy.strain.hex()]}


def run(name: str, threads: int) -> dict[str, object]:
    """Measure a case in a process of so many threads."""
    environment = {**os.environ, "RAYON_NUM_THREADS": str(threads)}
    command = [sys.executable, __file__, "--case", name]
    done = subprocess.run(command, env=environment, check=True, capture_output=True, text=True)
    return dict(json.loads(done.stdout))


def main() -> None:
    """Print a line for every case."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument(
        "--case", choices=CASES, help="measure this one here, for the program itself"
    )
    arguments = parser.parse_args()
    if arguments.case:
        print(json.dumps(measure(arguments.case)))
        return
    for name in CASES:
        made = [[run(name, threads) for threads in (1, 2)] for _ in range(arguments.runs)]
        one, two = (min(float(str(pair[k]["wall"])) for pair in made) for k in (0, 1))
        same = len({str(each["energies"]) for pair in made for each in pair}) == 1
        print(
            f"{name}: {one:.2f} s with one thread, {two:.2f} s with two, ratio {one / two:.2f}, "
            f"{'the same' if same else 'OTHER'} bits",
            flush=True,
        )


if __name__ == "__main__":
    main()
