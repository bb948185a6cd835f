"""An elastic layer, endless along x, that hits a rough rigid floor obliquely: an exact solution.

A layer 0 < y < H with waves of pressure and shear at the speeds c_p and c_s arrives with the
velocity (v_t, −v_n). Normal: it is stopped from below by a wave of pressure ρ c_p v_n, which comes
back from the free side after 2 H / c_p as a release; the layer then leaves at v_n, unstrained. So
r_n = ρ c_p v_n for 2 H / c_p, an impulse of 2 ρ H v_n. Tangential: as long as no shear wave has
come back (2 H / c_s, later), r_t slows the sole to v_t − r_t / (ρ c_s). It sticks if the
r_t = ρ c_s v_t that this takes is at most μ r_n, so if v_t / v_n ≤ μ c_p / c_s; else r_t = μ r_n
throughout, and friction dissipates per area

    D = μ r_n (v_t − μ (c_p/c_s) v_n) · 2 H / c_p = 2 μ ρ H v_n (v_t − μ (c_p/c_s) v_n).

Here ρ = H = c_s = 1 and c_p = 2, so ν = 1/3 and E = 8/3 in plane strain; μ = 0.2. v_n is small
against c_p, as a linear law wants it, but everything scales with it.

The layer starts half a step of travel above the floor: to touch exactly at the end of a step would
be decided by round-off, and with the condition `midpoint` meshes of different width would differ.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from runs import Run, observed_order, simulate

import carom

VARIANTS = (
    ("theta", "gap"),
    ("conserving", "gap"),
    ("conserving", "midpoint"),
    ("conserving", "massless"),
)
"""Schemes and contact conditions that are validated."""

ELEMENTS = (16, 32, 64, 128)
"""Elements across the layer in the convergence study."""

SPEED_P, SPEED_S = 2.0, 1.0  # m/s, c_p and c_s
FRICTION = 0.2
SPEED = 0.01  # m/s, v_n
STICKING = 0.2
SLIPPING = (1.0, 2.0)
"""Ratios v_t / v_n of a layer that sticks and of two that slip; the limit is 0.4."""

DURATION = 2.0 / SPEED_P  # s

FINE = 0.25
"""c_p Δt / h of the convergence study: what is seen is mostly the error of the mesh."""

MATCHED = 0.5**0.5
"""c_p Δt / h at which the scheme delays short waves by as much as the mesh hurries them."""


def exact_dissipation(ratio: float) -> float:
    """Return D of a layer with this v_t / v_n, in units of ρ H v_n²."""
    return 2.0 * FRICTION * max(ratio - FRICTION * SPEED_P / SPEED_S, 0.0)


def dispersion(*, courant: float, mass: str = "consistent") -> float:
    """Return κ: waves of number k run at c_p (1 + κ k² h²), to leading order.

    The mesh gives ± 1/24 (consistent mass hurries short waves, lumped mass delays them), the
    scheme with θ = ½ delays them by (ω Δt)² / 12.
    """
    return {"consistent": 1.0, "lumped": -1.0}[mass] / 24.0 - courant**2 / 12.0


@dataclass(frozen=True)
class Figures:
    """What describes an impact.

    Parameters
    ----------
    dissipation
        Dissipated by friction per area, in units of ρ H v_n².
    duration
        From the touch to the end of the contact [s].
    deficit
        What the impulse of the floor lacks of 2 ρ H v_n, relative to it. With the energy that the
        layer keeps as vibration, it does not leave at its full speed.
    """

    dissipation: float
    duration: float
    deficit: float


def run(
    *,
    elements: int,
    ratio: float,
    scheme: str = "theta",
    condition: str = "gap",
    courant: float = FINE,
    mass: str = "consistent",
    cells: int = 1,
) -> Run:
    """Run the impact with square elements, `cells` of them along x, and Δt = courant · h / c_p."""
    size = 1.0 / elements
    step = courant * size / SPEED_P
    mesh = carom.Rectangle(
        corner=[0.0, 0.5 * SPEED * step],
        size=[cells * size, 1.0],
        divisions=[cells, elements],
        periodic=True,
    )
    return simulate(
        carom.Scenario(
            analysis=carom.Dynamic(end_time=1.2, time_step=step, scheme={"kind": scheme}),
            output=carom.Output(history_every=step, merge_contacts=0.5),
            materials={"elastic": carom.LinearElastic(young=8 / 3, poisson=1 / 3, density=1.0)},
            bodies=[
                carom.Body(
                    name="layer",
                    material="elastic",
                    mass=mass,
                    mesh=mesh,
                    velocity=[ratio * SPEED, -SPEED],
                )
            ],
            obstacles=[carom.Plane(name="floor", point=[0.0, 0.0], normal=[0.0, 1.0])],
            contact=carom.Contact(condition=condition, friction=FRICTION),
        )
    )


def figures(run: Run) -> Figures:
    """Measure an impact."""
    momentum = run.history["momentum_y"]
    (contact,) = run.summary["contacts"]
    # ρ H = 1 kg/m², so the width is the mass.
    width = -momentum[0] / SPEED
    touch = 0.5 * run.summary["time_step"]
    return Figures(
        dissipation=run.summary["energy"]["friction"] / (width * SPEED**2),
        duration=contact["release"] - touch,
        deficit=float(1.0 - (momentum[-1] - momentum[0]) / (2.0 * width * SPEED)),
    )


def error(figures: Figures, ratio: float) -> float:
    """Return how far the dissipation is from the exact one, in units of ρ H v_n²."""
    return abs(figures.dissipation - exact_dissipation(ratio))


def order(figures: Sequence[Figures], ratio: float) -> float:
    """Return the order in h at which the error of runs with `ELEMENTS` vanishes."""
    return observed_order([1.0 / n for n in ELEMENTS], [error(each, ratio) for each in figures])


def smeared(*, elements: int, courant: float, mass: str = "consistent") -> float:
    """Return the width of a wave front after it has travelled H, in H: (|κ| h²/H²)^⅓."""
    return float(np.cbrt(abs(dispersion(courant=courant, mass=mass)) / elements**2))
