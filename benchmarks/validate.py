"""Run every validation, long ones included, and rewrite docs/validation.md with its pictures.

``make validate`` runs this. The cases and the measures are those of tests/validation.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterable, Sequence
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "validation"))

import bars
import cylinders
import layer
import oscillator
import pictures
from runs import Run, observed_order, theta_scheme

import carom

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "validation.md"
IMAGES = ROOT / "docs" / "images"

CONDITIONS = ("gap", "midpoint", "endpoint")
FRICTIONS = (0.0, 0.2)
DIVISIONS = (8, 12, 16)
STEPS = (2e-3, 1e-3, 5e-4, 2.5e-4)
"""Time steps of the cylinders [s]."""

KEPT = "<!-- What follows has commands of its own; make validate leaves it as it is. -->"
"""Where the part of the page begins that is not written here."""

THETAS = (0.5, 0.55, 0.75, 1.0)
ORDERS = {0.5: 2, 1.0: 1}
"""Order of the scheme in Δt by θ = ξ."""

RISE_TEST = {
    0.0: "without_friction_energy_rises_only_while_the_cylinders_touch",
    0.2: "energy_never_rises_by_more_than_the_defect",
}

PROTOTYPE_DRIFT = {8: 1.65e-2, 12: 1.27e-2, 16: 0.82e-2}
"""The prototype's drift over 15 s without friction, by divisions; its curves are for 8 only."""

INTRODUCTION = """\
# Validation

`make validate` runs everything below and rewrites this page; the numbers are those of carom
{version}. The tests named in the tables assert them in every `make test`.

Where the references come from:

- **exact**: analytic solutions, written as code in `tests/validation/bars.py` (d'Alembert),
  `tests/validation/layer.py` and `tests/validation/oscillator.py`.
- **prototype**: an independent implementation in plain Python, same method, separate code. Its
  curves are in `tests/validation/reference/`.
- **paper**: B. Magnain, Z.-Q. Feng, J.-M. Cros, *Modélisation des problèmes d'impact avec
  dissipation d'énergie par frottement*, C. R. Mécanique 333 (2005) 419–424.

The paper gives the material, the velocities, the sizes of the bodies and the time steps, and two
times: the cylinders meet at **2.45 s** without friction and at **2.8 s** with μ = 0.2. The rest of
the geometry is **inferred** from its figures: the gap of 0.02 m between the bars, the box of
8 m × 8 m, and the centres (2, 4) and (6, 4) of the cylinders.

Energies are relative to the initial energy E₀ unless a unit is given.
"""

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

LAYER = """\
## Oblique impact of a layer

`carom run examples/oblique_layer.toml`: an elastic layer of height H, periodic along x, hits a
rough rigid floor with the velocity (v_t, −v_n); ρ = H = c_s = 1, c_p = 2 (ν = 1/3), μ = 0.2. Exact,
derived in `tests/validation/layer.py`: contact for 2 H/c_p = 1 s; it sticks and dissipates nothing
if v_t/v_n ≤ μ c_p/c_s = 0.4, else it slips throughout and
D = 2 μ ρ H v_n (v_t − μ (c_p/c_s) v_n). D is per area, in units of ρ H v_n². N square elements
across the layer, c_pΔt = h/4. The order is that in h of the errors, by least squares over
N = {first} … {last}. Asserted in `test_oblique_layer.py`.

{refinement}

The impulse lacks the same part of 2 ρ H v_n at any v_t, and the D of v_t/v_n = 2 exceeds that of 1
by 2 μ ρ H v_n² less that part, to round-off.

**Why the order is 2/3 and not 1.** A step of velocity that travels L is smeared by dispersion over
(|κ| h² L)^⅓ if waves of number k run at c_p (1 + κ k²h²), and what rings behind the front stays in
the layer as vibration when it leaves. κ = ±1/24 − (c_pΔt/h)²/12 with consistent (+) or lumped (−)
mass. The lack of impulse over (|κ| h²/H²)^⅓ is nearly the same number for all masses, time steps
and meshes (`theta`, `gap`):

{dispersion}

Where mesh and scheme cancel, at c_pΔt = h/√2, the next order of dispersion is left, (h⁴ L)^⅕: 4/5.
Errors of D, same N; those of `midpoint` are so small there that they show no order.

{matched}
"""

