"""The problems, as data that every code reads."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from compare.meshes import Indices, Mesh, Points, bar, disc


@dataclass(frozen=True)
class Body:
    """An elastic body in plane strain, 1 m thick.

    Parameters
    ----------
    name
        Name.
    mesh
        Its cells.
    velocity
        Velocity at the start [m/s].
    """

    name: str
    mesh: Mesh
    velocity: tuple[float, float]


@dataclass(frozen=True)
class Problem:
    """Two bodies of one Saint-Venant–Kirchhoff material that hit each other.

    Parameters
    ----------
    name, title
        What the command line and the tables call it.
    bodies
        The bodies.
    box
        Rigid walls around them, (x₀, y₀, x₁, y₁) [m]; None is none.
    young, poisson, density
        Material [Pa], [-], [kg/m³].
    time_step
        Length of a step [s].
    steps
        How many.
    sample_every
        Steps between two looks at energy and momentum.
    earlier
        What other codes took that are not run: name and ms per step.
    """

    name: str
    title: str
    bodies: tuple[Body, Body]
    box: tuple[float, float, float, float] | None
    young: float
    poisson: float
    density: float
    time_step: float
    steps: int
    sample_every: int
    earlier: tuple[tuple[str, float], ...] = ()

    @property
    def end_time(self) -> float:
        """Time at the end of the last step [s]."""
        return self.steps * self.time_step

    @property
    def points(self) -> Points:
        """Coordinates of the nodes, body after body [m], shape [point_count, 2]."""
        return np.vstack([body.mesh.points for body in self.bodies])

    @property
    def cells(self) -> Indices:
        """Nodes of the cells, body after body."""
        first, second = (body.mesh for body in self.bodies)
        return np.vstack([first.cells, second.cells + len(first.points)])

    @property
    def of_body(self) -> tuple[slice, slice]:
        """The nodes of each body."""
        first, second = (len(body.mesh.points) for body in self.bodies)
        return slice(0, first), slice(first, first + second)

    @property
    def surfaces(self) -> tuple[Indices, Indices]:
        """The facets of each body that may touch, with the numbers of `points`."""
        first, second = (body.mesh for body in self.bodies)
        return first.surface, second.surface + len(first.points)

    @property
    def velocities(self) -> Points:
        """Velocities of the nodes at the start [m/s], shape [point_count, 2]."""
        return np.vstack([np.tile(b.velocity, (len(b.mesh.points), 1)) for b in self.bodies])

    def shortened(self, steps: int | None) -> Problem:
        """Return the first `steps` steps of the problem; None is all of them."""
        return self if steps is None else replace(self, steps=min(steps, self.steps))


BARS = Problem(
    name="bars",
    title="Two bars, head-on, touching at the start; exact: they part at 0.02 s",
    bodies=(
        Body("left", bar(-10.0, 10.0, 0.1, 100, touching="right"), (1.0, 0.0)),
        Body("right", bar(0.0, 10.0, 0.1, 100, touching="left"), (-1.0, 0.0)),
    ),
    box=None,
    young=1e3,
    poisson=0.0,
    density=1e-3,
    time_step=1e-5,
    steps=4000,
    sample_every=20,
    earlier=(("LMGC90 (linear, matrix assembled once)", 4.5),),
)

CYLINDERS = Problem(
    name="cylinders",
    title="Two cylinders in a box: one bounces off the floor and hits the other",
    bodies=(
        Body("left", disc((2.0, 1.2), 1.0, 10, 10), (1.0, -2.0)),
        Body("right", disc((3.9, 2.6), 1.0, 10, 10), (0.0, 0.0)),
    ),
    box=(0.0, 0.0, 10.0, 6.0),
    young=2700.0,
    poisson=0.33,
    density=1.0,
    time_step=1e-3,
    steps=600,
    sample_every=2,
    earlier=(("LMGC90", 74.0),),
)

PROBLEMS = {problem.name: problem for problem in (CYLINDERS, BARS)}
