"""Numbers of ``summary.json``."""

from __future__ import annotations


def number(value: object) -> float:
    """Return a number of the summary; null, which stands for what is not finite, is not one."""
    return float(value) if isinstance(value, int | float) else float("nan")
