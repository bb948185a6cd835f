"""A steel sphere strikes a rigid plane at 1 m/s: as a body of revolution and in space.

R = 10 mm, ρ = 7800 kg/m³, E = 210 GPa, ν = 0.3. Hertz's quasi-static theory of impact (Johnson,
*Contact Mechanics*, § 11.4): with the stiffness K = 4/3 √R E/(1 − ν²) and the mass m,

    depth  (5mv²/4K)^(2/5) = 17.75 µm
    force  K depth^(3/2) = 2300.9 N
    time   2.9432 depth/v = 52.24 µs.

The depth is the approach of the centre of mass. The theory takes the sphere for a half space, of
which the centre is where it would still move by some P/ER: a sphere is stiffer by the order of a/R,
the radius of the contact over its own, here 4 %. How much stiffer is measured by laying the sphere
on the plane under a weight P: its centre sinks by (P/K)^(2/3) − β P/ER, and with that the balance
of energy gives force, depth and time of an impact of a finite sphere, still quasi-static. The
impacts converge to that, and at lower speeds, so smaller a/R, to Hertz's.
"""

from __future__ import annotations

import math
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq

import carom

sys.path.insert(0, str(Path(__file__).parent))
from graded_sphere import GradedSphere

RADIUS, DENSITY, YOUNG, POISSON = 0.01, 7800.0, 210e9, 0.3
MASS = DENSITY * 4 / 3 * math.pi * RADIUS**3
STEPS = 400
"""Steps of time of Hertz's contact: its duration is known to one of them."""

STEP = 1 / STEPS
STIFFNESS = 4 / 3 * math.sqrt(RADIUS) * YOUNG / (1 - POISSON**2)


@dataclass(frozen=True)
class Impact:
    """Time [s], peak force [N] and depth [m] of an impact."""

    time: float
    force: float
    depth: float

    def errors(self, theory: Impact) -> tuple[float, float, float]:
        """Relative deviations of time, force and depth from a theory."""
        return (
            self.time / theory.time - 1,
            self.force / theory.force - 1,
            self.depth / theory.depth - 1,
        )


def quasi_static(speed: float = 1.0, stiffening: float = 0.0) -> Impact:
    """Return the impact of a sphere whose centre sinks by (P/K)^(2/3) − βP/ER under P.

    Without β it is Hertz's. The work up to a force P is 2/5 K^(−2/3) P^(5/3) − ½ βP²/ER.
    """
    softness, relief = STIFFNESS ** (-2 / 3), stiffening / (YOUNG * RADIUS)
    energy = 0.5 * MASS * speed**2

    def work(force: float) -> float:
        return float(0.4 * softness * force ** (5 / 3) - 0.5 * relief * force**2)

    hertz = STIFFNESS**0.4 * (2.5 * energy) ** 0.6
    peak = float(brentq(lambda force: work(force) - energy, 0.5 * hertz, 2.0 * hertz))

    # dt = dδ/v with P = (1 − x²) peak, so that nothing is infinite where the sphere turns back.
    def slowness(x: float) -> float:
        force = (1.0 - x * x) * peak
        slope = float(2 / 3 * softness * force ** (-1 / 3) - relief)
        return slope * 2.0 * x * peak / math.sqrt(2.0 * (energy - work(force)) / MASS)

    return Impact(
        time=2.0 * quad(slowness, 1e-8, 1.0 - 1e-12, limit=500)[0],
        force=peak,
        depth=softness * peak ** (2 / 3) - relief * peak,
    )


def patch(speed: float) -> float:
    """Size of the fine block [m], 1.4 times the radius of the contact."""
    return 1.4 * math.sqrt(RADIUS * quasi_static(speed).depth)


def scenario(
    file: Path, dimension: int, analysis: carom.Dynamic | carom.Static, speed: float = 0.0
) -> carom.Scenario:
    """Describe the sphere in `file` over the plane."""
    symmetry = [] if dimension == 2 else ["x", "y"]
    return carom.Scenario(
        title="Steel sphere",
        dimension=dimension,
        analysis=analysis,
        output=carom.Output(history_every=analysis.time_step, fields_every=analysis.end_time),
        materials={"steel": carom.LinearElastic(young=YOUNG, poisson=POISSON, density=DENSITY)},
        bodies=[
            carom.Body(
                name="sphere",
                material="steel",
                hypothesis="axisymmetric" if dimension == 2 else "plane-strain",
                mesh=carom.MeshFile(file=str(file)),
                velocity=[0.0] * (dimension - 1) + [-speed],
            )
        ],
        motions=[carom.Fixed(body="sphere", on=axis, components=[axis]) for axis in symmetry],
        obstacles=[
            carom.Plane(
                name="plane", point=[0.0] * dimension, normal=[0.0] * (dimension - 1) + [1.0]
            )
        ],
    )


