"""Blocks of rubber pressed flat between plates or bonded to them, and strips under pressure."""

from __future__ import annotations

from math import log

from compared import Compared, iterations_per_step
from runs import Run, simulate

import carom

YOUNG, POISSON = 3e6, 0.3
SIDE = 0.1  # m
STEPS = 10
PRESSURE = 1e3  # Pa, on strips of 1 MPa

STRIPS = ((10.0, 0.05), (10.0, 1.0), (4.0, 1.0), (1.0, 1.0))


def force_between_plates(compression: float) -> float:
    """Return the force [N] of plates on a block that is free across, 1 m thick, by its law.

    ψ = ½μ(I₁ − 3) − μ ln J + ½λ(ln J)² has P = μ(F − F⁻ᵀ) + λ ln J F⁻ᵀ; across it is 0.
    """
    mu = YOUNG / (2.0 * (1.0 + POISSON))
    lame = YOUNG * POISSON / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON))
    down = 1.0 - compression

    def stress(along: float, across: float) -> float:
        return mu * (along - 1.0 / along) + lame * log(along * across) / along

    low, high = 1.0, 10.0
    for _ in range(200):
        across = 0.5 * (low + high)
        low, high = (across, high) if stress(across, down) < 0.0 else (low, across)
    return -stress(down, across) * SIDE


def between_plates(compression: float) -> Compared:
    """Press a block between two plates without friction."""
    plates = [
        carom.Plane(name="below", point=(0.0, 0.0), normal=(0.0, 1.0)),
        carom.Plane(
            name="above",
            point=(0.0, SIDE),
            normal=(0.0, -1.0),
            motion=carom.Displacement(y=f"{-compression * SIDE}*t"),
        ),
    ]
    held = carom.Fixed(body="block", on="left", components=("x",))
    run = _run(_block(), motions=[held], obstacles=plates)
    return Compared(
        f"block pressed by {100 * compression:.0f} % without friction, force [N]",
        float(run.history["normal_force"][-1] / 2.0),
        force_between_plates(compression),
        "closed form of the law",
        iterations_per_step(run),
    )


def bonded(compression: float, change: float = 2e-4) -> Compared:
    """Press a block that its plates hold; its force is the slope of the energy over the way.

    The slope is that between the energies with a little less and a little more compression, from
    runs of their own: what a path of finite steps books does not enter.
    """

    def press(part: float) -> Run:
        motions = [
            carom.Fixed(body="block", on="bottom"),
            carom.Prescribed(body="block", on="top", x=0.0, y=f"{-part * SIDE}*t"),
        ]
        return _run(_block(), motions=motions)

    run = press(compression)
    low, high = (press(compression + sign * change).history["strain"][-1] for sign in (-1.0, 1.0))
    return Compared(
        f"bonded block pressed by {100 * compression:.0f} %, force [N]",
        float(-run.history["block.top.force_y"][-1]),
        float(high - low) / (2.0 * change * SIDE),
        "Castigliano: dU/du",
        iterations_per_step(run),
    )


def strip(length: float, height: float) -> Compared:
    """Press a strip on a floor."""
    divisions = (max(round(length / max(height, 0.2)), 2), max(round(4.0 * height), 1))
    run = _run(
        carom.Body(
            name="strip",
            material="elastic",
            mesh=carom.Rectangle(corner=(0.0, 0.0), size=(length, height), divisions=divisions),
        ),
        loads=[carom.Pressure(body="strip", on="top", pressure=PRESSURE)],
        motions=[carom.Fixed(body="strip", on="right", components=("x",))],
        obstacles=[carom.Plane(name="floor", point=(0.0, 0.0), normal=(0.0, 1.0))],
    )
    return Compared(
        f"strip of {length:g} × {height:g} on a floor, force [N]",
        float(run.history["normal_force"][-1]),
        PRESSURE * length,
        "balance",
        iterations_per_step(run),
    )


def _block() -> carom.Body:
    mesh = carom.Rectangle(corner=(0.0, 0.0), size=(SIDE, SIDE), divisions=(10, 10))
    return carom.Body(name="block", material="rubber", mesh=mesh)


def _run(body: carom.Body, **others) -> Run:
    return simulate(
        carom.Scenario(
            analysis=carom.Static(end_time=1.0, time_step=1.0 / STEPS),
            output=carom.Output(history_every=1.0 / STEPS),
            materials={
                "rubber": carom.NeoHookean(young=YOUNG, poisson=POISSON, density=1000.0),
                "elastic": carom.LinearElastic(young=1e6, poisson=0.0, density=1.0),
            },
            bodies=[body],
            **others,
        )
    )
