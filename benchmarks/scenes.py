"""The scenes of contact, judged step by step by geometry libraries that know nothing of carom.

    pip install shapely manifold3d gmsh
    .venv/bin/python benchmarks/scenes.py [part of a name ...]

A scene is right if it completes and nothing is in anything by more than the run said, or if it ends
with the reason. It is silent if the judge sees an intersection that the history does not tell of.
Prints a table, and ends with exit status 1 if a scene was silent.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np
from judge import Judge
from scene_list import SCENES

import carom
from carom.building.build import build

SEEN = 1e-9
"""Thickness of an intersection that is none, of the size of the scene."""

TOLD = 0.1
"""Part of what the judge sees that the run must have told of."""


def main() -> None:
    """Run the scenes whose names hold all the words given."""
    words = sys.argv[1:]
    chosen = {name: make for name, make in SCENES.items() if all(word in name for word in words)}
    heads = ("told", "allowed", "seen", "defect")
    titles = "".join(f"{head:>10}" for head in heads)
    print(f"{'scene':40} {'ended':14}{titles}{'its':>6}{'s':>7}")
    silent = []
    for name, make in chosen.items():
        with tempfile.TemporaryDirectory() as folder:
            row = judged(carom.Scenario.model_validate(make(Path(folder))))
        numbers = "".join(f"{row[head]:10.1e}" for head in heads)
        rest = f"{row['iterations']:6.1f}{row['seconds']:7.1f}  {row['why']}"
        print(f"{name:40} {row['ended']:14}{numbers}{rest}".rstrip(), flush=True)
        if row["silent"]:
            silent.append(name)
            time, told, seen = row["silent"]
            print(f"  SILENT at t = {time:.4g} s: told {told:.2e} m, seen {seen:.2e} m")
    print(f"{len(chosen)} scenes, {len(silent)} silent")
    raise SystemExit(bool(silent))


def judged(scenario: carom.Scenario) -> dict[str, Any]:
    """Return what became of a scene."""
    simulation = build(scenario, [])
    judge = Judge(scenario, simulation.surface())
    columns = simulation.history_columns()
    points = simulation.mesh()["points"]
    simulation.take_history()
    dt, end = scenario.analysis.time_step, scenario.analysis.end_time
    row: dict[str, Any] = {"ended": "completed", "why": "", "seen": 0.0, "silent": None}
    rows, seconds = [], process_time()
    size = float(np.ptp(points, axis=0).max())
    spent = 0.0
    steps = round(end / dt)
    every = max(1, steps // 200)
    for step in range(1, steps + 1):
        try:
            simulation.advance((step - 0.5) * dt, 1e9)
        except carom.ConvergenceError as error:
            row["ended"], row["why"] = "not converged", str(error)[:110]
            break
        new = simulation.take_history()
        rows.extend(new)
        if step % every:
            continue
        told = float(rows[-1][columns.index("penetration")])
        began = process_time()
        x = (points + simulation.fields()["displacement"])[:, : scenario.dimension]
        seen = judge.depth(x)
        spent += process_time() - began
        row["seen"] = max(row["seen"], seen if np.isfinite(seen) else 0.0)
        is_told = told > TOLD * seen if np.isfinite(seen) else told > 0.0
        if seen > SEEN * size + judge.blur(x) and not is_told and row["silent"] is None:
            row["silent"] = (step * dt, told, seen)
    table = np.array(rows)
    of = {
        name: table[:, columns.index(name)]
        for name in ("penetration", "defect", "newton_iterations")
    }
    summary = simulation.summary()
    worst = summary["penetration"]["worst"]
    row["told"] = float(of["penetration"].max())
    row["allowed"] = worst["allowed"] if worst else 0.0
    if worst and worst["depth"] > worst["allowed"] and row["ended"] == "completed":
        row["ended"] = "intersecting"
    row["defect"] = float(np.abs(of["defect"]).max())
    row["iterations"] = float(of["newton_iterations"].mean())
    row["seconds"] = process_time() - seconds - spent
    return row


if __name__ == "__main__":
    main()
