"""Where the energy of a run went: from what it came, to what it became, and bands of its size."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from carom.display.markup import format_number
from carom.ledger_terms import terms
from carom.plot.books import LEAST, SHORT

KINDS = ("translation", "rotation", "vibration")
"""Parts of the kinetic energy, where the history has them."""

PALER = (0.0, 0.25, 0.5)
"""How much white there is in the colour of each."""

AT_END = {"strain": "strain energy at the end", "springs": "springs at the end"}
"""What stored energy that is left is called."""

MOST_PAIRS = 6
"""Pairs whose friction is told apart; those with the least are one, and if that were most, all."""

Columns = Mapping[str, NDArray[np.float64]]


@dataclass(frozen=True)
class Share:
    """What some energy came from, or became.

    Parameters
    ----------
    label
        What it is called.
    colour
        Name of its colour, of those of `carom.display.colours`.
    joule
        How much it is [J].
    white
        How much white is mixed into the colour, from 0 to 1.
    """

    label: str
    colour: str
    joule: float
    white: float = 0.0


@dataclass(frozen=True)
class Flow:
    """Where energy came from and where it went; both sides have the same sum but for round-off."""

    sources: tuple[Share, ...]
    sinks: tuple[Share, ...]

    @property
    def total(self) -> float:
        """Sum of the sources [J]."""
        return sum(share.joule for share in self.sources)

    def fraction(self, share: Share) -> str:
        """Return how much of all a share is, as text."""
        return f"{format_number(100 * share.joule / self.total, 3)}\u202f%"


@dataclass(frozen=True)
class Band:
    """How a share is drawn: as wide as it is, from the trunk to its label.

    Parameters
    ----------
    share
        What it is.
    width
        Of the band.
    trunk, label
        Upper ends of the band at the trunk and at the label, from above.
    """

    share: Share
    width: float
    trunk: float
    label: float


@dataclass(frozen=True)
class Bands:
    """All bands of a flow, in the unit of length of who draws them.

    Parameters
    ----------
    height
        Of the whole drawing.
    top, width
        Upper end of the trunk, in which all bands meet, and its width.
    sources, sinks
        The bands from the top down.
    """

    height: float
    top: float
    width: float
    sources: tuple[Band, ...]
    sinks: tuple[Band, ...]


def flow(history: Columns, ledger: Mapping[str, Columns]) -> Flow:
    """Return where the energy of a run came from and where it went, from its books.

    What a term has with the wrong sign is on the other side: work that bodies did on what moves
    them is a sink, and so is a defect that is positive a source.

    Parameters
    ----------
    history
        Columns of ``history.csv``.
    ledger
        Columns of ``ledger.csv`` for each body and pair.
    """
    ends = {name: float(values[-1]) for name, values in history.items()}
    first = {name: float(values[0]) for name, values in history.items()}
    sources = [
        Share("kinetic energy at the start", "blue", first["kinetic"]),
        Share("strain energy at the start", "orange", first["strain"]),
    ]
    sinks: list[Share] = []
    _put(Share("springs at the start", "sky", first["springs"]), sources, sinks)
    for term in terms("run"):
        if term.name == "kinetic":
            sinks += _kinetic(ends)
        elif term.side == "given":
            _put(Share(term.label, term.colour, ends[term.name]), sources, sinks)
        elif term.name == "friction":
            for share in _friction(ledger, ends["friction"]):
                _put(share, sinks, sources)
        else:
            label = AT_END.get(term.name, SHORT[term.name])
            _put(Share(label, term.colour, ends[term.name]), sinks, sources)
    _put(Share("unexplained", "grey", ends["defect"]), sources, sinks)
    return Flow(_seen(sources), _seen(sinks))


def bands(what: Flow, width: float, slot: Callable[[Share, float], float]) -> Bands:
    """Lay out bands so that labels have room.

    Parameters
    ----------
    what
        The flow; it has some energy.
    width
        Of all bands together.
    slot
        What a share with a band of a width takes, with its label and its distance to others.
    """
    sides = [
        [(share, share.joule * width / what.total) for share in side]
        for side in (what.sources, what.sinks)
    ]
    slots = [[slot(share, wide) for share, wide in side] for side in sides]
    height = max(map(sum, slots))
    top = (height - width) / 2
    drawn = []
    for side, taken in zip(sides, slots, strict=True):
        trunk, free = top, (height - sum(taken)) / 2
        placed = []
        for (share, wide), room in zip(side, taken, strict=True):
            placed.append(Band(share, wide, trunk, free + (room - wide) / 2))
            trunk, free = trunk + wide, free + room
        drawn.append(tuple(placed))
    return Bands(height, top, width, drawn[0], drawn[1])


def _kinetic(ends: Mapping[str, float]) -> Iterator[Share]:
    if not all(kind in ends for kind in KINDS):
        yield Share("kinetic energy at the end", "blue", ends["kinetic"])
        return
    for kind, white in zip(KINDS, PALER, strict=True):
        yield Share(f"{kind} at the end", "blue", ends[kind], white)


def _friction(ledger: Mapping[str, Columns], total: float) -> Iterator[Share]:
    """Yield the friction of each pair, or of all where the books of pairs do not have its sum."""
    pairs = {
        name.replace("|", " – "): float(book["friction"][-1])
        for name, book in ledger.items()
        if len(book["friction"]) and np.isfinite(book["friction"][-1])  # bodies have none
    }
    # Books of a run of stages begin anew, so that those of pairs may be of another time.
    if not pairs or not abs(sum(pairs.values()) - total) <= 1e-6 * abs(total):
        yield Share("friction", "green", total)
        return
    ordered = sorted(pairs.items(), key=lambda pair: -abs(pair[1]))
    others = sum(joule for _, joule in ordered[MOST_PAIRS:])
    if abs(others) > 0.5 * abs(total):
        yield Share("friction", "green", total)
        return
    for name, joule in ordered[:MOST_PAIRS]:
        yield Share(f"friction {name}", "green", joule)
    if ordered[MOST_PAIRS:]:
        yield Share("friction of other pairs", "green", others)


def _put(share: Share, here: list[Share], there: list[Share]) -> None:
    """Put a share where it belongs by its sign."""
    if share.joule >= 0.0:
        here.append(share)
    else:
        there.append(replace(share, joule=-share.joule))


def _seen(shares: Sequence[Share]) -> tuple[Share, ...]:
    """Return the shares that are seen; of several others the sum is one."""
    least = LEAST * sum(share.joule for share in shares)
    seen = [share for share in shares if share.joule > 0.0 and share.joule >= least]
    small = [share for share in shares if 0.0 < share.joule < least]
    if len(small) > 1:
        return (*seen, Share("all other terms", "grey", sum(share.joule for share in small)))
    return (*seen, *small)
