"""Bodies under an initial stress, whose motion has a closed form."""

from __future__ import annotations

import tempfile
from math import pi, sqrt
from pathlib import Path

import numpy as np
from runs import Run, simulate

import carom

Law = type[carom.LinearElastic] | type[carom.SaintVenantKirchhoff] | type[carom.NeoHookean]

YOUNG, POISSON, DENSITY = 2700.0, 0.33, 1.5


def clamped(law: Law, stress: float) -> Run:
    """Clamp a block that presses with `stress` [Pa] under one twice as high, between two plates."""
    bodies = []
    for name, at, height, across in (("lower", 0.0, 1.0, 4), ("upper", 1.0, 2.0, 5)):
        mesh = carom.Rectangle(corner=(0.0, at), size=(1.0, height), divisions=(across, 4))
        pressed = carom.InitialStress(yy=-stress) if name == "lower" else None
        bodies.append(carom.Body(name=name, material="m", mesh=mesh, initial_stress=pressed))
    scenario = carom.Scenario(
        analysis=carom.Static(end_time=1.0, time_step=1.0),
        materials={"m": law(young=YOUNG, poisson=POISSON, density=DENSITY)},
        bodies=bodies,
        motions=[carom.Fixed(body=body.name, on="left", components=("x",)) for body in bodies],
        obstacles=[
            carom.Plane(name="floor", point=(0.0, 0.0), normal=(0.0, 1.0)),
            carom.Plane(name="ceiling", point=(0.0, 3.0), normal=(0.0, -1.0)),
        ],
    )
    return simulate(scenario)


def shared_pressure(stress: float) -> float:
    """Return the pressure [Pa] of the clamped blocks: p = σ₀ − E′ε₁ = −E′ε₂ with ε₁ + 2 ε₂ = 0."""
    return stress / 3.0


def measured_pressure(run: Run) -> float:
    """Return the mean over the floor, the blocks and the ceiling, which are 1 m² each [Pa]."""
    return float(run.history["normal_force"][-1]) / 3.0


HEIGHT, TENSION, AMPLITUDE = 0.02, 300.0, 1e-4
"""Of a strip [m], its tension [Pa], and how far it swings [m]."""


def swinging_strip(stress: float, divisions: int, directory: Path) -> Run:
    """Let go of an endless strip under tension in the shape of a sine of wavelength 1 m."""
    mesh = carom.Rectangle(
        corner=(0.0, 0.0), size=(1.0, HEIGHT), divisions=(32 * divisions, divisions), periodic=True
    )
    # The two sides are one.
    count = 32 * divisions
    x = np.tile(np.arange(count + 1) % count / count, divisions + 1)
    u = np.stack([np.zeros_like(x), AMPLITUDE * np.sin(2.0 * pi * x)], axis=1)
    np.save(directory / "sine.npy", u)
    scenario = carom.Scenario(
        analysis=carom.Dynamic(end_time=5.0 * period(stress), time_step=period(stress) / 200.0),
        materials={"m": carom.SaintVenantKirchhoff(young=YOUNG, poisson=POISSON, density=DENSITY)},
        bodies=[
            carom.Body(
                name="strip",
                material="m",
                mesh=mesh,
                initial_stress=carom.InitialStress(xx=stress),
            )
        ],
        initial=carom.Initial(
            displacements=[
                carom.InitialDisplacement(body="strip", file=str(directory / "sine.npy"))
            ]
        ),
        output=carom.Output(track=[carom.Track(name="crest", body="strip", point=(0.25, 0.0))]),
    )
    return simulate(scenario)


def period(stress: float) -> float:
    """Return the period [s] of a wave 1 m long: ω² = k² (σ + E′ k² h²/12)/ρ.

    E′ = E/(1 − ν²). It leaves out rotary inertia and shear, of the order (kh)² = 0.016 of the
    second term.
    """
    k = 2.0 * pi
    bending = YOUNG / (1.0 - POISSON**2) * (k * HEIGHT) ** 2 / 12.0
    return 2.0 * pi / (k * sqrt((stress + bending) / DENSITY))


def measured_period(run: Run) -> float:
    """Return the time [s] between zeros of the crest's displacement, from the first to the last."""
    t, y = run.history["time"], run.history["crest.u_y"]
    before = np.flatnonzero(y[:-1] * y[1:] < 0.0)
    zeros = t[before] - y[before] * (t[before + 1] - t[before]) / (y[before + 1] - y[before])
    return 2.0 * float(zeros[-1] - zeros[0]) / (len(zeros) - 1)


if __name__ == "__main__":
    for law in (carom.LinearElastic, carom.SaintVenantKirchhoff, carom.NeoHookean):
        for stress in (0.27, 90.0):
            run = clamped(law, stress)
            print(law, stress, measured_pressure(run) / shared_pressure(stress) - 1.0)
            print("   defect", run.history["defect"][-1], run.history["strain"][-1])
    with tempfile.TemporaryDirectory() as directory:
        for stress, divisions in ((0.0, 4), (0.0, 8), (TENSION, 2), (TENSION, 4), (TENSION, 8)):
            run = swinging_strip(stress, divisions, Path(directory))
            print(stress, divisions, period(stress), measured_period(run) / period(stress) - 1.0)
            print(np.abs(run.history["defect"]).max() / run.summary["energy"]["initial"])
