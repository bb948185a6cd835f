"""The names of the files in a results directory."""

from __future__ import annotations

from pathlib import Path

CASE = "case.toml"
SUMMARY = "summary.json"
HISTORY = "history.csv"
FIELDS = "fields.vtkhdf"
ENERGY_PLOT = "energy.png"


def track_plot(name: str) -> str:
    """Return the file name of the plot of a tracked point."""
    return f"track-{name}.png"


def clear(directory: Path) -> None:
    """Remove what an earlier run left, the summary first: without it, no results are claimed."""
    for name in (SUMMARY, CASE, HISTORY, FIELDS, ENERGY_PLOT):
        (directory / name).unlink(missing_ok=True)
    for plot in directory.glob(track_plot("*")):
        plot.unlink()
