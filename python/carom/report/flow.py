"""Where the energy went, as bands whose widths are joules: a drawing whose labels are text.

Screen readers get the labels as two lists; the bands beside them say nothing that these do not.
"""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from functools import partial

import numpy as np

from carom.display.markup import Html, element, format_number
from carom.display.si_prefix import prefixed
from carom.ledger_terms import terms
from carom.plot.flow import Band, Columns, Flow, Share, bands, flow

TRUNK = 200.0
"""Height of all energy together [px]."""

_LINE, _GAP = 17.0, 5.0
"""Height of a line of text, and least distance of bands [px]."""

_LETTERS = 15
"""Of a label that have room on a line of the narrowest page."""

_HAIR = 0.5
"""Bands that are narrower would be dots: they are drawn as a hair [px]."""

_ACROSS, _LEFT, _RIGHT = 100.0, 31.0, 34.0
"""Width of the drawing, which is stretched, and the sides of the trunk in it."""

_NEEDED = ("kinetic", "strain", "defect", *(term.name for term in terms("run")))


def energy_flow(history: Columns, ledger: Mapping[str, Columns]) -> Html | None:
    """Return the drawing; None where the books are not there, or there was no energy."""
    ends = [history[name][[0, -1]] for name in _NEEDED if len(history.get(name, ()))]
    if len(ends) < len(_NEEDED) or not np.isfinite(ends).all():
        return None
    what = flow(history, ledger)
    if not what.total > 0.0:
        return None
    drawn = bands(what, TRUNK, partial(_slot, what))
    trunk = element(
        "rect",
        x=f"{_LEFT:g}",
        y=f"{drawn.top:.3f}",
        width=f"{_RIGHT - _LEFT:g}",
        height=f"{drawn.width:.3f}",
        class_="trunk",
    )
    drawing = element(
        "svg",
        *(_path(band, _LEFT, 0.0) for band in drawn.sources),
        *(_path(band, _RIGHT, _ACROSS) for band in drawn.sinks),
        trunk,
        viewBox=f"0 0 {_ACROSS:g} {drawn.height:.3f}",
        preserveAspectRatio="none",
        aria_hidden="true",
    )
    return element(
        "div",
        _list(what, drawn.sources, "The energy came from", "came"),
        drawing,
        _list(what, drawn.sinks, "The energy went to", "went"),
        class_="flow",
        style=f"height:{drawn.height:.1f}px",
    )


def _list(what: Flow, shown: Sequence[Band], title: str, side: str) -> Html:
    """Return the labels of a side, each beside its band."""
    items = (
        element(
            "li",
            band.share.label,
            " ",
            element("span", _size(what, band.share)),
            style=f"top:{band.label + band.width / 2:.1f}px",
        )
        for band in shown
    )
    return element("ul", *items, class_=side, aria_label=title)


def _size(what: Flow, share: Share) -> str:
    unit, size = prefixed("J", what.total)
    return f"{format_number(share.joule / size, 3)}\u202f{unit} ({what.fraction(share)})"


def _slot(what: Flow, share: Share, width: float) -> float:
    """Return what a band takes, with its label and its distance to others [px]."""
    texts = (share.label, _size(what, share))
    lines = sum(len(textwrap.wrap(text, _LETTERS)) for text in texts)
    return max(width + _GAP, lines * _LINE + _GAP)


def _path(band: Band, x: float, far: float) -> Html:
    """Return a band between two upright edges."""
    (y, low), (end, foot) = ((at, at + band.width) for at in (band.trunk, band.label))
    half = (x + far) / 2
    there = f"M{x:g},{y:.3f}C{half:g},{y:.3f} {half:g},{end:.3f} {far:g},{end:.3f}"
    back = f"V{foot:.3f}C{half:g},{foot:.3f} {half:g},{low:.3f} {x:g},{low:.3f}Z"
    return element(
        "path",
        d=there + back,
        style=f"color:var(--{band.share.colour})",
        opacity=f"{0.85 * (1.0 - band.share.white):.3g}",
        class_="hair" if band.width < _HAIR else None,
        data_joule=repr(band.share.joule),
    )