CYLINDERS = """\
## Two cylinders in a rigid box

`carom run examples/two_cylinders.toml` with `--set contact.friction=…`: Saint-Venant–Kirchhoff
discs, Δt = 1e-3 s, 15 s. Condition `gap` and 8 divisions ({dofs} dofs) unless said otherwise.

{figures}

**Reference curves.** Distance of the energies from the prototype's until 5 s. The meshes agree on
the boundary and differ inside. Kinetic and strain energy swap within 0.06 s in an impact, so a lag
of a millisecond or two counts as 1 %; their sum and the friction dissipation do not see it.

{distances}

![Energies of the cylinders](images/cylinders.png)

**Meshes**, `--set bodies.0.mesh.divisions=…` and the same for body 1. After about 5.4 s the
sequence of impacts depends on the mesh and on round-off: onsets are not compared later, and
energies at 15 s are those of one sequence each.

{meshes}

**Time steps**, μ = 0.2 until 3 s, `--set analysis.time_step=…`: the defect is the work that the
averaged internal force of the scheme does not integrate exactly, and it vanishes with Δt (order
{defect_order:.2f} by least squares). What the condition `gap` takes at first touch does not.

{steps}

**When the energy rises.** With μ = 0.2 no interval until 5 s sees more rise than the defect in it:
E − defect rises by {rough_rise}. Without friction the same holds until the cylinders meet
({free_rise}). Then E − defect rises by up to {meeting_rise}: within an impact of the two cylinders
the normal reactions also do a little positive work, which those of plane obstacles never do. The
cause is not established; nodes that slide past corners of the other body's boundary are a
candidate. The prototype does the same: its energy rises by 4.6e-4 there.

**Where in time the unilateral condition is written**, `--set contact.condition=…`: the terms of
the ledger over 15 s.

{conditions}
"""

DISSIPATION = """\
## Dissipating schemes

`--set 'analysis.scheme={{kind="theta", theta=…, xi=…}}'` with θ = ξ. Energy falls monotonically
more with larger θ, and never rises for θ > ½ (`test_dissipation.py`; cylinders until 3.2 s there).

{bars}

{cylinders}
"""

CONSERVATION = """\
## Energy and momenta to round-off

The cylinders with `--set 'analysis.scheme={{kind="conserving"}}' --set contact.condition=midpoint`
and the first one 0.3 mm higher, over 15 s. Asserted at Δt = 1e-3 s in `test_conservation.py`, with
linear and angular momentum between wall contacts.

{runs}
"""

DAMPING = """\
## Damped motion

Rayleigh damping C = α M + β K with α = {alpha:g} /s and β = {beta:g} s, one cell of 1 m × 1 m
(`tests/validation/oscillator.py`): the exact solutions are a decaying velocity and a damped
oscillator. Largest error over 1 s relative to the largest exact value, by number of steps, and the
order in Δt by least squares. Asserted in
`test_damping.py::test_damped_motion_converges_at_the_order_of_the_scheme`.

{orders}
"""


def main() -> None:
    """Run everything and write the page."""
    start = time.perf_counter()
    IMAGES.mkdir(parents=True, exist_ok=True)
    sections = [
        INTRODUCTION.format(version=carom.__version__),
        bars_section(),
        layer_section(),
        cylinders_section(),
        conservation_section(),
        dissipation_section(),
        damping_section(),
    ]
    _, *kept = PAGE.read_text(encoding="utf-8").partition(KEPT)
    PAGE.write_text("\n".join(sections) + "\n" + "".join(kept), encoding="utf-8")
    print(f"wrote {PAGE.relative_to(ROOT)} in {time.perf_counter() - start:.0f} s")


