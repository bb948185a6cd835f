"""Who may write into a results directory: one run at a time, which the system sees to.

A run holds a lock on ``run.lock`` in its directory before it touches anything else there. Of two
that start at the same instant one gets it. The system takes it from a process that ends in whatever
way, so that a run that was killed keeps nobody out.
"""

from __future__ import annotations

import errno
import os
import sys
import weakref
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from carom.io import layout
from carom.io.progress import going_on, refuse_running
from carom.system.existing import make

if sys.platform == "win32":
    import msvcrt
else:
    import fcntl

_NO_LOCKS = (errno.ENOLCK, errno.ENOSYS, errno.ENOTSUP, errno.EOPNOTSUPP, errno.EINVAL)
"""Numbers of errors of file systems that know no locks; there the progress file alone tells."""


@contextmanager
def claimed(directory: Path) -> Iterator[None]:
    """Have a results directory for oneself; it is made if need be.

    Raises
    ------
    InputError
        Another run is going on there; the directory has files of others or cannot be made.
    """
    layout.has_results(directory)
    make(directory)
    refuse_running(directory)
    lock = _Lock(directory / layout.LOCK)
    if not lock.take():
        raise going_on(directory)
    try:
        # One on another machine, where locks do not reach, has told of itself.
        refuse_running(directory)
        yield
    finally:
        lock.release()


class _Lock:
    """A file that one process at a time holds."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._descriptor: int | None = None

    def take(self) -> bool:
        """Hold the file, and return whether nobody else does."""
        while True:
            descriptor = os.open(self._path, os.O_RDWR | os.O_CREAT, 0o666)
            try:
                is_free = _locked(descriptor)
            except BaseException:
                os.close(descriptor)
                raise
            # Who held it may have removed it since it was opened: then it keeps nobody out.
            if is_free and not self._is(descriptor):
                os.close(descriptor)
                continue
            if not is_free:
                os.close(descriptor)
                return False
            self._descriptor = descriptor
            _HELD.add(self)
            return True

    def _is(self, descriptor: int) -> bool:
        """Return whether what is open is what others find there."""
        try:
            return os.path.samestat(os.fstat(descriptor), self._path.stat())
        except FileNotFoundError:
            return False

    def release(self) -> None:
        """Remove the file and let others have their own."""
        if self._descriptor is None:
            return
        if (
            sys.platform != "win32"
        ):  # where what is open cannot be removed, and an empty file may stay
            self._path.unlink(missing_ok=True)
        self.forget()

    def forget(self) -> None:
        """Let go of the file as it is, which is not the last hold where a process was forked."""
        descriptor, self._descriptor = self._descriptor, None
        _HELD.discard(self)
        if descriptor is not None:
            os.close(descriptor)


_HELD: weakref.WeakSet[_Lock] = weakref.WeakSet()
"""Locks of this process."""


def _forget_all() -> None:
    for lock in list(_HELD):
        lock.forget()


if hasattr(os, "register_at_fork"):
    # A process that an observer forks would hold the directory after the run was killed.
    os.register_at_fork(after_in_child=_forget_all)


def _locked(descriptor: int) -> bool:
    """Lock an open file until it is closed, and return whether nobody else has."""
    try:
        if sys.platform == "win32":
            msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
        else:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        if error.errno in _NO_LOCKS:
            return True
        if error.errno in (errno.EACCES, errno.EAGAIN, errno.EWOULDBLOCK, errno.EDEADLK):
            return False
        raise
    return True
