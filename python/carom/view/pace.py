"""How time runs in a film: which frame of the run each of its pictures shows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from carom.errors import InputError
from carom.plot.style import positive, several

RATE = 25.0
"""Pictures per second of a film that shows every frame of a run once."""

FASTEST, SLOWEST = 60.0, 0.5
"""Pictures per second that are taken from the run's own frames, at most and at least."""

LEAST_RATE, MOST_RATE = 0.02, 1000.0
"""Pictures per second that can be asked for; a GIF knows none that stays a minute longer."""

MOST = 20_000
"""Pictures of a film."""

REAL = 0.02
"""By how much the pace may be off 1 to be called that of reality."""


@dataclass(frozen=True)
class Pace:
    """The frames of a film.

    Parameters
    ----------
    frames
        The frame of the run that each picture shows, shape [picture_count].
    rate
        Pictures per second.
    seconds
        Of the run, that pass in a second of the film around each picture, shape [picture_count].
    """

    frames: NDArray[np.int64]
    rate: float
    seconds: NDArray[np.float64]

    def text(self, picture: int) -> str:
        """Return the pace at a picture in words."""
        return said(float(self.seconds[picture]))


def pace(
    times: NDArray[np.float64],
    *,
    rate: float | None = None,
    duration: float | None = None,
    speed: float | None = None,
    between: tuple[float, float] | None = None,
) -> Pace:
    """Choose the frames of a film.

    Without a duration and a speed every frame of the run is shown once. With one of them time runs
    evenly: each picture shows the frame that is nearest, and no more pictures are made than the run
    has frames, unless a rate is asked for.

    Parameters
    ----------
    times
        Of the frames of the run [s], rising, shape [frame_count].
    rate
        Pictures per second; None is 25, or what shows the frames of the run once each.
    duration
        Of the film [s].
    speed
        Seconds of the run in a second of the film: 0.001 is slow motion by a thousand.
    between
        First and last time that is shown [s]; None is the whole run.

    Raises
    ------
    InputError
        A number is none that can be, or the film would be too long.
    """
    for option, value in (("--duration", duration), ("--speed", speed)):
        if value is not None:
            positive(option, value)
    if rate is not None and not LEAST_RATE <= rate <= MOST_RATE:
        raise InputError(
            f"--fps {rate:g}: must be {LEAST_RATE:g} to {MOST_RATE:g} pictures per second"
        )
    if duration is not None and speed is not None:
        raise InputError("--duration and --speed: each says how fast time runs; give one of them")
    taken = np.arange(len(times))
    if between is not None:
        several("--between", between, "START END")
        if not between[0] <= between[1]:
            raise InputError(
                f"--between {between[0]:g} {between[1]:g}: give START END in seconds, END not less "
                "than START"
            )
        taken = np.flatnonzero((times >= between[0]) & (times <= between[1]))
        if not len(taken):
            raise InputError(
                f"--between {between[0]:g} {between[1]:g}: no frame of the run is there, whose "
                f"times are from {times[0]:g} to {times[-1]:g} s, at most "
                f"{np.diff(times).max(initial=0.0):g} s apart"
            )
    here = times[taken]
    span = float(here[-1] - here[0])
    length = duration if speed is None else span / speed
    if length is None or span == 0.0:
        made = rate or RATE
        _not_too_long(len(taken))
        return Pace(taken, made, _paces(here, made))
    made = rate or float(np.clip((len(taken) - 1) / length, SLOWEST, FASTEST))
    _not_too_long(length * made)
    count = max(round(length * made), 1)
    wanted = here[0] + span * np.arange(count + 1) / count
    nearest = np.abs(np.searchsorted((here[1:] + here[:-1]) / 2, wanted))
    return Pace(taken[nearest], made, np.full(len(wanted), span / length))


def said(seconds: float) -> str:
    """Return the pace of a film in words, of so many seconds of the run in one of the film."""
    if not (np.isfinite(seconds) and seconds > 0.0):
        return ""
    if abs(seconds - 1.0) <= REAL:
        return "real time"
    if seconds > 1.0:
        return f"{seconds:.3g} × real time"
    return f"slow motion 1 : {_round(1.0 / seconds)}"


def _round(ratio: float) -> str:
    """Return a ratio with two digits, and as many zeros as it takes."""
    digits = max(1 - int(np.floor(np.log10(ratio))), -12)
    rounded = round(ratio, digits)
    return f"{rounded:,.{max(digits, 0)}f}".replace(",", "\u202f").removesuffix(".0")


def _paces(times: NDArray[np.float64], rate: float) -> NDArray[np.float64]:
    """Return how many seconds of the run pass in one of a film that shows every frame once.

    Of neighbours that differ by round-off, or by a last frame that came early, all have the pace of
    most: it is that of the median step where the step is within a tenth of it.
    """
    if len(times) < 2:
        return np.zeros(len(times))
    steps = np.diff(times, append=2 * times[-1] - times[-2])
    usual = float(np.median(steps))
    steps = np.where(np.abs(steps - usual) <= 0.1 * usual, usual, steps)
    return np.asarray(steps * rate)


def _not_too_long(count: float) -> None:
    if count > MOST:
        raise InputError(
            f"the film would have {count:.6g} pictures, and {MOST} at most can be; "
            "choose a larger --speed, a shorter --duration or a part by --between"
        )
