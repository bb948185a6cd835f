"""What claims.toml says: which number of which page comes from where."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import tomlkit

from .pages import Number, Page

MANIFEST = Path(__file__).parents[1] / "claims.toml"

MARKED = re.compile(r"«([^»]*)»")
"""A number that a claim is about, within its text."""

LABELLED = re.compile(r"[«‹]([^»›]*)[»›]")
"""Such a number, or one that says what is measured, as ‹20› in a row of a table."""

MEASURED = ("exact", "count", "round-off", "bound", "timing")
"""Kinds of claims that have a run; `judge` says what they mean."""

TOLD = ("given", "history", "timing")
"""Kinds without a run: what a case prescribes, what cannot be run again today, and times of which
the page names the command."""


@dataclass(frozen=True)
class Claim:
    """A text of a page and where its numbers come from.

    Parameters
    ----------
    page
        Path from the root.
    text
        What stands on the page; the numbers that are claimed are marked, as in «2.5» mm, and so are
        those that only say of what they are, as in ‹20› cells.
    kind
        One of `MEASURED` or `TOLD`.
    run
        Name of the run that measures; none of a claim that is only told.
    gives
        What finds the numbers in the output of the run, in their order: regular expressions, whose
        groups they are, or the names of what a Python function returns.
    scale
        By what the numbers of the run are multiplied: 100 for those in per cent.
    relative, absolute, factor
        What a number may be off by: of its size, in its unit, or as a ratio either way. Without
        any, `judge.ALLOWED` has what the kind allows.
    reason
        Why there is nothing to run.
    """

    page: str
    text: str
    kind: str
    run: str | None = None
    gives: tuple[str, ...] = ()
    scale: float = 1.0
    relative: float | None = None
    absolute: float | None = None
    factor: float | None = None
    reason: str = ""

    @property
    def plain(self) -> str:
        """The text as it stands on the page."""
        return LABELLED.sub(r"\1", self.text)

    @property
    def numbers(self) -> list[Number]:
        """The numbers that are claimed."""
        return [Number(shown) for shown in MARKED.findall(self.text)]

    def spans(self, page: Page) -> Iterator[tuple[int, int]]:
        """Yield where the marked numbers stand on the page, wherever the text does."""
        for place in page.places(self.plain):
            taken = 0  # characters of marks before
            for found in LABELLED.finditer(self.text):
                yield place + found.start() - taken, place + found.end() - taken - 2
                taken += 2


@dataclass(frozen=True)
class Section:
    """A section whose numbers all have the same status.

    Parameters
    ----------
    page, heading
        Where it is.
    kind
        ``"history"``; ``"timing"`` if what it says holds for one machine; ``"command"`` if a
        command rewrites it as a whole.
    reason
        Why nothing measures it, or the command.
    """

    page: str
    heading: str
    kind: str
    reason: str


@dataclass(frozen=True)
class Manifest:
    """All claims.

    Parameters
    ----------
    runs
        What measures, by name; see `runs.measure`.
    claims, sections
        What is claimed.
    uncovered
        How many numbers of a page are still in no claim.
    """

    runs: dict[str, dict[str, Any]]
    claims: list[Claim]
    sections: list[Section] = field(default_factory=list)
    uncovered: dict[str, int] = field(default_factory=dict)

    @classmethod
    def read(cls, path: Path = MANIFEST) -> Manifest:
        """Read the manifest."""
        data = tomlkit.parse(path.read_text(encoding="utf-8")).unwrap()
        return cls(
            runs=data["runs"],
            claims=[
                *(Claim(**{**each, "gives": tuple(each["gives"])}) for each in data["claims"]),
                *(
                    Claim(page=each["page"], text=text, kind=each["kind"], reason=each["reason"])
                    for each in data["told"]
                    for text in each["texts"]
                ),
            ],
            sections=[Section(**each) for each in data["sections"]],
            uncovered=data["uncovered"],
        )

    @property
    def pages(self) -> list[str]:
        """The pages that are looked at."""
        return list(self.uncovered)

    def bare(self, name: str) -> list[str]:
        """Return the numbers of a page that are in no claim, each with what stands around it."""
        page = Page.read(name)
        spans = [page.section(each.heading) for each in self.sections if each.page == name]
        for claim in self.claims:
            if claim.page == name:
                spans.extend(claim.spans(page))
        return [
            page.text[max(0, start - 30) : start] + f"«{page.text[start:end]}»"
            for start, end in page.numbers
            if not any(first <= start and end <= last for first, last in spans)
        ]
