"""A large load step: a cube of 106,722 unknowns that stands on 1,089 nodes and is pressed.

Time and memory of one thread:

    RAYON_NUM_THREADS=1 .venv/bin/python benchmarks/static_large.py [friction]
"""

from __future__ import annotations

import resource
import sys
import tempfile
from time import process_time

import carom

CELLS = 32
STEPS = 2


def scenario(friction: float) -> carom.Scenario:
    """Return the cube, whose top comes down by 2 %."""
    mesh = carom.Box(corner=(0.0, 0.0, 0.0), size=(1.0, 1.0, 1.0), divisions=(CELLS,) * 3)
    return carom.Scenario(
        dimension=3,
        analysis=carom.Static(end_time=1.0, time_step=1.0 / STEPS),
        output=carom.Output(history_every=1.0 / STEPS, fields_every=1.0),
        materials={"rubber": carom.NeoHookean(young=1e6, poisson=0.3, density=1000.0)},
        bodies=[carom.Body(name="cube", material="rubber", mesh=mesh)],
        motions=[carom.Prescribed(body="cube", on="top", z="-0.02*t")],
        obstacles=[carom.Plane(name="floor", point=(0.0, 0.0, 0.0), normal=(0.0, 0.0, 1.0))],
        contact=carom.Contact(friction=friction),
    )


def main() -> None:
    """Press the cube."""
    friction = float(sys.argv[1]) if len(sys.argv) > 1 else 0.3
    begun = process_time()
    with tempfile.TemporaryDirectory() as folder:
        summary = carom.run(scenario(friction), out=f"{folder}/out").summary
    seconds = (process_time() - begun) / summary["steps"]
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
    print(
        f"friction {friction:g}: {summary['status']}, {summary['newton_iterations']} iterations in "
        f"{summary['steps']} load steps, {seconds:.1f} s of one thread each, {memory:.2f} GB"
    )


if __name__ == "__main__":
    main()
