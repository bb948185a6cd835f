"""What a row of the history costs beside a step, where there is one after every step.

Piles of discs or balls, the same steps with and without rows, in turn; the least time of each
counts. Processor time of one thread:

    RAYON_NUM_THREADS=1 .venv/bin/python benchmarks/history_rows.py 3 8 27 64
    RAYON_NUM_THREADS=1 .venv/bin/python benchmarks/history_rows.py 2 100
"""

from __future__ import annotations

import argparse
from time import process_time

from many_bodies import STEP, pile

import carom

STEPS = 40
BEFORE = 30
RUNS = 3


def time_of(dimension: int, count: int, every: float) -> float:
    """Return the processor time of a step with a row of the history so often [s]."""
    case = pile(dimension, count, steps=BEFORE + STEPS)
    output = carom.Output(history_every=every, fields_every=case.analysis.end_time)
    simulation = carom.Simulation(case.model_copy(update={"output": output}))
    simulation.advance((BEFORE - 0.5) * STEP)
    begun = process_time()
    simulation.advance((BEFORE + STEPS - 0.5) * STEP)
    return (process_time() - begun) / STEPS


def measure(dimension: int, count: int) -> None:
    """Print what a row of a pile costs."""
    without, rows = [], []
    for _ in range(RUNS):
        without.append(time_of(dimension, count, 1e3))
        rows.append(time_of(dimension, count, STEP))
    step, row = min(without), min(rows) - min(without)
    print(
        f"{dimension}D {count:5d} bodies: step {1e6 * step:8.0f} us, row {1e6 * row:8.0f} us, "
        f"{100 * row / step:5.1f} %",
        flush=True,
    )


def main() -> None:
    """Measure every pile."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("dimension", type=int, choices=(2, 3))
    parser.add_argument("counts", type=int, nargs="+")
    arguments = parser.parse_args()
    for count in arguments.counts:
        measure(arguments.dimension, count)


if __name__ == "__main__":
    main()
