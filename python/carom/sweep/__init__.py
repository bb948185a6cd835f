"""Studies: a case run with many values, side by side, into one table and one picture."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from contextlib import closing
from pathlib import Path
from typing import Any

from carom.case.scenario import Scenario
from carom.sweep.axis import Axis, axis
from carom.sweep.processes import here, on_cluster
from carom.sweep.study import Point, points
from carom.sweep.table import (
    PICTURE,
    TABLE,
    row,
    spare_files_of_others,
    spare_other_study,
    write_table,
)
from carom.sweep.worker import Task
from carom.system.existing import make

__all__ = ["PICTURE", "TABLE", "Axis", "Done", "axis", "points", "sweep"]

Done = Callable[[int, int, dict[str, Any]], None]
"""Called with how many points are done, of how many, and the row of the last one."""


def sweep(
    scenario: Scenario,
    axes: Sequence[Axis],
    out: Path,
    *,
    jobs: int | None = None,
    scheduler: str | None = None,
    force: bool = False,
    done: Done | None = None,
) -> list[dict[str, Any]]:
    """Run a case with every combination of the values of some axes.

    Runs that have been made already, of the same case with the same values, are not made again. A
    run that fails is a row with its reason.

    Parameters
    ----------
    scenario
        The case.
    axes
        What is varied.
    out
        Directory of the table and of a folder for each run.
    jobs
        Processes at a time; None takes one for each processor.
    scheduler
        Address of a Dask scheduler, in place of processes here.
    force
        Whether finished runs are made again, and the results of other cases and studies replaced.
    done
        Called after each run.

    Returns
    -------
    list
        A row for each run, in the order of the values.

    Raises
    ------
    InputError
        A key is not known, a value not allowed, or there are results of another case or study;
        nothing is run.
    """
    study = points(scenario, axes, out)
    spare_files_of_others(out / TABLE, [point.directory.name for point in study])
    if not force:
        spare_other_study(out / TABLE, [one.key for one in axes])
    rows: list[dict[str, Any] | None] = [None] * len(study)
    count = 0

    def finish(index: int, summary: dict[str, Any]) -> None:
        nonlocal count
        made = rows[index] = row(study[index].values, summary)
        count += 1
        if done is not None:
            done(count, len(study), made)

    left: list[int] = []
    there = [None if force else point.finished() for point in study]
    for index, summary in enumerate(there):
        if summary is None:
            left.append(index)
        else:
            finish(index, summary)
    make(out)
    tasks = [_task(study[index]) for index in left]
    outcomes = (
        here(tasks, jobs=min(jobs or os.cpu_count() or 1, max(len(tasks), 1)))
        if scheduler is None
        else on_cluster(tasks, scheduler=scheduler)
    )
    with closing(outcomes):
        for index, summary in outcomes if tasks else ():
            finish(left[index], summary)
    made = [one for one in rows if one is not None]
    write_table(out / TABLE, made)
    return made


def _task(point: Point) -> Task:
    return Task(point.scenario.model_dump(mode="json"), str(point.directory.absolute()))
