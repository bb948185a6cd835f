"""A steel sphere strikes a thin plate: what the waves in the plate take, by Zener and by carom.

Zener (Phys. Rev. 59 (1941) 669): while the sphere touches a plate so large that no wave comes back,
the plate yields under a force F at the speed A F, A = 1/(8 √(D ρ h)) with D = E h³/12(1 − ν²), like
a dashpot, and the two approach by Hertz's law F = K s^(3/2). In units in which the rest is 1,

    s″ + (1 + λ d/dτ) s^(3/2) = 0,  s(0) = 0,  s′(0) = 1,  λ = A K^(2/5) m^(3/5) v^(1/5),

and the sphere leaves when s is 0 again, with e = −s′.
"""

from __future__ import annotations

import math
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from abaqus_file import written
from runs import EXAMPLES, Array
from scipy.integrate import solve_ivp

import carom

sys.path.insert(0, str(EXAMPLES))
from graded_sphere import GradedSphere

RADIUS, DENSITY, YOUNG, POISSON = 0.01, 7800.0, 210e9, 0.3
MASS = DENSITY * 4 / 3 * math.pi * RADIUS**3
STIFFNESS = 4 / 3 * math.sqrt(RADIUS) * YOUNG / (2 * (1 - POISSON**2))
"""K of two bodies of steel [N/m^(3/2)]."""

WAVES = math.sqrt(YOUNG * (1 - POISSON) / (DENSITY * (1 + POISSON) * (1 - 2 * POISSON)))
"""Speed of the fastest waves [m/s]."""


def restitution(inelasticity: float) -> float:
    """Return Zener's e(λ)."""

    def rate(_: float, state: Array) -> list[float]:
        approach, speed = state
        depth = max(approach, 0.0)
        return [speed, -(depth**1.5) - 1.5 * inelasticity * math.sqrt(depth) * speed]

    def leaves(_: float, state: Array) -> float:
        return float(state[0])

    leaves.terminal, leaves.direction = True, -1.0  # type: ignore[attr-defined]
    # It never leaves where λ is large, and creeps: what it has left then is nothing.
    path = solve_ivp(rate, (0.0, 1e3), [0.0, 1.0], events=leaves, rtol=1e-10, atol=1e-12)
    return float(-path.y[1, -1])


def thickness(inelasticity: float, speed: float) -> float:
    """Return the thickness of the plate that has this λ [m]."""
    yielding = inelasticity / (STIFFNESS**0.4 * MASS**0.6 * speed**0.2)
    impedance = math.sqrt(YOUNG * DENSITY / (12 * (1 - POISSON**2)))
    return 1.0 / math.sqrt(8.0 * yielding * impedance)


def hertz(speed: float) -> tuple[float, float]:
    """Return the time of contact [s] and its radius [m] on a plate that does not yield."""
    depth = (5 * MASS * speed**2 / (4 * STIFFNESS)) ** 0.4
    return 2.9432 * depth / speed, math.sqrt(RADIUS * depth)


def graded(fine: float, until: float, coarse: float, size: float, *, growth: float = 1.2) -> Array:
    """Return places of nodes from 0 to `size` [m]: cells of `fine` to `until`, then wider ones."""
    places = list(np.linspace(0.0, until, round(until / fine) + 1))
    step = fine
    while places[-1] < size:
        step = min(growth * step, coarse)
        places.append(places[-1] + step)
    stretched = np.array(places)
    far = stretched > until
    stretched[far] = until + (stretched[far] - until) * (size - until) / (places[-1] - until)
    return stretched


def plate(file: Path, *, cell: float, patch: float, height: float, radius: float) -> Path:
    """Write the half section of a round plate under the origin as an Abaqus input file."""
    r = graded(cell, patch, height / 6, radius)
    z = -graded(cell, patch, height / 8, height)[::-1]
    points = np.stack(np.meshgrid(r, z), axis=-1).reshape(-1, 2)
    number = np.arange(len(points)).reshape(len(z), len(r))
    corners = number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]
    cells = np.stack(corners, axis=-1).reshape(-1, 4)
    return written(file, points, cells, kind="CAX4", name="plate", sets={"x": number[:, 0]})


@dataclass(frozen=True)
class Rebound:
    """What came of an impact.

    Parameters
    ----------
    restitution
        Speed of the sphere after over that before.
    defect
        Largest defect of the ledger, relative to the energy at the start.
    closes
        By how much the energy that the sphere lost is off that of the plate and its own vibration,
        relative to the energy at the start.
    """

    restitution: float
    defect: float
    closes: float


def strike(
    inelasticity: float, *, speed: float, divisions: int, steps: int, condition: str = "midpoint"
) -> Rebound:
    """Let the sphere strike the plate that has this λ.

    Parameters
    ----------
    inelasticity
        Zener's λ.
    speed
        Of the sphere [m/s].
    divisions
        Cells along 1.4 times the radius of the contact, of both bodies.
    steps
        Steps in the time of Hertz's contact.
    """
    height = thickness(inelasticity, speed)
    duration, contact = hertz(speed)
    end = (1.35 + inelasticity) * duration
    patch = 1.4 * contact
    # What sets out from the middle is back after `end` at the earliest.
    size = 0.5 * WAVES * end
    sphere = GradedSphere.make(RADIUS, patch=patch, divisions=divisions, dimension=2, growth=1.5)
    steel = carom.LinearElastic(young=YOUNG, poisson=POISSON, density=DENSITY)
    with tempfile.TemporaryDirectory() as folder:
        files = {
            "sphere": sphere.write(Path(folder) / "sphere.inp"),
            "plate": plate(
                Path(folder) / "plate.inp",
                cell=patch / divisions,
                patch=patch,
                height=height,
                radius=size,
            ),
        }
        case = carom.Scenario(
            title="Sphere on a plate",
            analysis=carom.Dynamic(
                end_time=end, time_step=duration / steps, scheme=carom.Conserving()
            ),
            output=carom.Output(history_every=duration / steps, fields_every=end),
            materials={"steel": steel},
            bodies=[
                carom.Body(
                    name=name,
                    material="steel",
                    hypothesis="axisymmetric",
                    mesh=carom.MeshFile(file=str(file)),
                    velocity=[0.0, -speed if name == "sphere" else 0.0],
                )
                for name, file in files.items()
            ],
            motions=[carom.Fixed(body=name, on="x", components=["x"]) for name in files],
            contact=carom.Contact(condition=condition),
        )
        result = carom.run(case, out=Path(folder) / "results")
        history, energy = result.history, result.summary["energy"]
    assert history["normal_force"][-1] == 0.0, "the sphere is still there"
    initial = energy["initial"]
    parts = ("translation", "rotation", "vibration", "strain")
    recorded = sum(history[f"{name}.{part}"][-1] for name in files for part in parts)
    return Rebound(
        restitution=float(history["sphere.v_y"][-1] / speed),
        defect=float(np.abs(history["defect"]).max() / initial),
        closes=float(abs(recorded / initial - 1.0)),
    )
