"""Random static scenes: pressed, sheared, bent. Each completes, or ends with its reason.

    .venv/bin/python benchmarks/static_scenes.py [scenes] [first seed]

Blocks on blocks with meshes that do not fit, strips over posts and balls; all laws, cells of first
and second order, friction from 0 to 1, in the plane and in space. A scene that does not complete
is printed with its reason, to be looked at, and makes the exit status 1; so do books that do not
close. The last line says how many iterations a load step took.
"""

from __future__ import annotations

import sys
import tempfile
import warnings
from collections import Counter
from dataclasses import dataclass
from time import process_time
from typing import Any

import numpy as np

import carom

STEPS = 10

LAWS: tuple[dict[str, Any], ...] = (
    {"kind": "linear-elastic", "young": 1e6, "poisson": 0.3},
    {"kind": "saint-venant-kirchhoff", "young": 1e6, "poisson": 0.3},
    {"kind": "neo-hookean", "young": 1e6, "poisson": 0.4},
    {"kind": "mooney-rivlin", "c10": 1e5, "c01": 7e4, "bulk": 8e5},
    {"kind": "yeoh", "c10": 1.7e5, "c20": 1e4, "c30": 2e3, "bulk": 8e5},
    {"kind": "ogden", "mu": [3e5, -2e4], "alpha": [2.0, -2.0], "bulk": 8e5},
    {"kind": "blatz-ko", "shear": 4e5},
    {"kind": "j2-plasticity", "young": 1e6, "poisson": 0.3, "yield_stress": 3e4, "hardening": 1e5},
)

SMALL = {"linear-elastic", "saint-venant-kirchhoff", "j2-plasticity"}
"""Laws that are meant for smaller strains than rubber's."""

CELLS = {2: ("quad4", "tri3", "quad8", "quad9", "tri6"), 3: ("hex8", "tet4", "hex20", "tet10")}


def scene(seed: int) -> carom.Scenario:
    """Return a scene at random."""
    random = np.random.default_rng(seed)
    dimension = 2 if random.random() < 0.75 else 3
    law = dict(LAWS[random.integers(len(LAWS))])
    other = dict(LAWS[random.integers(len(LAWS))])
    softer = 10.0 ** random.uniform(-1.0, 1.0)
    for key in ("young", "c10", "c01", "c20", "c30", "bulk", "shear", "yield_stress", "hardening"):
        if key in other:
            other[key] *= softer
    if "mu" in other:
        other["mu"] = [softer * mu for mu in other["mu"]]
    strain = 0.03 if {law["kind"], other["kind"]} & SMALL else random.uniform(0.05, 0.3)
    kind = str(random.choice(["press", "shear", "bend", "plate"]))
    parts = {"press": _press, "shear": _press, "bend": _bend, "plate": _plate}[kind]
    bodies, motions, obstacles = parts(random, dimension, strain, kind)
    friction = float(random.choice([0.0, random.uniform(0.0, 1.0)]))
    return carom.Scenario.from_dict(
        {
            "title": f"Scene {seed}: {kind}, {law['kind']} on {other['kind']}, {friction:.2f}",
            "dimension": dimension,
            "analysis": {"kind": "static", "end_time": 1.0, "time_step": 1.0 / STEPS},
            "output": {"fields_every": 1.0, "history_every": 1.0 / STEPS},
            "materials": {"one": law | {"density": 1000.0}, "other": other | {"density": 1000.0}},
            "bodies": bodies,
            "motions": motions,
            "obstacles": obstacles,
            "contact": {"friction": friction},
        }
    )


def _block(
    random: np.random.Generator, name: str, material: str, corner: list[float], size: list[float]
) -> dict[str, Any]:
    dimension = len(size)
    cell = str(random.choice(CELLS[dimension]))
    finest = {2: 9, 3: 4}[dimension]
    divisions = [int(random.integers(2, finest)) for _ in size]
    kind = "rectangle" if dimension == 2 else "box"
    mesh = {"kind": kind, "corner": corner, "size": size, "divisions": divisions, "cell": cell}
    return {"name": name, "material": material, "mesh": mesh}


def _press(
    random: np.random.Generator, dimension: int, strain: float, kind: str
) -> tuple[list[dict[str, Any]], list[dict[str, Any]], list[dict[str, Any]]]:
    """Press a block on a block, and perhaps shear it, by its top."""
    across = dimension - 1
    lower = [*random.uniform(1.0, 3.0, across).tolist(), 1.0]
    upper = [
        *(random.uniform(0.5, 1.0) * np.array(lower[:-1])).tolist(),
        float(random.uniform(0.4, 1.0)),
    ]
    gap = float(random.choice([0.0, 0.01]))
    corner = [*(random.uniform(0.0, 1.0) * (np.array(lower[:-1]) - upper[:-1])).tolist(), 1.0 + gap]
    bodies = [
        _block(random, "lower", "one", [0.0] * dimension, lower),
        _block(random, "upper", "other", corner, upper),
    ]
    down = strain * (1.0 + upper[-1]) + gap
    axes = "xyz"[:dimension]
    driven = {axes[-1]: f"-{down}*t", "x": f"{0.5 * strain}*t" if kind == "shear" else 0.0}
    if dimension == 3:
        driven["y"] = 0.0
    motions = [
        {"kind": "fixed", "body": "lower", "on": "bottom"},
        {"kind": "prescribed", "body": "upper", "on": "top", **driven},
    ]
    return bodies, motions, []


