"""A steel sphere is thrown obliquely at a floor of steel: by Maw, Barber & Fawcett, and by carom.

The theory (Wear 38 (1976) 101): normal contact is Hertz's, and so are pressures p. Tangential
tractions q of the circle of contact, |q| ≤ μ p, move the surfaces by what the same pressures would,
over κ = 2(1 − ν)/(2 − ν). With displacements in units of μ/κ and tractions in units of μ nothing is
left but χ = (1 − ν)(1 + 1/k)/(2 − ν), k = 2/5 for a sphere, and the angle of incidence
ψ₁ = κ v_t/(μ v_n):

    s″ = −2χ ∫ q dA / m,  |q| ≤ p,  q = p sign(slip) where it slips,  ψ₂ = s′/v_n at the end.

It is solved here on rings of uniform traction, whose displacements are complete elliptic integrals
(Johnson, Contact Mechanics, eq. 3.29). Where all slips throughout, for ψ₁ ≥ 4χ − 1, ψ₂ = ψ₁ − 4χ.
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
from scipy.special import ellipe, ellipk

import carom

sys.path.insert(0, str(EXAMPLES))
from graded_sphere import GradedSphere, Lattice

RADIUS, DENSITY, YOUNG, POISSON = 0.01, 7800.0, 210e9, 0.3
FRICTION, SPEED = 0.1, 0.05
MASS = DENSITY * 4 / 3 * math.pi * RADIUS**3
STIFFNESS = 4 / 3 * math.sqrt(RADIUS) * YOUNG / (2 * (1 - POISSON**2))
KAPPA = 2 * (1 - POISSON) / (2 - POISSON)
CHI = 3.5 * KAPPA / 2


def compliance(edges: Array) -> Array:
    """Displacements amid rings by uniform tractions of 1 on each; both modules are 1."""
    centres = 0.5 * (edges[1:] + edges[:-1])
    r, b = centres[:, None], edges[None, 1:]
    inner, outer = np.minimum(r / b, 1.0) ** 2, np.minimum(b / r, 1.0) ** 2
    within = 4.0 / math.pi * b * ellipe(inner)
    beyond = 4.0 / math.pi * r * (ellipe(outer) - (1.0 - outer) * ellipk(np.minimum(outer, 0.999)))
    discs = np.where(r < b, within, beyond)
    return np.diff(discs, axis=1, prepend=0.0)


class Rings:
    """Tractions on the circle of contact.

    Parameters
    ----------
    size
        Largest radius of the contact.
    count
        Rings.
    """

    def __init__(self, size: float, count: int) -> None:
        edges = np.linspace(0.0, size, count + 1)
        self.centres = 0.5 * (edges[1:] + edges[:-1])
        self.areas = math.pi * np.diff(edges**2)
        self.compliance = compliance(edges)
        self.traction = np.zeros(count)

    def move(self, by: float, pressure: Array) -> float:
        """Return the force after the sphere has moved `by`, with these pressures."""
        before, known = self.traction, pressure > 0.0
        sticks = known & (np.abs(before) < pressure)
        way = np.where(before != 0.0, np.sign(before), math.copysign(1.0, by))
        if not sticks.any():
            sticks = known.copy()
        for _ in range(200):
            q = np.where(known & ~sticks, way * pressure, 0.0)
            if sticks.any():
                rest = by - self.compliance[sticks] @ (q - before)
                part = self.compliance[np.ix_(sticks, sticks)]
                q[sticks] = np.linalg.solve(part, rest)
            slip = by - self.compliance @ (q - before)
            beyond = sticks & (np.abs(q) > pressure * (1 + 1e-12))
            back = known & ~sticks & (slip * way < 0.0)
            if not beyond.any() and not back.any():
                break
            way = np.where(beyond, np.sign(q), way)
            sticks = (sticks & ~beyond) | back
        else:
            raise RuntimeError("no state of sticking and slipping was found")
        self.traction = q
        return float(self.areas @ q)


def rebound(incidence: float, *, chi: float = CHI, rings: int = 100, steps: int = 400) -> float:
    """Return ψ₂ of ψ₁, with as many rings and steps in the time of contact.

    Units are those in which radius, mass, speed and the modulus of both bodies together are 1.
    """
    deepest = (15.0 / 16.0) ** 0.4
    step = 2.9432 * deepest / steps
    contact = Rings(math.sqrt(deepest), rings)
    depth, sinks, moved, moves = 0.0, 1.0, 0.0, incidence
    force, friction = 0.0, 0.0
    while True:
        # Leapfrog, velocities half a step ahead.
        half_sinks, half_moves = sinks - 0.5 * step * force, moves - chi * step * friction
        depth, by = depth + step * half_sinks, step * half_moves
        if depth <= 0.0:
            return half_moves
        moved += by
        radius = math.sqrt(depth)
        inside = np.maximum(1.0 - (contact.centres / radius) ** 2, 0.0)
        pressure = 2.0 * radius / math.pi * np.sqrt(inside)
        force, friction = 4.0 / 3.0 * depth**1.5, contact.move(by, pressure)
        sinks, moves = half_sinks - 0.5 * step * force, half_moves - chi * step * friction


def duration() -> tuple[float, float]:
    """Return time [s] and radius [m] of Hertz's contact."""
    depth = (5 * MASS * SPEED**2 / (4 * STIFFNESS)) ** 0.4
    return 2.9432 * depth / SPEED, math.sqrt(RADIUS * depth)


