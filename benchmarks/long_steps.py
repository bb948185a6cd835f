"""Long steps of a large body: a ball lands in steps in which a wave crosses 1, 10 or 100 cells.

Processor time of one thread per step in contact, as a median, and what a step costs beside one of
the shortest:

    RAYON_NUM_THREADS=1 .venv/bin/python benchmarks/long_steps.py [--divisions 8] [--condition gap]
"""

from __future__ import annotations

import argparse
from statistics import median
from time import process_time

import carom

LENGTHS = (1, 10, 100)
CONDITIONS = ("massless", "gap", "midpoint")
STEPS = 12
WAVE_SPEED = 63.0


def landing(divisions: int, length: int, condition: str = "massless") -> carom.Scenario:
    """Return a ball that reaches the floor in its third step."""
    step = length / divisions / WAVE_SPEED
    speed = 0.01 * WAVE_SPEED / length**0.5
    return carom.Scenario(
        dimension=3,
        analysis=carom.Dynamic(
            end_time=STEPS * step, time_step=step, scheme=carom.Conserving(), max_halvings=4
        ),
        output=carom.Output(fields_every=1e3, history_every=1e3),
        materials={"rubber": carom.SaintVenantKirchhoff(young=2700.0, poisson=0.33, density=1.0)},
        bodies=[
            carom.Body(
                name="ball",
                material="rubber",
                mesh=carom.Ball(
                    centre=[0.0, 0.0, 1.0 + 2.5 * speed * step], radius=1.0, divisions=divisions
                ),
                velocity=[0.0, 0.0, -speed],
            )
        ],
        obstacles=[carom.Plane(name="floor", point=(0.0, 0.0, 0.0), normal=(0.0, 0.0, 1.0))],
        contact=carom.Contact(condition=condition, friction=0.2),
    )


def main() -> None:
    """Print a line for every length."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--divisions", type=int, default=12)
    parser.add_argument("--condition", default="massless", choices=CONDITIONS)
    arguments = parser.parse_args()
    shortest = None
    for length in LENGTHS:
        simulation = carom.Simulation(landing(arguments.divisions, length, arguments.condition))
        unknowns = sum(body.displacement.size for body in simulation.bodies.values())
        seconds, iterations = [], []
        while not simulation.has_ended:
            begun = process_time()
            step = simulation.step()
            if step.contacts > 0:
                seconds.append(process_time() - begun)
                iterations.append(step.iterations)
        typical = median(seconds)
        shortest = shortest or typical
        print(
            f"{unknowns} unknowns, {length:4d} cells per step: {typical:6.3f} s, "
            f"{median(iterations):.1f} iterations, {len(seconds)} steps in contact, "
            f"{typical / shortest:5.2f} times",
            flush=True,
        )


if __name__ == "__main__":
    main()
