"""Two cylinders are pressed together and pushed sideways: Hertz, Cattaneo and Mindlin.

Half cylinders of radius 8 m and length 1 m, E = 200 Pa and ν = 0.3, in plane strain, with a force
of 10 N between their flat sides, which are moved until it is there. Hertz's half-width a and
pressure p₀ are

    a² = 8 P R* (1 − ν²)/(π E),    p₀ = 2P/(π a),    1/R* = 1/R + 1/R

and under a tangential force Q < μP the contact sticks over a half-width c = a √(1 − Q/μP).

Half-widths are read from nodal forces, finer than the mesh: in Hertz's solution p² is linear in x²,
and so is (μp − q)² where the contact sticks, with q the tangential traction. The zero of a straight
line through the values inside is a², or c². What is found settles 0.4 % from Hertz's values, and
0.8 % from Mindlin's: theirs are for half planes, of which these are cylinders by a/R = 0.085.
"""

from __future__ import annotations

import itertools
import math
import sys
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import carom

RADIUS, YOUNG, POISSON = 8.0, 200.0, 0.3
FORCE, TANGENTIAL, FRICTION = 10.0, 0.93616, 0.2

HALF_WIDTH = math.sqrt(8 * FORCE * RADIUS / 2 * (1 - POISSON**2) / (math.pi * YOUNG))
PEAK = 2 * FORCE / (math.pi * HALF_WIDTH)
STICK = HALF_WIDTH * math.sqrt(1 - TANGENTIAL / (FRICTION * FORCE))

CORE = 0.45  # half the width of the core of the mesh, in radii
INSIDE = 0.9  # values out to this fraction of the half-width are fitted

Array = NDArray[np.float64]


@dataclass(frozen=True)
class HalfCylinder:
    """A half cylinder whose arc is on the side of +y or −y of its flat side.

    A core of 2n × m cells within rings along rays, graded towards the top of the arc.

    Parameters
    ----------
    points
        Nodes [m], shape [node_count, 2].
    cells
        Quadrilaterals, counter-clockwise, shape [cell_count, 4].
    flat
        Nodes of the flat side.
    """

    points: Array
    cells: NDArray[np.int64]
    flat: NDArray[np.int64]

    @classmethod
    def graded(cls, columns: int, *, upper: bool) -> HalfCylinder:
        """Mesh with 2 × `columns` cells under the eighths of the arc next to its top."""
        n, m = columns, max(columns // 2, 4)
        grading = 4.0
        tau = np.linspace(-1, 1, 2 * n + 1)
        top = math.pi / 4 * np.sinh(grading * tau) / math.sinh(grading)
        side = np.linspace(math.pi / 2, math.pi / 4, m + 1)
        # The core: x by the rays to its top, y by those to its sides.
        x = CORE * RADIUS * np.tan(top)
        y = CORE * RADIUS / np.tan(side)
        core = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)  # row by row, from the flat side
        number = np.arange(len(core)).reshape(m + 1, 2 * n + 1)
        # The rays, clockwise from −x, and the nodes of the core that they start from.
        angles = np.concatenate([-side[:-1], top, side[::-1][1:]])
        starts = np.concatenate([number[:-1, 0], number[-1], number[::-1, -1][1:]])
        # Rings: the one at the arc is as thick as the cells there are wide.
        width = RADIUS * (top[n + 1] - top[n])
        depth = np.array([0.0])
        layer, room = width, RADIUS * (1 - CORE)
        while depth[-1] < room:
            depth = np.append(depth, depth[-1] + layer)
            layer *= 1.2
        levels = 1 - depth[::-1] / depth[-1]  # from the core, 0, to the arc, 1
        arc = RADIUS * np.stack([np.sin(angles), np.cos(angles)], axis=-1)
        rings = [core[starts] + (arc - core[starts]) * s for s in levels[1:]]
        points = np.concatenate([core, *rings])
        ring = [starts] + [
            len(core) + k * len(starts) + np.arange(len(starts)) for k in range(len(rings))
        ]
        quads = [_quads(number)] + [_quads(np.stack([a, b])) for a, b in itertools.pairwise(ring)]
        flat = np.flatnonzero(np.abs(points[:, 1]) < 1e-9 * RADIUS)
        cells = np.concatenate(quads)
        if upper:
            points = np.stack([points[:, 0], RADIUS - points[:, 1]], axis=-1)
            cells = cells[:, ::-1]
        else:
            points = points - [0.0, RADIUS]
        return cls(points, cells, flat)

    def write(self, file: Path) -> None:
        """Write an Abaqus input file with the set of nodes ``flat``."""
        lines = ["*NODE"]
        lines += [f"{n}, {x!r}, {y!r}" for n, (x, y) in enumerate(self.points.tolist(), 1)]
        lines += ["*ELEMENT, TYPE=CPE4, ELSET=body"]
        lines += [
            f"{e}, {', '.join(map(str, c))}" for e, c in enumerate((self.cells + 1).tolist(), 1)
        ]
        lines += ["*NSET, NSET=flat", *(str(n + 1) for n in self.flat)]
        file.write_text("\n".join(lines) + "\n", encoding="utf-8")


def _quads(grid: NDArray[np.int64]) -> NDArray[np.int64]:
    """Join neighbours in a grid of nodes whose rows go clockwise, or along x, and then outward."""
    a, b, c, d = grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]
    return np.stack([a, b, c, d], axis=-1).reshape(-1, 4)


