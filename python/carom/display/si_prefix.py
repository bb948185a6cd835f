"""Units with the prefix in which numbers are short: MPa, not 1e8 Pa."""

from __future__ import annotations

import math

PREFIXES = (
    ("T", 1e12),
    ("G", 1e9),
    ("M", 1e6),
    ("k", 1e3),
    ("", 1.0),
    ("m", 1e-3),
    ("µ", 1e-6),
    ("n", 1e-9),
    ("p", 1e-12),
)


def prefixed(unit: str, largest: float) -> tuple[str, float]:
    """Return a unit with its prefix, and what it is worth in the unit without.

    Parameters
    ----------
    unit
        Without a prefix, such as ``Pa`` or ``J/m³``; the empty one of numbers gets none.
    largest
        The largest size to be written in it. It becomes at least 1 and less than 1000, where there
        is a prefix for that; lengths stay in metres down to 0.1 m.
    """
    if not unit or not math.isfinite(largest) or largest <= 0.0:
        return unit, 1.0
    least = 0.1 if unit == "m" else 1.0
    # By a hair less, as 0.9999999999 is 1 but for round-off.
    worth = next(
        ((sign, size) for sign, size in PREFIXES if largest >= size * _least(sign, least)),
        PREFIXES[-1],
    )
    return worth[0] + unit, worth[1]


def _least(sign: str, least: float) -> float:
    return (least if sign == "" else 1.0) * (1.0 - 1e-9)
