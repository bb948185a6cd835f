"""When two that move touch: steps through time that their distance allows."""

from __future__ import annotations

from collections.abc import Callable

SAMPLES = 200
"""Steps through the run; paths between them count as straight."""

HALVINGS = 10
"""How often a step is halved before it is looked at whether the two pass into one another."""

REFINEMENTS = 30
"""Halvings of the interval in which they do."""

SAFE = 0.9
"""Share of the distance that may be moved without a look."""


def first_touch(
    gap: Callable[[float], float],
    motion: Callable[[float, float], float],
    end: float,
    *,
    tolerance: float,
) -> tuple[float | None, float]:
    """Return when a gap closes, None if it does not, and the least that was seen of it [m].

    Parameters
    ----------
    gap
        Distance at a time [m].
    motion
        How far points of the two move towards one another between two times at the most [m].
    end
        End of the run [s].
    tolerance
        Distance that counts as touching [m].
    """
    longest = end / SAMPLES
    shortest = longest * 0.5**HALVINGS
    time, least = 0.0, gap(0.0)
    if least <= tolerance:
        return 0.0, least
    free = SAFE * least
    while time < end:
        step = min(longest, end - time)
        moved = motion(time, time + step)
        if moved > free:
            least, free = _look(gap(time), least)
            while moved > free and step > shortest:
                step *= 0.5
                moved = motion(time, time + step)
        before, time, free = time, time + step, free - moved
        if free < 0.0:
            if (now := gap(time)) <= tolerance:
                return _closing(gap, before, time, tolerance), min(least, now)
            least, free = _look(now, least)
    return None, min(least, *(gap(end * k / SAMPLES) for k in range(1, SAMPLES + 1)))


def _look(now: float, least: float) -> tuple[float, float]:
    return min(least, now), SAFE * now


def _closing(gap: Callable[[float], float], low: float, high: float, tolerance: float) -> float:
    """Return the time in an interval at which a gap closes."""
    for _ in range(REFINEMENTS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if gap(middle) <= tolerance else (middle, high)
    return high
