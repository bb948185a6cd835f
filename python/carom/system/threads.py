"""How many threads share the work on large bodies."""

from __future__ import annotations

import os

THREADS = "RAYON_NUM_THREADS"
"""Says how many: the native core reads it when it first has work to share."""


def take_threads(count: int | None) -> None:
    """Let so many threads share the work of this process; None leaves it at all cores.

    Results do not depend on it. Bodies of less than some ten thousand unknowns are not shared.
    """
    if count is not None:
        os.environ[THREADS] = str(count)
