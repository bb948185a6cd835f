"""A body as the auditor sees it: forces, energies and momenta of its states."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property

import numpy as np

from carom.auditing.arrays import (
    Array,
    Indices,
    Mask,
    einsum,
    inertia,
    turned,
    turning_axes,
)
from carom.auditing.bodies.ball import Ball
from carom.auditing.bodies.growing import Growth
from carom.auditing.bodies.mass import AddedMass, Mass
from carom.auditing.bodies.moving import MovingBody
from carom.auditing.bodies.places import Attached, Place, place_on
from carom.auditing.bodies.vibrations import MOST_UNKNOWNS, Vibrations
from carom.auditing.materials.composition import Composition
from carom.auditing.materials.dilatation import MeanDilatation, Response
from carom.auditing.mesh.cells import Cells
from carom.auditing.mesh.drawn import Drawn, drawn, nodes_of, unknown
from carom.auditing.mesh.facets import Facets
from carom.auditing.mesh.stiffness import reference_stiffness
from carom.case.body import AnyBody, Body, ReducedBody, RigidBody
from carom.case.foreign_body import ForeignEntry
from carom.case.material import Material
from carom.case.mesh import Rectangle
from carom.case.point_mass import PointMass

STEADYING = 0.1
"""Resistance of a node without mass to a change of its motion, in terms of what holds it."""

HEAVIEST = 0.25
"""The same at most, as the inertia of this part of the mass that the node had."""

ON_THE_AXIS = 1e-9
"""Nodes whose radius is below this part of the size of a body of revolution are on its axis."""

MUCH_SHORTER = 8.0
"""From so many parts of a nominal step on the resistance grows with their square."""

ITERATIONS = 500
"""Most iterations for the velocities that impulses give; mass matrices need some dozens."""


class AuditBody(MovingBody):
    """One body of a case. All arrays are in its own numbering of nodes.

    Parameters
    ----------
    entry
        What the case says of it.
    materials
        The materials of the case.
    types, nodes, points
        Its cells and reference positions, see `Cells`.
    first_node
        Number of its first node in the model.
    massless
        Whether the nodes that may touch others have no mass.
    masses
        Masses at points of it.
    """

    known = True
    """Whether anything says what its law and its mass are."""

    divides = False
    """Whether the force of steps that conserve is a quotient of energies of the body: `doubt`."""

    anchored = False
    """Whether its law may act on it as a whole, as what holds or loads it does."""

    def __init__(
        self,
        entry: AnyBody,
        materials: Mapping[str, Material],
        *,
        types: Indices,
        nodes: Indices,
        points: Array,
        first_node: int,
        massless: bool,
        masses: Sequence[PointMass] = (),
    ) -> None:
        self.name = entry.name
        self._entry = entry
        self.points = points
        self.span = slice(first_node, first_node + len(points))
        self.rigid = isinstance(entry, RigidBody)
        """Whether its nodes move as one."""
        self.modes = entry.modes if isinstance(entry, ReducedBody) else None
        """Modes of a reduced body beside the shapes of its contact surface."""
        self.drawn = self._drawn()
        """Its mesh as the case draws it."""
        self.revolution = entry.hypothesis == "axisymmetric"
        """Whether it is one of revolution around x = 0."""
        self.dimension = int(points.shape[1])
        self.thickness = entry.thickness if self.dimension == 2 else 1.0
        """Thickness [m]; 1 in space."""
        self.cells = Cells(types, nodes, points, self.thickness, revolution=self.revolution)
        self.law = Composition(entry, materials, self.cells.middles, self.drawn)
        """Its materials, cell by cell."""
        self.growth = Growth.of(entry, large=self.law.objective)
        """How it grows."""
        dilates = isinstance(entry, Body | ReducedBody) and entry.formulation != "standard"
        self.masters = _masters(entry, points)
        """For every node the one that it moves with, itself as a rule, [node_count]."""
        self.images: Indices = np.flatnonzero(self.masters != np.arange(len(points)))
        """Nodes that move with another: of a body that repeats itself."""
        self.turns = self.law.objective and not self.images.size and not self.revolution
        """Whether it can turn without storing energy."""
        self.on_axis = self._on_axis()
        """Nodes on the axis of a body of revolution, which stay there."""
        self.fixed = self._fixed()
        """Which components of nodes never move, whatever supports it, [node_count, D]."""
        self.response: Response = self.law
        """What stresses its deformation has."""
        if dilates:
            self.response = MeanDilatation(self.law, self.cells.weights)
        self.boundary: Indices = self.cells.outer_sides()
        """All facets of its boundary, the sides where it repeats itself too."""
        outer = self._outside()
        self.outline: Indices = outer
        """All facets of its boundary, whatever of it may touch others."""
        sets = entry.contact_sets
        self.facets = outer if sets is None else outer[self.named(outer, sets)]
        self.surface: Indices = np.unique(self.facets)
        self.sources = np.setdiff1d(self.surface, self.images)
        """Nodes that may touch others; an image would do so twice."""
        self.ball = Ball.of(entry, points, self.surface)
        """What it is to other round things and what has no corners, if it is round."""
        self.massless = self.surface if massless else np.zeros(0, dtype=np.int64)
        self._weigh(masses)
        self._stiffen(dilates=dilates)

    def _drawn(self) -> Drawn:
        """Return its mesh as the case draws it."""
        assert not isinstance(self._entry, ForeignEntry), "that draws itself"
        return drawn(self._entry, self.points.shape[1])

    def _on_axis(self) -> Indices:
        """Return the nodes on the axis of a body of revolution."""
        size = float(np.linalg.norm(np.ptp(self.points, axis=0)))
        return np.flatnonzero((self.points[:, 0] <= ON_THE_AXIS * size) & self.revolution)

    def _fixed(self) -> Mask:
        """Return which components of nodes never move, shape [node_count, D]."""
        fixed = np.zeros(self.points.shape, dtype=bool)
        fixed[self.on_axis, 0] = True
        return fixed

    def _weigh(self, masses: Sequence[PointMass]) -> None:
        """Find its mass, with masses at points of it."""
        entry = self._entry
        assert not isinstance(entry, ForeignEntry), "that weighs itself"
        self.mass = Mass(
            self.cells,
            self.points,
            _density(entry, self.law, self.cells, self.ball),
            lumped=entry.mass == "lumped",
            massless=self.massless,
            facets=Facets(self.dimension, self.facets, self.thickness),
            added=[one for given in masses for one in self._added(given)],
        )
        self.more = np.zeros((1, 1))
        given = None
        if isinstance(entry, RigidBody) and entry.inertia is not None:
            given = _tensor(entry.inertia)
        elif self.ball is not None and not self.revolution:
            given = self.ball.inertia(float(self.mass.nodal.sum()))
        if given is not None:
            self.more = given - inertia(self.arms(0.0 * self.points), self.mass.times)

    def _outside(self) -> Indices:
        """Return the facets of the boundary that are outside."""
        outer = self.boundary
        if self.images.size:
            outer = outer[~self.named(outer, ("left", "right"))]
        return outer[~np.isin(outer, self.on_axis).all(axis=1)]

    def _stiffen(self, *, dilates: bool) -> None:
        """Find what resists where nothing has moved."""
        lame, shear = self.law.first, self.law.second
        self._stiffness = reference_stiffness(self.cells, lame, shear, dilates=dilates)
        diagonal = einsum("caiai->ca", self._stiffness)
        self.holding = self._gathered(diagonal)[self.massless] / self.dimension
        """tr K_bb/D of each massless node in the reference configuration [N/m]."""
        rows: Array = np.abs(self._stiffness).sum(axis=(3, 4)).max(axis=2)
        self.row_stiffness = self._gathered(rows)
        """Largest force [N] on each node where every coordinate moves by 1 m, [node_count]."""

    def weigh_all_nodes(self) -> None:
        """Treat nodes without mass as all others, as where nothing has inertia."""
        self.massless, self.holding = self.massless[:0], self.holding[:0]

    @cached_property
    def vibrations(self) -> Vibrations:
        """The shapes in which a reduced body vibrates."""
        assert self.modes is not None, "it is reduced"
        count, arms = len(self.points), self.points - self.mass.mean(self.points)
        if arms.size > MOST_UNKNOWNS:
            return Vibrations.unknown(arms)
        units = np.eye(self.dimension * count).reshape(-1, count, self.dimension)
        return Vibrations.of(
            mass=np.array([self.mass.times(unit).ravel() for unit in units]),
            stiffness=np.array([self.linear_force(unit).ravel() for unit in units]),
            arms=arms,
            kept=self.surface,
            modes=self.modes,
        )

    @property
    def moves_as_a_whole(self) -> bool:
        """Whether its equations are those of its momenta, and of amplitudes if it is reduced."""
        return self.rigid or self.modes is not None

    @property
    def carries_waves(self) -> bool:
        """Whether its law says how fast waves run in it."""
        return not self.rigid

    @property
    def blends(self) -> bool:
        """Whether its stresses are blended where steps blend any."""
        return not self.moves_as_a_whole

    def initial_velocity(self) -> Array:
        """Return the velocities of its nodes at the start of a run [m/s], shape [node_count, D]."""
        spin, velocity = self._entry.spin, self._entry.velocity
        about = np.zeros(turning_axes(self.dimension)) if spin is None else np.atleast_1d(spin)
        wanted = turned(self.arms(0.0 * self.points), about)
        return wanted if velocity is None else wanted + np.array(velocity)

    @property
    def damping(self) -> float:
        """That of a reduced body in terms of its stiffness [s]."""
        return float(self.law.stiffness_damping.max())

    def linear_force(self, u: Array) -> Array:
        """Return K₀ u [N], with the stiffness where nothing has moved, shape [node_count, D]."""
        local = einsum("caibk,cbk->cai", self._stiffness, u[self.cells.nodes])
        return self.cells.assembled(local)

    def faces(self, nodes: Indices) -> Facets:
        """Return facets of its boundary by their nodes."""
        return Facets(self.dimension, nodes, self.thickness, self.revolution)

    @cached_property
    def facet_areas(self) -> Array:
        """Areas of the facets that may touch others [m²], shape [facet_count]."""
        return self.faces(self.facets).areas(self.points)

    def centre_of_force(self, point: tuple[float, ...] | None) -> Place:
        """Return where a force on a rigid body acts: at a point as drawn, or the centre of mass."""
        at = self.mass.mean(self.points) if point is None else np.array(point)
        return place_on(self._entry, self.points, at)

    def places(self, at: Attached) -> list[Place]:
        """Return the places that something is attached to: of a set every node of it."""
        if at.on is None:
            return [place_on(self._entry, self.points, np.array(at.point))]
        nodes = nodes_of(self.drawn, at.on, self.points, self.boundary, self.cells.nodes)
        return [Place(np.array([node]), np.ones(1), self.points[node]) for node in nodes]

    def named(self, facets: Indices, names: Iterable[str]) -> Mask:
        """Return which facets of a boundary are of one of these sets."""
        chosen = np.zeros(len(facets), dtype=bool)
        for name in names:
            if name == "all":
                return np.ones(len(facets), dtype=bool)
            own = self.drawn.facets(name, self.points, facets)
            if own is None:
                raise unknown(name)
            chosen |= own
        return chosen

    def _added(self, given: PointMass) -> list[AddedMass]:
        places = self.places(given)
        share = given.mass / len(places)
        return [AddedMass(share, place.nodes, place.shares) for place in places]

    def accelerated(self, impulse: Array, held: Mask) -> Array:
        """Return M⁻¹ p of impulses on nodes [N s] as velocities [m/s], by conjugate gradients.

        Images move as their masters do, and nodes without mass and what is held not at all.
        """
        moves = np.zeros(held.shape, dtype=bool)
        moves[self.masters] = True
        moves[self.massless] = False
        moves &= ~held
        scale = np.where(moves, self.folded(self.mass.sizes)[:, None], 1.0)
        rest = self.folded(impulse) * moves
        velocity, ready = np.zeros_like(rest), rest / scale
        along, power = ready, float((rest * ready).sum())
        least = np.finfo(np.float64).eps ** 2 * power
        for _ in range(ITERATIONS):
            if power <= least:
                break
            resisted = self.folded(self.mass.times(along[self.masters])) * moves
            step = power / float((along * resisted).sum())
            velocity, rest = velocity + step * along, rest - step * resisted
            ready = rest / scale
            before, power = power, float((rest * ready).sum())
            along = ready + power / before * along
        return velocity[self.masters]

    def folded(self, values: Array) -> Array:
        """Return numbers or vectors of nodes with those of images moved to their masters."""
        folded = np.zeros_like(values)
        np.add.at(folded, self.masters, values)
        return folded

    def strain_energy(self, u: Array, grown: float = 0.0) -> float:
        """Return the strain energy [J] of what has grown by this strain."""
        if self.modes is not None:
            local = self._axes(u).own[self.cells.nodes]
            return 0.5 * float(einsum("cai,caibk,cbk->", local, self._stiffness, local))
        return self._integral(self.response.energy, u, grown)

    def slope(self, u: Array, energy: float) -> float:
        """Return by how much the strain energy changes where all of u changes by 1 m [N]."""
        del u
        # E ≈ ½ k e², so that an error of e changes it by √(2 E k) δ.
        return float(np.sqrt(2.0 * max(energy, 0.0) * float(self.row_stiffness.sum())))

    def plastic_work(self, u: Array, grown: float) -> float:
        """Return the plastic work of a step to u [J]."""
        return self._integral(self.response.plastic_work, u, grown) if self.law.flows else 0.0

    def work_of_growth(self, u: tuple[Array, Array], grown: tuple[float, float]) -> float:
        """Return the work of growth in a step [J], the change of energy by it at fixed motion.

        By the first half of it where the step starts, and by the second where it ends.
        """
        if grown[0] == grown[1]:
            return 0.0
        middle = 0.5 * (grown[0] + grown[1])
        (before, half), (late, after) = (
            [self._integral(self.response.potential, place, strain) for strain in strains]
            for place, strains in zip(u, ((grown[0], middle), (middle, grown[1])), strict=True)
        )
        return half - before + after - late

    def plastic_strain(self, u: Array, grown: float) -> Array:
        """Return the equivalent plastic strain of cells after a step to u, shape [cell_count]."""
        if not self.law.flows:
            return np.zeros(len(self.cells.nodes))
        return self.cells.mean(self.response.plastic_strain(self._elastic(u, grown)))

    def advance(self, u: Array, grown: float) -> None:
        """Remember what a step to u leaves of what flows."""
        if self.law.flows:
            self.response.advance(self._elastic(u, grown))

    def viscous_force(self, u0: Array, u1: Array, dt: float) -> Array:
        """Return the force with which viscosity resists a step from u₀ to u₁ [N]."""
        if not self.law.viscous:
            return np.zeros_like(u0)
        f0, f1 = (self.cells.deformation_gradient(u) for u in (u0, u1))
        return self.cells.divergence(self.law.viscous_stress(f0, f1, dt))

    def internal_force(self, u: Array, grown: float = 0.0) -> Array:
        """Return ∂E/∂u [N], shape [node_count, D]."""
        stress = self.response.stress(self._elastic(u, grown))
        return self.cells.divergence(self.growth.factor(grown, 2) * stress)

    def conserving_force(self, u0: Array, u1: Array, grown: float = 0.0) -> Array:
        """Return the force [N] whose work from u₀ to u₁ is the change of the strain energy."""
        f0, f1 = (self._elastic(u, grown) for u in (u0, u1))
        stress = self.response.discrete_stress(f0, f1)
        return self.cells.divergence(self.growth.factor(grown, 2) * stress)

    def doubt(self, u0: Array, u1: Array, energy: float) -> Array:
        """Return how far that force may be off [N] by as much of an energy [J], [node_count]."""
        raise NotImplementedError("that of stresses is no quotient of energies")

    def difference_force(self, u0: Array, u1: Array) -> Array:
        """Return the force [N] of the difference of the stresses at u₁ and u₀.

        Only bodies without mass where they touch have it, and these do not grow.
        """
        f0, f1 = (self.cells.deformation_gradient(u) for u in (u0, u1))
        return self.cells.divergence(self.response.stress_difference(f0, f1))

    def _elastic(self, u: Array, grown: float) -> Array:
        """Return F_e at the points of cells, shape [cell_count, q, 3, 3]."""
        return self.growth.elastic(self.cells.deformation_gradient(u), grown)

    def _integral(self, density: Callable[[Array], Array], u: Array, grown: float) -> float:
        """Return the integral over the body as it has grown of a density of F_e [J]."""
        whole = float((self.cells.weights * density(self._elastic(u, grown))).sum())
        return self.growth.factor(grown, 3) * whole

    def damping_force(self, u: Array, v: Array) -> Array:
        """Return C v [N] with C = α M + β R K₀ Rᵀ and R the mean rotation at u."""
        force = self.law.mass_damping * self.mass.times(v)
        share = self.law.stiffness_damping
        if share.any():
            rotation = self.rotation(u)
            local = einsum("caibk,cbk->cai", self._stiffness, (v @ rotation)[self.cells.nodes])
            force += self.cells.assembled(share[:, None, None] * local) @ rotation.T
        return force

    def cell_states(self, u: Array, grown: float) -> tuple[Array, Array]:
        """Return mean Cauchy stress xx yy zz xy yz xz [Pa] and energy density [J/m³] of cells."""
        f = self._elastic(u if self.modes is None else self._axes(u).own, grown)
        stress = self.cells.mean(self.response.cauchy_stress(f))
        if self.modes is not None:
            rotation = np.eye(3)
            rotation[: self.dimension, : self.dimension] = self._axes(u).rotation
            stress = rotation @ stress @ rotation.T
        components = stress[:, [0, 1, 2, 0, 1, 0], [0, 1, 2, 1, 2, 2]]
        density = self.growth.factor(grown, 3) * self.cells.mean(self.response.energy(f))
        return components, density

    def _gathered(self, local: Array) -> Array:
        """Sum numbers of the nodes of cells, shape [cell_count, a], over the cells."""
        sums = np.bincount(self.cells.nodes.ravel(), local.ravel(), len(self.points))
        return sums.astype(np.float64)


def _tensor(given: float | tuple[float, ...] | tuple[tuple[float, ...], ...]) -> Array:
    """Return an inertia as a matrix, shape [1, 1] or [3, 3]; three numbers are its principal."""
    table = np.asarray(given, dtype=np.float64)
    if table.ndim == 1:
        return np.diag(table)
    return table.reshape(1, 1) if table.ndim == 0 else table


def _density(entry: AnyBody, law: Composition, cells: Cells, ball: Ball | None) -> Array:
    """Return the density of each cell [kg/m³].

    The mass of a rigid body may be given, and cells of one that is round have that of the ball.
    """
    if not isinstance(entry, RigidBody):
        return law.density
    volume = float(cells.shared_volumes.sum())
    if entry.density is not None:
        whole = volume if ball is None else ball.volume(entry)
        return np.full(len(cells.nodes), entry.density * (whole / volume))
    assert entry.mass is not None
    return np.full(len(cells.nodes), entry.mass / volume)


def _masters(entry: AnyBody, points: Array) -> Indices:
    """Return the node that each moves with: on the right side of what repeats itself another."""
    masters = np.arange(len(points))
    if not isinstance(entry.mesh, Rectangle) or not entry.mesh.periodic:
        return masters
    low, width = entry.mesh.corner[0], entry.mesh.size[0]
    left, right = (
        np.flatnonzero(np.abs(points[:, 0] - x) <= 1e-9 * width) for x in (low, low + width)
    )
    for node in right:
        masters[node] = left[np.abs(points[left, 1] - points[node, 1]).argmin()]
    return masters
