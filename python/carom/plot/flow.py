"""Where the energy of a run went: from what it came, to what it became, as bands of its size."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch, Rectangle
from matplotlib.path import Path as Curve
from numpy.typing import NDArray

from carom.display.colours import FAINT, GREY, INK, NAMED
from carom.display.si_prefix import prefixed
from carom.ledger_terms import terms
from carom.plot.books import LEAST, SHORT
from carom.plot.style import DOTS, INCH, PAPER, paper_file, positive, write
from carom.results.result import Result

KINDS = ("translation", "rotation", "vibration")
"""Parts of the kinetic energy, where the history has them."""

AT_END = {"strain": "strain energy at the end", "springs": "springs at the end"}
"""What stored energy that is left is called."""

MOST_PAIRS = 6
"""Pairs whose friction is told apart; those with the least are one, and if that were most, all."""

TRUNK = 0.36
"""Of the picture's width: the height of all energy together."""

WIDTH = 120.0
"""Of the picture unless it is said [mm]."""

_LINE, _GAP = 0.14, 0.05
"""Height of a line of text, and least distance of bands [inch]."""


@dataclass(frozen=True)
class Share:
    """What some energy came from, or became: what it is called, its colour, how much it is [J]."""

    label: str
    colour: str
    joule: float


@dataclass(frozen=True)
class Flow:
    """Where energy came from and where it went; both sides have the same sum but for round-off."""

    sources: tuple[Share, ...]
    sinks: tuple[Share, ...]


def flow(result: Result) -> Flow:
    """Return where the energy of a run came from and where it went, from its books.

    What a term has with the wrong sign is on the other side: work that bodies did on what moves
    them is a sink, and so is a defect that is positive a source.
    """
    history = result.history
    ends = {name: float(values[-1]) for name, values in history.items()}
    first = {name: float(values[0]) for name, values in history.items()}
    sources = [
        Share("kinetic energy at the start", NAMED["blue"], first["kinetic"]),
        Share("strain energy at the start", NAMED["orange"], first["strain"]),
    ]
    sinks: list[Share] = []
    _put(Share("springs at the start", NAMED["sky"], first["springs"]), sources, sinks)
    for term in terms("run"):
        if term.name == "kinetic":
            sinks += _kinetic(ends)
        elif term.side == "given":
            _put(Share(term.label, NAMED[term.colour], ends[term.name]), sources, sinks)
        elif term.name == "friction":
            for share in _friction(result, ends["friction"]):
                _put(share, sinks, sources)
        else:
            label = AT_END.get(term.name, SHORT[term.name])
            _put(Share(label, NAMED[term.colour], ends[term.name]), sinks, sources)
    _put(Share("unexplained", GREY, ends["defect"]), sources, sinks)
    return Flow(_seen(sources), _seen(sinks))


def energy_flow(
    result: Result, out: Path | str | None = None, *, width: float | None = None
) -> Figure:
    """Draw where the energy of a run went, as bands whose widths are joules.

    At the left stands what it came from, at the right what it became: energy at the end, what
    friction (by pairs) and other terms of the ledger took, and what is unexplained.

    Parameters
    ----------
    result
        The results.
    out
        The file to write: ``.pdf``, ``.svg`` or ``.png``. None writes none.
    width
        Of the picture [mm]. None is 120.

    Returns
    -------
    Figure
        Matplotlib's, to go on with.

    Raises
    ------
    InputError
        The file has another ending, or the width is none that can be.
    """
    file = None if out is None else paper_file(out)
    drawn = _drawn(result, positive("--width", width or WIDTH))
    if file is not None:
        with mpl.rc_context(PAPER):
            write(drawn, file, dots=DOTS)
    return drawn


