"""Many bodies: what a pile of discs or balls takes to set up, per body and step, and in memory.

Bodies inside a pile have more neighbours than those at its rim, so that time is told per pair of
neighbours, too.

Processor time of one thread:

    RAYON_NUM_THREADS=1 .venv/bin/python benchmarks/many_bodies.py 2 10 100 1000 10000
    RAYON_NUM_THREADS=1 .venv/bin/python benchmarks/many_bodies.py 3 8 64 512 4096
    RAYON_NUM_THREADS=1 .venv/bin/python benchmarks/many_bodies.py 2 10 100 --condition massless
"""

from __future__ import annotations

import argparse
import math
import subprocess
import sys
from pathlib import Path
from time import process_time

import numpy as np
from scipy.spatial import KDTree

import carom

RADIUS = 0.05
STEP = 5e-4
STEPS = 40
CONDITIONS = ("midpoint", "gap", "massless")


def pile(
    dimension: int,
    count: int,
    *,
    steps: int = STEPS,
    damping: float = 20.0,
    condition: str = "midpoint",
    young: float = 5e6,
) -> carom.Scenario:
    """Return bodies in layers above a floor, each a little off its place, about to touch.

    The damping [1/s] is that of their mass, `young` their Young's modulus [Pa].
    """
    rng = np.random.default_rng(1)
    side = max(2, round(count ** (1 / dimension)))
    pitch = 2.0005 * RADIUS
    bodies = []
    for i in range(count):
        place = np.array([i // side**k % side for k in range(dimension)], dtype=float)
        place[-1] = i // side ** (dimension - 1)
        # Every other layer rests between the bodies of the one below.
        place[:-1] += 0.5 * (place[-1] % 2) + 1e-4 * rng.random(dimension - 1)
        place[-1] *= math.sqrt(1.0 - 0.25 * (dimension - 1))
        centre = (place * pitch + 1.0003 * RADIUS).tolist()
        mesh = (
            carom.Disc(centre=centre, radius=RADIUS, divisions=4)
            if dimension == 2
            else carom.Ball(centre=centre, radius=RADIUS, divisions=2)
        )
        bodies.append(carom.Body(name=f"b{i}", material="rubber", mesh=mesh))
    up = (0.0,) * (dimension - 1) + (1.0,)
    width = (side + 0.5) * pitch
    walls = [carom.Plane(name="floor", point=(0.0,) * dimension, normal=up)]
    for k in range(dimension - 1):
        for at, sense in ((0.0, 1.0), (width, -1.0)):
            point, normal = np.zeros(dimension), np.zeros(dimension)
            point[k], normal[k] = at, sense
            walls.append(
                carom.Plane(
                    name=f"wall-{k}{sense:+g}", point=point.tolist(), normal=normal.tolist()
                )
            )
    law = carom.SaintVenantKirchhoff(
        young=young,
        poisson=0.3,
        density=1100.0,
        damping=carom.Damping(mass=damping, stiffness=2e-4),
    )
    return carom.Scenario(
        dimension=dimension,
        analysis=carom.Dynamic(
            gravity=tuple(-9.81 * x for x in up),
            end_time=steps * STEP,
            time_step=STEP,
            scheme=carom.Conserving(),
        ),
        output=carom.Output(history_every=steps * STEP / 4, fields_every=steps * STEP),
        materials={"rubber": law},
        bodies=bodies,
        obstacles=walls,
        contact=carom.Contact(condition=condition, friction=0.3),
    )


def neighbours(case: carom.Scenario) -> int:
    """Return how many pairs of bodies are close enough to touch, one at least."""
    centres = np.array([body.mesh.centre for body in case.bodies])
    return max(1, len(KDTree(centres).query_pairs(2.02 * RADIUS)))


def measure(dimension: int, count: int, condition: str) -> None:
    """Set up and run a pile."""
    case = pile(dimension, count, condition=condition)
    begun = process_time()
    simulation = carom.Simulation(case)
    set_up = process_time() - begun
    begun = process_time()
    # Factors are made in the first step.
    simulation.step()
    first = process_time() - begun
    begun = process_time()
    simulation.advance(case.analysis.end_time)
    steps = process_time() - begun
    with Path("/proc/self/status").open(encoding="ascii") as status:
        peak = next(int(line.split()[1]) for line in status if line.startswith("VmHWM"))
    ledger = simulation.ledger
    print(
        f"{dimension}D {count:6d} bodies: set-up {set_up:6.2f} s, first step {first:6.2f} s, "
        f"{1e6 * steps / count / (STEPS - 1):6.1f} us per body and step, "
        f"{1e6 * steps / neighbours(case) / (STEPS - 1):6.1f} per pair, {peak / 1e6:5.2f} GB, "
        f"friction {ledger.friction:.3g} J, defect {ledger.defect:.1e} J",
        flush=True,
    )


def main() -> None:
    """Measure every pile in a process of its own, so that memory is its own."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("dimension", type=int, choices=(2, 3))
    parser.add_argument("counts", type=int, nargs="+")
    parser.add_argument("--condition", default="midpoint", choices=CONDITIONS)
    arguments = parser.parse_args()
    if len(arguments.counts) == 1:
        measure(arguments.dimension, arguments.counts[0], arguments.condition)
        return
    for count in arguments.counts:
        of_pile = [str(arguments.dimension), str(count), "--condition", arguments.condition]
        subprocess.run([sys.executable, __file__, *of_pile], check=True)


if __name__ == "__main__":
    main()
