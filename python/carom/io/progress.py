"""``progress.json``: how far a run has come, for other processes; it is there while the run is."""

from __future__ import annotations

import dataclasses
import json
import os
import socket
import time
from dataclasses import dataclass
from pathlib import Path

from carom.errors import InputError
from carom.io import layout
from carom.io.atomic import write_whole
from carom.system.progress import Progress

EVERY = 1.0
"""Wall time between two updates [s]."""

SILENT = 300.0
"""Without news for so long a run on another machine is taken to be dead [s]."""


@dataclass(frozen=True)
class Running:
    """What a run says of itself.

    Parameters
    ----------
    pid, host, birth
        Its process: the number, the machine, and when it started, which tells it from a later
        process of the same number. They are empty where that is not known.
    updated
        When it said so [s since 1970].
    progress
        How far it is; None before its first step.
    """

    pid: int
    host: str
    birth: str
    updated: float
    progress: Progress | None

    @property
    def is_own(self) -> bool:
        """Whether it is of this process."""
        return self.host == socket.gethostname() and self.pid == os.getpid()

    @property
    def is_alive(self) -> bool:
        """Whether its process is still there; of another machine, whether there was news lately."""
        if self.host != socket.gethostname():
            return time.time() - self.updated < SILENT
        try:
            os.kill(self.pid, 0)
        except (ProcessLookupError, OverflowError):
            return False
        except PermissionError:
            pass
        return _birth(self.pid) == self.birth


class ProgressFile:
    """Writes the progress of this process's run.

    Parameters
    ----------
    directory
        Results directory, which the run has for itself, see `carom.io.claim`.
    """

    def __init__(self, directory: Path) -> None:
        self._path = directory / layout.PROGRESS
        self._last = 0.0
        self.write(None)

    def write(self, progress: Progress | None) -> None:
        """Write the progress, unless that was a moment ago."""
        now = time.time()
        if progress is not None and progress.step < progress.steps and now - self._last < EVERY:
            return
        self._last = now
        running = Running(
            pid=os.getpid(),
            host=socket.gethostname(),
            birth=_birth(os.getpid()),
            updated=now,
            progress=progress,
        )
        write_whole(self._path, json.dumps(dataclasses.asdict(running)).encode())

    def remove(self) -> None:
        """Say that the run is over."""
        self._path.unlink(missing_ok=True)


def read_progress(directory: Path) -> Running | None:
    """Return what a run in a directory last said; None if there is none."""
    try:
        data = json.loads((directory / layout.PROGRESS).read_bytes())
        progress = data.pop("progress")
        return Running(progress=Progress(**progress) if progress else None, **data)
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return None


def refuse_running(directory: Path) -> None:
    """Refuse a directory in which another process runs.

    Raises
    ------
    InputError
        There is one.
    """
    running = read_progress(directory)
    if running is not None and not running.is_own and running.is_alive:
        raise going_on(directory)


def going_on(directory: Path) -> InputError:
    """Return the refusal of a directory in which another run is going on."""
    running = read_progress(directory)
    # One that has only just begun has not said who it is.
    who = f" (process {running.pid} on {running.host})" if running and running.is_alive else ""
    return InputError(
        f"{directory}: a run is going on there{who}; choose another --out, or follow it with carom "
        "watch"
    )


def _birth(pid: int) -> str:
    """Return when a process started, where the system tells; "dead" of one that has ended."""
    try:
        # The name of the program is in parentheses and may hold anything.
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
        return "dead" if fields[0] in "ZX" else fields[19]
    except (OSError, IndexError):
        return ""