def _drawn(result: Result, width: float) -> Figure:
    what = flow(result)
    total = sum(share.joule for share in what.sources)
    unit, size = prefixed("J", total)
    with mpl.rc_context(PAPER):
        across = width / INCH
        joule = TRUNK * across / total if total > 0.0 else 0.0
        up = max(
            _room(share.joule * joule for share in side) for side in (what.sources, what.sinks)
        )
        figure = Figure(figsize=(across, up))
        FigureCanvasAgg(figure)
        axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        axes.set(xlim=(0.0, across), ylim=(0.0, up))
        axes.set_axis_off()
        if not joule:
            axes.text(across / 2, up / 2, "no energy", ha="center", va="center", color=FAINT)
            return figure
        trunk = (up + total * joule) / 2
        left, middle, right = 0.34 * across, 0.42 * across, 0.64 * across
        for side, shares in ((-1, what.sources), (1, what.sinks)):
            edge, inner = (left, middle) if side < 0 else (right, middle + 0.06)
            tops = _apart([share.joule * joule for share in shares], up)
            start = trunk
            for share, top in zip(shares, tops, strict=True):
                height = share.joule * joule
                _band(axes, (inner, start), (edge, top), height, share.colour)
                text = f"{share.joule / size:.3g} {unit} ({100 * share.joule / total:.3g} %)"
                gap = 0.06 * side
                align = "left" if side > 0 else "right"
                centre = top - height / 2
                axes.text(edge + gap, centre, share.label, ha=align, va="bottom", color=INK)
                axes.text(edge + gap, centre - 0.01, text, ha=align, va="top", color=FAINT)
                start -= height
        axes.add_patch(
            Rectangle((middle, trunk - total * joule), 0.06, total * joule, color=INK, linewidth=0)
        )
    return figure


def _kinetic(ends: Mapping[str, float]) -> Iterator[Share]:
    if not all(kind in ends for kind in KINDS):
        yield Share("kinetic energy at the end", NAMED["blue"], ends["kinetic"])
        return
    for kind, colour in zip(KINDS, ("#0072B2", "#3C93C8", "#86BDE0"), strict=True):
        yield Share(f"{kind} at the end", colour, ends[kind])


def _friction(result: Result, total: float) -> Iterator[Share]:
    """Yield the friction of each pair, or of all where the books of pairs do not have its sum."""
    colour = NAMED["green"]
    pairs = {
        name.replace("|", " – "): float(book["friction"][-1])
        for name, book in result.ledger.items()
        if len(book["friction"]) and np.isfinite(book["friction"][-1])  # bodies have none
    }
    # Books of a run of stages begin anew, so that those of pairs may be of another time.
    if not pairs or not abs(sum(pairs.values()) - total) <= 1e-6 * abs(total):
        yield Share("friction", colour, total)
        return
    ordered = sorted(pairs.items(), key=lambda pair: -abs(pair[1]))
    others = sum(joule for _, joule in ordered[MOST_PAIRS:])
    if abs(others) > 0.5 * abs(total):
        yield Share("friction", colour, total)
        return
    for name, joule in ordered[:MOST_PAIRS]:
        yield Share(f"friction {name}", colour, joule)
    if ordered[MOST_PAIRS:]:
        yield Share("friction of other pairs", colour, others)


def _put(share: Share, here: list[Share], there: list[Share]) -> None:
    """Put a share where it belongs by its sign."""
    if share.joule >= 0.0:
        here.append(share)
    else:
        there.append(Share(share.label, share.colour, -share.joule))


def _seen(shares: Sequence[Share]) -> tuple[Share, ...]:
    """Return the shares that are seen; the sum of the others is one."""
    least = LEAST * sum(share.joule for share in shares)
    small = sum(share.joule for share in shares if share.joule < least)
    seen = [share for share in shares if share.joule >= least and share.joule > 0.0]
    if small > 0.0:
        seen.append(Share("all other terms", GREY, small))
    return tuple(seen)


def _slot(height: float) -> float:
    """Return what a band of a height takes, with its label and its distance to others [inch]."""
    return max(height + _GAP, 2.0 * _LINE)


def _room(heights: Iterable[float]) -> float:
    """Return what bands take, one below the other [inch]."""
    return sum(map(_slot, heights)) + _LINE


def _apart(heights: Sequence[float], up: float) -> list[float]:
    """Return the upper ends of bands from the top down, so far apart that labels have room."""
    top = (up + sum(map(_slot, heights))) / 2
    tops = []
    for height in heights:
        tops.append(top - (_slot(height) - height) / 2)
        top -= _slot(height)
    return tops


def _band(
    axes: Axes,
    start: tuple[float, float],
    end: tuple[float, float],
    height: float,
    colour: str,
) -> None:
    """Draw a band between two upright edges, given by their upper ends."""
    (x, y), (far, top) = start, end
    half = (x + far) / 2
    corners: NDArray[np.float64] = np.array(
        [
            (x, y),
            (half, y),
            (half, top),
            (far, top),
            (far, top - height),
            (half, top - height),
            (half, y - height),
            (x, y - height),
            (x, y),
        ]
    )
    codes = [Curve.MOVETO, *[Curve.CURVE4] * 3, Curve.LINETO, *[Curve.CURVE4] * 3, Curve.CLOSEPOLY]
    axes.add_patch(PathPatch(Curve(corners, codes), facecolor=colour, linewidth=0, alpha=0.85))
