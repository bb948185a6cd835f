"""The pictures of docs/validation.md."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import bars
import cylinders
import ironing
import numpy as np
import oscillator
from matplotlib.axes import Axes
from matplotlib.ticker import FixedLocator, NullLocator, StrMethodFormatter
from runs import Array, Run

from carom.display.colours import BLACK, BLUE, GREEN, ORANGE, PURPLE
from carom.plot.style import figure, save

CURVES = (
    ("E_c", r"$E_c$ kinetic", BLUE),
    ("E_e", r"$E_e$ strain", ORANGE),
    ("E_t", r"$E_t = E_c + E_e$", GREEN),
)
"""Reference column, label and colour of each energy."""


def draw_bars(run: Run, path: Path) -> None:
    """Draw displacement and velocity of the bars' contact point over the exact solution."""
    time = run.history["time"]
    milliseconds = 1e3 * time
    with figure(height=4.6) as picture:
        displacement, velocity = picture.subplots(2, sharex=True)
        displacement.plot(milliseconds, 1e3 * run.history["C.u_x"], color=BLUE)
        _dash(displacement, milliseconds, 1e3 * bars.exact_displacement(time))
        displacement.set_ylabel("$u_C$ [mm]")
        displacement.set_title("Two bars: contact point C, 100 elements per bar")
        velocity.plot(
            milliseconds, run.history["C.vmid_x"], color=BLUE, linewidth=1.0, label="carom"
        )
        _dash(velocity, milliseconds, bars.exact_velocity(time), label="exact (d'Alembert)")
        velocity.set_ylabel(r"$v_\mathrm{mid} = \Delta u_C / \Delta t$ [m/s]")
        velocity.set_xlabel("time $t$ [ms]")
        velocity.legend(loc="upper right")
    save(picture, path)


def draw_ironing(runs: Mapping[tuple[str, str], ironing.Ironing], path: Path) -> None:
    """Draw the forces that draw the iron and press it."""
    with figure(height=3.6) as picture:
        axes = picture.subplots()
        for (discretisation, way), colour in zip(runs, (ORANGE, BLUE, BLACK), strict=True):
            run = runs[discretisation, way]
            for force, style in zip(run.forces, ("-", "--"), strict=True):
                label = f"{discretisation}, {way}" if style == "-" else None
                time = run.history["time"]
                axes.plot(time, 1e-6 * force, style, color=colour, linewidth=1.0, label=label)
        axes.set_title("Iron: drawn (full) and pressed (dashed)")
        axes.set_ylabel("force [MN/m]")
        axes.set_xlabel("time $t$ [s]")
        axes.legend(loc="upper left")
    save(picture, path)


def draw_cylinders(runs: Mapping[float, Run], path: Path) -> None:
    """Draw the cylinders' energies over the reference curves, a panel per friction."""
    with figure(height=5.6) as picture:
        panels = picture.subplots(len(runs), sharex=True, sharey=True)
        for axes, (friction, run) in zip(panels, runs.items(), strict=True):
            _energies(axes, run, friction)
        panels[-1].set_xlabel("time $t$ [s]")
        handles, labels = panels[0].get_legend_handles_labels()
        picture.legend(
            handles, labels, loc="outside upper center", ncols=len(handles), columnspacing=1.2
        )
    save(picture, path)


def _energies(axes: Axes, run: Run, friction: float) -> None:
    curves = cylinders.reference_curves(friction)
    shown = run.history["time"] <= curves["t"][-1] + 1e-9
    for column, label, colour in CURVES:
        axes.plot(
            run.history["time"][shown],
            run.history[cylinders.ENERGIES[column]][shown],
            color=colour,
            linewidth=2.4,
            label=label,
        )
    for column, _, _ in CURVES:
        last = column == CURVES[-1][0]
        _dash(axes, curves["t"], curves[column], label="prototype" if last else None)
    meeting = cylinders.MEETING_IN_PAPER[friction]
    axes.axvline(meeting, color=PURPLE, linewidth=1.4, linestyle=":", label="meeting (paper)")
    axes.set_ylim(0.0, 1.05 * curves["E_t"][0])
    axes.set_ylabel("energy [J]")
    axes.set_title(rf"$\mu = {friction:g}$")


def draw_convergence(
    figures: Sequence[bars.Figures], damped: Mapping[float, Sequence[Run]], path: Path
) -> None:
    """Draw the bars' errors over the element size, the damped column's over the time step."""
    with figure(height=3.4) as picture:
        left, right = picture.subplots(1, 2)
        _bars_errors(left, figures)
        _column_errors(right, damped)
        for axes in (left, right):
            axes.set_xscale("log")
            axes.set_yscale("log")
            axes.margins(x=0.08)
            axes.legend(fontsize=8)
        _ticks(left, [bars.LENGTH / elements for elements in bars.ELEMENTS], "{x:g}")
        _ticks(right, [1e3 * oscillator.END / steps for steps in oscillator.STEPS], "{x:g}")
    save(picture, path)


def _bars_errors(axes: Axes, figures: Sequence[bars.Figures]) -> None:
    sizes = [bars.LENGTH / elements for elements in bars.ELEMENTS]
    prototype = [bars.prototype(elements=elements) for elements in bars.ELEMENTS]
    for quantity, label, colour in (
        ("velocity_error", r"$v_\mathrm{mid}$", BLUE),
        ("displacement_error", "$u_C$", ORANGE),
    ):
        order = bars.order(figures, quantity)
        errors = [getattr(figure, quantity) for figure in figures]
        axes.plot(sizes, errors, "o-", color=colour, label=f"{label}, order {order:.2f}")
        theirs = [getattr(figure, quantity) for figure in prototype]
        last = quantity == "displacement_error"
        axes.plot(
            sizes, theirs, "+", color=BLACK, markersize=11, label="prototype" if last else None
        )
    axes.set_xlabel("element size $h$ [m]")
    axes.set_ylabel("relative $L_2$ error")
    axes.set_title("Two bars")


def _column_errors(axes: Axes, damped: Mapping[float, Sequence[Run]]) -> None:
    steps = 1e3 * oscillator.END / np.array(oscillator.STEPS)
    for colour, (theta, runs) in zip((BLUE, ORANGE), reversed(damped.items()), strict=True):
        order = oscillator.order(runs, oscillator.column_error)
        errors = [oscillator.column_error(run) for run in runs]
        axes.plot(
            steps,
            errors,
            "o-",
            color=colour,
            label=rf"$\theta = \xi = {theta:g}$, order {order:.2f}",
        )
    axes.set_xlabel(r"time step $\Delta t$ [ms]")
    axes.set_ylabel("relative largest error")
    axes.set_title("Damped column")


def _ticks(axes: Axes, places: Sequence[float], form: str) -> None:
    axes.xaxis.set_major_locator(FixedLocator(list(places)))
    axes.xaxis.set_major_formatter(StrMethodFormatter(form))
    axes.xaxis.set_minor_locator(NullLocator())


def _dash(axes: Axes, time: Array, values: Array, label: str | None = None) -> None:
    """Draw a reference curve on top."""
    axes.plot(time, values, color=BLACK, linewidth=0.9, linestyle=(0, (4, 3)), label=label)
