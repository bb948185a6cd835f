"""Putting measured numbers where drifted ones stand, on pages and in the texts of claims."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

from .judge import Verdict
from .manifest import LABELLED, Claim
from .pages import BLOCK, Page


@dataclass(frozen=True, order=True)
class Change:
    """A number to be shown in another's place.

    Parameters
    ----------
    start, end
        Where the old one is in the text of the page.
    shown
        The new one.
    """

    start: int
    end: int
    shown: str


def like(shown: str, value: float) -> str:
    """Return a value as another number is shown: sign, decimals, exponent and separators."""
    mantissa, _, exponent = shown.partition("e")
    decimals = len(mantissa.partition(".")[2])
    if exponent:
        digits, _, power = f"{abs(value):.{decimals}e}".partition("e")
        width = len(exponent.lstrip("+−-"))
        written = f"{digits}e{'-' if int(power) < 0 else ''}{abs(int(power)):0{width}d}"
    else:
        grouped = f"{abs(value):,.{decimals}f}"
        separator = next((each for each in ", " if each in mantissa), "")
        written = grouped.replace(",", separator)
    if value < 0 and written.strip("0.,"):
        return f"−{written}"
    return f"+{written}" if shown.startswith("+") else written


def changes(page: Page, verdicts: Iterable[Verdict]) -> list[Change]:
    """Return what has to be changed on a page so that it says what was measured.

    Physics and counts are shown as measured, also within their tolerance: a table of one run has no
    numbers of another. Round-off changes from machine to machine and is shown anew where it
    drifted. A bound is left to people: how far above the measurement it is is theirs to say.
    """
    found = set()
    for claim, judged in _by_claim(verdicts):
        measured = [index for index, marked in enumerate(_marks(claim)) if marked]
        for place in range(len(page.places(claim.plain))):
            spans = list(claim.spans(page))[place * len(_marks(claim)) :]
            for index, verdict in zip(measured, judged, strict=True):
                shown = like(verdict.number.shown, verdict.measured)
                renewed = claim.kind in {"exact", "count"} and shown != verdict.number.shown
                if renewed or (claim.kind == "round-off" and not verdict.holds):
                    found.add(Change(*spans[index], shown))
    return sorted(found)


def _by_claim(verdicts: Iterable[Verdict]) -> Iterable[tuple[Claim, list[Verdict]]]:
    grouped: dict[int, tuple[Claim, list[Verdict]]] = {}
    for verdict in verdicts:
        grouped.setdefault(id(verdict.claim), (verdict.claim, []))[1].append(verdict)
    return grouped.values()


def _marks(claim: Claim) -> list[bool]:
    """Return which of the marked numbers are measured; the others are labels."""
    return [found[0].startswith("«") for found in LABELLED.finditer(claim.text)]


def rewritten(page: Page, done: list[Change]) -> str:
    """Return the source of a page with its changes, its lines broken as they were."""
    places = _sources(page)
    source = page.source
    for change in reversed(done):
        start, end = places[change.start], places[change.end - 1] + 1
        source = source[:start] + change.shown + source[end:]
    return source


def _sources(page: Page) -> dict[int, int]:
    """Return where in the source the characters of the text are; space is not among them."""
    hidden = [found.span() for found in BLOCK.finditer(page.source)]
    visible = (
        place
        for place, character in enumerate(page.source)
        if not character.isspace() and not any(start <= place < end for start, end in hidden)
    )
    texts = (place for place, character in enumerate(page.text) if not character.isspace())
    return dict(zip(texts, visible, strict=True))


def claimed(claim: Claim, page: Page, done: list[Change]) -> str:
    """Return the text of a claim, marks included, as it is after the changes of its page."""
    place = page.places(claim.plain)[0]
    text, behind = [], place
    for piece in re.split(r"([«»‹›])", claim.text):
        if piece in {"«", "»", "‹", "›"}:
            text.append(piece)
            continue
        text.append(_after(page, behind, behind + len(piece), done))
        behind += len(piece)
    return "".join(text)


def _after(page: Page, start: int, end: int, done: list[Change]) -> str:
    """Return what becomes of a part of the page."""
    part, at = [], start
    for change in done:
        if start <= change.start and change.end <= end:
            part += [page.text[at : change.start], change.shown]
            at = change.end
    return "".join([*part, page.text[at:end]])
