"""One run of a study, in whatever process it is."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from carom.building.build import build
from carom.case.scenario import Scenario
from carom.errors import CaromError, InputError
from carom.io import layout
from carom.io.summary import read_summary
from carom.mesh_file import Note
from carom.results.doubts import Doubt
from carom.running.run import drive
from carom.sweep.stopping import is_cut
from carom.system.interrupt import Terminated, terminable

STOPPED = ("interrupted", "the study was stopped")
"""What becomes of a run whose study ends before it."""


@dataclass(frozen=True)
class Task:
    """What a process is told: plain data, which goes to other machines too.

    Parameters
    ----------
    case
        The scenario as plain data.
    directory
        Where its results go.
    """

    case: dict[str, Any]
    directory: str


def work(task: Task) -> dict[str, Any]:
    """Run a point; return its summary, or a status and a reason where there is none."""
    with terminable():
        try:
            return refused(*STOPPED) if is_cut() else _run(task)
        except Terminated:
            if not is_cut():
                raise
            return refused(*STOPPED)


def _run(task: Task) -> dict[str, Any]:
    directory = Path(task.directory)
    try:
        scenario = Scenario.from_dict(task.case)
        notes: list[Note] = []
        simulation = build(scenario, notes)
        result = drive(simulation, scenario, directory, force=True, notes=notes, notify=_leave)
        return dict(result.summary)
    except InputError as error:
        return refused("refused", str(error))
    except CaromError as error:
        return _left(directory) or refused("failed", str(error))
    except OSError as error:
        return refused("failed", f"{error.filename or directory}: {error.strerror or error}")


def _leave(doubt: Doubt) -> None:
    """Leave a doubt to the table of the study, which has those of every run."""


def refused(status: str, reason: str) -> dict[str, Any]:
    """Return what stands for the summary of a run that has none."""
    return {"status": status, "reason": " ".join(reason.split())}


def _left(directory: Path) -> dict[str, Any] | None:
    try:
        return read_summary(directory / layout.SUMMARY)
    except (OSError, ValueError):
        return None
