"""Numbers of things in messages."""

from __future__ import annotations


def count(number: int, what: str, many: str | None = None) -> str:
    """Return a number of things as text.

    Parameters
    ----------
    number
        How many there are.
    what
        One of them.
    many
        More of them; None puts an s to one.
    """
    return f"{number:,} {what if number == 1 else many or f'{what}s'}"