def strike(dimension: int, divisions: int, *, speed: float = 1.0, steps: int = STEPS) -> Impact:
    """Let a sphere with as many cells along a side of the fine block strike."""
    sphere = GradedSphere.make(
        RADIUS, patch=patch(speed), divisions=divisions, dimension=dimension, growth=1.5
    )
    duration = quasi_static(speed).time
    analysis = carom.Dynamic(end_time=1.2 * duration, time_step=duration / steps)
    with tempfile.TemporaryDirectory() as folder:
        case = scenario(sphere.write(Path(folder) / "sphere.inp"), dimension, analysis, speed)
        result = carom.run(case, out=Path(folder) / "results")
        history, energy = result.history, result.summary["energy"]
    assert abs(energy["final"] / energy["initial"] - 1.0) < 1e-6
    part = 1 if dimension == 2 else 4  # a quarter of the sphere
    touching = np.flatnonzero(history["normal_force"] > 0.0)
    height = history["sphere.y" if dimension == 2 else "sphere.z"]
    return Impact(
        time=float(history["time"][touching[-1]] - history["time"][touching[0]])
        + analysis.time_step,
        force=part * float(history["normal_force"].max()),
        depth=float(height[0] - height.min()),
    )


def stiffening(divisions: int) -> float:
    """Measure β: lay the sphere on the plane under the peak force of the impact at 1 m/s."""
    sphere = GradedSphere.make(
        RADIUS, patch=patch(1.0), divisions=divisions, dimension=2, growth=1.5
    )
    gravity = [0.0, -quasi_static().force / MASS]
    analysis = carom.Static(end_time=1.0, time_step=0.5, gravity=gravity)
    with tempfile.TemporaryDirectory() as folder:
        case = scenario(sphere.write(Path(folder) / "sphere.inp"), 2, analysis)
        history = carom.run(case, out=Path(folder) / "results").history
    force = float(history["normal_force"][-1])
    sunk = float(history["sphere.y"][0] - history["sphere.y"][-1])
    return float(((force / STIFFNESS) ** (2 / 3) - sunk) * YOUNG * RADIUS / force)


def main(
    out: str | Path | None = None,
    *,
    plane: tuple[int, ...] = (6, 12, 24),
    space: tuple[int, ...] = (6, 9, 12),
    slow: tuple[float, ...] = (0.1, 0.01),
) -> None:
    """Print time, force and depth on two rows of meshes and at lower speeds; check them."""
    del out
    beta = stiffening(24)
    hertz, finite = quasi_static(), quasi_static(stiffening=beta)
    print("sphere          v [m/s] cells over a  time [µs]  force [N] depth [µm]   against Hertz")

    def show(kind: str, speed: float, cells: str, found: Impact) -> tuple[float, float, float]:
        errors = found.errors(quasi_static(speed))
        print(
            f"{kind:16} {speed:6g} {cells:>12} {found.time * 1e6:10.2f} {found.force:10.2f} "
            f"{found.depth * 1e6:10.3f}  " + " ".join(f"{error:+7.2%}" for error in errors)
        )
        return errors

    show("Hertz", 1.0, "", hertz)
    show(f"finite, β {beta:.3f}", 1.0, "", finite)
    for dimension, divisions in [*((2, n) for n in plane), *((3, n) for n in space)]:
        found = strike(dimension, divisions)
        kind = "of revolution" if dimension == 2 else "in space"
        errors = show(kind, 1.0, f"{divisions / 1.4:.1f}", found)
        if divisions >= 9:
            assert max(map(abs, errors)) < 0.02 + STEP
            assert max(map(abs, found.errors(finite))) < 0.005 + STEP
        else:
            assert max(map(abs, errors)) < 0.03
    for speed in slow:
        error = max(map(abs, show("of revolution", speed, "17.1", strike(2, 24, speed=speed))))
        assert error < 0.023 * speed**0.4 + STEP


if __name__ == "__main__":
    main()
