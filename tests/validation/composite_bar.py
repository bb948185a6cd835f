"""A bar of two materials that hits a wall: the case, and its exact solution by d'Alembert."""

from __future__ import annotations

import math

from runs import Array, Run, simulate

import carom

SPEED = 1.0  # m/s, towards the wall
CROSSING = 1e-3  # s, of a wave through each half
IMPEDANCES = (1e6, 3e6)  # Pa s/m, ρ c
LENGTHS = (1.0, 1.5)  # m
DENSITIES = (1e3, 2e3)  # kg/m³


def exact_impulse(time: float) -> float:
    """Return the impulse of the wall per area [Pa s] up to a time after the first touch.

    In each half v = a + b and σ = Z (b − a), with a wave a that runs away from the wall and one, b,
    that runs to it; both are constant over times of `CROSSING`, which waves need through either
    half. At the interface v and σ are one: the wave that a makes there comes back with
    (Z₁ − Z₂)/(Z₁ + Z₂) and goes on with 2 Z₁/(Z₁ + Z₂). At the wall v = 0 while it presses, at the
    free end σ = 0.
    """
    first, second = IMPEDANCES
    away, back = [-SPEED / 2, -SPEED / 2], [-SPEED / 2, -SPEED / 2]
    impulse, touches = 0.0, True
    for number in range(math.ceil(time / CROSSING - 1e-9)):
        pressure = -2.0 * first * back[0]
        touches = touches and pressure > 0.0
        if touches:
            impulse += pressure * min(CROSSING, time - number * CROSSING)
        from_wall = -back[0] if touches else back[0]
        reflected = ((first - second) * away[0] + 2 * second * back[1]) / (first + second)
        passed = (2 * first * away[0] + (second - first) * back[1]) / (first + second)
        away, back = [from_wall, passed], [reflected, away[1]]
    return impulse


def scenario(dimension: int, cells: int, *overrides: str) -> carom.Scenario:
    """Return the case with so many cells along each half."""
    across = [0.1] * (dimension - 1)
    length = sum(LENGTHS)
    # Cells are equal, and the interface is between two of them.
    divisions = [round(cells * length / LENGTHS[0]), *[1] * (dimension - 1)]
    normal = [1.0, *[0.0] * (dimension - 1)]
    origin = [0.0] * dimension
    moduli = [z**2 / rho for z, rho in zip(IMPEDANCES, DENSITIES, strict=True)]
    step = 0.5 * LENGTHS[0] / cells / 1e3
    return carom.Scenario.from_dict(
        {
            "title": "Composite bar",
            "dimension": dimension,
            "analysis": {
                "end_time": 8 * CROSSING,
                "time_step": step,
                "scheme": {"kind": "conserving"},
            },
            "output": {"history_every": step, "fields_every": 1e-3},
            "materials": {
                name: {"kind": "linear-elastic", "young": young, "poisson": 0.0, "density": density}
                for name, young, density in zip(("near", "far"), moduli, DENSITIES, strict=True)
            },
            "bodies": [
                {
                    "name": "bar",
                    "material": "near",
                    "regions": [
                        {
                            "material": "far",
                            "corner": [LENGTHS[0], *[0.0] * (dimension - 1)],
                            "size": [LENGTHS[1], *across],
                        }
                    ],
                    "mesh": {
                        "kind": "rectangle" if dimension == 2 else "box",
                        "corner": origin,
                        "size": [length, *across],
                        "divisions": divisions,
                    },
                    "contact_sets": ["left"],
                    "velocity": [-SPEED, *[0.0] * (dimension - 1)],
                }
            ],
            "obstacles": [{"kind": "plane", "name": "wall", "point": origin, "normal": normal}],
            "contact": {"condition": "massless"},
        }
    ).with_overrides(overrides)


def impulses(run: Run, dimension: int) -> tuple[Array, Array]:
    """Return times [s] and the impulse of the wall per area up to then [Pa s]."""
    history = run.history
    momentum = history["momentum_x"]
    return history["time"], (momentum - momentum[0]) / 0.1 ** (dimension - 1)


def run(dimension: int, cells: int, *overrides: str) -> Run:
    """Run the case to its end."""
    return simulate(scenario(dimension, cells, *overrides))
