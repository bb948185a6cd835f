"""Showing how far a run has come."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from time import monotonic

from rich.console import Console, Group
from rich.live import Live
from rich.progress import BarColumn, TextColumn
from rich.progress import Progress as Bar
from rich.text import Text

from carom.system.progress import Progress, ShowProgress

LINE_EVERY = 5.0
"""Wall time between two lines where no bar can be drawn [s]."""

BAR_WIDTH = 12
"""Width of the bar [characters]: it and the numbers fit 80."""


@contextmanager
def shown_progress(console: Console) -> Iterator[ShowProgress]:
    """Give a function that shows a bar on a terminal, and now and then a line elsewhere."""
    if not console.is_terminal:
        yield _lines(console)
        return
    bar = Bar(
        TextColumn("step {task.completed}/{task.total}"),
        BarColumn(bar_width=BAR_WIDTH),
        TextColumn("{task.fields[state]}"),
    )
    task = bar.add_task("run", total=None, state="")
    energies = Text()
    with Live(Group(bar, energies), console=console, refresh_per_second=4):

        def draw(progress: Progress) -> None:
            state = f"{_state(progress)}, ETA {_clock(progress.eta)}"
            bar.update(task, total=progress.steps, completed=progress.step, state=state)
            energies.plain = _energies(progress)

        yield draw


def _lines(console: Console) -> ShowProgress:
    last = monotonic()
    ended = False

    def line(progress: Progress) -> None:
        nonlocal last, ended
        now = monotonic()
        ends = progress.step == progress.steps and not ended
        if ends or now - last >= LINE_EVERY:
            last, ended = now, ended or ends
            console.print(
                f"step {progress.step}/{progress.steps}, {_state(progress)}, "
                f"{_energies(progress)}, ETA {_clock(progress.eta)}",
                highlight=False,
                soft_wrap=True,
            )

    return line


def _state(progress: Progress) -> str:
    many = "" if progress.contacts == 1 else "s"
    return f"t = {progress.time:.4g} s, {progress.contacts} contact{many}"


def _energies(progress: Progress) -> str:
    return (
        f"kinetic {progress.kinetic:.4g} J, strain {progress.strain:.4g} J, "
        f"friction took {progress.friction:.4g} J, {progress.retried} steps rejected"
    )


def _clock(seconds: float | None) -> str:
    """Return a wall time as hours, minutes and seconds."""
    if seconds is None:
        return "-:--:--"
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes // 60}:{minutes % 60:02}:{rest:02}"
