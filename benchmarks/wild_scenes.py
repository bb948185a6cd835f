"""Whatever is thrown at it: random scenes that end as completed, or as failed with a reason.

    .venv/bin/python benchmarks/wild_scenes.py [scenes] [first seed]

Bodies, laws, friction, speeds up to that of waves, time steps from a fifth to five times what waves
need for a cell, schemes and contact conditions are drawn at random, in the plane and in space.
Prints a table, every failure with its reason, and exit status 1 if a scene ended otherwise, took
longer than `PATIENCE`, or has books that do not close. `random_scenes.py` compares the schemes on
equal and milder scenes.
"""

from __future__ import annotations

import sys
import tempfile
import traceback
import warnings
from collections import defaultdict
from dataclasses import dataclass
from time import process_time
from typing import Any
from unittest import mock

import numpy as np

import carom
from carom.results.doubts import defect_share

SPACING = 2.5
"""Distance of the places where bodies start [m]."""

STEPS = 80

PATIENCE = 60.0
"""Processor time of a scene [s]."""

CLOSED = 1e-6
"""Largest defect of the ledger after a whole step, of the energy that there was, with the scheme
`conserving`; parts of a step may leave more for one another. That of `theta` is the error of its
stresses, of which a run warns where it is large."""

CONDITIONS = {
    "theta": ("gap", "midpoint", "endpoint"),
    "conserving": ("gap", "midpoint", "massless"),
}

LAWS: tuple[dict[str, Any], ...] = (
    {"kind": "linear-elastic", "young": 1.0, "poisson": 0.3},
    {"kind": "saint-venant-kirchhoff", "young": 1.0, "poisson": 0.3},
    {"kind": "neo-hookean", "young": 1.0, "poisson": 0.4},
    {"kind": "mooney-rivlin", "c10": 0.1, "c01": 0.07, "bulk": 0.8},
    {"kind": "yeoh", "c10": 0.17, "c20": 0.01, "c30": 0.002, "bulk": 0.8},
    {"kind": "ogden", "mu": [0.3, -0.02], "alpha": [2.0, -2.0], "bulk": 0.8},
    {"kind": "blatz-ko", "shear": 0.4},
    {"kind": "j2-plasticity", "young": 1.0, "poisson": 0.3, "yield_stress": 0.01, "hardening": 0.1},
)
"""Of a Young's modulus of about 1 Pa, which is multiplied; a wave of 1 m/s at a density of 1."""

STIFFNESSES = (
    *("young", "c10", "c01", "c20", "c30", "bulk", "mu", "shear", "yield_stress", "hardening"),
)


def scene(seed: int) -> carom.Scenario:
    """Return a scene at random."""
    random = np.random.default_rng(seed)
    dimension = 2 if random.random() < 0.7 else 3
    scheme = str(random.choice(list(CONDITIONS)))
    condition = str(random.choice(CONDITIONS[scheme]))
    count = int(random.integers(1, 5 if dimension == 2 else 3))
    places = random.permutation(2**dimension)[:count]
    materials, bodies, waves, cells = {}, [], [], []
    for index, place in enumerate(places):
        name = f"body{index}"
        young = 10.0 ** random.uniform(3.0, 5.0)
        materials[name] = _law(random, young, remembers=condition != "massless")
        centre = SPACING * (0.5 + np.array([(place >> axis) & 1 for axis in range(dimension)]))
        # Without mass at the boundary a body needs cells inside.
        mesh, cell = _mesh(random, centre, dimension, coarsest=2 if condition == "massless" else 1)
        wave = np.sqrt(young)
        direction = random.normal(size=dimension)
        speed = wave * 10.0 ** random.uniform(-2.0, 0.0)
        turn = 0.2 * wave * random.normal(size=1 if dimension == 2 else 3)
        bodies.append(
            {
                "name": name,
                "material": name,
                "mesh": mesh,
                "velocity": list(speed * direction / np.linalg.norm(direction)),
                "spin": float(turn[0]) if dimension == 2 else list(turn),
            }
        )
        waves.append(wave)
        cells.append(cell)
    step = 5.0 ** random.uniform(-1.0, 1.0) * min(cells) / max(waves)
    kind = {"kind": scheme}
    if scheme == "theta":
        kind["theta"] = float(random.choice([0.5, 0.5, 0.6, 1.0]))
    return carom.Scenario.from_dict(
        {
            "title": f"Wild scene {seed}",
            "dimension": dimension,
            "analysis": {
                "end_time": STEPS * step,
                "time_step": step,
                "scheme": kind,
                "gravity": [0.0, -9.81, 0.0][:dimension] if random.random() < 0.5 else None,
            },
            "output": {"fields_every": STEPS * step, "history_every": step},
            "materials": materials,
            "bodies": bodies,
            "obstacles": _walls(dimension),
            "contact": {
                "condition": condition,
                "friction": float(random.choice([0.0, random.uniform(0.0, 1.0)])),
            },
        }
    )


def _law(random: np.random.Generator, young: float, *, remembers: bool) -> dict[str, Any]:
    laws = LAWS if remembers else LAWS[:-1]
    law: dict[str, Any] = {"density": 1.0}
    for key, value in laws[random.integers(len(laws))].items():
        if key not in STIFFNESSES:
            law[key] = value
        else:
            law[key] = [young * v for v in value] if isinstance(value, list) else young * value
    if random.random() < 0.2:
        law["damping"] = {"stiffness": float(1e-2 / np.sqrt(young))}
    return law