def _plate(
    random: np.random.Generator, dimension: int, strain: float, kind: str
) -> tuple[list[dict[str, Any]], list[dict[str, Any]], list[dict[str, Any]]]:
    """Press a block that nothing holds but two plates, one of which comes down."""
    size = random.uniform(0.5, 2.0, dimension).tolist()
    bodies = [_block(random, "block", "one", [0.0] * dimension, size)]
    up = [*[0.0] * (dimension - 1), 1.0]
    top = [*[0.0] * (dimension - 1), size[-1]]
    motion = {"xyz"[dimension - 1]: f"-{strain * size[-1]}*t"}
    obstacles = [
        {"name": "below", "kind": "plane", "point": [0.0] * dimension, "normal": up},
        {
            "name": "above",
            "kind": "plane",
            "point": top,
            "normal": [-x for x in up],
            "motion": motion,
        },
    ]
    return bodies, [], obstacles


def _bend(
    random: np.random.Generator, dimension: int, strain: float, kind: str
) -> tuple[list[dict[str, Any]], list[dict[str, Any]], list[dict[str, Any]]]:
    """Bend a cantilever by its tip over a ball or a post."""
    depth = float(random.uniform(0.1, 0.3))
    size = [2.0, depth] if dimension == 2 else [2.0, 0.5, depth]
    bodies = [_block(random, "strip", "one", [0.0] * dimension, size)]
    bodies[0]["mesh"]["divisions"][0] = int(random.integers(8, 24 if dimension == 2 else 13))
    place = float(random.uniform(0.6, 1.4))
    axis = "xyz"[dimension - 1]
    motions = [
        {"kind": "fixed", "body": "strip", "on": "left"},
        {"kind": "prescribed", "body": "strip", "on": "right", axis: f"-{strain}*t"},
    ]
    radius = float(random.uniform(0.1, 0.4))
    if random.random() < 0.5:
        middle = [0.0] * (dimension - 2)
        centre = [place, *([0.25] if dimension == 3 else middle), -radius]
        obstacles = [{"name": "ball", "kind": "sphere", "centre": centre, "radius": radius}]
    else:
        corner = [place, *([-0.1] if dimension == 3 else []), -1.0]
        sizes = [0.2, *([0.7] if dimension == 3 else []), 1.0]
        obstacles = [{"name": "post", "kind": "box", "corner": corner, "size": sizes}]
    return bodies, motions, obstacles


@dataclass(frozen=True)
class Tally:
    """What came of the scenes.

    Parameters
    ----------
    statuses
        How many ended how.
    failures
        Those that did not complete, with the reason.
    defect
        The largest defect of the books, of the work.
    iterations
        Newton iterations per load step.
    """

    statuses: dict[str, int]
    failures: list[str]
    defect: float
    iterations: float

    def in_words(self) -> str:
        """Return the summary in a sentence."""
        ended = ", ".join(f"{count} {status}" for status, count in sorted(self.statuses.items()))
        return (
            f"{sum(self.statuses.values())} scenes: {ended}; largest defect {self.defect:.1e} of "
            f"the work; {self.iterations:.2f} iterations per load step."
        )


def run(count: int, first: int = 0) -> Tally:
    """Run so many scenes, and print those that do not complete as they come."""
    seen: Counter[str] = Counter()
    failures = []
    worst_defect, iterations, steps = 0.0, 0, 0
    for seed in range(first, first + count):
        case = scene(seed)
        begun = process_time()
        with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                result = carom.run(case, out=f"{folder}/out")
                status, reason = result.summary["status"], ""
            except carom.CaromError as error:
                result = carom.Result.open(f"{folder}/out")
                status, reason = result.summary["status"], str(error)
        seen[status] += 1
        energy = result.summary["energy"]
        scale = max(energy["strain"], energy["prescribed"], 1e-300)
        worst_defect = max(worst_defect, abs(energy["max_defect"]) / scale)
        iterations += result.summary["newton_iterations"]
        steps += max(result.summary["steps"], 1)
        if status != "completed":
            failures.append(f"{case.title}: {status}: {reason}")
            print(f"{failures[-1]} ({process_time() - begun:.1f} s)", flush=True)
    return Tally(dict(seen), failures, worst_defect, iterations / steps)


def main() -> int:
    """Run the scenes."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 200
    first = int(sys.argv[2]) if len(sys.argv) > 2 else 0
    tally = run(count, first)
    print(tally.in_words())
    return int(bool(tally.failures) or tally.defect > 1e-9)


if __name__ == "__main__":
    sys.exit(main())
