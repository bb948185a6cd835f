"""The two cylinders of the paper."""

from __future__ import annotations

import cylinders
from runs import Run, observed_order

from sections import pictures
from sections.layout import FRICTIONS, IMAGES, percent, power, table, told

CONDITIONS = ("gap", "midpoint", "endpoint")
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
({free_rise}).

Then E − defect rises by up to {meeting_rise}: within an impact of the two cylinders
the normal reactions also do a little positive work, which those of plane obstacles never do. The
cause is not established; nodes that slide past corners of the other body's boundary are a
candidate. The prototype does the same: its energy rises by 4.6e-4 there.

**Where in time the unilateral condition is written**, `--set contact.condition=…`: the terms of
the ledger over 15 s.

{conditions}
"""

DIVISIONS = (8, 12, 16)
STEPS = (2e-3, 1e-3, 5e-4, 2.5e-4)
"""Time steps of the cylinders [s]."""

RISE_TEST = {
    0.0: "without_friction_energy_rises_only_while_the_cylinders_touch",
    0.2: "energy_never_rises_by_more_than_the_defect",
}

PROTOTYPE_DRIFT = {8: 1.65e-2, 12: 1.27e-2, 16: 0.82e-2}
"""The prototype's drift over 15 s without friction, by divisions; its curves are for 8 only."""


def section() -> str:
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
        figures=_figures(paper),
        distances=_distances(paper),
        meshes=_meshes(by_mesh),
        steps=_steps(by_step),
        defect_order=observed_order(STEPS, [run.energy("max_defect") for run in by_step.values()]),
        rough_rise=power(paper[0.2].rise_beyond_defect(until=cylinders.COMPARED)),
        free_rise=power(paper[0.0].rise_beyond_defect(until=meeting)),
        meeting_rise=power(paper[0.0].rise_beyond_defect()),
        conditions=_conditions(by_condition),
    )


def _figures(paper: dict[float, Run]) -> str:
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


def _distances(paper: dict[float, Run]) -> str:
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


def _meshes(runs: dict[tuple[int, float], Run]) -> str:
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


def _steps(runs: dict[float, Run]) -> str:
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


def _conditions(runs: dict[tuple[str, float], Run]) -> str:
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
            "certificate [J]",
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
                power(run.summary["certificate"]["max_joule"]),
            )
            for (condition, friction), run in sorted(
                runs.items(), key=lambda item: (item[0][1], CONDITIONS.index(item[0][0]))
            )
        ],
    )
