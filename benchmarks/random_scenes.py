"""How robust the schemes are: random bodies thrown into a box, run with each of them.

    .venv/bin/python benchmarks/random_scenes.py [scenes] [first seed]

Prints for every scheme how many scenes it completed, how many steps it had to halve, the defect of
the ledger over the initial energy, the deepest penetration, and the time per step.
"""

from __future__ import annotations

import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

import carom

VARIANTS = (
    ("theta", "gap"),
    ("theta", "massless"),
    ("conserving", "midpoint"),
    ("conserving", "gap"),
    ("conserving", "massless"),
)
"""Schemes and contact conditions that are compared."""

BOX = 8.0
"""Side of the box [m]."""

LAWS = (carom.SaintVenantKirchhoff, carom.NeoHookean)


def scene(seed: int, scheme: str, condition: str) -> carom.Scenario:
    """Return 2 to 5 bodies of random shape, size, material and motion in a box."""
    random = np.random.default_rng(seed)
    columns = 3
    cell = BOX / columns
    places = random.permutation(columns * columns)[: random.integers(2, 6)]
    materials, bodies = {}, []
    for index, place in enumerate(places):
        name = f"body{index}"
        young = 10.0 ** random.uniform(3.0, 4.5)
        materials[name] = LAWS[random.integers(len(LAWS))](
            young=young, poisson=random.uniform(0.0, 0.4), density=1.0
        )
        centre = (np.array([place % columns, place // columns]) + 0.5) * cell
        centre += random.uniform(-0.05, 0.05, 2) * cell
        # Velocities up to a twelfth of the speed of waves: strong, yet with strains that laws bear.
        speed = np.sqrt(young) / 12.0 * random.uniform(0.2, 1.0)
        angle = random.uniform(0.0, 2.0 * np.pi)
        if random.random() < 0.6:
            mesh = carom.Disc(
                centre=centre,
                radius=random.uniform(0.2, 0.38) * cell,
                divisions=2 * int(random.integers(2, 5)),
            )
        else:
            size = random.uniform(0.35, 0.6, 2) * cell
            mesh = carom.Rectangle(
                corner=centre - 0.5 * size,
                size=size,
                divisions=[int(n) for n in random.integers(3, 9, 2)],
            )
        bodies.append(
            carom.Body(
                name=name,
                material=name,
                mesh=mesh,
                velocity=speed * np.array([np.cos(angle), np.sin(angle)]),
                spin=random.uniform(-3.0, 3.0),
            )
        )
    sides = {"floor": (0, 1), "ceiling": (0, -1), "west": (1, 0), "east": (-1, 0)}
    planes = [
        carom.Plane(name=name, point=[0.0 if sum(n) > 0 else BOX] * 2, normal=n)
        for name, n in sides.items()
    ]
    stiffest = max(m.young for m in materials.values())
    step = 0.05 / np.sqrt(stiffest)
    return carom.Scenario(
        title=f"scene {seed}",
        analysis=carom.Dynamic(
            end_time=800 * step,
            time_step=step,
            scheme={"kind": scheme},
            gravity=[0.0, -9.81] if random.random() < 0.5 else None,
        ),
        output=carom.Output(history_every=step, fields_every=800 * step),
        materials=materials,
        bodies=bodies,
        obstacles=planes,
        contact=carom.Contact(condition=condition, friction=float(random.choice([0.0, 0.2, 0.6]))),
    )


@dataclass
class Tally:
    """What a scheme did over all scenes; lists have one entry per completed scene."""

    retried: int = 0
    steps: int = 0
    defects: list[float] = field(default_factory=list)
    gaps: list[float] = field(default_factory=list)
    seconds: list[float] = field(default_factory=list)
    failures: list[str] = field(default_factory=list)

    def add(self, summary: dict[str, Any], seconds: float) -> None:
        """Count a completed scene."""
        energy = summary["energy"]
        self.steps += summary["steps"]
        self.retried += summary["retried_steps"]
        self.defects.append(energy["max_defect"] / energy["initial"])
        self.gaps.append(summary["min_gap"])
        self.seconds.append(seconds / summary["steps"])


def main() -> None:
    """Run the scenes and print the table."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 40
    first = int(sys.argv[2]) if len(sys.argv) > 2 else 0
    tallies = {variant: Tally() for variant in VARIANTS}
    with tempfile.TemporaryDirectory() as directory:
        for seed in range(first, first + count):
            for (scheme, condition), tally in tallies.items():
                start = perf_counter()
                out = Path(directory) / "run"
                try:
                    result = carom.run(scene(seed, scheme, condition), out=out)
                except carom.ConvergenceError as error:
                    tally.failures.append(f"scene {seed}: {error}")
                    continue
                tally.add(result.summary, perf_counter() - start)
    print(
        "| scheme | condition | completed | steps tried again | defect, median | largest |", end=""
    )
    print(" scenes > 1e-9 | smallest gap [m] | ms/step, median | largest |")
    print("|" + " --- |" * 10)
    for (scheme, condition), tally in tallies.items():
        defects, milliseconds = np.array(tally.defects), 1e3 * np.array(tally.seconds)
        cells = (
            f"`{scheme}`",
            f"`{condition}`",
            f"{len(defects)} of {count}",
            f"{tally.retried} of {tally.steps}",
            f"{np.median(defects):.1e}",
            f"{defects.max():.1e}",
            str(np.count_nonzero(defects > 1e-9)),
            f"{min(tally.gaps):.1e}".replace("-", "−", 1),
            f"{np.median(milliseconds):.2f}",
            f"{milliseconds.max():.1f}",
        )
        print(f"| {' | '.join(cells)} |")
    for (scheme, condition), tally in tallies.items():
        for failure in tally.failures:
            print(f"{scheme}, {condition}, {failure}")


if __name__ == "__main__":
    main()
