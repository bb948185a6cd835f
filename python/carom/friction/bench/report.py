"""A comparison as tables: Markdown for people, CSV and JSON for programs."""

from __future__ import annotations

import csv
import json
import math
from dataclasses import asdict, fields
from pathlib import Path

from carom.display.sheet import Sheet
from carom.friction.bench import siconos
from carom.friction.bench.comparison import WORTH_TUNING, Comparison, geometric_mean
from carom.friction.bench.profile import ratios, shares
from carom.friction.bench.run import Run

MARKDOWN, CSV, JSON = "table.md", "table.csv", "table.json"
"""Files of a report."""

FACTORS = (1.0, 2.0, 5.0, 10.0, 100.0)
"""Factors of the least time that the table of profiles has columns for."""


def write_report(comparison: Comparison, folder: Path) -> list[Path]:
    """Write the tables into a folder and return their paths."""
    runs = [*comparison.runs, *comparison.peer_runs]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / MARKDOWN).write_text(markdown(comparison), encoding="utf-8")
    with (folder / CSV).open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["contacts", "dimension", *(field.name for field in fields(Run))])
        sizes = {case.name: case.problem for case in comparison.cases}
        for run in runs:
            problem = sizes[run.case]
            writer.writerow([problem.contacts, problem.dimension, *asdict(run).values()])
    data = {
        "tolerance": comparison.tolerance,
        "time_limit_s": comparison.time_limit,
        "runs": [_plain(run) for run in runs],
    }
    (folder / JSON).write_text(json.dumps(data, indent=2) + "\n", encoding="utf-8")
    return [folder / name for name in (MARKDOWN, CSV, JSON)]


def markdown(comparison: Comparison) -> str:
    """Return the tables with what follows from them."""
    told = (table(part) if isinstance(part, Sheet) else part for part in parts(comparison))
    return "\n\n".join(told) + "\n"


def parts(comparison: Comparison) -> list[str | Sheet]:
    """Return the tables and what is said between them."""
    limit, tolerance = comparison.time_limit, comparison.tolerance
    told: list[str | Sheet] = [
        f"Median time of a solve from zero in ms, one thread, tolerance {tolerance:g}, at most "
        f"{limit:g} s; a word where the answer is none.",
        times_table(comparison),
    ]
    if comparison.peer_runs:
        told += [
            f"Against {siconos.NAME}, whose answers are measured by the same residual:",
            peer_table(comparison),
            *(speed_up_text(comparison, solver) for solver in comparison.solvers[:1]),
        ]
    told += [
        "Share of its problems that a solver solves within so many times the least time of all:",
        profile_table(comparison),
        false_success_text(comparison),
    ]
    return told


def times_table(comparison: Comparison) -> Sheet:
    """Return the times of carom's solvers by problem."""
    rows = [
        [case.name, str(case.problem.contacts), f"{case.problem.dimension}D"]
        + [shown(comparison.run(case.name, solver)) for solver in comparison.solvers]
        for case in comparison.cases
    ]
    return Sheet(["problem", "contacts", "", *comparison.solvers], rows, keys=3)


def peer_table(comparison: Comparison) -> Sheet:
    """Return the times of the other code, its best, and how much faster carom's default is."""
    solver = comparison.solvers[0]
    faster = comparison.speed_ups(solver)
    rows = []
    for case in comparison.cases:
        best = comparison.best_peer(case.name)
        rows.append(
            [
                case.name,
                shown(comparison.run(case.name, solver)),
                f"{shown(best)} ({best.solver})" if best else "none",
                f"{faster[case.name]:.2g}" if case.name in faster else "–",
            ]
            + [shown(comparison.run(case.name, peer)) for peer in comparison.peer_solvers]
        )
    header = ["problem", f"carom {solver}", f"best of {siconos.NAME}", "times faster"]
    return Sheet([*header, *comparison.peer_solvers], rows)


def speed_up_text(comparison: Comparison, solver: str) -> str:
    """Return in words how a solver compares with the best of the other code."""
    everywhere = comparison.speed_ups(solver)
    slow = comparison.speed_ups(solver, least_time=WORTH_TUNING)
    slower = [case for case, ratio in slow.items() if ratio < 1.0]
    own = sum(run.solved for run in comparison.runs if run.solver == solver)
    peer = len({run.case for run in comparison.peer_runs if run.solved})
    compared = {run.case for run in comparison.peer_runs}
    text = (
        f"`{solver}` solves {own} of {len(comparison.cases)} problems, all solvers of "
        f"{siconos.NAME} together {peer} of {len(compared)}. Where both do, `{solver}` is "
        f"{geometric_mean(everywhere.values()):.3g} times faster than the best of them for each "
        f"problem (geometric mean of {len(everywhere)}), and {geometric_mean(slow.values()):.3g} "
        f"times on the {len(slow)} that take these 1 ms or more."
    )
    return text + (f" It is slower on {', '.join(slower)}." if slower else "")


def profile_table(comparison: Comparison) -> Sheet:
    """Return the performance profiles of all solvers at some factors."""
    found = ratios([*comparison.runs, *comparison.peer_runs])
    solved = shares(found, [*FACTORS, FAR])
    rows = [
        [label(comparison, solver), *(f"{100 * share:.0f} %" for share in part)]
        for solver, part in sorted(solved.items(), key=lambda item: [-x for x in item[1][::-1]])
    ]
    return Sheet(["solver", *(f"{factor:g}×" for factor in FACTORS), "at all"], rows)


FAR = 1e300
"""A factor that only what is not solved exceeds."""


def false_success_text(comparison: Comparison) -> str:
    """Return in words whose claim to have solved a problem does not hold."""
    runs = comparison.false_successes
    if not runs:
        return "No solver says that it solved a problem that it did not."
    lines = [
        f"- {label(comparison, run.solver)} on {run.case}: residual {run.residual:.2e}"
        for run in runs
    ]
    return "\n".join(["Taken for solved by the solver, but above the tolerance:", "", *lines])


def label(comparison: Comparison, solver: str) -> str:
    """Return a solver's name with its code's, if that is not carom."""
    return f"{siconos.NAME} {solver}" if solver in comparison.peer_solvers else solver


def shown(run: Run | None) -> str:
    """Return a time in ms with three digits, or why there is none."""
    if run is None:
        return "–"
    return f"{1e3 * run.time:.3g}" if run.solved else run.status


def table(sheet: Sheet) -> str:
    """Return a Markdown table."""
    lines = [sheet.header, ["---"] * len(sheet.header), *sheet.rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def _plain(run: Run) -> dict[str, object]:
    """Return a run for JSON, which has no word for what is not finite."""
    return {
        key: None if isinstance(value, float) and not math.isfinite(value) else value
        for key, value in asdict(run).items()
    }
