"""Keeping Ctrl-C out of the middle of a file."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Hold Ctrl-C back until the block, and any such block around it, has ended.

    Outside the main thread there is nothing to hold back: Python delivers signals to it alone.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    received = False

    def note(*_: object) -> None:
        nonlocal received
        received = True

    previous = signal.signal(signal.SIGINT, note)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, previous)
    if received:
        signal.raise_signal(signal.SIGINT)
