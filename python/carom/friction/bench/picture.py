"""Performance profiles as a picture."""

from __future__ import annotations

from itertools import cycle
from pathlib import Path

import matplotlib as mpl
import numpy as np

from carom.friction.bench.comparison import Comparison
from carom.friction.bench.profile import ratios
from carom.friction.bench.report import label
from carom.plot.style import figure, save

PICTURE = "profile.png"
"""Name of the picture in a report."""

WIDEST = 1e4
"""Largest factor that is drawn."""


def draw_profile(comparison: Comparison, folder: Path) -> Path:
    """Draw the share of problems solved within a factor of the least time, by solver."""
    found = ratios([*comparison.runs, *comparison.peer_runs])
    finite = np.concatenate([each[np.isfinite(each)] for each in found.values()] or [np.ones(1)])
    widest = min(WIDEST, 1.5 * float(finite.max(initial=2.0)))
    with figure(height=4.2) as picture:
        axes = picture.add_subplot()
        colours = {
            solver: colour
            for solvers, palette in (
                (comparison.solvers, "tab10"),
                (comparison.peer_solvers, "Set2"),
            )
            for solver, colour in zip(solvers, cycle(mpl.color_sequences[palette]))
        }
        for solver, each in found.items():
            peer = solver in comparison.peer_solvers
            steps = np.concatenate([[1.0], each[np.isfinite(each)], [max(widest, 1.0)]])
            share = np.searchsorted(each, steps, side="right") / len(each)
            axes.step(
                steps,
                share,
                "--" if peer else "-",
                where="post",
                color=colours[solver],
                linewidth=1.2 if peer else 1.8,
                label=label(comparison, solver),
            )
        axes.set_xscale("log")
        axes.set_xlim(1.0, widest)
        axes.set_ylim(0.0, 1.02)
        axes.set_xlabel("time over the least time of all solvers")
        axes.set_ylabel("share of problems solved")
        axes.set_title(f"{len(comparison.cases)} problems, tolerance {comparison.tolerance:g}")
        picture.legend(loc="outside right center", fontsize=8)
    folder.mkdir(parents=True, exist_ok=True)
    return save(picture, folder / PICTURE)
