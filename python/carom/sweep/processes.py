"""Runs side by side: in processes of this machine, or on a cluster through Dask."""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Generator, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import ExitStack, contextmanager
from importlib import import_module
from typing import Any

from carom.errors import InputError
from carom.sweep.stopping import deaf, hold, line
from carom.sweep.worker import Task, refused, work
from carom.system.threads import THREADS

Outcome = tuple[int, dict[str, Any]]
"""The index of a task, and its summary."""

START = "spawn"
"""How processes are started: the same on every system, and without what this process holds."""

ONE_EACH = (THREADS, "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
"""Variables by which carom and the libraries are told to take one thread each."""


def here(tasks: Sequence[Task], *, jobs: int) -> Generator[Outcome]:
    """Work on tasks in some processes; yield the outcomes as they come.

    A task whose process dies, for want of memory for example, is `failed`; the others go on.
    Where this generator is closed, or Ctrl-C strikes, the runs that are under way stop.
    """
    again: list[int] = []
    for index, future in _pooled(tasks, range(len(tasks)), jobs):
        try:
            yield index, future.result()
        except BrokenProcessPool:  # one has died, and all that were under way go with it
            again.append(index)
    for index in again:
        for _, future in _pooled(tasks, [index], 1):
            try:
                yield index, future.result()
            except BrokenProcessPool:
                yield index, refused("failed", "the process of this run died; was memory short?")


def _pooled(
    tasks: Sequence[Task], indices: Sequence[int], jobs: int
) -> Iterator[tuple[int, Future[dict[str, Any]]]]:
    context = multiprocessing.get_context(START)
    stopped = ExitStack()
    end = stopped.enter_context(line())
    # The line is cut before the pool waits for its processes, whatever they still work on.
    with (
        _one_thread_each(),
        ProcessPoolExecutor(jobs, context, initializer=hold, initargs=(end,)) as pool,
        stopped,
    ):
        with deaf():
            waiting = {pool.submit(work, tasks[index]): index for index in indices}
        try:
            while waiting:
                for future in wait(waiting, return_when=FIRST_COMPLETED).done:
                    yield waiting.pop(future), future
        finally:
            for future in waiting:
                future.cancel()


@contextmanager
def _one_thread_each() -> Iterator[None]:
    """Tell the processes that are started in the block to take one thread each."""
    before = {name: os.environ.get(name) for name in ONE_EACH}
    os.environ.update(dict.fromkeys(ONE_EACH, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


def on_cluster(tasks: Sequence[Task], *, scheduler: str) -> Generator[Outcome]:
    """Work on tasks through a Dask scheduler, whose workers see the same files.

    Raises
    ------
    InputError
        Dask is not installed, or no scheduler answers at the address.
    """
    try:
        distributed: Any = import_module("distributed")  # an extra
    except ImportError:
        raise InputError(
            "--scheduler needs Dask, which is not installed: pip install 'carom[dask]'"
        ) from None
    try:
        client = distributed.Client(scheduler, timeout="10s")
    except (OSError, ValueError, TimeoutError) as error:
        raise InputError(f"--scheduler {scheduler}: no scheduler answers: {error}") from None
    with client:
        waiting = {client.submit(work, task, pure=False): n for n, task in enumerate(tasks)}
        for future in distributed.as_completed(list(waiting)):
            why = future.exception()
            summary = future.result() if why is None else refused("failed", str(why))
            yield waiting[future], summary
