"""The paper's two bars: the case, its exact solution, and the figures that describe a run.

The gap of 0.02 m is inferred: the paper shows it in a figure only.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from runs import Array, Run, example, observed_order, reference, relative_l2, simulate

ELEMENTS = (50, 100, 200, 400)
"""Elements per bar of the convergence study."""

LENGTH = 10.0  # m
WAVE_SPEED = 1000.0  # m/s, sqrt(E / ρ)
SPEED = 1.0  # m/s, of each bar towards the other
HALF_GAP = 0.01  # m
TOUCH = HALF_GAP / SPEED  # s
RELEASE = TOUCH + 2.0 * LENGTH / WAVE_SPEED  # s
MIDDLE = 0.5 * (TOUCH + RELEASE)  # s, of the contact
FORCE = 1.0  # N, ρ c v A: 1e-3 kg/m³, 1 m²
LATE = 0.035  # s, from when on the velocity after release is averaged

VARIANT = {"gap": "pos", "midpoint": "mid", "massless": "zeroS"}
"""The prototype's names of the contact conditions."""


def exact_displacement(time: Array) -> Array:
    """Return the displacement of the tip C of the left bar [m], by d'Alembert's solution.

    Until the touch at t₁ the bar moves at speed v, unstrained. By symmetry the tip then stands
    still as if it had met a rigid wall: a compression wave of velocity jump −v runs down the bar at
    the speed c, stopping it; at t₁ + L/c it meets the free end and comes back as a release wave of
    the same jump −v, behind which the bar is unstrained and moves at −v. It reaches the tip at
    t₂ = t₁ + 2 L/c, and the bars part:

        u_C(t) = v · [min(t, t₁) − max(t − t₂, 0)].
    """
    displacement: Array = SPEED * (np.minimum(time, TOUCH) - np.maximum(time - RELEASE, 0.0))
    return displacement


def exact_velocity(time: Array) -> Array:
    """Return the velocity of the tip C [m/s]: v before the touch, 0 in contact, then −v."""
    return np.select([time < TOUCH, time < RELEASE], [SPEED, 0.0], -SPEED)


MASSLESS = (
    'bodies.0.contact_sets=["right"]',
    'bodies.1.contact_sets=["left"]',
)
"""With the condition ``massless``: the ends that meet. The bars are one element high, so that no
mass would be left inside if all sides could touch."""

CONSERVING = 'analysis.scheme={kind="conserving"}'


def least_dispersion(elements: int) -> tuple[str, str]:
    """Return the overrides of the time step at which waves disperse least: c Δt = h/√2.

    Of linear elements with their consistent mass ω = c k (1 + (k h)²/24), of the midpoint of time
    ω Δt/2 = arctan(ω₀ Δt/2): the leading errors cancel. The touch stays at the end of a step.
    """
    step = LENGTH / elements / WAVE_SPEED / np.sqrt(2.0)
    step = TOUCH / round(TOUCH / step)
    return f"analysis.time_step={step!r}", f"output.history_every={step!r}"


def run(*, elements: int = 100, condition: str = "gap", overrides: Sequence[str] = ()) -> Run:
    """Run ``examples/two_bars.toml``, every step recorded."""
    sides = MASSLESS if condition == "massless" else ()
    scenario = example("two_bars.toml", f"contact.condition={condition}", *sides, *overrides)
    return simulate(
        scenario.with_overrides(
            [
                f"output.history_every={scenario.analysis.time_step}",
                f"bodies.0.mesh.divisions=[{elements}, 1]",
                f"bodies.1.mesh.divisions=[{elements}, 1]",
            ]
        )
    )


@dataclass(frozen=True)
class Figures:
    """What describes a run of the bars, each defined as in the prototype.

    Parameters
    ----------
    release
        End of the contact [s].
    late_velocity
        Mean velocity of C from 0.035 s to the end [m/s].
    displacement_error, velocity_error
        Errors of u_C and v_mid = Δu_C/Δt, relative and in the L2 norm over the whole run, sampled
        at the ends of all steps and at t = 0. v_mid is compared with the exact velocity in the
        middle of the step (touch and release fall on ends of steps).
    plateau
        Mean contact force over the middle half of the contact, over the exact ρ c v A.
    energy_change
        E(end) / E(0) − 1.
    """

    release: float
    late_velocity: float
    displacement_error: float
    velocity_error: float
    plateau: float
    energy_change: float


def figures(run: Run) -> Figures:
    """Measure a run of the bars."""
    history = run.history
    time = history["time"]
    middle = time - 0.5 * run.summary["time_step"]
    (contact,) = run.summary["contacts"]
    return Figures(
        release=contact["release"],
        late_velocity=float(history["C.v_x"][time > LATE + 1e-9].mean()),
        displacement_error=relative_l2(history["C.u_x"], exact_displacement(time)),
        velocity_error=relative_l2(history["C.vmid_x"], exact_velocity(middle)),
        plateau=float(history["normal_force"][abs(time - MIDDLE) < 0.25 * (RELEASE - TOUCH)].mean())
        / FORCE,
        energy_change=run.energy_change,
    )


def prototype(*, elements: int, condition: str = "gap") -> Figures:
    """Return the figures of the prototype's run."""
    table = reference("bars_table")
    (row,) = table[(table["variant"] == VARIANT[condition]) & (table["N"] == elements)]
    return Figures(
        release=float(row["t_off"]),
        late_velocity=float(row["vC_late"]),
        displacement_error=float(row["err_u_L2rel"]),
        velocity_error=float(row["err_vmid_L2rel"]),
        plateau=float("nan"),  # not in the table
        energy_change=float(row["dE_end_rel"]),
    )


def order(figures: Sequence[Figures], quantity: str, elements: Sequence[int] = ELEMENTS) -> float:
    """Return the order in h at which a figure of runs vanishes, with the first of `elements`."""
    sizes = [LENGTH / count for count in elements[: len(figures)]]
    return observed_order(sizes, [abs(getattr(figure, quantity)) for figure in figures])
