"""Does a run take more and more memory? A million steps, and the growth with its uncertainty.

    .venv/bin/python benchmarks/soak.py [--steps N] [recorded | native …]

Prints a table. A disc bounces in a box under gravity, and never comes to rest;
``recorded`` is `carom.run` with all its files, ``native`` the time loop of the core alone, its
history taken and thrown away. Linux only: memory is what /proc says is resident. Each run has a
process of its own and takes some three minutes.
"""

from __future__ import annotations

import argparse
import multiprocessing
import os
import tempfile
from collections.abc import Callable
from pathlib import Path
from time import perf_counter
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

import carom
from carom.building.build import build

STEP = 1e-3  # s
HISTORY = 100
"""Steps between two rows of history."""

FRAMES = 1000
"""Steps between two frames of fields."""

WARM = 0.1
"""Share of the run that is not judged: buffers grow to the size that they need."""

BLOCKS = 9
"""Parts of the rest whose growths are compared."""

ROOM = 100_000
"""Samples that there is room for beside one for each row: ten in a second, for hours."""


class Memory(NamedTuple):
    """Resident memory over a run.

    Parameters
    ----------
    steps
        Steps done, shape [n].
    resident
        What the process has in memory then [bytes], shape [n].
    """

    steps: NDArray[np.float64]
    resident: NDArray[np.float64]

    def growth(self) -> tuple[float, float]:
        """Return bytes per step and the standard error, from what the blocks say."""
        edges = np.linspace(WARM * self.steps[-1], self.steps[-1], BLOCKS + 1)
        levels = np.interp(edges, self.steps, self.resident)
        slopes = np.diff(levels) / np.diff(edges)
        return slopes.mean(), slopes.std(ddof=1) / np.sqrt(BLOCKS)


def scenario(steps: int) -> carom.Scenario:
    """Return a disc that bounces in a box."""
    sides = {"floor": (0.0, 1.0), "ceiling": (0.0, -1.0), "west": (1.0, 0.0), "east": (-1.0, 0.0)}
    return carom.Scenario(
        title="Soak",
        analysis=carom.Dynamic(end_time=steps * STEP, time_step=STEP, gravity=[0.0, -1.0]),
        output=carom.Output(history_every=HISTORY * STEP, fields_every=FRAMES * STEP),
        materials={"elastic": carom.SaintVenantKirchhoff(young=2700.0, poisson=0.33, density=1.0)},
        bodies=[
            carom.Body(
                name="disc",
                material="elastic",
                mesh=carom.Disc(centre=[2.0, 2.0], radius=1.0, divisions=2),
                velocity=[1.0, -2.0],
                spin=1.0,
            )
        ],
        obstacles=[
            carom.Plane(name=name, point=[0.0, 0.0] if sum(n) > 0 else [4.0, 4.0], normal=n)
            for name, n in sides.items()
        ],
        contact=carom.Contact(condition="midpoint", friction=0.2),
    )


def resident() -> int:
    """Return the resident memory of this process [bytes]."""
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE")


def recorded(steps: int, note: Callable[[int], None]) -> carom.Result:
    """Run with everything that a run writes."""
    with tempfile.TemporaryDirectory() as directory:
        return carom.run(scenario(steps), out=directory, progress=lambda p: note(p.step))


def native(steps: int, note: Callable[[int], None]) -> carom._carom.Simulation:
    """Run the time loop alone."""
    simulation = build(scenario(steps))
    while not simulation.advance(steps * STEP, 0.1):
        simulation.take_history()
        simulation.take_ledger()
        note(simulation.step)
    return simulation


MODES = {"recorded": recorded, "native": native}


def soaked(mode: str, steps: int) -> str:
    """Run and return a row of the table."""
    # All there from the start: a list would be what grows.
    samples = np.ones((steps // HISTORY + ROOM, 2))
    taken = 0

    def note(step: int) -> None:
        nonlocal taken
        samples[taken] = step, resident()
        taken += 1

    start = perf_counter()
    run = MODES[mode](steps, note)
    minutes = (perf_counter() - start) / 60.0
    summary = run.summary if isinstance(run, carom.Result) else run.summary()
    memory = Memory(*samples[:taken].T)
    growth, error = memory.growth()
    cells = (
        f"`{mode}`",
        f"{summary['steps']:,}",
        f"{len(summary['contacts']):,}",
        f"{minutes:.1f}",
        f"{np.interp(WARM * steps, *memory) / 1e6:.2f}",
        f"{memory.resident[-1] / 1e6:.2f}",
        f"{growth:.3f} ± {error:.3f}".replace("-", "−"),
    )
    return f"| {' | '.join(cells)} |"


def main() -> None:
    """Run and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("modes", nargs="*", help=f"of {', '.join(MODES)}; by default all")
    parser.add_argument("--steps", type=int, default=1_000_000, help="steps of a run")
    options = parser.parse_args()
    if unknown := set(options.modes) - set(MODES):
        parser.error(f"no mode: {', '.join(unknown)}")
    print(
        "| mode | steps | contacts | time [min] | resident after a tenth [MB] | at the end | ",
        end="",
    )
    print("growth [bytes per step] |")
    print("|" + " --- |" * 7, flush=True)
    processes = multiprocessing.get_context("spawn")
    for mode in options.modes or MODES:
        with processes.Pool(1) as pool:
            print(pool.apply(soaked, (mode, options.steps)), flush=True)


if __name__ == "__main__":
    main()
