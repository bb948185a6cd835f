"""A steel sphere strikes a rigid plane at 1 m/s: as a body of revolution and in space.

R = 10 mm, ρ = 7800 kg/m³, E = 210 GPa, ν = 0.3. Hertz's quasi-static theory of impact (Johnson,
*Contact Mechanics*, § 11.4): with the stiffness K = 4/3 √R E/(1 − ν²) and the mass m,

    depth  (5mv²/4K)^(2/5) = 17.75 µm
    force  K depth^(3/2) = 2300.9 N
    time   2.9432 depth/v = 52.24 µs.

The depth is the approach of the centre of mass. The theory takes the sphere for a half space: its
centre is where a half space would still have moved by 0.5 P/ER, so that a sphere is stiffer by the
order of a/R, the radius of the contact over its own, here 4 %. The errors converge to that.
"""

from __future__ import annotations

import math
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import carom

sys.path.insert(0, str(Path(__file__).parent))
from graded_sphere import GradedSphere

RADIUS, DENSITY, YOUNG, POISSON, SPEED = 0.01, 7800.0, 210e9, 0.3, 1.0
MASS = DENSITY * 4 / 3 * math.pi * RADIUS**3
STIFFNESS = 4 / 3 * math.sqrt(RADIUS) * YOUNG / (1 - POISSON**2)
DEPTH = (5 * MASS * SPEED**2 / (4 * STIFFNESS)) ** 0.4
FORCE = STIFFNESS * DEPTH**1.5
TIME = 2.9432 * DEPTH / SPEED
PATCH = 1.4 * math.sqrt(RADIUS * DEPTH)


@dataclass(frozen=True)
class Impact:
    """What was measured: time [s], peak force [N], depth [m], share of the energy that is left."""

    time: float
    force: float
    depth: float
    energy: float

    def errors(self) -> tuple[float, float, float]:
        """Relative errors of time, force and depth."""
        return self.time / TIME - 1, self.force / FORCE - 1, self.depth / DEPTH - 1


def scenario(file: Path, dimension: int, time_step: float) -> carom.Scenario:
    """Describe the impact with the mesh in `file`."""
    symmetry = [] if dimension == 2 else ["x", "y"]
    return carom.Scenario(
        title="Steel sphere",
        dimension=dimension,
        analysis=carom.Dynamic(end_time=1.2 * TIME, time_step=time_step),
        output=carom.Output(history_every=time_step, fields_every=TIME, merge_contacts=1e-6),
        materials={"steel": carom.LinearElastic(young=YOUNG, poisson=POISSON, density=DENSITY)},
        bodies=[
            carom.Body(
                name="sphere",
                material="steel",
                hypothesis="axisymmetric" if dimension == 2 else "plane-strain",
                mesh=carom.MeshFile(file=str(file)),
                velocity=[0.0] * (dimension - 1) + [-SPEED],
            )
        ],
        motions=[carom.Fixed(body="sphere", on=axis, components=[axis]) for axis in symmetry],
        obstacles=[
            carom.Plane(
                name="plane", point=[0.0] * dimension, normal=[0.0] * (dimension - 1) + [1.0]
            )
        ],
    )


def strike(dimension: int, divisions: int, *, growth: float = 1.5, steps: int = 200) -> Impact:
    """Let a sphere with as many cells along a side of the fine block strike."""
    sphere = GradedSphere.make(
        RADIUS, patch=PATCH, divisions=divisions, dimension=dimension, growth=growth
    )
    time_step = TIME / steps
    with tempfile.TemporaryDirectory() as folder:
        case = scenario(sphere.write(Path(folder) / "sphere.inp"), dimension, time_step)
        result = carom.run(case, out=Path(folder) / "results")
        history, summary = result.history, result.summary
    part = 1 if dimension == 2 else 4  # a quarter of the sphere
    touching = np.flatnonzero(history["normal_force"] > 0.0)
    height = history["sphere.y" if dimension == 2 else "sphere.z"]
    return Impact(
        time=float(history["time"][touching[-1]] - history["time"][touching[0]] + time_step),
        force=part * float(history["normal_force"].max()),
        depth=float(height[0] - height.min()),
        energy=summary["energy"]["final"] / summary["energy"]["initial"],
    )


def main(
    out: str | Path | None = None, *, plane: tuple[int, ...] = (6, 12), space: int = 6
) -> None:
    """Print time, force and depth on a row of meshes; check those of the finest."""
    del out
    print("sphere            cells over a  time [µs]  force [N] depth [µm]   errors")
    print(f"Hertz                          {TIME * 1e6:9.2f} {FORCE:10.1f} {DEPTH * 1e6:10.2f}")
    for dimension, divisions in [*((2, n) for n in plane), (3, space)]:
        found = strike(dimension, divisions)
        kind = "of revolution" if dimension == 2 else "in space"
        errors = found.errors()
        print(
            f"{kind:16} {divisions / 1.4:13.1f} {found.time * 1e6:10.2f} {found.force:10.1f} "
            f"{found.depth * 1e6:10.2f}  " + " ".join(f"{error:+7.2%}" for error in errors)
        )
        assert abs(found.energy - 1.0) < 1e-6
        assert max(map(abs, errors)) < (0.02 if divisions >= 12 else 0.03)


if __name__ == "__main__":
    main()
