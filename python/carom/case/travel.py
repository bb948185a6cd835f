"""Where rigid obstacles are over time, and what drives them."""

from __future__ import annotations

import json

import numpy as np
from numpy.typing import NDArray

from carom import _carom
from carom.case.obstacle import Obstacle
from carom.case.signal import Signal, Table


def travel(
    obstacle: Obstacle, times: NDArray[np.float64], *, dimension: int
) -> NDArray[np.float64]:
    """Return how far an obstacle has moved at some times [m], shape [time_count, D].

    Parameters
    ----------
    obstacle
        The obstacle.
    times
        Times [s], shape [time_count].
    dimension
        Of the case, D.

    Raises
    ------
    InputError
        A formula of its motion is none.
    """
    moved = np.zeros((len(times), dimension))
    if obstacle.velocity is not None:
        moved += np.outer(times, obstacle.velocity)
    if obstacle.motion is not None:
        for index, name in enumerate("xyz"[:dimension]):
            signal = getattr(obstacle.motion, name)
            if signal is not None:
                moved[:, index] = values(signal, times)
    return moved


def values(signal: Signal, times: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the values of a function of time, which the native core alone evaluates."""
    spec = signal.model_dump(mode="json") if isinstance(signal, Table) else signal
    return _carom.signal_values(json.dumps(spec), np.asarray(times, dtype=np.float64))
