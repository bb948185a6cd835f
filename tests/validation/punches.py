"""Rigid punches on large elastic blocks, flat and with rounded corners.

With E* = E/(1 − ν²), half-width a and a force P per length,

    flat:       p(x) = P/(π √(a² − x²))
    rounded:    P = E* a²/(2R) [π/2 − φ − sin φ cos φ],    sin φ = b/a
                p(0) = E* a/(πR) [π/2 − φ − sin φ arcosh(1/sin φ)]
    revolved:   F = 2 a E* d of a flat punch pressed in by d

where the rounded punch is flat over |x| < b and parabolic with radius R beyond. The first and the
last are equations 2.64 and 3.36 of Johnson, Contact Mechanics (1985); those of the rounded punch
are by Ciavarella, Hills & Monno, Proc. Instn Mech. Engrs C 212 (1998) 319–328.

The corner of a flat punch is in the middle of a cell, or on a node.
"""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from math import acosh, cos, pi, sin
from pathlib import Path

import grids
import numpy as np
from compared import Compared
from runs import Array
from scipy.optimize import brentq

import carom

YOUNG, POISSON = 1e6, 0.3
STIFFNESS = YOUNG / (1.0 - POISSON**2)
HALF_WIDTH = 1.0  # m
DEPTH = 1e-3  # m, by which a flat punch goes in
STEPS = 2


@dataclass(frozen=True)
class Pressed:
    """A half of a block, or a section of one of revolution, that a punch is pressed into.

    Parameters
    ----------
    x
        Places of the nodes of the top [m].
    force
        Forces on them [N], upwards the punch's.
    iterations
        Newton iterations of each load step.
    """

    x: Array
    force: Array
    iterations: float

    @property
    def total(self) -> float:
        """Force on the whole top [N]."""
        return float(self.force.sum())


def press(
    obstacle: carom.RigidBox | carom.RigidPolygon,
    across: Array,
    size: float,
    first: float,
    hypothesis: str = "plane-strain",
    *,
    growth: float,
) -> Pressed:
    """Press a punch into a block of `size` [m] with cells at the top that are `first` [m] thick."""
    down = grids.away_from(first, growth, size)
    x, y = np.meshgrid(across, -down[::-1])
    with tempfile.TemporaryDirectory() as folder:
        mesh = carom.MeshFile(file=str(grids.write(Path(folder) / "block.inp", x, y)))
        scenario = carom.Scenario(
            analysis=carom.Static(end_time=1.0, time_step=1.0 / STEPS),
            materials={"elastic": carom.LinearElastic(young=YOUNG, poisson=POISSON, density=1.0)},
            bodies=[carom.Body(name="block", material="elastic", hypothesis=hypothesis, mesh=mesh)],
            motions=[
                carom.Fixed(body="block", on="left", components=("x",)),
                carom.Fixed(body="block", on="bottom"),
            ],
            obstacles=[obstacle],
        )
        simulation = carom.Simulation(scenario)
        iterations = []
        while not simulation.has_ended:
            iterations.append(simulation.step().iterations)
        force = np.asarray(simulation.bodies["block"].reaction)[-len(across) :, 1]
    return Pressed(across, -force, float(np.mean(iterations)))


def towards_the_corner(first: float, reach: float, growth: float, *, on_node: bool) -> Array:
    """Return places along a top [m] with the corner of the punch in the middle of the smallest.

    Or `on_node`, between two of these.
    """
    half = 0.0 if on_node else 0.5 * first
    inside = HALF_WIDTH - half - grids.away_from(first, growth, HALF_WIDTH - half)[::-1]
    outside = HALF_WIDTH + half + grids.away_from(first, growth, reach - HALF_WIDTH - half)
    return np.append(inside, outside[1:] if on_node else outside)


def flat_box() -> carom.RigidBox:
    """Return the flat punch, which goes down by DEPTH in 1 s."""
    return carom.RigidBox(
        name="punch",
        corner=(-HALF_WIDTH, 0.0),
        size=(2.0 * HALF_WIDTH, 1.0),
        motion={"y": f"-{DEPTH}*t"},
    )


