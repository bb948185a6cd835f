"""How exactly the numbers of a file say where its points are."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FEWEST, MOST = 7, 12
"""Significant digits: fewer are no sign of a coarse file, as of a box of 1 m; more are exact."""

_ROUND_OFF = 4.0 * np.finfo(np.float64).eps


def precision(points: NDArray[np.float64]) -> float:
    """Return how far a point may be from where it is meant to be, in the unit of the points.

    That is half of the last digit of the largest coordinate, if all are written with `MOST`
    significant digits or fewer. If all are numbers in single precision, it is half of its last
    bit there. It is 0 if they are neither, or all of them 0.
    """
    values = np.abs(points[points != 0.0]).ravel()
    values = values[np.isfinite(values)]
    if not len(values):
        return 0.0
    largest = float(values.max())
    found = 0.0
    exponents = np.floor(np.log10(values))
    for digits in range(FEWEST, MOST + 1):
        # Of numbers near the smallest there is no such power, and they have no digits to speak of.
        with np.errstate(over="ignore", invalid="ignore"):
            whole = values * 10.0 ** (digits - 1 - exponents)
            are_whole = np.abs(whole - np.rint(whole)) <= _ROUND_OFF * whole
        if np.all(are_whole):
            found = 0.5 * 10.0 ** (np.floor(np.log10(largest)) + 1 - digits)
            break
    with np.errstate(over="ignore"):
        singles = values.astype(np.float32).astype(np.float64)
    # Single precision, as it is written with nine digits.
    if np.all(np.abs(singles - values) <= 5e-9 * values):
        found = max(found, 0.5 * float(np.spacing(np.float32(largest))))
    return float(found)