def _mesh(
    random: np.random.Generator, centre: np.ndarray, dimension: int, *, coarsest: int
) -> tuple[dict[str, Any], float]:
    """Return a mesh that fits a place, and the size of its cells [m]."""
    radius = random.uniform(0.5, 1.05)
    divisions = 2 * int(random.integers(coarsest, 3 if dimension == 2 else coarsest + 1))
    if random.random() < 0.5:
        kind = "disc" if dimension == 2 else "ball"
        mesh = {"kind": kind, "centre": list(centre), "radius": radius, "divisions": divisions}
        return mesh, radius / divisions
    size = radius * random.uniform(0.8, 1.6, dimension)
    kind = "rectangle" if dimension == 2 else "box"
    corner = list(centre - 0.5 * size)
    counts = [divisions] * dimension
    mesh = {"kind": kind, "corner": corner, "size": list(size), "divisions": counts}
    return mesh, float(size.min()) / divisions


def _walls(dimension: int) -> list[dict[str, Any]]:
    walls = []
    for axis in range(dimension):
        for side, place in ((1.0, 0.0), (-1.0, 2.0 * SPACING)):
            normal = [0.0] * dimension
            normal[axis] = side
            walls.append(
                {
                    "name": f"{'xyz'[axis]}{'-' if side > 0 else '+'}",
                    "kind": "plane",
                    "point": [place] * dimension,
                    "normal": normal,
                }
            )
    return walls


@dataclass
class Ending:
    """How a scene ended.

    Parameters
    ----------
    status
        That of the run, or ``"broken"``.
    reason
        What it says.
    seconds
        Processor time of the run [s].
    silence
        Processor time from the last word of progress to the end [s].
    defect
        Largest defect of its ledger, of the energy that there was.
    left
        The same after whole steps.
    warned
        Whether it warns of that.
    """

    status: str
    reason: str
    seconds: float
    silence: float
    defect: float
    left: float
    warned: bool = False


def ending(scenario: carom.Scenario) -> Ending:
    """Run a scene and say how it ended."""
    start = last = process_time()

    def note(_: carom.Progress) -> None:
        nonlocal last
        last = process_time()

    reason = ""
    with tempfile.TemporaryDirectory() as directory, mock.patch("carom.plot.draw"):
        try:
            carom.run(scenario, out=directory, progress=note)
        except (
            carom.ConvergenceError,
            carom.CertificateError,
            carom.PenetrationError,
        ) as error:
            reason = str(error)
        except BaseException as error:  # a panic is no Exception
            if isinstance(error, KeyboardInterrupt):
                raise
            return Ending(
                "broken", "".join(traceback.format_exception(error)), 0.0, 0.0, np.nan, np.nan
            )
        end = process_time()
        result = carom.Result.open(directory)
        summary, rows = result.summary, result.history
    defect = defect_share(summary["energy"])
    left = defect_share(summary["energy"] | {"max_defect": np.abs(rows["defect"]).max()})
    warned = any(warning["code"] == "ledger-defect" for warning in summary["warnings"])
    return Ending(summary["status"], reason, end - start, end - last, defect, left, warned=warned)


def main() -> None:
    """Run the scenes and print the table."""
    warnings.simplefilter("ignore", carom.CaromWarning)
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 500
    first = int(sys.argv[2]) if len(sys.argv) > 2 else 0
    rows: dict[tuple[str, str, int], list[Ending]] = defaultdict(list)
    bad: list[str] = []
    failures: list[str] = []
    for seed in range(first, first + count):
        scenario = scene(seed)
        scheme = scenario.analysis.scheme.kind
        end = ending(scenario)
        rows[scheme, scenario.contact.condition, scenario.dimension].append(end)
        if scheme == "conserving" and end.status == "completed" and end.left > CLOSED:
            bad.append(f"scene {seed} ({scheme}): the ledger misses {end.left:.1e}")
        if end.status not in ("completed", "failed", "uncertified", "intersecting"):
            bad.append(f"scene {seed}: {end.status}: {end.reason}")
        if end.seconds > PATIENCE:
            bad.append(f"scene {seed}: took {end.seconds:.0f} s")
        if end.status != "completed":
            failures.append(f"scene {seed}: {end.silence:.1f} s: {end.reason}")
            print(failures[-1], file=sys.stderr, flush=True)
    columns = (
        *("scheme", "condition", "dimension", "scenes", "completed", "with a warning"),
        *("failed, with its reason", "defect, median", "largest", "longest run [s]"),
        "longest last step of a failure [s]",
    )
    print(f"| {' | '.join(columns)} |")
    print("|" + " --- |" * len(columns))
    for (scheme, condition, dimension), ends in sorted(rows.items()):
        defects = [e.defect for e in ends if e.status == "completed"] or [np.nan]
        failed = [e for e in ends if e.status not in ("completed", "broken") and e.reason]
        cells = (
            *(f"`{scheme}`", f"`{condition}`", str(dimension), str(len(ends))),
            str(sum(e.status == "completed" for e in ends)),
            str(sum(e.status == "completed" and e.warned for e in ends)),
            str(len(failed)),
            f"{np.median(defects):.1e}",
            f"{max(defects):.1e}",
            f"{max(e.seconds for e in ends):.1f}",
            f"{max((e.silence for e in failed), default=0.0):.1f}",
        )
        print(f"| {' | '.join(cells)} |")
    print(*failures, sep="\n")
    print(*(f"broken contract: {line}" for line in bad), sep="\n")
    sys.exit(1 if bad else 0)


if __name__ == "__main__":
    main()
