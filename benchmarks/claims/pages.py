"""Numbers on the pages of the documentation: where they are, and what they say."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

ROOT = Path(__file__).parents[2]

NUMBER = re.compile(
    r"""(?<![\w.])                      # not the 4 of quad4, not a part of a version
    [+−-]?
    (?:\d{1,3}(?:[ ,]\d{3})+|\d+)       # 15 000 and 15,000 are one number
    (?:\.\d+)?
    (?:e[+−-]?\d+)?
    (?:[⁰¹²³⁴-⁹⁻]+)?
    (?!\w|\.\d)""",
    re.VERBOSE,
)

UNSEEN = re.compile(r"`[^`]*`|\]\([^)]*\)|<[^>]*>|https?://\S+")
"""Parts of a line that are no prose: code, targets of links, HTML."""

BLOCK = re.compile(r"^```.*?^```$|<!--.*?-->", re.DOTALL | re.MULTILINE)
"""What is shown as it is: what runs in it is held by tests/test_pages.py."""


@dataclass(frozen=True)
class Number:
    """A number as a page has it.

    Parameters
    ----------
    shown
        Its characters.
    """

    shown: str

    @property
    def value(self) -> float:
        """What it says."""
        return float(self._plain)

    @property
    def last_digit(self) -> float:
        """One unit of the last digit that is shown: 0.01 of 2.35, 1e-13 of 1.2e-12."""
        mantissa, _, exponent = self._plain.partition("e")
        decimals = len(mantissa.partition(".")[2])
        return float(10.0 ** (int(exponent or 0) - decimals))

    @property
    def _plain(self) -> str:
        return re.sub(r"[ ,]", "", self.shown).replace("−", "-")


@dataclass(frozen=True)
class Page:
    """A page whose lines are joined, so that a text is found however it is broken.

    Parameters
    ----------
    source
        The page as it is written.
    """

    source: str

    @classmethod
    def read(cls, name: str) -> Page:
        """Return a page by its path from the root."""
        return cls((ROOT / name).read_text(encoding="utf-8"))

    @cached_property
    def text(self) -> str:
        """Everything but blocks of code and comments; headings stay apart by line breaks."""
        lines = re.split(r"^(#+ .*)$", BLOCK.sub(" ", self.source), flags=re.MULTILINE)
        return "\n".join(" ".join(each.split()) for each in lines)

    @cached_property
    def blocks(self) -> str:
        """What the page shows as it is: code, and what it prints; `tests/test_pages.py` runs it."""
        return "\n".join(found[0] for found in BLOCK.finditer(self.source))

    @cached_property
    def numbers(self) -> list[tuple[int, int]]:
        """Where the numbers of the prose and the tables are in the text."""
        unseen = [each.span() for each in UNSEEN.finditer(self.text)]
        return [
            found.span()
            for found in NUMBER.finditer(self.text)
            if not any(start <= found.start() < end for start, end in unseen)
        ]

    def places(self, text: str) -> list[int]:
        """Return where a text stands."""
        return [found.start() for found in re.finditer(re.escape(text), self.text)]

    def section(self, heading: str) -> tuple[int, int]:
        """Return where the section with this heading begins and ends.

        Raises
        ------
        ValueError
            If there is not exactly one.
        """
        found = list(re.finditer(rf"^(#+) {re.escape(heading)}$", self.text, re.MULTILINE))
        if len(found) != 1:
            raise ValueError(f"has {len(found)} sections with the heading {heading!r}, not 1")
        level = len(found[0][1])
        after = re.compile(rf"^#{{1,{level}}} ", re.MULTILINE).search(self.text, found[0].end())
        return found[0].start(), after.start() if after else len(self.text)
