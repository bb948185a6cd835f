"""The names of the files in a results directory."""

from __future__ import annotations

from pathlib import Path

from carom.system.existing import entries, refuse_foreign

CASE = "case.toml"
SUMMARY = "summary.json"
HISTORY = "history.csv"
FIELDS = "fields.vtkhdf"
SURFACE = "surface.vtkhdf"
LEDGER = "ledger.csv"
AUDIT = "audit.h5"
ENERGY_PLOT = "energy.png"
REPORT = "report.html"
MODES = "modes.csv"
FAILED_PROBLEM = "failed_contact_problem.hdf5"
PROGRESS = "progress.json"
"""There while the run goes on, and after it was killed."""

LOCK = "run.lock"
"""What a run holds while it goes on, see `carom.io.claim`."""

DIGESTED = (CASE, HISTORY, LEDGER)
"""Files of which the summary has digests: text that is easily edited."""

CHECKPOINT = "checkpoint.h5"
PREVIOUS_CHECKPOINT = "checkpoint-previous.h5"
FRESH_CHECKPOINT = "checkpoint-fresh.h5"
"""A whole one that has not taken the place of the last yet."""

END_STATE = "end_state.h5"
"""The state in which a completed run ended, from which another case may go on."""

UNFINISHED = ".unfinished"
"""What ends the name of a file that is being written."""

JOURNAL = ".journal"
"""What ends the name of a file with a change of another, see `carom.io.journal`."""

CHECKPOINTS = (CHECKPOINT, FRESH_CHECKPOINT, PREVIOUS_CHECKPOINT)
"""The latest first."""

ENDED = ("completed", "uncertified", "intersecting", "failed")
"""Statuses of runs that came to an end of their own: there is nothing to go on with."""

_NAMES = (
    SUMMARY,
    *CHECKPOINTS,
    CASE,
    HISTORY,
    LEDGER,
    FIELDS,
    SURFACE,
    AUDIT,
    END_STATE,
    ENERGY_PLOT,
    REPORT,
    MODES,
    FAILED_PROBLEM,
)


def track_plot(name: str) -> str:
    """Return the file name of the plot of a tracked point."""
    return f"track-{name}.png"


def has_results(directory: Path) -> bool:
    """Return whether a run has left anything in a directory.

    Raises
    ------
    InputError
        The directory is not one of results and has something in it, or there can be none.
    """
    there = entries(directory)
    # A run makes its lock and its progress file before any other: one killed early has these.
    if PROGRESS in there or {HISTORY, FIELDS} <= there:
        return not there.isdisjoint(_NAMES)
    refuse_foreign(directory, there - {LOCK, f"{PROGRESS}{UNFINISHED}"}, of="a carom run")
    return False


def clear(directory: Path) -> None:
    """Remove what an earlier run left, the summary first: without it, no results are claimed.

    Raises
    ------
    InputError
        See `has_results`.
    """
    if has_results(directory):
        for name in _NAMES:
            (directory / name).unlink(missing_ok=True)
            (directory / f"{name}{JOURNAL}").unlink(missing_ok=True)
        forget_outcome(directory)


def forget_outcome(directory: Path) -> None:
    """Remove what is written at the end of a run, and what was being written when it stopped."""
    for name in (SUMMARY, END_STATE, ENERGY_PLOT, REPORT, MODES, FAILED_PROBLEM):
        (directory / name).unlink(missing_ok=True)
    for name in (*_NAMES, PROGRESS):
        (directory / f"{name}{UNFINISHED}").unlink(missing_ok=True)
    for plot in directory.glob(track_plot("*")):
        plot.unlink()
