"""Numbers that no command of the project prints: each function returns them by name."""

from __future__ import annotations

import itertools
import os
import re
from pathlib import Path

import bars
import cylinders
from runs import example, simulate

from carom import friction
from carom.friction import bench

from .pages import ROOT


def two_bars() -> dict[str, float]:
    """Run the bars of the README with each condition."""
    found = {}
    for condition, overrides in (
        ("gap", ()),
        ("midpoint", ()),
        ("massless", (bars.CONSERVING,)),
    ):
        run = bars.run(condition=condition, overrides=overrides)
        found[f"{condition}: normal reactions"] = run.energy("normal_contact")
        found[f"{condition}: defect"] = run.energy("max_defect")
        found[f"{condition}: drift"] = run.energy("max_drift")
        found[f"{condition}: certificate"] = run.summary["certificate"]["max_joule"]
    return found


def ten_milliseconds() -> dict[str, float]:
    """Run the cylinders of `cargo bench --bench limit` with ten times the step length."""
    found = {}
    mesh = [f"bodies.{body}.mesh.rings=10" for body in (0, 1)]
    for condition, scheme in (("gap", "theta"), ("midpoint", "conserving")):
        for rubbing in (0.0, 0.2):
            run = cylinders.run(
                friction=rubbing,
                condition=condition,
                divisions=10,
                overrides=(
                    *mesh,
                    f'analysis.scheme={{kind="{scheme}"}}',
                    "analysis.time_step=1e-2",
                ),
            )
            name = f"{condition}, {rubbing:g}"
            summary = run.summary
            found[f"{name}: iterations"] = summary["newton_iterations"] / summary["steps"]
            found[f"{name}: factorisations"] = summary["factorisations"]
            found[f"{name}: halved"] = summary["retried_steps"]
    return found


def two_balls() -> dict[str, float]:
    """Run the paper's second problem in space, with friction and without."""
    found = {}
    for name, rubbing in (("free", 0.0), ("rough", 0.2)):
        run = simulate(example("two_balls.toml", f"contact.friction={rubbing}"))
        found[f"{name}: drift"] = run.energy("max_drift")
        found[f"{name}: defect"] = run.energy("max_defect")
        found[f"{name}: friction"] = run.energy("friction")
    return found


def published() -> dict[str, float]:
    """Solve the problems of `benchmarks/published_problems.py`, in the folder CAROM_FCLIB."""
    cases, _ = bench.read_cases(Path(os.environ["CAROM_FCLIB"]))
    found = [friction.solve(case.problem, tolerance=1e-8, time_limit=30.0) for case in cases]
    return {"problems": len(found), "solved": sum(each.solved for each in found)}


def validation() -> dict[str, float]:
    """Take from docs/validation.md, which a command writes, what other pages sum up."""
    page = (ROOT / "docs" / "validation.md").read_text(encoding="utf-8")
    prize = table(page, "smallest gap [m]", "total variation [N]")
    quiet = [row for row in prize if "massless" in row["run"]]
    free = [row for row in quiet if row["μ"] == "0" and "speed" not in row["run"]]
    rough = [row for row in quiet if row["μ"] != "0"]
    by_name = {row["run"].split("`")[1]: row for row in prize}
    conditions = table(page, "condition", "peak force, first impact [N]")
    by_condition = {row["condition"].strip("`"): row for row in conditions if row["μ"] == "0"}
    conserving = table(page, "Δt [s]", "largest drift", "iterations per step")
    scenes = {
        (row["scheme"].strip("`"), row["condition"].strip("`")): row
        for row in table(page, "scheme", "scenes > 1e-9")
    }
    massless = scenes["conserving", "massless"]
    loads = {row["case"]: number(row["largest defect"]) for row in table(page, "case")}
    steps = [number(row["ms/step"]) / number(by_name["gap"]["ms/step"]) for row in free]
    found = {
        "certificate": max(number(row["certificate [J]"]) for row in [*prize, *conditions]),
        "massless: drift": max(number(row["drift"]) for row in free),
        "massless: gap": min(number(row["smallest gap [m]"]) for row in quiet),
        "massless: momenta": max(number(row["momenta"]) for row in free),
        "massless: least variation": min(number(row["total variation [N]"]) for row in free),
        "massless: largest variation": max(number(row["total variation [N]"]) for row in free),
        "massless: rough defect": max(number(row["defect"]) for row in rough),
        "massless: least friction": min(number(row["least friction [J]"]) for row in rough),
        "massless: least cost": min(steps),
        "massless: largest cost": max(steps),
        "scenes: all": number(massless["completed"].split(" of ")[1]),
        "scenes: beyond 1e-9": number(massless["scenes > 1e-9"]),
        "scenes: largest defect": number(massless["largest"]),
        "scenes: slowest": number(massless["ms/step, largest"]),
        "loads: gravity": loads["gravity"],
        "loads: damping": max(loads.values()),
        "conserving: defect": max(number(row["largest defect"]) for row in conserving),
    }
    for condition in ("gap", "midpoint"):
        found[f"{condition}: variation"] = number(by_name[condition]["total variation [N]"])
    for condition in ("gap", "midpoint", "massless"):
        completed = scenes["conserving", condition]["completed"]
        found[f"scenes: {condition}"] = number(completed.split(" of ")[0])
    for condition, row in by_condition.items():
        found[f"{condition}: normal reactions"] = number(row["normal contact"])
        found[f"{condition}: gap [m]"] = abs(number(row["smallest gap [m]"]))
        found[f"{condition}: gap [mm]"] = 1e3 * found[f"{condition}: gap [m]"]
        found[f"{condition}: defect"] = number(row["largest defect"])
    for row in conserving:
        if row["μ"] == "0":
            found[f"conserving, {row['Δt [s]']} s: drift"] = number(row["largest drift"])
    return found


def reliability() -> dict[str, float]:
    """Take from the table of docs/reliability.md what the page sums up."""
    page = (ROOT / "docs" / "reliability.md").read_text(encoding="utf-8")
    scenes = table(page, "scheme", "scenes", "completed")
    titles = {"completed": "completed", "failed": "failed, with its reason"}
    return {name: sum(number(row[title]) for row in scenes) for name, title in titles.items()}


def table(page: str, *titles: str) -> list[dict[str, str]]:
    """Return the rows of the first table that has these columns.

    Raises
    ------
    ValueError
        If there is no such table.
    """
    lines = page.splitlines()
    for place, line in enumerate(lines):
        header = cells(line)
        if header and set(titles) <= set(header) and set("".join(cells(lines[place + 1]))) == {"-"}:
            rows = itertools.takewhile(lambda each: each.startswith("|"), lines[place + 2 :])
            return [dict(zip(header, cells(row), strict=True)) for row in rows]
    raise ValueError(f"no table with the columns {', '.join(titles)}")


def cells(line: str) -> list[str]:
    """Return the cells of a row of a table, none of another line."""
    return [each.strip() for each in line.split("|")[1:-1]] if line.startswith("|") else []


def number(shown: str) -> float:
    """Return a number as commands and pages print it."""
    return float(re.sub(r"[ ,%]", "", shown).replace("−", "-"))
