"""Keeping Ctrl-C and SIGTERM out of the middle of a file."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager


class Terminated(KeyboardInterrupt):
    """SIGTERM, by which batch systems announce that time is up."""


@contextmanager
def terminable() -> Iterator[None]:
    """Make SIGTERM raise `Terminated` within the block, as Ctrl-C raises `KeyboardInterrupt`."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    previous = signal.signal(signal.SIGTERM, _terminate)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, previous)


@contextmanager
def uninterrupted() -> Iterator[None]:
    """Hold Ctrl-C back until the block, and any such block around it, has ended.

    SIGTERM too, where it is `terminable`. Outside the main thread there is nothing to hold back:
    Python delivers signals to it alone.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    with ExitStack() as stack:
        stack.enter_context(_held(signal.SIGINT))
        if signal.getsignal(signal.SIGTERM) is _terminate:
            stack.enter_context(_held(signal.SIGTERM))
        yield


@contextmanager
def _held(number: signal.Signals) -> Iterator[None]:
    received = False

    def note(*_: object) -> None:
        nonlocal received
        received = True

    previous = signal.signal(number, note)
    try:
        yield
    finally:
        signal.signal(number, previous)
    if received:
        signal.raise_signal(number)


def _terminate(*_: object) -> None:
    raise Terminated
