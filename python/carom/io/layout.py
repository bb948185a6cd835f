"""The names of the files in a results directory."""

from __future__ import annotations

from pathlib import Path

from carom.errors import InputError

CASE = "case.toml"
SUMMARY = "summary.json"
HISTORY = "history.csv"
FIELDS = "fields.vtkhdf"
SURFACE = "surface.vtkhdf"
LEDGER = "ledger.csv"
AUDIT = "audit.h5"
ENERGY_PLOT = "energy.png"
REPORT = "report.html"
FAILED_PROBLEM = "failed_contact_problem.hdf5"

_NAMES = (
    *(SUMMARY, CASE, HISTORY, LEDGER, FIELDS, SURFACE, AUDIT, ENERGY_PLOT, REPORT),
    FAILED_PROBLEM,
)


def track_plot(name: str) -> str:
    """Return the file name of the plot of a tracked point."""
    return f"track-{name}.png"


def clear(directory: Path) -> None:
    """Remove what an earlier run left, the summary first: without it, no results are claimed.

    Raises
    ------
    InputError
        The directory is not one of results and has files that a run would overwrite.
    """
    present = [name for name in _NAMES if (directory / name).exists()]
    if not {HISTORY, FIELDS} <= set(present):
        if present:
            raise InputError(
                f"{directory}: has a {present[0]} that is not of a carom run; choose another --out"
            )
        return
    for name in present:
        (directory / name).unlink()
    for plot in directory.glob(track_plot("*")):
        plot.unlink()
