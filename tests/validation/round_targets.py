"""Round bodies in space as targets; shared by the tests and ``benchmarks/smooth_targets.py``."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from press_fits import DELTA, OUTER, RADIUS, STEEL, lame
from runs import Array, Run, simulate

import carom

Targets = Literal["smooth", "faceted"]
TARGETS: tuple[Targets, ...] = ("faceted", "smooth")

RUBBER = carom.SaintVenantKirchhoff(young=2700.0, poisson=0.33, density=1.0)


def collision(
    targets: Targets, *, condition: str, friction: float, cell: str = "hex8", divisions: int = 4
) -> Run:
    """Let two balls, one of which spins, meet off centre in free space."""
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
            end_time=0.4,
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


@dataclass(frozen=True)
class Fit:
    """A shaft in a hub.

    Parameters
    ----------
    error
        How much the normal force is off Lamé's, relative to it.
    spread
        Standard deviation of the pressures of contacts, relative to the exact one.
    """

    error: float
    spread: float


def fit(targets: Targets, discretisation: str, cell: str, divisions: int = 4) -> Fit:
    """Fit a solid shaft into a hub with half as many facets again around, held along the axis."""
    height = RADIUS / 2
    layers = max(1, divisions // 2)
    shaft = carom.Cylinder(
        base=(0.0, 0.0, 0.0),
        radius=RADIUS,
        height=height,
        divisions=divisions,
        layers=layers,
        cell=cell,
    )
    hub = carom.Tube(
        base=(0.0, 0.0, 0.0),
        inner_radius=RADIUS,
        outer_radius=OUTER,
        height=height,
        divisions=(6 * divisions, divisions, layers),
        cell=cell,
    )
    bodies = (
        carom.Body(name="shaft", material="steel", mesh=shaft, contact_sets=("side",)),
        carom.Body(name="hub", material="steel", mesh=hub, contact_sets=("inner",)),
    )
    held = [(body, on) for body in ("shaft", "hub") for on in ("bottom", "top")]
    scenario = carom.Scenario(
        dimension=3,
        analysis=carom.Static(end_time=1.0, time_step=0.5),
        materials={"steel": STEEL},
        bodies=bodies,
        motions=tuple(carom.Fixed(body=b, on=on, components=("z",)) for b, on in held),
        contact=carom.Contact(
            targets=targets,
            discretisation=discretisation,
            pairs=(carom.Pair(between=("shaft", "hub"), interference=f"{DELTA}*min(t, 1)"),),
        ),
    )
    run = simulate(scenario)
    return Fit(run.history["normal_force"][-1] / lame(height) - 1.0, 0.0)


def ripple(angle: Array, force: Array) -> float:
    """Return how much a force varies about a straight line, relative to its mean (RMS)."""
    rest = force - np.polyval(np.polyfit(angle, force, 1), angle)
    return float(rest.std() / force.mean())
