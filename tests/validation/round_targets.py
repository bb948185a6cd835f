"""Round bodies in space as targets; shared by the tests and ``benchmarks/smooth_targets.py``."""

from __future__ import annotations

from math import pi
from typing import Literal

import numpy as np
from press_fits import DELTA, OUTER, POISSON, RADIUS, STEEL, YOUNG
from runs import Run, simulate

import carom

Targets = Literal["smooth", "faceted"]
TARGETS: tuple[Targets, ...] = ("faceted", "smooth")

RUBBER = carom.SaintVenantKirchhoff(young=2700.0, poisson=0.33, density=1.0)


def collision(
    targets: Targets,
    *,
    condition: str,
    friction: float,
    cell: str = "hex8",
    divisions: int = 4,
    end_time: float = 0.4,
) -> Run:
    """Let two balls, one of which spins, meet off centre in free space; they part by 0.4 s."""
    spin = (0.4, -0.7, 1.5)
    first = carom.Body(
        name="first",
        material="rubber",
        mesh=carom.Ball(centre=(0.0, 0.0, 0.0), radius=1.0, divisions=divisions, cell=cell),
        velocity=(2.0, 0.1, -0.2),
        spin=spin,
    )
    second = carom.Body(
        name="second",
        material="rubber",
        mesh=carom.Ball(centre=(2.05, 0.5, 0.3), radius=1.0, divisions=divisions, cell=cell),
    )
    scenario = carom.Scenario(
        dimension=3,
        analysis=carom.Dynamic(
            end_time=end_time,
            time_step=2e-3,
            scheme=carom.Conserving(),
            newton=carom.Newton(tolerance=1e-12),
        ),
        materials={"rubber": RUBBER},
        bodies=(first, second),
        contact=carom.Contact(
            condition=condition,
            friction=friction,
            targets=targets,
            sources="finer",
            solver=carom.FrictionSolver(tolerance=1e-13),
        ),
        output=carom.Output(history_every=2e-3),
    )
    return simulate(scenario)


def momentum_changes(run: Run) -> tuple[float, float]:
    """Return by how much momentum and angular momentum vary in a run, relative to their sizes."""

    def change(name: str) -> float:
        columns = np.stack([run.history[f"{name}_{axis}"] for axis in "xyz"], axis=1)
        return float(np.abs(columns - columns[0]).max() / np.linalg.norm(columns[0]))

    return change("momentum"), change("angular_momentum")


CORE = 0.2 * RADIUS
"""Radius of the rigid core of the shaft [m]."""

HEIGHT = 0.5 * RADIUS
"""Height of a fit [m]."""


def fit_error(
    targets: Targets, discretisation: str, divisions: int, *, cell: str = "hex8"
) -> float:
    """Fit a shaft into a hub with half as many facets again around.

    Return by how much the normal force is off that of plane strain. The shaft is held by a rigid
    core, the hub by the shaft.
    """

    def tube(inner: float, outer: float, around: int, along: int) -> carom.Tube:
        return carom.Tube(
            base=(0.0, 0.0, 0.0),
            inner_radius=inner,
            outer_radius=outer,
            height=HEIGHT,
            divisions=(around, divisions, along),
            cell=cell,
        )

    shaft, hub = tube(CORE, RADIUS, 4 * divisions, 2), tube(RADIUS, OUTER, 6 * divisions, 3)
    bodies = (
        carom.Body(name="shaft", material="steel", mesh=shaft, contact_sets=("outer",)),
        carom.Body(name="hub", material="steel", mesh=hub, contact_sets=("inner",)),
    )
    held = [(body, on) for body in ("shaft", "hub") for on in ("bottom", "top")]
    scenario = carom.Scenario(
        dimension=3,
        analysis=carom.Static(end_time=1.0, time_step=0.5),
        materials={"steel": STEEL},
        bodies=bodies,
        motions=(
            *(carom.Fixed(body=b, on=on, components=("z",)) for b, on in held),
            carom.Fixed(body="shaft", on="inner", components=("x", "y")),
        ),
        contact=carom.Contact(
            targets=targets,
            discretisation=discretisation,
            pairs=(carom.Pair(between=("shaft", "hub"), interference=f"{DELTA}*min(t, 1)"),),
        ),
    )
    return float(simulate(scenario).history["normal_force"][-1] / _exact_force() - 1.0)


