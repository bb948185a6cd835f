"""Numbers that no command of the project prints: each function returns them by name."""

from __future__ import annotations

import itertools
import math
import os
import re
import sys
import tempfile
from pathlib import Path

import bars
import cylinders
import tomlkit
from runs import example, simulate

import carom
from carom import friction
from carom.friction import bench
from carom.mesh_file import read_body_mesh
from carom.new.mesh_case import mesh_case as template_of_part
from carom.new.template import template

from .pages import ROOT, Page

GRAVITY = 9.81
"""As the cases of the pages have it [m/s²]."""


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
    of_gap = next(row for row in free if "Δt = 0.001 s" in row["run"])
    found = {
        "certificate": max(number(row["certificate [J]"]) for row in [*prize, *conditions]),
        "massless: drift": max(number(row["drift"]) for row in free),
        "massless: gap": min(number(row["smallest gap [m]"]) for row in quiet),
        "massless: momenta": max(number(row["momenta"]) for row in free),
        "massless: least variation": min(number(row["total variation [N]"]) for row in free),
        "massless: largest variation": max(number(row["total variation [N]"]) for row in free),
        "massless: rough defect": max(number(row["defect"]) for row in rough),
        "massless: least friction": min(number(row["least friction [J]"]) for row in rough),
        "massless: cost": number(of_gap["ms/step"]) / number(by_name["gap"]["ms/step"]),
        "scenes: cost": number(massless["ms/step, median"])
        / number(scenes["conserving", "gap"]["ms/step, median"]),
        "scenes: all": number(massless["completed"].split(" of ")[1]),
        "scenes: beyond 1e-9": number(massless["scenes > 1e-9"]),
        "scenes: largest defect": number(massless["after whole steps"]),
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


def two_bodies() -> dict[str, float]:
    """Run the case of the tutorial, and once more without friction."""
    with tempfile.TemporaryDirectory() as directory:
        file = Path(directory) / "case.toml"
        file.write_text(template("two-bodies"), encoding="utf-8")
        scenario = carom.Scenario.from_toml(file)
        rough = carom.run(scenario, out=file.with_name("rough")).summary
        smooth = scenario.with_overrides(["contact.friction=0"])
        smooth_energy = carom.run(smooth, out=file.with_name("smooth")).summary["energy"]
    (contact,) = rough["contacts"]
    return {
        "onset [ms]": 1e3 * contact["onset"],
        "release [ms]": 1e3 * contact["release"],
        "peak [kN]": 1e-3 * contact["peak_force"],
        "friction": rough["energy"]["friction"],
        "lost": rough["energy"]["initial"] - rough["energy"]["final"],
        "certificate": rough["certificate"]["max_joule"],
        "frictionless drift": smooth_energy["max_drift"],
    }


def mesh_case() -> dict[str, float]:
    """Take from the case that `carom new mesh-file` writes what the tutorial for a part says."""
    mesh = ROOT / "docs" / "gallery" / "bracket.msh"
    text = template_of_part(mesh, mesh.with_suffix(".toml"), unit="mm", material="steel")
    case = tomlkit.parse(text).unwrap()
    arrays = read_body_mesh(mesh, body=None, scale=1.0, space=3, key="")
    low, high = arrays.points.min(axis=0), arrays.points.max(axis=0)
    size = float((high - low).max())
    above = 1e-3 * float(low[2]) - case["obstacles"][0]["point"][2]
    speed = -case["bodies"][0]["velocity"][2]
    return {
        "gap [%]": 100.0 * above / (1e-3 * size),
        "speed": speed,
        "height": speed**2 / (2.0 * GRAVITY),
        "from half a metre": math.sqrt(2.0 * GRAVITY * 0.5),
        "from a metre": math.sqrt(2.0 * GRAVITY),
        "friction": case["contact"]["friction"],
        "young [GPa]": 1e-9 * case["materials"]["steel"]["young"],
        "size in the file": size,
    }


def incline() -> dict[str, float]:
    """Slide the block of the examples in C and Fortran, by what does the same in Python."""
    sys.path.insert(0, str(ROOT / "tests" / "unit" / "contact"))
    import twins  # noqa: PLC0415 (of the tests)

    friction, step = 0.3, 1e-3
    steep, shallow = 0.5, 0.1
    rows = twins.incline(slopes=((steep, 500), (shallow, 700)))
    first, second = rows[:10], rows[10:]
    gain = GRAVITY * (math.sin(steep) - friction * math.cos(steep))
    # The mean speed of the last 50 steps, and what is gained from their middle to their end.
    speed = (first[-1, 5] - first[-2, 5]) / (50 * step) + 24.5 * step * gain
    brake = GRAVITY * (friction * math.cos(shallow) - math.sin(shallow))
    return {
        "steep: speed": abs(speed / (1.0 + gain * first[-1, 0]) - 1.0),
        "shallow: way": abs(second[-1, 5] * 2.0 * brake - 1.0),
    }


def by_hand() -> dict[str, float]:
    """Work out what pages work out by hand, from the numbers of the cases that they show."""

    def of(page: str, expression: str) -> list[float]:
        blocks = Page.read(page).blocks
        found = re.search(expression, blocks)
        if found is None:
            raise ValueError(f"{page} shows nothing like {expression!r}")
        return [number(group) for group in found.groups()]

    teacher = "docs/tutorials/teacher.md"
    place, radius = of(teacher, r"Disc\(centre=\[0.0, (\S+)\], radius=(\S+),")
    friction, restitution = of(teacher, r"friction=(\S+), restitution=(\S+)\)")
    fit = "docs/how-to/press-fits.md"
    young, poisson = of(fit, r"young=(\S+), poisson=(\S+),")
    inner, outer = of(fit, r"inner_radius=(\S+), outer_radius=(\S+),")
    (delta,) = of(fit, r'interference="(\S+)\*t"')
    (struck,) = of("docs/how-to/stages.md", r"end_time=(1\.\d*[1-9]), time_step")
    laws = "docs/how-to/friction-laws.md"
    static, kinetic, distance = of(
        laws, r"StaticKinetic\(static=(\S+), kinetic=(\S+), distance=(\S+)\)"
    )
    (mass,), (gravity,) = of(laws, r"mass=(\S+),"), of(laws, r"gravity=\[0.0, -(\S+)\]")
    (way,) = of(laws, r"weakening: (\S+) m")
    ring = (outer**2 - inner**2) / (2.0 * inner * outer**2 * (1.0 - poisson**2))
    fall = place - radius
    return {
        "teacher: height": fall,
        "teacher: restitution": restitution,
        "teacher: friction": friction,
        "teacher: bounce": friction * (1.0 + restitution) * math.sqrt(2.0 * GRAVITY * fall),
        "press fit: Lamé [MPa]": 1e-6 * young * delta * ring,
        "press fit: interference [µm]": 1e6 * delta,
        "stages: end of the hit": struck,
        "stages: length of the hit [ms]": 1e3 * (struck - 1.0),
        "friction laws: static": static,
        "friction laws: kinetic": kinetic,
        "friction laws: distance": distance,
        "friction laws: weight": mass * gravity,
        "friction laws: weakening": (static - kinetic) / 2.0 * distance * mass * gravity,
        "friction laws: way": way,
        "friction laws: rest": kinetic * mass * gravity * way,
    }


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
