"""Showing how far a run has come."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from time import monotonic

from rich.console import Console
from rich.progress import BarColumn, TextColumn, TimeRemainingColumn
from rich.progress import Progress as Bar

from carom.simulation import Observer, Progress

LINE_EVERY = 5.0
"""Wall time between two lines where no bar can be drawn [s]."""

BAR_WIDTH = 12
"""Width of the bar [characters]: it and the numbers fit 80."""


@contextmanager
def shown_progress(console: Console) -> Iterator[Observer]:
    """Give an observer that shows a bar on a terminal, and now and then a line elsewhere."""
    if not console.is_terminal:
        yield _lines(console)
        return
    columns = (
        TextColumn("step {task.completed}/{task.total}"),
        BarColumn(bar_width=BAR_WIDTH),
        TextColumn("{task.fields[state]}"),
        TextColumn("ETA"),
        TimeRemainingColumn(),
    )
    with Bar(*columns, console=console) as bar:
        task = bar.add_task("run", total=None, state="")

        def draw(progress: Progress) -> None:
            bar.update(task, total=progress.steps, completed=progress.step, state=_state(progress))

        yield draw


def _lines(console: Console) -> Observer:
    start = last = monotonic()

    def line(progress: Progress) -> None:
        nonlocal last
        now = monotonic()
        if progress.step == progress.steps or now - last >= LINE_EVERY:
            last = now
            left = (now - start) * (progress.steps / max(progress.step, 1) - 1)
            console.print(
                f"step {progress.step}/{progress.steps}, {_state(progress)}, ETA {left:.0f} s",
                highlight=False,
                soft_wrap=True,
            )

    return line


def _state(progress: Progress) -> str:
    return f"t = {progress.time:.4g} s, {progress.contacts} contacts, E = {progress.total:.4g} J"
