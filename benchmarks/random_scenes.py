"""How robust the schemes are: random bodies thrown into a box, run with each of them.

    .venv/bin/python benchmarks/random_scenes.py [scenes] [first seed]

Prints for every scheme how many scenes it completed, how many steps it had to halve, the defect of
the ledger over the initial energy, after parts of halved steps and after whole steps, the deepest
penetration, and the time per step.
"""

from __future__ import annotations

import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path
from time import perf_counter
from typing import Any

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "validation"))

import numpy as np
from sections.layout import power, table

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
    left: list[float] = field(default_factory=list)
    gaps: list[float] = field(default_factory=list)
    seconds: dict[int, float] = field(default_factory=dict)
    failures: list[str] = field(default_factory=list)

    def add(self, seed: int, summary: dict[str, Any], left: float, seconds: float) -> None:
        """Count a completed scene, with its defect after whole steps."""
        energy = summary["energy"]
        self.steps += summary["steps"]
        self.retried += summary["retried_steps"]
        self.defects.append(energy["max_defect"] / energy["initial"])
        self.left.append(left)
        self.gaps.append(summary["min_gap"])
        self.seconds[seed] = seconds / summary["steps"]

    @property
    def median_seconds(self) -> float:
        """Median time of a step over the completed scenes [s]."""
        return float(np.median(list(self.seconds.values())))

    def worst_ratio(self, other: Tally) -> float:
        """Return the largest ratio of the time of a scene to that with another scheme."""
        both = self.seconds.keys() & other.seconds.keys()
        return max(self.seconds[seed] / other.seconds[seed] for seed in both)


HEADER = (
    *("scheme", "condition", "completed", "steps tried again", "defect, median", "largest"),
    *("after whole steps", "scenes > 1e-9", "smallest gap [m]", "ms/step, median"),
    "ms/step, largest",
)


def run(count: int, first: int = 0) -> dict[tuple[str, str], Tally]:
    """Run so many scenes with every scheme and contact condition."""
    tallies = {variant: Tally() for variant in VARIANTS}
    with tempfile.TemporaryDirectory() as directory:
        for seed in range(first, first + count):
            for (scheme, condition), tally in tallies.items():
                start = perf_counter()
                out = Path(directory) / "run"
                given = scene(seed, scheme, condition)
                # What is timed are steps, and no rows of a history.
                brief = given.with_overrides([f"output.history_every={given.analysis.end_time!r}"])
                try:
                    summary = carom.run(brief, out=out, force=True).summary
                except (carom.ConvergenceError, carom.PenetrationError) as error:
                    tally.failures.append(f"scene {seed}: {error}")
                    continue
                seconds = perf_counter() - start
                left = summary["energy"]["max_defect"]
                if summary["retried_steps"]:
                    rows = carom.run(given, out=out, force=True).history
                    left = np.abs(rows["defect"]).max()
                tally.add(seed, summary, left / summary["energy"]["initial"], seconds)
    return tallies


def tabulated(tallies: dict[tuple[str, str], Tally]) -> str:
    """Return what the schemes did as a table."""
    rows = []
    for (scheme, condition), tally in tallies.items():
        defects, left = np.array(tally.defects), np.array(tally.left)
        rows.append(
            (
                f"`{scheme}`",
                f"`{condition}`",
                f"{len(defects)} of {len(defects) + len(tally.failures)}",
                f"{tally.retried} of {tally.steps}",
                power(np.median(defects)),
                power(defects.max()),
                power(left.max()),
                np.count_nonzero(left > 1e-9),
                power(min(tally.gaps)),
                f"{1e3 * tally.median_seconds:.2f}",
                f"{1e3 * max(tally.seconds.values()):.1f}",
            )
        )
    return table(HEADER, rows)


def compared(tallies: dict[tuple[str, str], Tally]) -> str:
    """Say what `massless` costs beside `gap`, both with `conserving`."""
    massless, gap = (tallies["conserving", each] for each in ("massless", "gap"))
    return (
        f"A scene with `conserving` and `massless` costs "
        f"{massless.median_seconds / gap.median_seconds:.1f} times one with `gap` per step "
        f"(medians), and {massless.worst_ratio(gap):.1f} times at most."
    )


def failures(tallies: dict[tuple[str, str], Tally]) -> list[str]:
    """Say which scenes were not completed, and why."""
    return [
        f"`{scheme}`, `{condition}`, {failure}"
        for (scheme, condition), tally in tallies.items()
        for failure in tally.failures
    ]


if __name__ == "__main__":
    found = run(*(int(word) for word in sys.argv[1:3] or ("40",)))
    print(tabulated(found), *failures(found), compared(found), sep="\n")
