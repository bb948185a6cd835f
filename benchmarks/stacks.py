"""Stacks of flush boxes at rest: how far they move, how deep they sink in, what they cost.

    .venv/bin/python benchmarks/stacks.py [2d | 3d] [boxes ...]

Boxes of one metre are let go on one another and damped for 5 s, on equal meshes and on such of 3
and 2 cells in turn, with default settings and with the condition `gap`. Prints a table of

- the largest way of a box across, the mean over its nodes, and the largest penetration at any time,
  both in sizes of a box,
- the kinetic energy at the end over m g h,
- the iterations per step in the last second, and the time of the run.
"""

from __future__ import annotations

import sys
import warnings
from itertools import product
from time import process_time
from typing import Any

import numpy as np

import carom
from carom.building.build import build

GRAVITY = 9.81
DENSITY = 1000.0

SETTINGS: dict[str, dict[str, Any]] = {"default": {}, "gap": {"condition": "gap"}}


def main() -> None:
    """Print the table."""
    words = sys.argv[1:]
    dimensions = [d for d in (2, 3) if f"{d}d" in words or not {"2d", "3d"} & set(words)]
    counts = [int(word) for word in words if word.isdigit()] or [2, 5, 10, 20]
    heads = ("across", "depth", "kinetic", "its", "s")
    print(f"{'stack':28}" + "".join(f"{head:>10}" for head in heads))
    for dimension, count, cells, setting in product(dimensions, counts, ((2,), (3, 2)), SETTINGS):
        row = rest(dimension, count, cells, SETTINGS[setting])
        meshes = ":".join(map(str, cells)) if len(cells) > 1 else "equal"
        numbers = "".join(f"{row[head]:10.1e}" for head in heads[:3])
        name = f"{count} boxes {dimension}D {meshes} {setting}"
        print(f"{name:28}{numbers}{row['its']:10.2f}{row['s']:10.1f}  {row['why']}", flush=True)


def stack(
    dimension: int, count: int, cells: tuple[int, ...], contact: dict[str, Any], end: float
) -> carom.Scenario:
    """Return the scenario of so many boxes, whose meshes have these numbers of cells in turn."""
    across = dimension - 1
    bodies = [
        {
            "name": f"box-{k}",
            "material": "m",
            "mesh": {
                "kind": "box" if dimension == 3 else "rectangle",
                "corner": [0.0] * across + [float(k)],
                "size": [1.0] * dimension,
                "divisions": [cells[k % len(cells)]] * dimension,
            },
        }
        for k in range(count)
    ]
    up = [0.0] * across + [1.0]
    material = {"kind": "neo-hookean", "young": 1e7, "poisson": 0.3, "density": DENSITY}
    material["damping"] = {"mass": 12.0, "stiffness": 1e-4}
    case = {
        "dimension": dimension,
        "analysis": {
            "kind": "dynamic",
            "end_time": end,
            "time_step": 5e-3,
            "gravity": [-GRAVITY * x for x in up],
        },
        "materials": {"m": material},
        "bodies": bodies,
        "obstacles": [{"name": "floor", "kind": "plane", "point": [0.0] * dimension, "normal": up}],
        "contact": {"friction": 0.3, **contact},
    }
    return carom.Scenario.model_validate(case)


def rest(
    dimension: int, count: int, cells: tuple[int, ...], contact: dict[str, Any], end: float = 5.0
) -> dict[str, Any]:
    """Return what became of a stack."""
    scenario = stack(dimension, count, cells, contact, end)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        simulation = build(scenario, [])
    columns = simulation.history_columns()
    simulation.take_history()
    owners = bodies_of_nodes(scenario)
    dt, across, rows, began, why = scenario.analysis.time_step, 0.0, [], process_time(), ""
    for step in range(round(scenario.analysis.end_time / dt)):
        try:
            simulation.advance((step + 0.5) * dt, 1e9)
        except carom.ConvergenceError as error:
            why = f"t = {step * dt:g} s: {error}"
            break
        rows.extend(simulation.take_history())
        if step % 10 == 9:
            moved = simulation.fields()["displacement"][:, : dimension - 1]
            means = [moved[owners == body].mean(axis=0) for body in range(count)]
            across = max(across, float(np.abs(means).max()))
    table = np.array(rows)
    last = table[:, columns.index("time")] > scenario.analysis.end_time - 1.0
    weight = DENSITY * GRAVITY * count * count / 2.0
    return {
        "across": across,
        "depth": float(table[:, columns.index("penetration")].max()),
        "kinetic": float(table[-1, columns.index("kinetic")]) / weight,
        "its": float(table[last, columns.index("newton_iterations")].mean())
        if last.any()
        else np.nan,
        "s": process_time() - began,
        "why": why,
    }


def bodies_of_nodes(scenario: carom.Scenario) -> np.ndarray:
    """Return the number of the body of every node."""
    counts = [np.prod([n + 1 for n in body.mesh.divisions]) for body in scenario.bodies]
    return np.repeat(np.arange(len(counts)), counts)


if __name__ == "__main__":
    main()
