"""How the processes of a study end with it: by a line that is cut when it stops or dies."""

from __future__ import annotations

import _thread
import multiprocessing
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing.connection import Connection

_cut = threading.Event()
"""Whether the line of this process has been cut."""


@contextmanager
def line() -> Iterator[Connection]:
    """Give the end that processes hold on to; it is cut at the end of the block.

    The system cuts it too where this process dies, by whatever signal.
    """
    theirs, ours = multiprocessing.Pipe(duplex=False)
    with theirs, ours:
        yield theirs


@contextmanager
def deaf() -> Iterator[None]:
    """Start processes in the block that Ctrl-C in a terminal, which all of them get, leaves alone.

    They are to stop with the study, and not with a traceback each while they start.
    """
    if not hasattr(signal, "pthread_sigmask"):  # not on Windows
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def hold(theirs: Connection) -> None:
    """Let this process stop when the line is cut: what it works on, as of SIGTERM, and all else."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # where they could not be started deaf
    threading.Thread(target=_listen, args=(theirs,), daemon=True).start()


def is_cut() -> bool:
    """Return whether the study has stopped that this process works for."""
    return _cut.is_set()


def _listen(theirs: Connection) -> None:
    try:
        theirs.recv_bytes()
    except (EOFError, OSError):
        _cut.set()
        _thread.interrupt_main(signal.SIGTERM)  # nothing where no run is under way
