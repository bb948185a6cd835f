"""A sphere pressed on a rough rigid plane is moved to and fro along it: Mindlin's loop.

The contact sticks in the middle and slips around it, and every cycle of the tangential force
between ±Q takes, with the normal force P and the radius a of the contact,

    ΔW = 9μ²P²/10a · (2 − ν)/G · {1 − (1 − q)^(5/3) − 5q/6 · [1 + (1 − q)^(2/3)]},   q = Q/μP

(Mindlin & Deresiewicz 1953; Johnson, *Contact Mechanics*, § 7.4, with one elastic body). The theory
neglects that pressure alone moves the surface sideways, which vanishes at ν = ½: here ν = 0.49,
with mean dilatation so that the hexahedra do not lock. It also takes the slip for parallel to Q.

The error falls with the square of the number of cells across the ring that slips, whose inner
radius is a (1 − q)^(1/3); three are needed for 3 %.
"""

from __future__ import annotations

import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import carom

sys.path.insert(0, str(Path(__file__).parent))
from graded_sphere import GradedSphere

RADIUS, YOUNG, POISSON, FRICTION = 1.0, 1e6, 0.49, 0.3
COMPOSITE = YOUNG / (1 - POISSON**2)
SHEAR = YOUNG / (2 * (1 + POISSON))
CONTACT = 0.02 * RADIUS
DEPTH = CONTACT**2 / RADIUS
FORCE = 4 * COMPOSITE * CONTACT**3 / (3 * RADIUS)
# Of the tangential force, in terms of μP, if the equator moved as the theory says.
AMPLITUDES = (0.76, 0.85, 0.97)


def shift(amplitude: float) -> float:
    """How far the equator is moved to and fro [m]."""
    whole = 3 * FRICTION * FORCE / (16 * CONTACT) * (2 - POISSON) / SHEAR
    return float(whole * (1 - (1 - amplitude) ** (2 / 3)))


@dataclass(frozen=True)
class Loop:
    """What was measured: normal and tangential force [N], and what friction took in a cycle [J]."""

    normal: float
    tangential: float
    dissipated: float

    def theory(self) -> float:
        """Return Mindlin and Deresiewicz's dissipation under the same forces [J]."""
        radius = float((0.75 * self.normal * RADIUS / COMPOSITE) ** (1 / 3))
        limit = FRICTION * self.normal
        q = self.tangential / limit
        shape = float(1 - (1 - q) ** (5 / 3) - 5 * q / 6 * (1 + (1 - q) ** (2 / 3)))
        return 0.9 * limit**2 / radius * (2 - POISSON) / SHEAR * shape


def scenario(file: Path, steps: int, amplitude: float) -> carom.Scenario:
    """Describe press, first push and one cycle, with as many steps from turn to turn."""
    far = shift(amplitude)
    path = {"time": [1.0, 1.5, 2.5, 3.5], "value": [0.0, far, -far, far]}
    return carom.Scenario(
        title="Mindlin's loop",
        dimension=3,
        analysis=carom.Static(end_time=3.5, time_step=1 / steps),
        output=carom.Output(history_every=1 / steps, fields_every=1.0),
        materials={"elastic": carom.NeoHookean(young=YOUNG, poisson=POISSON, density=1.0)},
        bodies=[
            carom.Body(
                name="sphere",
                material="elastic",
                formulation="mean-dilatation",
                mesh=carom.MeshFile(file=str(file)),
            )
        ],
        motions=[
            carom.Prescribed(
                body="sphere",
                on="equator",
                x=path,
                y=0.0,
                z={"time": [0.0, 1.0], "value": [0.0, -DEPTH]},
            ),
            carom.Fixed(body="sphere", on="y", components=["y"]),
        ],
        obstacles=[carom.Plane(name="plane", point=[0.0, 0.0, 0.0], normal=[0.0, 0.0, 1.0])],
        contact=carom.Contact(friction=FRICTION),
    )


def cycle(divisions: int, amplitude: float, *, steps: int = 12, growth: float = 2.5) -> Loop:
    """Run a cycle on half a sphere with as many cells across the fine block, 1.15 a wide."""
    sphere = GradedSphere.make(
        RADIUS,
        patch=1.15 * CONTACT,
        divisions=divisions,
        dimension=3,
        half=True,
        growth=growth,
    ).mirrored()
    with tempfile.TemporaryDirectory() as folder:
        case = scenario(sphere.write(Path(folder) / "sphere.inp"), steps, amplitude)
        history = carom.run(case, out=Path(folder) / "results").history
    start = int(abs(history["time"] - 1.5).argmin())
    # One half of the sphere, y ≥ 0.
    return Loop(
        normal=2 * float(history["normal_force"][start:].mean()),
        tangential=2 * float(abs(history["sphere.equator.force_x"]).max()),
        dissipated=2 * float(history["friction"][-1] - history["friction"][start]),
    )


def main(
    out: str | Path | None = None,
    *,
    meshes: tuple[int, ...] = (4, 6, 8, 10),
    amplitudes: tuple[float, ...] = AMPLITUDES,
    steps: int = 12,
) -> None:
    """Print what cycles take on a row of meshes; check by the cells across the slipping ring."""
    del out
    print("cells over a      P [N]     Q/μP     ΔW [J]   theory [J]    error")
    for amplitude in amplitudes:
        for divisions in meshes:
            loop = cycle(divisions, amplitude, steps=steps)
            error, limit = loop.dissipated / loop.theory() - 1, FRICTION * loop.normal
            print(
                f"{divisions / 1.15:12.1f} {loop.normal:10.4f} "
                f"{loop.tangential / limit:8.4f} {loop.dissipated:10.4e} "
                f"{loop.theory():12.4e} {error:+8.2%}"
            )
            slipping = divisions / 1.15 * (1 - (1 - loop.tangential / limit) ** (1 / 3))
            assert abs(error) < 0.3 / slipping**2


if __name__ == "__main__":
    main()
