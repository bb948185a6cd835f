"""Bodies of other codes as the auditor sees them: their law is what their code answers."""

from __future__ import annotations

import numpy as np

from carom.auditing.arrays import Array, Indices, Mask, cross, inertia, solved, turned
from carom.auditing.bodies.body import AuditBody
from carom.auditing.bodies.code import Code, NoCode
from carom.auditing.bodies.given_mass import GivenMass
from carom.auditing.mesh.drawn import Drawn, given
from carom.case.foreign_body import ForeignEntry

RIGID = 1e-7
"""A motion that deforms a body by less than this part of itself has the force in its middle: all
else would be round-off."""

STILL = 1e-9
"""So has one that deforms it by less than this part of its size."""

PROBES = 8
"""Small motions in which a law is asked how stiff it is."""

PROBED = 1e-6
"""How small they are beside the size of the body."""


class ForeignBody(AuditBody):
    """A body of a case whose mass and law another code knows.

    Its equations are those of the nodes of any body. The code may hold or load the body as a whole,
    so that nothing is taken for granted of its momenta.

    Parameters
    ----------
    entry
        What the case says of it.
    code
        What the code says of it.
    cells
        Types and nodes of its cells, and the reference positions of its nodes [m]: see `Cells`.
    first_node
        Number of its first node in the model.
    """

    divides = True
    anchored = True
    carries_waves = False
    blends = False

    def __init__(
        self,
        entry: ForeignEntry,
        code: Code,
        *,
        cells: tuple[Indices, Indices, Array],
        first_node: int,
    ) -> None:
        self._code, self.known = code, not isinstance(code, NoCode)
        types, nodes, points = cells
        super().__init__(
            entry,
            {},
            types=types,
            nodes=nodes,
            points=points,
            first_node=first_node,
            massless=False,
        )

    def _drawn(self) -> Drawn:
        return given(self._code.mesh())

    def _fixed(self) -> Mask:
        return self._code.fixed

    def _weigh(self, masses: object) -> None:
        del masses  # All of its mass is its own.
        self.mass = GivenMass(self._code.mass_entries, self.points.shape)
        self.more = np.zeros((1, 1))

    def _stiffen(self, *, dilates: bool) -> None:
        """Find what resists where nothing has moved, in magnitude.

        By the stiffness that the code gives, or by what small motions make of its force where that
        is more: the one may be approximate, the others are few.
        """
        del dilates
        self.holding = np.zeros(0)
        rest, count = np.zeros(self.points.shape), self.points.size
        rows, _, values = self._code.stiffness_at(rest)
        resists = np.bincount(rows, np.abs(values), count).astype(np.float64)
        size = PROBED * float(np.linalg.norm(np.ptp(self.points, axis=0)))
        random = np.random.default_rng(0)
        for _ in range(PROBES if self.known else 0):
            motion = size * random.choice([-1.0, 1.0], rest.shape)
            change = self._code.force_at(motion) - self._code.force_at(-motion)
            resists = np.maximum(resists, np.abs(change).ravel() / (2.0 * size))
        self.row_stiffness: Array = resists.reshape(self.points.shape).max(axis=1)

    def initial_velocity(self) -> Array:
        """Return the velocities of its nodes at the start of a run [m/s], shape [node_count, D]."""
        return np.where(self.fixed, 0.0, self._code.velocity)

    def spin(self, u: Array, v: Array) -> Array:
        """Return the mean spin about the centre [rad/s], by the masses of nodes."""
        arms = self.arms(u)
        return solved(self.nodal_inertia(arms), self.mass.nodal @ cross(arms, v))

    def vibration(self, u: Array, v: Array, held: Mask) -> Array:
        """Return that it neither takes nor gives what blends leave over, [node_count, D]."""
        del u, held
        return np.zeros_like(v)

    def strain_energy(self, u: Array, grown: float = 0.0) -> float:
        """Return E(u) [J]."""
        del grown
        return self._code.energy_at(u)

    def slope(self, u: Array, energy: float) -> float:
        """Return by how much its energy changes where all of u changes by 1 m [N].

        It may have any sign, and be least anywhere.
        """
        del energy
        return float(np.abs(self._code.force_at(u)).sum())

    def internal_force(self, u: Array, grown: float = 0.0) -> Array:
        """Return ∂E/∂u [N], shape [node_count, D]."""
        del grown
        return self._code.force_at(u)

    def conserving_force(self, u0: Array, u1: Array, grown: float = 0.0) -> Array:
        """Return the force [N] whose work from u₀ to u₁ is the change of the energy.

        That in the middle, and along what deforms the body as much as its work lacks (Gonzalez,
        J. Nonlinear Sci. 6, 1996): so it has no more resultant and moment than that in the middle.
        """
        del grown
        force = self._code.force_at(0.5 * (u0 + u1))
        deforming, size = self._deforming(u0, u1)
        if size == 0.0:
            return force
        change = self._code.energy_at(u1) - self._code.energy_at(u0)
        lacking = change - float((force * (u1 - u0)).sum())
        return force + lacking / size * deforming

    def doubt(self, u0: Array, u1: Array, energy: float) -> Array:
        """Return how far that force may be off [N] by as much of an energy [J], [node_count]."""
        deforming, size = self._deforming(u0, u1)
        off: Array = energy / size * np.linalg.norm(deforming, axis=1) if size else deforming[:, 0]
        return off

    def _deforming(self, u0: Array, u1: Array) -> tuple[Array, float]:
        """Return what a motion has beside the nearest rigid one [m], [node_count, D].

        And the sum of its squares [m²], zero where energies tell nothing of it but round-off.
        """
        x, d = self.points + 0.5 * (u0 + u1), u1 - u0
        arms, beside = x - x.mean(axis=0), d - d.mean(axis=0)
        resists = inertia(arms, lambda field: field)
        turn = np.linalg.lstsq(resists, cross(arms, beside).sum(axis=0), rcond=None)[0]
        deforming: Array = beside - turned(arms, turn)
        size = float((deforming**2).sum())
        least = max(RIGID**2 * float((d**2).sum()), STILL**2 * float((arms**2).sum()))
        return (deforming, size) if size > least else (0.0 * deforming, 0.0)