FLAT = 1.0  # m, half of the flat part of a rounded punch
RADIUS = 500.0  # m, of its rounded parts


def rounded_polygon(depth: float, sides: int, reach: float = 2.0) -> carom.RigidPolygon:
    """Return a punch with parabolas of RADIUS beyond FLAT that goes down by `depth` [m] in 1 s."""
    x = np.linspace(FLAT, reach, sides + 1)
    right = np.stack([x, (x - FLAT) ** 2 / (2.0 * RADIUS)], axis=-1)
    left = right[::-1] * [-1.0, 1.0]
    top = [[reach, 1.0], [-reach, 1.0]]
    points = np.vstack([left, right, top])
    return carom.RigidPolygon(name="punch", points=points.tolist(), motion={"y": f"-{depth}*t"})


def rounded_angle(force: float) -> float:
    """Return φ of a rounded punch under a force per length [N/m]."""

    def excess(phi: float) -> float:
        half_width = FLAT / sin(phi)
        needed = STIFFNESS * half_width**2 / (2.0 * RADIUS)
        return needed * (0.5 * pi - phi - sin(phi) * cos(phi)) - force

    return float(brentq(excess, 0.05, 0.5 * pi))


def _even(cell: float, even: float, reach: float, growth: float) -> Array:
    """Return places along a top [m]: equal cells out to `even` and growing ones beyond."""
    inside = np.linspace(0.0, even, round(even / cell) + 1)
    return np.append(inside, even + grids.away_from(cell, growth, reach - even)[1:])


def _pressure_at_centre(pressed: Pressed) -> float:
    """Return the pressure [Pa] at x = 0, where a node has half a cell."""
    return float(pressed.force[0] / (0.5 * pressed.x[1]))


def flat_of_revolution(
    cell: float, growth: float, size: float = 80.0, *, on_node: bool = False
) -> Compared:
    """Press a flat punch of revolution into cylinders of two sizes, its corner `on_node` or not.

    The force is too large by a part that goes with a over the size: twice the larger cylinder's
    less the smaller one's is that of a half space.
    """
    across = {s: towards_the_corner(cell, s, growth, on_node=on_node) for s in (0.5 * size, size)}
    runs = [press(flat_box(), x, s, cell, "axisymmetric", growth=growth) for s, x in across.items()]
    return Compared(
        f"flat punch of revolution, cells of {cell} a, force [N]",
        2.0 * runs[1].total - runs[0].total,
        2.0 * HALF_WIDTH * STIFFNESS * DEPTH,
        "Johnson, eq. 3.36",
        runs[1].iterations,
    )


def flat_in_the_plane(cell: float, growth: float, size: float = 80.0) -> Compared:
    """Press a flat punch into a block in plane strain."""
    across = towards_the_corner(cell, size, growth, on_node=False)
    pressed = press(flat_box(), across, size, cell, growth=growth)
    return Compared(
        f"flat punch, cells of {cell} a, p(0) [Pa]",
        _pressure_at_centre(pressed),
        2.0 * pressed.total / (pi * HALF_WIDTH),
        "Johnson, eq. 2.64",
        pressed.iterations,
    )


def rounded_in_the_plane(cell: float, growth: float = 1.15, size: float = 80.0) -> Compared:
    """Press a flat punch with rounded corners into a block in plane strain, to a = 1.5 b."""
    punch = rounded_polygon(0.002, 50)
    pressed = press(punch, _even(cell, 1.5 * FLAT, size, growth), size, cell, growth=growth)
    phi = rounded_angle(2.0 * pressed.total)
    half_width = FLAT / sin(phi)
    shape = 0.5 * pi - phi - sin(phi) * acosh(1.0 / sin(phi))
    return Compared(
        f"rounded punch, cells of {cell} b, p(0) [Pa]",
        _pressure_at_centre(pressed),
        STIFFNESS * half_width / (pi * RADIUS) * shape,
        "Ciavarella, Hills & Monno 1998",
        pressed.iterations,
    )
