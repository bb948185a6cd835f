"""Painlevé's rod: a slender rod whose lower tip slides on a floor rougher than 4/3.

With its tip sliding at an angle θ to the floor, A = 1 + 3 cos θ (cos θ − μ sin θ) < 0: pressing on
the floor, friction turns the tip into it, and no finite force goes with sliding on (Painlevé 1895).
Steps of finite length let the tip jam, and the rod jumps.
"""

from __future__ import annotations

import math

import carom

LENGTH, WIDTH, MASS, SPEED = 1.0, 0.02, 1.0, 3.0
ANGLE = math.radians(60.0)
ROUGH = 2.5
"""μ: with 60° A is −1.5."""

LAWS = {
    "coefficient": ROUGH,
    "static and kinetic": carom.StaticKinetic(static=1.2 * ROUGH, kinetic=ROUGH),
    "over a speed": carom.StaticKinetic(static=1.2 * ROUGH, kinetic=ROUGH, speed=0.5),
    "over a distance": carom.StaticKinetic(static=1.2 * ROUGH, kinetic=ROUGH, distance=0.05),
    "viscous": carom.StaticKinetic(kinetic=ROUGH, viscous=0.1),
    "rate and state": carom.RateAndState(
        reference=ROUGH, direct=0.02, evolution=0.03, speed=0.1, distance=1e-2
    ),
    "formula": carom.FrictionFormula(formula="2.5 - 0.5*exp(-v/0.2) + 0.1*min(s/0.1, 1)"),
    "pressure": carom.FrictionFormula(formula="2 + 0.5/(1 + p/1e4)"),
}


def factor() -> float:
    """A of the rod as it starts: below 0 there is no sliding on."""
    cosine, sine = math.cos(ANGLE), math.sin(ANGLE)
    return 1.0 + 3.0 * cosine * (cosine - ROUGH * sine)


def written(file, dimension):
    """Write the rod with its lower tip at the origin, one cell, leaning against its way."""
    along = math.cos(ANGLE), math.sin(ANGLE)
    across = -along[1], along[0]
    corners = [(0.0, 0.0), (LENGTH, 0.0), (LENGTH, WIDTH), (0.0, WIDTH)]
    points = [(a * along[0] + b * across[0], a * along[1] + b * across[1]) for a, b in corners]
    lowest = min(y for _, y in points)
    points = [(x, y - lowest) for x, y in points]
    kind, rows = "CPE4", [points]
    if dimension == 3:
        kind = "C3D8"
        rows = [[(x, depth, y) for x, y in points] for depth in (0.25, -0.25)]
    nodes = [point for row in rows for point in row]
    lines = ["*NODE", *(f"{n}, {', '.join(map(repr, x))}" for n, x in enumerate(nodes, 1))]
    lines += [f"*ELEMENT, TYPE={kind}, ELSET=rod"]
    lines += ["1, " + ", ".join(str(n) for n in range(1, len(nodes) + 1))]
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return file


def rod(file, friction, *, condition="midpoint", dimension=2):
    """Describe the rod, which slides the way in which it jams."""
    up = dimension - 1
    contact = carom.Contact(condition=condition, friction=friction)
    if isinstance(friction, carom.OrthotropicFriction):
        pair = carom.Pair(between=["rod", "floor"], friction=friction)
        contact = carom.Contact(condition=condition, pairs=[pair])
    gravity = [0.0] * up + [-10.0]
    return carom.Scenario(
        dimension=dimension,
        analysis=carom.Dynamic(
            end_time=0.5,
            time_step=1e-3,
            scheme=carom.Conserving(),
            newton=carom.Newton(tolerance=1e-12),
            gravity=gravity,
        ),
        output=carom.Output(history_every=1e-3, fields_every=0.5),
        bodies=[
            carom.RigidBody(
                name="rod",
                mass=MASS,
                mesh=carom.MeshFile(file=str(written(file, dimension))),
                velocity=[-SPEED] + [0.0] * up,
            )
        ],
        obstacles=[carom.Plane(name="floor", point=[0.0] * dimension, normal=[0.0] * up + [1.0])],
        contact=contact,
    )