def _exact_force() -> float:
    """Return the normal force [N] of the fit by Lamé, in plane strain.

    The radial displacement is A r + B/r; of the shaft it is zero at the core, of the hub the stress
    is zero outside.
    """
    core, outer = (CORE / RADIUS) ** 2, (OUTER / RADIUS) ** 2
    soft = 1.0 - 2.0 * POISSON
    shaft = soft * (1.0 - core) / (1.0 + soft * core)
    hub = (soft + outer) / (outer - 1.0)
    pressure = DELTA / RADIUS * YOUNG / (1.0 + POISSON) / (shaft + hub)
    return pressure * 2.0 * pi * RADIUS * HEIGHT


def slide(targets: Targets, *, divisions: int = 8, steps: int = 40) -> Run:
    """Press a rigid ball 2 cm into a shaft of 24 facets around and slide it over some of them.

    The surface of the ball goes on a circle around the shaft, and along it; from t = 1 s on it
    slides. It does not turn, so that its own nodes change places as well.
    """
    radius, depth, clearance = 0.4, 0.02, 1e-3
    distance = f"({1.0 + radius + clearance} - {depth + clearance}*min(t, 1))"
    angle = "0.6*max(t - 1, 0)"
    ball = carom.Body(
        name="ball",
        material="rubber",
        mesh=carom.Ball(
            centre=(0.0, 0.02, 1.0 + radius + clearance),
            radius=radius,
            divisions=divisions,
            rings=1,
        ),
    )
    shaft = carom.Body(
        name="shaft",
        material="rubber",
        mesh=carom.Tube(
            base=(0.0, -0.8, 0.0),
            axis=(0.0, 1.0, 0.0),
            inner_radius=0.6,
            outer_radius=1.0,
            height=1.6,
            divisions=(24, 2, 6),
        ),
        contact_sets=("outer",),
    )
    scenario = carom.Scenario(
        dimension=3,
        analysis=carom.Static(end_time=2.0, time_step=1.0 / steps),
        materials={"rubber": RUBBER},
        bodies=(ball, shaft),
        motions=(
            carom.Fixed(body="shaft", on="inner"),
            carom.Prescribed(
                body="ball",
                on="surface",
                x=f"{distance}*sin({angle})",
                y="0.05*max(t - 1, 0)",
                z=f"{distance}*cos({angle}) - {1.0 + radius + clearance}",
            ),
        ),
        contact=carom.Contact(
            targets=targets, pairs=(carom.Pair(between=("ball", "shaft"), sources="first"),)
        ),
        output=carom.Output(history_every=1.0 / steps),
    )
    return simulate(scenario)


def roll(targets: Targets, *, friction: float, divisions: int = 6, end_time: float = 0.4) -> Run:
    """Let a ball roll, or without friction slide, down a rigid coarse sphere under gravity."""
    radius, speed = 0.4, (1.0, 0.35)
    ball = carom.Body(
        name="ball",
        material="soft",
        mesh=carom.Ball(centre=(0.0, 0.0, 1.0 + radius + 1e-4), radius=radius, divisions=divisions),
        velocity=(*speed, 0.0),
        spin=(-speed[1] / radius, speed[0] / radius, 0.0) if friction > 0.0 else (0.0, 0.0, 0.0),
    )
    sphere = carom.Body(
        name="sphere",
        material="soft",
        mesh=carom.Ball(centre=(0.0, 0.0, 0.0), radius=1.0, divisions=4),
    )
    soft = carom.SaintVenantKirchhoff(
        young=2e5, poisson=0.3, density=1000.0, damping=carom.Damping(stiffness=2e-3)
    )
    scenario = carom.Scenario(
        dimension=3,
        analysis=carom.Dynamic(
            end_time=end_time,
            time_step=1e-3,
            gravity=(0.0, 0.0, -9.81),
            scheme=carom.Conserving(),
        ),
        materials={"soft": soft},
        bodies=(ball, sphere),
        motions=(carom.Fixed(body="sphere", on="surface"),),
        contact=carom.Contact(
            condition="massless",
            friction=friction,
            targets=targets,
            pairs=(carom.Pair(between=("ball", "sphere"), sources="first"),),
        ),
        output=carom.Output(history_every=1e-3),
    )
    return simulate(scenario)


def ripple(run: Run, start: float, degree: int) -> float:
    """Return how much the normal force varies about a polynomial in time from `start` on.

    It is the root of the mean square, relative to the mean force.
    """
    time, force = run.history["time"], run.history["normal_force"]
    time, force = time[time >= start], force[time >= start]
    rest = force - np.polyval(np.polyfit(time, force, degree), time)
    return float(rest.std() / force.mean())
