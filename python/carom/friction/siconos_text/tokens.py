"""The words of a text file, taken one after the other."""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from carom.errors import InputError

_INTEGER = re.compile(r"[+-]?\d{1,18}")
"""Integers that the arrays can hold."""


class Tokens:
    """Words, and how far they have been read.

    Parameters
    ----------
    text
        The text.
    """

    def __init__(self, text: str) -> None:
        self._text = text
        self._words = text.split()
        self._next = 0

    @property
    def left(self) -> int:
        """Number of words not yet read."""
        return len(self._words) - self._next

    def ahead(self, count: int) -> list[str]:
        """Return the next words without taking them."""
        return self._words[self._next : self._next + count]

    def words(self, count: int, what: str) -> list[str]:
        """Take words."""
        if count > self.left:
            missing = count - self.left
            more = "1 more number" if missing == 1 else f"{missing} more numbers"
            raise InputError(
                f"{self._place(len(self._words))}: the text ends where {what} needs {more}; "
                "is the file cut short?"
            )
        taken = self._words[self._next : self._next + count]
        self._next += count
        return taken

    def integer(self, what: str, *, least: int = 0) -> int:
        """Take one integer."""
        return int(self.integers(1, what, least=least)[0])

    def integers(self, count: int, what: str, *, least: int = 0) -> NDArray[np.int64]:
        """Take integers."""
        taken = self.words(count, what)
        for offset, word in enumerate(taken):
            if not is_integer(word) or int(word) < least:
                raise self.wrong(f"{what} must be an integer of at least {least}", offset - count)
        return np.array([int(word) for word in taken], dtype=np.int64)

    def numbers(self, count: int, what: str) -> NDArray[np.float64]:
        """Take finite numbers."""
        return self.convert(self.words(count, what), what)

    def convert(self, words: list[str], what: str, *, stride: int = 1) -> NDArray[np.float64]:
        """Return words just taken as numbers; `stride` apart in the text, the last one last."""
        try:
            values = np.array(words, dtype=np.float64)
        except ValueError:
            values = np.array([_number(word) for word in words])
        if not np.isfinite(values).all():
            first = int(np.flatnonzero(~np.isfinite(values))[0])
            after = (len(words) - 1 - first) * stride
            raise self.wrong(f"{what} must be finite numbers", -1 - after)
        return values

    def expect(self, word: str, what: str) -> None:
        """Take a word that must be the given one."""
        if self.words(1, what)[0] != word:
            raise self.wrong(f"{what} must have {word!r} here")

    def wrong(self, what: str, offset: int = -1) -> InputError:
        """Return the error that a word just taken is not what it must be.

        Parameters
        ----------
        what
            What is expected.
        offset
            Its place relative to the next word to be read.
        """
        index = self._next + offset
        return InputError(f"{self._place(index)}: {self._words[index]!r}: {what}")

    def _place(self, index: int) -> str:
        """Return line and number of a word."""
        found = re.compile(r"\S+").finditer(self._text)
        start = next((m.start() for k, m in enumerate(found) if k == index), len(self._text))
        return f"line {self._text.count(chr(10), 0, start) + 1}, word {index + 1}"


def is_integer(word: str) -> bool:
    """Whether a word is an integer."""
    return _INTEGER.fullmatch(word) is not None


def _number(word: str) -> float:
    try:
        return float(word)
    except ValueError:
        return float("nan")
