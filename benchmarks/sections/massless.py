"""Massless contact: the cylinders, the bars and the layer with it."""

from __future__ import annotations

import bars
import bouncing_bar
import cylinders
import layer
import prize
from runs import Run, observed_order

from sections.layout import percent, power, signed, table, told

CYLINDERS = """\
## Energy-exact, quiet and non-penetrating in one run

`python benchmarks/prize.py`: the cylinders with scheme `conserving`, condition `massless` and
smooth targets, the first one 0.3 mm higher, 15 s.

Bounds: drift 5e-10, defect 1e-9, gap −1e-12 m,
total variation of the normal force in the first two impacts {quiet:.0f} N, momenta between two
touches of a wall 1e-9 of their largest value, least friction 0; asserted in `test_prize.py` at Δt =
1e-3 s, at 5e-4 s until 3.4 s, and at four times the speed. α reaches its limit in some steps
at other Δt, and the carried energy debt makes up for it.

{runs}

The last two rows, for comparison, have facets. Timings are of one run each on a shared machine.
"""

BARS = """\
## Massless bars

`contact_sets` right and left, `conserving`, otherwise as above; the prototype's in parentheses are
of `theta` and another distribution of the mass. Asserted in `test_two_bars.py`.

{refinement}

With `theta` max |ΔE|/E₀ is {theta} for N = {elements}.

At a fixed time step errors do not fall: consistent mass runs ahead of the wave where steps are
short, and lets the bars part early by more and more cells. With c Δt = h/√2 both leading errors of
dispersion cancel, and the orders do not turn round; the velocity jumps, so that its order is at
most a half. *Late* is the release after the exact one in times h/c that a wave takes through a
cell, *plateau* the mean force over the middle half of the contact against ρ c v A. Asserted in
`test_two_bars.py::test_massless_bars_converge_where_waves_disperse_least`.

{matched}
"""

BOUNCES = """\
## A bar that bounces under gravity

`tests/validation/bouncing_bar.py`: a bar of 10 m with c = 30 m/s falls from 5 m on a floor,
condition `massless`, c Δt = h/√2, until {end:g} s. Nine contacts, of which every other one leaves
the bar ringing and the next takes the vibration back; the exact height of its lower end is derived
there by d'Alembert's solution. Its error over the drop, root mean square, by time; asserted in
`test_bouncing_bar.py`. Fronts that have crossed the bar many times are spread over it: what comes
back of them late no longer converges at these sizes.

{bounces}

Defects are relative to the energy that the floor turns round, m g h.
"""

LAYER = """\
## Massless layer: is it of first order?

Error of D with its sign, `conserving` and `massless`, by c_pΔt/h and v_t/v_n:

{errors}

A fit over N = {first} … {last} at c_pΔt/h = 0.5 gives orders of {slow:.1f} and {fast:.1f}, but
errors change their sign there: a positive part of the massless layer and the negative part of the
dispersed front, which falls as h^⅔ and is left in the end. At the time step of least dispersion the
error is at most {worst:.3f} h; `test_oblique_layer.py` asserts h/8 to N = 256. A sticking layer
(v_t/v_n = {sticking:g}) loses up to {lost:.3f} h, in the step of the touch.
"""

FINER = (*layer.ELEMENTS, 256, 512, 1024)
MORE = (*bars.ELEMENTS, 800, 1600)
CELLS = (25, 50, 100, 200, 400)
COURANTS = (layer.FINE, 0.5, layer.MATCHED)


def cylinders_section() -> str:
    """Run the cylinders at several time steps."""
    return CYLINDERS.format(quiet=1.1 * cylinders.QUIET, runs=prize.measured())


def bars_section() -> str:
    """Run the bars with massless ends."""
    runs = [_bars(elements, bars.CONSERVING) for elements in bars.ELEMENTS]
    theta = [_bars(elements) for elements in bars.ELEMENTS]
    return BARS.format(
        refinement=_refinement(runs),
        theta=", ".join(power(run.energy("max_drift")) for run in theta),
        elements=", ".join(str(elements) for elements in bars.ELEMENTS),
        matched=_matched(),
    )


def _bars(elements: int, *overrides: str) -> Run:
    name = f"bars, massless, N = {elements}, {overrides}"
    return told(name, bars.run(elements=elements, condition="massless", overrides=overrides))


