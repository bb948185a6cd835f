"""Going on with a run that was stopped: which checkpoint, and whether it is of this case."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from carom._carom import Simulation
from carom.building.identity import difference, what_counts
from carom.case.scenario import Scenario
from carom.errors import InputError
from carom.io import layout
from carom.io.checkpoint import Checkpoint, DamagedError, read_checkpoint
from carom.io.summary import read_summary
from carom.results.doubts import Doubt
from carom.results.result import Result, read_case
from carom.running.recorder import conclude

Notify = Callable[[Doubt], None]
"""What is told that the user should know something."""


def ended(directory: Path, scenario: Scenario) -> Result | None:
    """Return the results of a run of this scenario that has ended; None if there is more to do.

    The last files are made where it was stopped in the middle of them.

    Raises
    ------
    InputError
        The results are of another case.
    """
    try:
        status = read_summary(directory / layout.SUMMARY)["status"]
    except (OSError, ValueError, KeyError, TypeError):
        return None
    if status not in layout.ENDED:
        return None
    refuse_other_results(directory, scenario)
    if (directory / layout.PROGRESS).exists():  # stopped in the middle of its last files
        return conclude(directory, reports=scenario.output.report)
    return Result.open(directory)


def latest(
    directory: Path, case: Mapping[str, Any], simulation: Simulation, notify: Notify
) -> Checkpoint | None:
    """Restore the last good checkpoint of a directory and return it; None if there never was one.

    Raises
    ------
    InputError
        It is of another case, or there is none that is whole.
    """
    damaged: list[tuple[Path, str]] = []
    for name in (layout.CHECKPOINT, layout.FRESH_CHECKPOINT, layout.PREVIOUS_CHECKPOINT):
        try:
            checkpoint = read_checkpoint(directory / name)
            _refuse_another(directory, dict(case), checkpoint.case)
            simulation.restore(checkpoint.arrays)
        except FileNotFoundError:
            continue
        except DamagedError as error:
            damaged.append((directory / name, str(error)))
        except ValueError as error:
            if isinstance(error, InputError):
                raise
            damaged.append((directory / name, f"{directory / name} does not fit: {error}"))
        else:
            for file, wrong in damaged:
                notify(
                    Doubt(
                        "checkpoint-damaged",
                        f"{wrong}; goes on from the checkpoint at t = {checkpoint.time:g} s",
                        str(file),
                    )
                )
            return checkpoint
    if damaged:
        raise InputError(
            f"{damaged[0][1]}, and there is no other that is whole; start again with --force"
        )
    return None


def refuse_other_results(directory: Path, scenario: Scenario) -> None:
    """Refuse a directory with results that are not the beginning of this run.

    Raises
    ------
    InputError
        They are of another case.
    """
    if not layout.has_results(directory) or not (directory / layout.CASE).exists():
        return
    here, there = (what_counts(case) for case in (scenario, read_case(directory)))
    _refuse_another(directory, here, there)


def _refuse_another(directory: Path, here: Mapping[str, Any], there: Mapping[str, Any]) -> None:
    """Refuse to go on with a run of another case, and say where they differ."""
    if (found := difference(here, there)) is None:
        return
    key, what = found
    raise InputError(
        f"{directory} is the run of another case: {what}; give that case, or choose another --out",
        key,
    )
