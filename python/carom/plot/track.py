"""Motion of a tracked point over time."""

from __future__ import annotations

from matplotlib.figure import Figure

from carom.display.colours import BLUE, ORANGE
from carom.plot.style import figure, run_unit
from carom.results.result import Result

COMPONENTS = (("x", BLUE), ("y", ORANGE))
"""Each component and its colour."""


def track_figure(result: Result, *, track: str) -> Figure:
    """Draw displacement [m] and velocity [m/s] of a tracked point over time.

    The velocity to read is the mean over each step, v_mid = Δu/Δt. The velocity at the end of a
    step, a thin line, flips from step to step while the point is in contact.

    Parameters
    ----------
    result
        Results of a run that tracked the point.
    track
        Name of the tracked point.
    """
    history = result.history
    unit = run_unit(result)
    time = history["time"] / unit.seconds
    with figure(height=5.0) as picture:
        displacement, velocity = picture.subplots(2, sharex=True)
        for component, colour in COMPONENTS:
            displacement.plot(
                time, history[f"{track}.u_{component}"], color=colour, label=f"$u_{component}$"
            )
            velocity.plot(
                time,
                history[f"{track}.v_{component}"],
                color=colour,
                linewidth=0.4,
                alpha=0.6,
                label=f"$v_{component}$, end of step",
            )
            velocity.plot(
                time,
                history[f"{track}.vmid_{component}"],
                color=colour,
                label=rf"$v_{{\mathrm{{mid}},{component}}}$",
            )
        displacement.set_ylabel("displacement [m]")
        displacement.set_title(
            f"{result.summary['title']}: {track}".removeprefix(": "), parse_math=False
        )
        velocity.set_ylabel("velocity [m/s]")
        velocity.set_xlabel(f"time $t$ [{unit.symbol}]")
        for axes in (displacement, velocity):
            axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    return picture