FLOOR = 0.05
"""Radius of the half ball that is the floor [m]."""


def floor(patch: float, divisions: int) -> GradedSphere:
    """Return the quarter of a half ball below z = 0, as fine where it is touched as the sphere."""
    points, cells = Lattice(divisions, 3, 1.5).half(patch / FLOOR)
    points = points * [1.0, 1.0, -1.0]
    points[np.abs(points) < 1e-14] = 0.0
    edges = points[cells[:, [1, 3, 4]]] - points[cells[:, [0]]]
    wrong = np.linalg.det(edges) < 0
    cells[wrong] = cells[wrong][:, [0, 3, 2, 1, 4, 7, 6, 5]]
    return GradedSphere(FLOOR * points, cells, FLOOR)


def half_body(file: Path, half: GradedSphere) -> Path:
    """Write half a body with its plane of symmetry, ``y``, and the outermost nodes, ``rim``."""
    far = np.linalg.norm(half.points, axis=1) > (1 - 1e-9) * half.radius
    sets = {"y": np.flatnonzero(half.points[:, 1] == 0.0), "rim": np.flatnonzero(far)}
    return written(file, half.points, half.cells, kind="C3D8", name="all_cells", sets=sets)


@dataclass(frozen=True)
class Throw:
    """What came of an impact.

    Parameters
    ----------
    rebound
        ψ₂.
    restitution
        Of the normal velocity.
    defect
        Largest defect of the ledger, relative to the energy at the start.
    """

    rebound: float
    restitution: float
    defect: float


def throw(incidence: float, *, divisions: int, steps: int) -> Throw:
    """Throw the sphere at the angle ψ₁, with as many cells along 1.4 radii of the contact."""
    time, radius = duration()
    patch = 1.4 * radius
    sphere = GradedSphere.make(RADIUS, patch=patch, divisions=divisions, dimension=3, growth=1.5)
    slides = incidence * FRICTION * SPEED / KAPPA
    with tempfile.TemporaryDirectory() as folder:
        files = {
            name: half_body(Path(folder) / f"{name}.inp", quarter.mirrored())
            for name, quarter in (("sphere", sphere), ("floor", floor(patch, divisions)))
        }
        case = carom.Scenario(
            title="Sphere thrown at a floor",
            dimension=3,
            analysis=carom.Dynamic(
                end_time=1.1 * time,
                time_step=time / steps,
                scheme=carom.Conserving(),
                newton=carom.Newton(tolerance=1e-11),
            ),
            output=carom.Output(history_every=time / steps, fields_every=2 * time),
            materials={"steel": carom.LinearElastic(young=YOUNG, poisson=POISSON, density=DENSITY)},
            bodies=[
                carom.Body(
                    name=name,
                    material="steel",
                    mesh=carom.MeshFile(file=str(file)),
                    velocity=[slides, 0.0, -SPEED] if name == "sphere" else None,
                )
                for name, file in files.items()
            ],
            motions=[
                carom.Fixed(body="sphere", on="y", components=["y"]),
                carom.Fixed(body="floor", on="y", components=["y"]),
                carom.Fixed(body="floor", on="rim", components=["x", "z"]),
            ],
            # Forces are large beside the energy of so slow a sphere.
            contact=carom.Contact(
                condition="midpoint", friction=FRICTION, certificate_tolerance=1e-7
            ),
        )
        result = carom.run(case, out=Path(folder) / "results")
        history, energy = result.history, result.summary["energy"]
    assert history["normal_force"][-1] == 0.0, "the sphere is still there"
    slides = history["sphere.v_x"][-1] - RADIUS * history["sphere.spin_y"][-1]
    return Throw(
        rebound=float(KAPPA * slides / (FRICTION * SPEED)),
        restitution=float(history["sphere.v_z"][-1] / SPEED),
        defect=float(np.abs(history["defect"]).max() / energy["initial"]),
    )
