"""The two bars of the paper."""

from __future__ import annotations

import bars
import oscillator
from runs import Run

from sections import damping, pictures
from sections.layout import IMAGES, percent, power, signed, table, told

BARS = """\
## Two bars

`carom run examples/two_bars.toml`: frictionless, 10 m each, wave speed 1000 m/s, Δt = 1e-5 s,
{steps} steps. The exact contact lasts 2 L/c = 0.02 s, from 0.01 s to 0.03 s.

{figures}

The errors are relative and in the L2 norm over the whole run, sampled at t = 0 and at the end of
every step; so defined, the prototype's own table is met to eight digits at N = 100. v_mid = Δu_C/Δt
is the mean velocity over a step and is compared with the exact velocity within that step. The
velocity after release is the mean of u̇_C over t > 0.035 s: just behind the release, the jump is
smeared by the dispersion of the mesh.

![Contact point of the bars](images/bars.png)

The spike at the touch lasts nine steps: the tip rebounds once and is caught again. The prototype
shows the same.

**Refinement** at fixed Δt, with `--set bodies.0.mesh.divisions=[N, 1]` and the same for body 1
(condition `gap`; prototype in parentheses). The last row is the order in h by least squares.

{refinement}

`midpoint` conserves energy at every N. Its contact velocity chatters: v_mid is no measure of it.

{midpoint}

The loss is work of normal reactions in phases of contact, so it is bounded by the tolerance of the
contact solver, 1e-12 by default; with 1e-14, max |ΔE|/E₀ is {tight:.1e} at N = 100.

![Orders](images/convergence.png)
"""


def section() -> str:
    """Run the bars and describe them."""
    runs = {
        (condition, elements): told(
            f"bars, {condition}, N = {elements}", bars.run(elements=elements, condition=condition)
        )
        for condition in ("gap", "midpoint")
        for elements in bars.ELEMENTS
    }
    gap = {elements: bars.figures(runs["gap", elements]) for elements in bars.ELEMENTS}
    tight = bars.run(
        condition="midpoint",
        overrides=('contact.solver={kind="gauss-seidel", tolerance=1e-14}',),
    )
    damped = {
        theta: [oscillator.column(steps=steps, theta=theta) for steps in oscillator.STEPS]
        for theta in damping.ORDERS
    }
    pictures.draw_bars(runs["gap", 100], IMAGES / "bars.png")
    pictures.draw_convergence(list(gap.values()), damped, IMAGES / "convergence.png")
    return BARS.format(
        steps=runs["gap", 100].summary["steps"],
        figures=_figures(gap[100], runs["midpoint", 100]),
        refinement=_refinement(gap),
        midpoint=table(
            ("N", "max &#124;ΔE&#124;/E₀", "L2 error of u_C", "prototype's", "smallest gap [m]"),
            [
                (
                    elements,
                    power(run.energy("max_drift")),
                    percent(bars.figures(run).displacement_error),
                    percent(
                        bars.prototype(elements=elements, condition="midpoint").displacement_error
                    ),
                    power(run.summary["min_gap"]),
                )
                for (condition, elements), run in runs.items()
                if condition == "midpoint"
            ],
        ),
        tight=tight.energy("max_drift"),
    )


def _figures(gap: bars.Figures, midpoint: Run) -> str:
    """Tabulate the figures at N = 100."""
    theirs = bars.prototype(elements=100)
    where = "test_two_bars.py::test_"
    return table(
        ("quantity, N = 100", "bound", "exact", "prototype", "carom", "asserted in"),
        [
            (
                "release [s]",
                "0.0299 ± 0.0002",
                f"{bars.RELEASE:.4f}",
                f"{theirs.release:.5f}",
                f"{gap.release:.5f}",
                f"`{where}bars_part_after_the_wave_has_returned`",
            ),
            (
                "velocity of C after release [m/s]",
                "−1 ± 0.01",
                "−1",
                signed(theirs.late_velocity, 4),
                signed(gap.late_velocity, 4),
                f"`{where}bars_leave_with_reversed_velocity`",
            ),
            (
                "L2 error of u_C",
                "≤ 1 %",
                "0",
                percent(theirs.displacement_error),
                percent(gap.displacement_error),
                f"`{where}contact_point_follows_the_exact_solution`",
            ),
            (
                "L2 error of v_mid",
                "≤ 8 %",
                "0",
                percent(theirs.velocity_error),
                percent(gap.velocity_error),
                "same",
            ),
            (
                "ΔE/E₀, `gap`",
                "−0.5 % ± 0.1 %",
                "0",
                percent(theirs.energy_change),
                percent(gap.energy_change),
                f"`{where}gap_condition_loses_energy_at_the_touch`",
            ),
            (
                "max &#124;ΔE&#124;/E₀, `midpoint`",
                "≤ 1e-11",
                "0",
                power(abs(bars.prototype(elements=100, condition="midpoint").energy_change)),
                power(midpoint.energy("max_drift")),
                f"`{where}midpoint_condition_conserves_energy`",
            ),
            (
                "errors for N = 50 … 400",
                "prototype's rates ± 0.02, values ± 1 %",
                "",
                "below",
                "below",
                f"`{where}errors_fall_with_the_element_size_at_the_prototypes_rate`",
            ),
        ],
    )


def _refinement(gap: dict[int, bars.Figures]) -> str:
    """Tabulate errors over N with the prototype's, and the orders."""
    quantities = ("displacement_error", "velocity_error", "energy_change")
    theirs = {elements: bars.prototype(elements=elements) for elements in gap}
    rows: list[tuple[object, ...]] = [
        (
            elements,
            f"{figures.release:.5f} ({theirs[elements].release:.5f})",
            *(
                f"{percent(getattr(figures, quantity), 3)} "
                f"({percent(getattr(theirs[elements], quantity), 3)})"
                for quantity in quantities
            ),
        )
        for elements, figures in gap.items()
    ]
    orders = (
        f"{bars.order(list(gap.values()), quantity):.3f} "
        f"({bars.order(list(theirs.values()), quantity):.3f})"
        for quantity in quantities
    )
    rows.append(("order", "", *orders))
    return table(("N", "release [s]", "L2 error of u_C", "L2 error of v_mid", "ΔE/E₀"), rows)