def _refinement(runs: list[Run]) -> str:
    """Tabulate errors over N with the prototype's, and the orders."""
    ours = [bars.figures(run) for run in runs]
    theirs = [bars.prototype(elements=n, condition="massless") for n in bars.ELEMENTS]
    rows: list[tuple[object, ...]] = [
        (
            elements,
            f"{mine.release:.5f} ({other.release:.5f})",
            f"{power(run.energy('max_drift'))} ({power(abs(other.energy_change))})",
            f"{percent(mine.displacement_error, 3)} ({percent(other.displacement_error, 3)})",
            f"{percent(mine.velocity_error, 1)} ({percent(other.velocity_error, 1)})",
            power(run.summary["min_gap"]),
        )
        for elements, run, mine, other in zip(bars.ELEMENTS, runs, ours, theirs, strict=True)
    ]
    orders = (
        f"{signed(bars.order(ours, each), 2)} ({signed(bars.order(theirs, each), 2)})"
        for each in ("displacement_error", "velocity_error")
    )
    rows.append(("order", "", "", *orders, ""))
    return table(
        (
            *("N", "release [s]", "max &#124;ΔE&#124;/E₀", "L2 error of u_C"),
            *("L2 error of v_mid", "smallest gap [m]"),
        ),
        rows,
    )


def _matched() -> str:
    """Tabulate errors over N at the time step of least dispersion, and the orders."""
    runs = [_bars(elements, bars.CONSERVING, *bars.least_dispersion(elements)) for elements in MORE]
    figures = [bars.figures(run) for run in runs]
    rows: list[tuple[object, ...]] = [
        (
            elements,
            f"{(mine.release - bars.RELEASE) * bars.WAVE_SPEED * elements / bars.LENGTH:.2f} h/c",
            f"{mine.plateau:.5f}",
            percent(mine.displacement_error, 3),
            percent(mine.velocity_error, 1),
            power(run.energy("max_drift")),
        )
        for elements, run, mine in zip(MORE, runs, figures, strict=True)
    ]
    orders = (
        signed(bars.order(figures, each, MORE), 2)
        for each in ("displacement_error", "velocity_error")
    )
    rows.append(("order", "", "", *orders, ""))
    return table(
        (
            *("N", "late", "plateau", "L2 error of u_C", "L2 error of v_mid"),
            "max &#124;ΔE&#124;/E₀",
        ),
        rows,
    )


def bounces_section() -> str:
    """Let a bar bounce on finer and finer meshes."""
    times = (0.0, bouncing_bar.AFTER, bouncing_bar.FIRST_BOUNCES, 16.0, 24.0)
    rows: list[tuple[object, ...]] = []
    for cells in CELLS:
        run = told(f"bouncing bar, N = {cells}", bouncing_bar.run(cells, bounces=times[-1]))
        rows.append(
            (
                cells,
                *(power(error) for error in bouncing_bar.errors(run, times)),
                power(run.summary["energy"]["max_defect"] / bouncing_bar.FALL),
                power(run.summary["min_gap"]),
            )
        )
    spans = (f"until {end:g} s" for end in times[1:])
    return BOUNCES.format(
        end=times[-1],
        bounces=table(("N", *spans, "largest defect", "smallest gap [m]"), rows),
    )


def layer_section() -> str:
    """Run the layer on finer and finer meshes."""
    errors = {
        (courant, ratio): [_lost(n, ratio, courant) - layer.exact_dissipation(ratio) for n in FINER]
        for courant in COURANTS
        for ratio in layer.SLIPPING
    }
    sizes = [1.0 / n for n in layer.ELEMENTS]
    slow, fast = (
        observed_order(sizes, [abs(error) for error in errors[0.5, ratio][: len(sizes)]])
        for ratio in layer.SLIPPING
    )
    return LAYER.format(
        errors=table(
            ("c_pΔt/h", "v_t/v_n", *(str(n) for n in FINER)),
            [
                (f"{courant:.2g}", f"{ratio:g}", *(power(error) for error in row))
                for (courant, ratio), row in errors.items()
            ],
        ),
        first=layer.ELEMENTS[0],
        last=layer.ELEMENTS[-1],
        slow=slow,
        fast=fast,
        worst=max(
            abs(error) * n
            for ratio in layer.SLIPPING
            for n, error in zip(FINER, errors[layer.MATCHED, ratio], strict=True)
        ),
        sticking=layer.STICKING,
        lost=max(_lost(n, layer.STICKING, layer.FINE) * n for n in layer.ELEMENTS),
    )


def _lost(elements: int, ratio: float, courant: float) -> float:
    """Return what friction takes of the layer."""
    case = {"scheme": "conserving", "condition": "massless", "courant": courant}
    name = f"layer, massless, N = {elements}, v_t/v_n = {ratio}, c_pΔt/h = {courant:.2g}"
    run = told(name, layer.run(elements=elements, ratio=ratio, **case))
    return layer.figures(run).dissipation
