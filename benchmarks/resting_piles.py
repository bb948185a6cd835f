r"""What a step of a pile at rest costs beside one of the same pile as it falls together.

A pile falls, is damped until all of it rests, and waits. Processor time of one thread:

    RAYON_NUM_THREADS=1 .venv/bin/python benchmarks/resting_piles.py 2 100
    RAYON_NUM_THREADS=1 .venv/bin/python benchmarks/resting_piles.py 2 1000 \
        --young 5e7 --damping 120
    RAYON_NUM_THREADS=1 .venv/bin/python benchmarks/resting_piles.py 3 64
    RAYON_NUM_THREADS=1 .venv/bin/python benchmarks/resting_piles.py 2 100 --driven

A pile sinks as fast as its slowest vibration fades, whose frequency falls with the height: damping
of more than twice that makes it creep. So 1,000 discs, 32 layers, want a stiffer rubber to come to
rest in some 1,500 steps.

With --driven the pile of discs lies on a slab that is held where it is and will be moved when all
is over, in place of the floor.
"""

from __future__ import annotations

import argparse
from time import process_time

from many_bodies import CONDITIONS, RADIUS, STEP, pile

import carom

MOVING = 200
BLOCK = 50
MOST = 4000
WAIT = 400


def on_slab(case: carom.Scenario) -> carom.Scenario:
    """Return a pile of discs with a slab in place of its floor, which moves when all is over."""
    east = next(o for o in case.obstacles if o.name == "wall-0-1")
    width = east.point[0]
    slab = carom.Body(
        name="slab",
        material="rubber",
        mesh=carom.Rectangle(
            corner=[0.1 * RADIUS, -RADIUS],
            size=[width - 0.2 * RADIUS, RADIUS],
            divisions=[max(4, round(width / RADIUS)), 2],
        ),
    )
    end = case.analysis.end_time
    motion = carom.Prescribed(body="slab", on="bottom", x=0.0, y=f"0.1*step(t - {end})*(t - {end})")
    return case.model_copy(
        update={
            "bodies": (*case.bodies, slab),
            "obstacles": tuple(o for o in case.obstacles if o.name != "floor"),
            "motions": (motion,),
        }
    )


def measure(case: carom.Scenario) -> None:
    """Print what a pile costs in motion and at rest."""
    dimension, count = case.dimension, len(case.bodies)
    simulation = carom.Simulation(case)
    # Factors are made in the first step.
    simulation.step()
    moving = time_of(simulation, MOVING) / MOVING
    while len(simulation.resting) < count and simulation.steps < MOST:
        time_of(simulation, BLOCK)
    rested = len(simulation.resting), simulation.steps
    iterations = simulation.step().iterations
    waiting = time_of(simulation, WAIT - 1) / (WAIT - 1)
    ledger, energy = simulation.ledger, simulation.energy
    print(
        f"{dimension}D {count:5d} bodies: {1e6 * moving / count:6.1f} us per body and step in "
        f"motion, {1e6 * waiting / count:6.2f} where {rested[0]} rest after {rested[1]} steps, "
        f"{100 * waiting / moving:5.2f} %, {iterations} iterations, "
        f"defect {abs(ledger.defect) / max(energy.total, ledger.external):.1e}",
        flush=True,
    )


def time_of(simulation: carom.Simulation, steps: int) -> float:
    """Go on by so many steps; return the processor time that takes [s]."""
    begun = process_time()
    simulation.advance((simulation.steps + steps - 0.5) * STEP)
    return process_time() - begun


def main() -> None:
    """Measure every pile."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("dimension", type=int, choices=(2, 3))
    parser.add_argument("counts", type=int, nargs="+")
    parser.add_argument("--driven", action="store_true")
    parser.add_argument("--condition", default="midpoint", choices=CONDITIONS)
    parser.add_argument("--young", type=float, default=5e6, help="Young's modulus [Pa]")
    parser.add_argument("--damping", type=float, default=60.0, help="of the mass [1/s]")
    arguments = parser.parse_args()
    for count in arguments.counts:
        case = pile(
            arguments.dimension,
            count,
            steps=MOST + WAIT,
            damping=arguments.damping,
            condition=arguments.condition,
            young=arguments.young,
        )
        measure(on_slab(case) if arguments.driven else case)


if __name__ == "__main__":
    main()