def bars_section() -> str:
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
        for theta in ORDERS
    }
    pictures.draw_bars(runs["gap", 100], IMAGES / "bars.png")
    pictures.draw_convergence(list(gap.values()), damped, IMAGES / "convergence.png")
    return BARS.format(
        steps=runs["gap", 100].summary["steps"],
        figures=bars_figures(gap[100], runs["midpoint", 100]),
        refinement=bars_refinement(gap),
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


def bars_figures(gap: bars.Figures, midpoint: Run) -> str:
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


def bars_refinement(gap: dict[int, bars.Figures]) -> str:
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


def layer_section() -> str:
    """Run the layer at several ratios of its velocities, meshes and time steps, and describe it."""
    start = time.perf_counter()
    ratios = (layer.STICKING, *layer.SLIPPING)
    names = {variant: "`{}`, `{}`".format(*variant) for variant in layer.VARIANTS}

    def refined(variant: tuple[str, str], ratio: float, courant: float) -> list[layer.Figures]:
        scheme, condition = variant
        case = {"ratio": ratio, "scheme": scheme, "condition": condition, "courant": courant}
        return [layer.figures(layer.run(elements=n, **case)) for n in layer.ELEMENTS]

    refinement: list[tuple[object, ...]] = [
        ("exact", "", *(f"{layer.exact_dissipation(ratio):g}" for ratio in ratios), "1", "0")
    ]
    matched: list[tuple[object, ...]] = []
    for variant, name in names.items():
        fine = {ratio: refined(variant, ratio, layer.FINE) for ratio in ratios}
        for k, elements in enumerate(layer.ELEMENTS):
            row = [fine[ratio][k] for ratio in ratios]
            refinement.append(
                (
                    name,
                    elements,
                    *(f"{each.dissipation:.5f}" for each in row),
                    f"{row[-1].duration:.4f}",
                    percent(row[-1].deficit),
                )
            )
        orders = [f"{layer.order(fine[ratio], ratio):.2f}" for ratio in ratios]
        deficits = [each.deficit for each in fine[ratios[-1]]]
        sizes = [1.0 / n for n in layer.ELEMENTS]
        refinement.append((name, "order", *orders, "", f"{observed_order(sizes, deficits):.2f}"))
        for ratio in layer.SLIPPING:
            runs = refined(variant, ratio, layer.MATCHED)
            errors = [f"{layer.error(each, ratio):.1e}" for each in runs]
            told_order = f"{layer.order(runs, ratio):.2f}" if variant[1] == "gap" else "–"
            matched.append((name, f"{ratio:g}", *errors, told_order))
    dispersed = [
        (
            mass,
            f"{courant:g}",
            signed(layer.dispersion(courant=courant, mass=mass), 4),
            *(
                f"{figures.deficit / layer.smeared(elements=n, courant=courant, mass=mass):.3f}"
                for n in (64, 128, 256)
                for figures in [
                    layer.figures(layer.run(elements=n, ratio=1.0, courant=courant, mass=mass))
                ]
            ),
        )
        for mass in ("consistent", "lumped")
        for courant in (0.25, 0.5, 1.0)
    ]
    print(f"{time.perf_counter() - start:6.1f} s  layer", flush=True)
    return LAYER.format(
        first=layer.ELEMENTS[0],
        last=layer.ELEMENTS[-1],
        refinement=table(
            (
                "scheme, condition",
                "N",
                *(f"D, v_t/v_n = {ratio:g}" for ratio in ratios),
                "contact [s]",
                "lack of impulse",
            ),
            refinement,
        ),
        dispersion=table(("mass", "c_pΔt/h", "κ", "N = 64", "N = 128", "N = 256"), dispersed),
        matched=table(
            ("scheme, condition", "v_t/v_n", *(f"N = {n}" for n in layer.ELEMENTS), "order"),
            matched,
        ),
    )


def cylinders_section() -> str:
    """Run the cylinders and describe them."""
    by_condition = {
        (condition, friction): told(
            f"cylinders, {condition}, μ = {friction}",
            cylinders.run(friction=friction, condition=condition),
        )
        for condition in CONDITIONS
        for friction in FRICTIONS
    }
    paper = {friction: by_condition["gap", friction] for friction in FRICTIONS}
    by_mesh = {
        (divisions, friction): paper[friction]
        if divisions == DIVISIONS[0]
        else told(
            f"cylinders, {divisions} divisions, μ = {friction}",
            cylinders.run(friction=friction, divisions=divisions),
        )
        for divisions in DIVISIONS
        for friction in FRICTIONS
    }
    by_step = {
        step: told(
            f"cylinders, Δt = {step} s, until 3 s",
            cylinders.run(friction=0.2, end_time=3.0, overrides=(f"analysis.time_step={step}",)),
        )
        for step in STEPS
    }
    pictures.draw_cylinders(paper, IMAGES / "cylinders.png")
    meeting = cylinders.onset(paper[0.0], "left", "right")
    return CYLINDERS.format(
        dofs=paper[0.0].summary["dofs"],
        figures=cylinders_figures(paper),
        distances=cylinders_distances(paper),
        meshes=cylinders_meshes(by_mesh),
        steps=cylinders_steps(by_step),
        defect_order=observed_order(STEPS, [run.energy("max_defect") for run in by_step.values()]),
        rough_rise=power(paper[0.2].rise_beyond_defect(until=cylinders.COMPARED)),
        free_rise=power(paper[0.0].rise_beyond_defect(until=meeting)),
        meeting_rise=power(paper[0.0].rise_beyond_defect()),
        conditions=cylinders_conditions(by_condition),
    )


def cylinders_figures(paper: dict[float, Run]) -> str:
    """Tabulate the figures of the paper's two runs."""
    free, rough = paper[0.0], paper[0.2]
    where = "test_two_cylinders.py::test_"
    rows: list[tuple[object, ...]] = [
        (
            f"first wall contact, μ = {friction:g} [s]",
            "1.50 ± 0.01",
            "–",
            "1.50",
            f"{cylinders.first_wall_contact(run):.3f}",
            f"`{where}first_cylinder_touches_the_floor`",
        )
        for friction, run in paper.items()
    ]
    rows += [
        (
            f"cylinders meet, μ = {friction:g} [s]",
            f"{expected} ± 0.03",
            f"{cylinders.MEETING_IN_PAPER[friction]:g}",
            f"{expected}",
            f"{cylinders.onset(paper[friction], 'left', 'right'):.3f}",
            f"`{where}friction_on_the_floor_delays_the_meeting`",
        )
        for friction, expected in ((0.0, 2.49), (0.2, 2.83))
    ]
    rows += [
        (
            "largest drift, μ = 0",
            "0.5 % … 2.5 %",
            "–",
            percent(PROTOTYPE_DRIFT[8]),
            percent(free.energy("max_drift")),
            f"`{where}drift_without_friction_is_that_of_the_gap_condition`",
        ),
        (
            "E_end/E₀, μ = 0.2",
            "0.79 ± 0.02",
            "–",
            "≈ 0.79",
            f"{rough.energy('final'):.3f}",
            f"`{where}energy_at_the_end_with_friction`",
        ),
        (
            "largest defect of the ledger, μ = 0.2",
            "≤ 1e-3",
            "–",
            "–",
            power(rough.energy("max_defect")),
            f"`{where}friction_and_the_other_terms_account_for_the_loss`",
        ),
    ]
    rows += [
        (
            f"largest rise of the energy, μ = {friction:g}",
            f"≤ defect ({run.energy('max_defect'):.1e})",
            "–",
            "–",
            power(run.energy_rise),
            f"`{where}{RISE_TEST[friction]}`",
        )
        for friction, run in paper.items()
    ]
    return table(("quantity", "bound", "paper", "prototype", "carom", "asserted in"), rows)


def cylinders_distances(paper: dict[float, Run]) -> str:
    """Tabulate distances from the reference curves, largest and RMS."""
    distances = {
        friction: cylinders.distances(run, friction=friction) for friction, run in paper.items()
    }
    header = ["energy"]
    for friction in distances:
        header += [f"largest, μ = {friction:g}", f"RMS, μ = {friction:g}"]
    return table(
        header,
        [
            (
                f"`{name}`",
                *(percent(figure) for each in distances.values() for figure in each[name]),
            )
            for name in cylinders.ENERGIES
        ],
    )


def cylinders_meshes(runs: dict[tuple[int, float], Run]) -> str:
    """Tabulate events and energies by mesh."""
    return table(
        (
            "divisions",
            "dofs",
            "μ",
            "floor [s]",
            "meet [s]",
            "right on east [s]",
            "largest drift",
            "prototype's",
            "E_end/E₀",
            "friction",
            "largest defect",
        ),
        [
            (
                divisions,
                run.summary["dofs"],
                f"{friction:g}",
                f"{cylinders.onset(run, 'left', 'floor'):.3f}",
                f"{cylinders.onset(run, 'left', 'right'):.3f}",
                f"{cylinders.onset(run, 'right', 'east'):.3f}",
                percent(run.energy("max_drift")) if friction == 0.0 else "–",
                percent(PROTOTYPE_DRIFT[divisions]) if friction == 0.0 else "–",
                f"{run.energy('final'):.4f}",
                f"{run.energy('friction'):.4f}",
                power(run.energy("max_defect")),
            )
            for (divisions, friction), run in sorted(
                runs.items(), key=lambda item: (item[0][1], item[0][0])
            )
        ],
    )


def cylinders_steps(runs: dict[float, Run]) -> str:
    """Tabulate the ledger by time step."""
    return table(
        ("Δt [s]", "meet [s]", "friction", "normal contact", "largest defect", "largest rise"),
        [
            (
                f"{step:g}",
                f"{cylinders.onset(run, 'left', 'right'):.4f}",
                f"{run.energy('friction'):.4f}",
                power(run.energy("normal_contact")),
                power(run.energy("max_defect")),
                power(run.energy_rise),
            )
            for step, run in runs.items()
        ],
    )


def cylinders_conditions(runs: dict[tuple[str, float], Run]) -> str:
    """Tabulate the ledger by contact condition."""
    return table(
        (
            "condition",
            "μ",
            "meet [s]",
            "E_end/E₀",
            "friction",
            "normal contact",
            "largest defect",
            "smallest gap [m]",
            "peak force, first impact [N]",
        ),
        [
            (
                f"`{condition}`",
                f"{friction:g}",
                f"{cylinders.onset(run, 'left', 'right'):.3f}",
                f"{run.energy('final'):.4f}",
                f"{run.energy('friction'):.4f}",
                power(run.energy("normal_contact")),
                power(run.energy("max_defect")),
                power(run.summary["min_gap"]),
                f"{run.summary['contacts'][0]['peak_force']:.0f}",
            )
            for (condition, friction), run in sorted(
                runs.items(), key=lambda item: (item[0][1], CONDITIONS.index(item[0][0]))
            )
        ],
    )


def conservation_section() -> str:
    """Run the cylinders with the energy–momentum scheme and finer and finer steps."""
    return CONSERVATION.format(
        runs=table(
            ("Δt [s]", "μ", "largest drift", "largest defect", "friction", "iterations per step"),
            [
                (
                    f"{step:g}",
                    f"{friction:g}",
                    power(run.energy("max_drift")) if friction == 0.0 else "–",
                    power(run.energy("max_defect")),
                    f"{run.energy('friction'):.4f}",
                    f"{run.summary['newton_iterations'] / run.summary['steps']:.1f}",
                )
                for friction in FRICTIONS
                for step in (2e-3, 1e-3, 5e-4)
                for run in [
                    told(
                        f"cylinders, conserving, μ = {friction}, Δt = {step:g}",
                        cylinders.run(
                            friction=friction,
                            condition="midpoint",
                            overrides=(*cylinders.CONSERVING, f"analysis.time_step={step}"),
                        ),
                    )
                ]
            ],
        )
    )


def dissipation_section() -> str:
    """Run both problems with θ = ξ from ½ to 1."""
    sweeps = {
        "two bars, 0.04 s": lambda scheme: bars.run(overrides=(scheme,)),
        "two cylinders, μ = 0.2, 15 s": lambda scheme: cylinders.run(
            friction=0.2, overrides=(scheme,)
        ),
    }
    tables = [
        table(
            (f"θ = ξ, {name}", "E_end/E₀", "scheme", "friction", "normal contact", "largest rise"),
            [
                (
                    f"{theta:g}",
                    f"{run.energy('final'):.4f}",
                    f"{run.energy('scheme'):.4f}",
                    f"{run.energy('friction'):.4f}",
                    power(run.energy("normal_contact")),
                    power(run.energy_rise),
                )
                for theta in THETAS
                for run in [told(f"{name}, θ = ξ = {theta}", sweep(theta_scheme(theta)))]
            ],
        )
        for name, sweep in sweeps.items()
    ]
    return DISSIPATION.format(bars=tables[0], cylinders=tables[1])


def damping_section() -> str:
    """Run the damped motions with finer and finer steps."""
    motions = (
        ("free flight", oscillator.coasting, oscillator.coasting_error),
        ("column under gravity", oscillator.column, oscillator.column_error),
    )
    rows = []
    for name, motion, error in motions:
        for theta, expected in ORDERS.items():
            runs = [motion(steps=steps, theta=theta) for steps in oscillator.STEPS]
            order = oscillator.order(runs, error)
            errors = [f"{error(run):.2e}" for run in runs]
            rows.append((name, f"{theta:g}", *errors, f"{order:.3f}", expected))
    return DAMPING.format(
        alpha=oscillator.DAMPING.mass,
        beta=oscillator.DAMPING.stiffness,
        orders=table(
            ("motion", "θ = ξ", *(str(steps) for steps in oscillator.STEPS), "order", "expected"),
            rows,
        ),
    )


def told(name: str, run: Run) -> Run:
    """Return a run after saying how long it took."""
    print(f"{run.wall:6.1f} s  {name}", flush=True)
    return run


def table(header: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """Return a Markdown table."""
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join(f"| {' | '.join(str(cell) for cell in line)} |" for line in lines)


def percent(value: float, digits: int = 2) -> str:
    """Return a value in per cent, with a proper minus sign."""
    return f"{signed(100 * value, digits)} %"


def power(value: float) -> str:
    """Return a value as a power of ten, with a proper minus sign in front."""
    return f"{value:.1e}".replace("-", "−", 1) if value < 0 else f"{value:.1e}"


def signed(value: float, digits: int) -> str:
    """Return a value with so many decimals and a proper minus sign."""
    return f"{value:.{digits}f}".replace("-", "−")


if __name__ == "__main__":
    main()
