"""A sphere is pressed on a rigid plane: Hertz's contact, as a body of revolution and in space.

Steel, R = 10 mm, E = 210 GPa, ν = 0.3; the equator is lowered by 4 µm. With E* = E/(1 − ν²) and the
force P that it takes Hertz found, for a contact that is small against the sphere (Johnson, *Contact
Mechanics*, § 4.2),

    a³ = 3PR/4E*,    p₀ = 3P/2πa²,    δ = a²/R.

The equator stays plane and free to widen, as that of a sphere between two plates. Radius and peak
of the pressure are those of the ellipsoid through the nodal pressures: p² is linear in r².
"""

from __future__ import annotations

import math
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import carom

sys.path.insert(0, str(Path(__file__).parent))
from graded_sphere import GradedSphere, ellipsoid

RADIUS, YOUNG, POISSON = 0.01, 210e9, 0.3
COMPOSITE = YOUNG / (1 - POISSON**2)
DEPTH = 4e-6
CONTACT = math.sqrt(RADIUS * DEPTH)


@dataclass(frozen=True)
class Pressed:
    """What was measured: force [N], radius of the contact [m] and peak pressure [Pa]."""

    force: float
    radius: float
    peak: float

    def errors(self) -> tuple[float, float, float]:
        """Relative errors of a, p₀ and δ against Hertz's under the same force."""
        radius = (0.75 * self.force * RADIUS / COMPOSITE) ** (1 / 3)
        peak = 1.5 * self.force / (math.pi * radius**2)
        return self.radius / radius - 1, self.peak / peak - 1, DEPTH / (radius**2 / RADIUS) - 1


def scenario(file: Path, dimension: int) -> carom.Scenario:
    """Describe the press with the mesh in `file`."""
    up = "y" if dimension == 2 else "z"
    down = {up: f"{-DEPTH!r}*t"}
    symmetry = [] if dimension == 2 else ["x", "y"]
    return carom.Scenario(
        title="Hertz's sphere",
        dimension=dimension,
        analysis=carom.Static(end_time=1.0, time_step=0.25),
        materials={"steel": carom.LinearElastic(young=YOUNG, poisson=POISSON, density=7800.0)},
        bodies=[
            carom.Body(
                name="sphere",
                material="steel",
                hypothesis="axisymmetric" if dimension == 2 else "plane-strain",
                mesh=carom.MeshFile(file=str(file)),
            )
        ],
        motions=[
            carom.Prescribed(body="sphere", on="equator", **down),
            *(carom.Fixed(body="sphere", on=axis, components=[axis]) for axis in symmetry),
        ],
        obstacles=[
            carom.Plane(
                name="plane", point=[0.0] * dimension, normal=[0.0] * (dimension - 1) + [1.0]
            )
        ],
    )


def press(dimension: int, divisions: int) -> Pressed:
    """Press a sphere with as many cells along a side of the fine block, 1.5 a wide."""
    sphere = GradedSphere.make(
        RADIUS, patch=1.5 * CONTACT, divisions=divisions, dimension=dimension, half=True, growth=1.5
    )
    with tempfile.TemporaryDirectory() as folder:
        case = scenario(sphere.write(Path(folder) / "sphere.inp"), dimension)
        simulation = carom.Simulation(case)
        simulation.advance(1.0)
    forces = simulation.bodies["sphere"].reaction
    # A quarter of the sphere carries a quarter of the force.
    force = float(forces[:, -1].sum()) * (1 if dimension == 2 else 4)
    return Pressed(force, *ellipsoid(*sphere.pressures(forces)))


def main(
    out: str | Path | None = None, *, plane: tuple[int, ...] = (6, 12, 24), space: int = 6
) -> None:
    """Print radius, peak pressure and depth on a row of meshes; check those of the finest."""
    del out
    print("sphere            cells over a      P [N]    a error   p0 error    δ error")
    for dimension, divisions in [*((2, n) for n in plane), (3, space)]:
        found = press(dimension, divisions)
        kind = "of revolution" if dimension == 2 else "in space"
        errors = found.errors()
        print(
            f"{kind:16} {divisions / 1.5:13.1f} {found.force:10.3f} "
            + " ".join(f"{error:+10.2%}" for error in errors)
        )
        assert max(map(abs, errors)) < (0.02 if dimension == 3 or divisions >= 12 else 0.1)


if __name__ == "__main__":
    main()
