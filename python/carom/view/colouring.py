"""What gives the bodies their colours: one number for each point, face or edge that is seen."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from carom.display.colours import DIVERGING, SEQUENTIAL
from carom.errors import InputError
from carom.io.frames import Frames
from carom.messages import known
from carom.view.fields import TITLES, UNITS, Shown, choices, shown
from carom.view.outline import Outline

Place = Literal["points", "faces", "rim"]
"""What has a number each: points, faces, or in the plane the edges where bodies end."""

SIGNED = frozenset({"hydrostatic-pressure"})
"""What has a sign, whose zero is in the middle of the colours."""

BODY = "body"
"""The name of the colouring that tells bodies apart."""

_LEFT_OUT = frozenset({"area"})

_MOST_TELLING = ("von-mises", "pressure", "velocity", "displacement")

_INSTEAD = {"stress": "von-mises"}
"""What is taken for a name that is short for it."""


@dataclass(frozen=True)
class Colouring:
    """A field as it is drawn.

    Parameters
    ----------
    name
        What the user calls it.
    place
        What has its numbers.
    rows
        Gives them for a frame, shape [row_count]; NaN where there is none.
    """

    name: str
    place: Place
    rows: Callable[[int], NDArray[np.float64]]

    @property
    def title(self) -> str:
        """What it is."""
        return TITLES.get(self.name, self.name)

    @property
    def unit(self) -> str:
        """Its unit; empty for a number."""
        return UNITS.get(self.name, "")

    @property
    def map(self) -> str:
        """The colours that it has unless others are asked for, by matplotlib's name."""
        return DIVERGING if self.name in SIGNED else SEQUENTIAL

    def limits(self, frames: Iterable[int]) -> tuple[float, float]:
        """Return the values of the first and the last colour.

        They are the least and the largest of the frames. Zero is in the middle of what has a sign,
        and it is the first or the last where all values are one, to a millionth of it, or the least
        is less than half of the largest. Where all are zero, the last is 1.
        """
        ends = [
            (np.nanmin(v), np.nanmax(v)) for k in frames if np.isfinite(v := self.rows(k)).any()
        ]
        low = float(min((end[0] for end in ends), default=0.0))
        high = float(max((end[1] for end in ends), default=1.0))
        if self.name in SIGNED:
            high = max(abs(low), abs(high))
            low = -high
        elif high - low <= 1e-6 * max(abs(low), abs(high)):
            low, high = min(low, 0.0), max(high, 0.0)
        elif 0.0 <= low < 0.5 * high:
            low = 0.0
        return (low, high) if high > low else (low, low + 1.0)


def colourings(frames: Frames, surface: Frames | None, seen: Outline) -> dict[str, Colouring]:
    """Return all that can be shown, by name: of the bodies, then of their boundaries."""
    made = {}
    for name in choices(frames):
        what = shown(frames, name)
        chosen = seen.points if what.on_points else seen.cell
        place: Place = "points" if what.on_points else "faces"
        made[name] = Colouring(name, place, _rows(frames, what, chosen))
    if surface is None or (seen.facets < 0).all():
        return made
    for name in choices(surface):
        if name in _LEFT_OUT or surface.is_on_points(name):
            continue
        place = "faces" if seen.dimension == 3 else "rim"
        made[name] = Colouring(name, place, _rows(surface, shown(surface, name), seen.facets))
    return made


def chosen(made: dict[str, Colouring], name: str | None) -> Colouring | None:
    """Return the colouring of a name; None that tells bodies apart.

    Parameters
    ----------
    made
        What there is.
    name
        What was asked for; None is the most telling that there is.

    Raises
    ------
    InputError
        There is no such field.
    """
    if name is None:
        name = next((n for n in (*_MOST_TELLING, *made) if n in made), BODY)
    name = _INSTEAD.get(name, name)
    if name == BODY:
        return None
    if name not in made:
        raise InputError(f"--field {name}: no such field; {known(name, [*made, BODY])}")
    return made[name]


def _rows(
    frames: Frames, what: Shown, chosen: NDArray[np.int64]
) -> Callable[[int], NDArray[np.float64]]:
    def rows(frame: int) -> NDArray[np.float64]:
        values = what.values(frames, min(frame, len(frames.times) - 1))
        return np.where(chosen >= 0, values[chosen], np.nan)

    return rows