@dataclass(frozen=True)
class Profile:
    """Tractions on the arc of the upper half cylinder.

    Parameters
    ----------
    x
        Reference positions along x [m], shape [node_count].
    pressure
        Nodal forces along y per width along x [Pa], shape [node_count].
    traction
        Those along x [Pa], shape [node_count].
    force
        The sums of the forces along y and x [N].
    """

    x: Array
    pressure: Array
    traction: Array
    force: tuple[float, float]

    @property
    def half_width(self) -> tuple[float, float]:
        """Half-width of the contact [m] and the peak of the pressure [Pa]."""
        return _ellipse(self.x, self.pressure)

    @property
    def stick_half_width(self) -> float:
        """Half-width of the part that sticks [m]."""
        return _ellipse(self.x, FRICTION * self.pressure - np.abs(self.traction))[0]


def _ellipse(x: Array, value: Array) -> tuple[float, float]:
    """Half-width and height of the half ellipse through the values that are large."""
    inside = value > math.sqrt(1 - INSIDE**2) * value.max()
    slope, square = np.polyfit(x[inside] ** 2, value[inside] ** 2, 1)
    return math.sqrt(-square / slope), math.sqrt(square)


def scenario(
    files: dict[str, Path], *, discretisation: str, approach: float, shift: float
) -> carom.Scenario:
    """Describe a press until t = 1 s, by an `approach` of the flat sides, and a push until 2 s."""
    bodies = [
        carom.Body(name=name, material="elastic", mesh=carom.MeshFile(file=str(file)))
        for name, file in files.items()
    ]
    press = {"time": [0.0, 1.0], "value": [0.0, -approach]}
    push = {"time": [0.0, 1.0, 2.0], "value": [0.0, 0.0, shift]}
    return carom.Scenario(
        title=f"Two cylinders, {discretisation}",
        analysis=carom.Static(end_time=2.0, time_step=0.1),
        materials={"elastic": carom.LinearElastic(young=YOUNG, poisson=POISSON, density=1.0)},
        bodies=bodies,
        motions=[
            carom.Fixed(body="lower", on="flat"),
            carom.Prescribed(body="upper", on="flat", x=push, y=press),
        ],
        contact=carom.Contact(
            condition="gap", friction=FRICTION, sources="second", discretisation=discretisation
        ),
    )


class Press:
    """Two half cylinders whose meshes do not match."""

    def __init__(self, columns: int, *, discretisation: str) -> None:
        self._discretisation = discretisation
        self._upper = HalfCylinder.graded(columns, upper=True)
        self._lower = HalfCylinder.graded(columns * 6 // 5, upper=False)

    def profile(self, approach: float, shift: float | None = None) -> Profile:
        """Tractions after an approach of the flat sides [m], or after the shift that follows it."""
        with tempfile.TemporaryDirectory() as folder:
            files = {name: Path(folder) / f"{name}.inp" for name in ("lower", "upper")}
            self._lower.write(files["lower"])
            self._upper.write(files["upper"])
            case = scenario(
                files,
                discretisation=self._discretisation,
                approach=approach,
                shift=shift or 0.0,
            )
            simulation = carom.Simulation(case)
            simulation.advance(1.0 if shift is None else 2.0)
            return _profile(self._upper, simulation.bodies["upper"].reaction)

    def solve(self) -> tuple[Profile, Profile]:
        """Tractions under the normal force, and under the tangential one too."""
        approach, pressed = _secant(self.profile, lambda p: p.force[0], FORCE, 0.2)
        _, pushed = _secant(
            lambda shift: self.profile(approach, shift), lambda p: abs(p.force[1]), TANGENTIAL, 0.02
        )
        return pressed, pushed


def _secant(
    respond: Callable[[float], Profile],
    force: Callable[[Profile], float],
    wanted: float,
    guess: float,
) -> tuple[float, Profile]:
    """Find the displacement that makes a force; none makes none."""
    displacement, last, last_force = guess, 0.0, 0.0
    for _ in range(8):
        profile = respond(displacement)
        found = force(profile)
        if abs(found - wanted) < 1e-5 * wanted:
            return displacement, profile
        slope = (found - last_force) / (displacement - last)
        last, last_force = displacement, found
        displacement += (wanted - found) / slope
    raise RuntimeError(f"no displacement makes {wanted} N")


def _profile(upper: HalfCylinder, forces: Array) -> Profile:
    arm = upper.points - [0.0, RADIUS]
    arc = np.flatnonzero(np.abs(np.hypot(*arm.T) - RADIUS) < 1e-9 * RADIUS)
    arc = arc[np.argsort(upper.points[arc, 0])]
    # By symmetry the contact is on the horizontal plane between the bodies.
    x, force = upper.points[arc, 0], forces[arc]
    width = np.diff(x)
    width = 0.5 * (np.append(width, 0.0) + np.append(0.0, width))
    total = force.sum(axis=0)
    return Profile(x, force[:, 1] / width, force[:, 0] / width, (total[1], total[0]))


def main(out: str | Path | None = None, *, meshes: tuple[int, ...] = (20, 40, 80)) -> None:
    """Print the half-widths and the peak pressure on a row of meshes; check them on a fine one."""
    del out  # nothing is written
    print("columns  discretisation      a [m]    error   p0 [Pa]    error     c [m]    error")
    for columns in meshes:
        for discretisation in ("mortar", "node-to-segment"):
            pressed, pushed = Press(columns, discretisation=discretisation).solve()
            (width, peak), stick = pressed.half_width, pushed.stick_half_width
            errors = [width / HALF_WIDTH - 1, peak / PEAK - 1, stick / STICK - 1]
            print(
                f"{columns:7}  {discretisation:15} {width:9.5f} {errors[0]:+8.2%} {peak:9.5f}"
                f" {errors[1]:+8.2%} {stick:9.5f} {errors[2]:+8.2%}"
            )
            if columns >= 40 and discretisation == "mortar":
                assert max(map(abs, errors)) < 0.01


if __name__ == "__main__":
    main(meshes=tuple(map(int, sys.argv[1:])) or (20, 40, 80))
