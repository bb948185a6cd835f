"""Wedges and blocks on slopes, whose limit forces follow from balance and Coulomb's law alone.

Where everything slides, every reaction is at the angle φ = atan μ to its normal, and what drives
the body is in balance with them: the mechanics of rigid bodies, Meriam & Kraige, Engineering
Mechanics: Statics, section 6/4. Rigid obstacles have the same normal everywhere, so this is exact
for deformable bodies. Between two bodies it is exact in the limit of stiff ones.
"""

from __future__ import annotations

import tempfile
from math import atan, cos, radians, sin, tan
from pathlib import Path

import grids
import numpy as np
from compared import Compared, iterations_per_step
from runs import Run, simulate

import carom

ANGLE = radians(15.0)
FRICTION, FLOOR_FRICTION = 0.3, 0.2
PHI, FLOOR_PHI = atan(FRICTION), atan(FLOOR_FRICTION)
GRAVITY, DENSITY = 10.0, 1000.0
STEPS = 10
SOURCE = "balance with tan(α + φ)"


MAX_ITERATIONS = 200
"""Of nodes that lie flush on a stiff side one after the other comes to press."""


def rubber(young: float = 1e6) -> carom.NeoHookean:
    """Return what the bodies are of; the forces do not depend on it."""
    return carom.NeoHookean(young=young, poisson=0.3, density=DENSITY)


def block_on_a_slope() -> tuple[Compared, Compared]:
    """Push a block of 5 kN up a slope, level, and let it down again."""
    along, across = np.meshgrid(np.linspace(0.0, 1.0, 17), np.linspace(0.0, 0.5, 9))
    x = along * cos(ANGLE) - across * sin(ANGLE)
    y = along * sin(ANGLE) + across * cos(ANGLE)
    run = _run(
        {"block": (x, y)},
        end_time=2.0,
        gravity=(0.0, -GRAVITY),
        motions=[
            carom.Prescribed(
                body="block", on="left", x=carom.Table(time=(0.0, 1.0, 2.0), value=(0.0, 0.02, 0.0))
            )
        ],
        obstacles=[carom.Plane(name="slope", point=(0.0, 0.0), normal=(-sin(ANGLE), cos(ANGLE)))],
    )
    weight = DENSITY * GRAVITY * 0.5
    force = run.history["block.left.force_x"]
    iterations = iterations_per_step(run)
    up, down = float(force[STEPS]), float(force[-1])
    return (
        Compared(
            "block pushed up a slope, force [N]", up, weight * tan(ANGLE + PHI), SOURCE, iterations
        ),
        Compared(
            "block let down a slope, force [N]", down, weight * tan(ANGLE - PHI), SOURCE, iterations
        ),
    )


def wedge_in_a_gap() -> Compared:
    """Drive a wedge between a floor and a slope that narrow; it is squeezed by 3 to 10 %."""
    x, share = np.meshgrid(np.linspace(0.0, 1.0, 17), np.linspace(0.0, 1.0, 9))
    y = share * (1.5 - x) * tan(ANGLE)
    run = _run(
        {"wedge": (x, y)},
        motions=[carom.Prescribed(body="wedge", on="left", x="0.05*t")],
        obstacles=[
            carom.Plane(name="floor", point=(0.0, 0.0), normal=(0.0, 1.0)),
            carom.Plane(name="slope", point=(1.5, 0.0), normal=(-sin(ANGLE), -cos(ANGLE))),
        ],
        pairs=[carom.Pair(between=("wedge", "floor"), friction=FLOOR_FRICTION)],
    )
    drive, pressed = run.history["wedge.left.force_x"][-1], run.history["normal_force"][-1]
    # Per normal force of the floor; that of the slope follows from the balance upwards.
    on_slope = 1.0 / (cos(ANGLE) - FRICTION * sin(ANGLE))
    exact = (tan(FLOOR_PHI) + tan(ANGLE + PHI)) / (1.0 + on_slope)
    return Compared(
        "wedge driven into a gap, force per normal force",
        float(drive / pressed),
        exact,
        SOURCE,
        iterations_per_step(run),
    )


def wedge_under_a_weight(
    discretisation: str, young: float, max_iterations: int = MAX_ITERATIONS
) -> Compared:
    """Drive a wedge under a block that is guided upwards and bears 1 kN."""
    x, share = np.meshgrid(np.linspace(0.0, 1.4, 19), np.linspace(0.0, 1.0, 5))
    wedge = (x, share * (1.5 - x) * tan(ANGLE))
    x, share = np.meshgrid(np.linspace(0.4, 1.0, 9), np.linspace(0.0, 1.0, 7))
    low = (1.5 - x) * tan(ANGLE)
    block = (x, low + share * (0.8 - low))
    run = _run(
        {"wedge": wedge, "block": block},
        young=young,
        motions=[
            carom.Prescribed(body="wedge", on="left", x="0.05*t"),
            *(carom.Fixed(body="block", on=on, components=("x",)) for on in ("left", "right")),
        ],
        loads=[carom.Traction(body="block", on="top", traction=(0.0, -1000.0 / 0.6))],
        obstacles=[carom.Plane(name="floor", point=(0.0, 0.0), normal=(0.0, 1.0))],
        pairs=[carom.Pair(between=("wedge", "floor"), friction=FLOOR_FRICTION)],
        discretisation=discretisation,
        max_iterations=max_iterations,
    )
    exact = 1000.0 * (tan(FLOOR_PHI) + tan(ANGLE + PHI))
    return Compared(
        f"wedge driven under a weight, {discretisation}, E = {young:.0e} Pa, force [N]",
        float(run.history["wedge.left.force_x"][-1]),
        exact,
        SOURCE,
        iterations_per_step(run),
    )


def _run(
    grids_of: dict,
    *,
    end_time: float = 1.0,
    young: float = 1e6,
    gravity=None,
    pairs=(),
    discretisation: str = "node-to-segment",
    max_iterations: int = MAX_ITERATIONS,
    **others,
) -> Run:
    with tempfile.TemporaryDirectory() as folder:
        bodies = [
            carom.Body(
                name=name,
                material="rubber",
                mesh=carom.MeshFile(file=str(grids.write(Path(folder) / f"{name}.inp", *grid))),
            )
            for name, grid in grids_of.items()
        ]
        return simulate(
            carom.Scenario(
                analysis=carom.Static(
                    end_time=end_time,
                    time_step=1.0 / STEPS,
                    gravity=gravity,
                    newton=carom.Newton(max_iterations=max_iterations),
                ),
                output=carom.Output(history_every=1.0 / STEPS),
                materials={"rubber": rubber(young)},
                bodies=bodies,
                contact=carom.Contact(
                    friction=FRICTION, pairs=tuple(pairs), discretisation=discretisation
                ),
                **others,
            )
        )
