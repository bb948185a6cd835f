"""How many threads share the work on large bodies."""

from __future__ import annotations

import os

from carom.errors import InputError

THREADS = "RAYON_NUM_THREADS"
"""Says how many: the native core reads it when it first has work to share."""


MOST_PER_CORE = 16
"""Threads for each core, at most: more of them wait for one another for hours."""


def take_threads(count: int | None) -> None:
    """Let so many threads share the work of this process; None leaves it at all cores.

    Results do not depend on it. Bodies of less than some ten thousand unknowns are not shared.

    Raises
    ------
    InputError
        They are far more than there are cores.
    """
    if count is None:
        return
    cores = os.cpu_count() or 1
    if count > MOST_PER_CORE * cores:
        raise InputError(
            f"--threads {count}: there are {cores} cores; take as many threads, or leave it out"
        )
    os.environ[THREADS] = str(count)
