"""Which cells of a body are of which material, and what follows for each of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from carom.auditing.arrays import Array, Indices
from carom.auditing.materials.flow import Flow
from carom.auditing.materials.laws import Law
from carom.auditing.materials.plane_stress import PlaneStress
from carom.auditing.materials.tensors import IDENTITY, transposed
from carom.auditing.mesh.drawn import Drawn
from carom.case.body import AnyBody, Body, InitialStress, ReducedBody, Region, materials_of
from carom.case.material import Damping, J2Plasticity, Material, Viscosity

_Function = Callable[..., Array]


class Composition:
    """The materials of a body, cell by cell; a rigid body has none, nor one of another code.

    Parameters
    ----------
    entry
        What the case says of the body.
    known
        The materials of the case.
    middles
        Means of the nodes of each cell [m], shape [cell_count, D].
    mesh
        The mesh as the case draws it, which has the sets of cells.

    Raises
    ------
    InputError
        The auditor does not know one of the laws.
    """

    def __init__(
        self, entry: AnyBody, known: Mapping[str, Material], middles: Array, mesh: Drawn
    ) -> None:
        materials = [known[name] for name in materials_of(entry)]
        stress = entry.initial_stress if isinstance(entry, Body) else None
        sheet = entry.hypothesis == "plane-stress"
        grows = isinstance(entry, Body) and entry.growth is not None and not sheet
        # What cannot grow across the plane is strained there.
        free = 3 if grows else middles.shape[1]
        self._laws = [_law(one, free, stress, sheet=sheet) for one in materials] or [Law.none()]
        self._densities = [material.density for material in materials]
        regions = entry.regions if isinstance(entry, Body | ReducedBody) else ()
        self._of_cell = _regions(regions, middles, mesh)
        numbers = np.array([list(known).index(name) for name in materials_of(entry)] or [-1])
        self.material: Indices = numbers[self._of_cell]
        """Number of the material of each cell among those of the case, -1 of none."""
        viscosities = [material.viscosity for material in materials] or [Viscosity()]
        self._viscosities = tuple(
            np.array([getattr(one, name) for one in viscosities]) for name in ("shear", "bulk")
        )
        """η and ζ of each material [Pa s]."""
        dampings = [material.damping for material in materials] or [Damping()]
        self.mass_damping = dampings[0].mass
        """α of C = α M + β K₀ [1/s], the same of all materials."""
        self.stiffness_damping = np.array([damping.stiffness for damping in dampings])[
            self._of_cell
        ]
        """β [s] of each cell."""

    @property
    def first(self) -> Array:
        """λ [Pa] of each cell, shape [cell_count]."""
        return np.array([law.first for law in self._laws])[self._of_cell]

    @property
    def second(self) -> Array:
        """μ [Pa] of each cell, shape [cell_count]."""
        return np.array([law.second for law in self._laws])[self._of_cell]

    @property
    def density(self) -> Array:
        """Density [kg/m³] of each cell of a body that deforms, shape [cell_count]."""
        return np.array(self._densities)[self._of_cell]

    @property
    def modulus(self) -> float:
        """The largest λ + 2μ [Pa]."""
        return max(law.modulus for law in self._laws)

    @property
    def wave_speed(self) -> float:
        """The speed of the slowest pressure waves [m/s] in a body that deforms."""
        pairs = zip(self._laws, self._densities, strict=True)
        return min(law.wave_speed(density) for law, density in pairs)

    @property
    def objective(self) -> bool:
        """Whether a rotation strains nothing; all materials of a body agree in that."""
        return self._laws[0].objective

    @property
    def subtracts(self) -> bool:
        """Whether ψ of some material is a small difference of terms of the size of its moduli."""
        return any(law.subtracts for law in self._laws)

    @property
    def damped(self) -> bool:
        """Whether damping takes energy from the body's motion."""
        return self.mass_damping > 0 or bool((self.stiffness_damping > 0).any()) or self.viscous

    def energy(self, f: Array) -> Array:
        """Return ψ [J/m³] of F, shape [cell_count, q, 3, 3], shape [cell_count, q]."""
        return self._by_material([law.energy for law in self._laws], f)

    @property
    def flows(self) -> bool:
        """Whether some material flows."""
        return any(isinstance(law, Flow) for law in self._laws)

    def potential(self, f: Array) -> Array:
        """Return ψ and the plastic work of a step to F together [J/m³], shape [cell_count, q]."""
        return self._by_material([law.potential for law in self._laws], f)

    def plastic_work(self, f: Array) -> Array:
        """Return the plastic work of a step to F [J/m³], shape [cell_count, q]."""
        return self._by_material(self._of_flow("plastic_work"), f)

    def plastic_strain(self, f: Array) -> Array:
        """Return the equivalent plastic strain after a step to F, shape [cell_count, q]."""
        return self._by_material(self._of_flow("plastic_strain"), f)

    def _of_flow(self, name: str) -> list[_Function]:
        """Return a function of every law that flows, and nothing of the others."""
        return [getattr(law, name, _nothing) for law in self._laws]

    def advance(self, f: Array) -> None:
        """Remember what a step to F leaves."""
        for number, law in enumerate(self._laws):
            if isinstance(law, Flow):
                law.advance(f[self._of_cell == number])

    def go_on(self, before: Composition) -> None:
        """Remember what another composition of the same materials does."""
        for law, other in zip(self._laws, before._laws, strict=True):
            if isinstance(law, Flow) and isinstance(other, Flow):
                law.go_on(other)

    def viscous_stress(self, f0: Array, f1: Array, dt: float) -> Array:
        """Return ½(F₀ + F₁)(2 η dev Ė + ζ tr(Ė) 1) [Pa] of a step, shape [cell_count, q, 3, 3].

        Ė is the change of the Green–Lagrange strain over Δt, or of the small strain where the law
        is one of small displacements.
        """
        mean = 0.5 * (f0 + f1)
        if self.objective:
            rate = (transposed(f1) @ f1 - transposed(f0) @ f0) / (2.0 * dt)
        else:
            rate = 0.5 * (f1 - f0 + transposed(f1 - f0)) / dt
            mean = np.broadcast_to(IDENTITY, f0.shape)
        shear, bulk = (part[self._of_cell][:, None, None, None] for part in self._viscosities)
        volume = np.trace(rate, axis1=-2, axis2=-1)[..., None, None] * IDENTITY
        stress: Array = mean @ (2.0 * shear * (rate - volume / 3.0) + bulk * volume)
        return stress

    @property
    def viscous(self) -> bool:
        """Whether some material has a viscosity."""
        return any(bool(part.any()) for part in self._viscosities)

    @property
    def sluggishness(self) -> float:
        """The largest viscosity, in terms of λ + 2μ [s]."""
        shear, bulk = self._viscosities
        return float((bulk + 2.0 * shear).max()) / self.modulus if self.viscous else 0.0

    def stress(self, f: Array) -> Array:
        """Return P [Pa] of F, shape [cell_count, q, 3, 3]."""
        return self._by_material([law.stress for law in self._laws], f)

    def cauchy_stress(self, f: Array) -> Array:
        """Return P Fᵀ/J [Pa], shape [cell_count, q, 3, 3]."""
        return self._by_material([law.cauchy_stress for law in self._laws], f)

    def discrete_stress(self, f0: Array, f1: Array) -> Array:
        """Return the stress of a step whose work is the change of ψ, see `Law`."""
        return self._by_material([law.discrete_stress for law in self._laws], f0, f1)

    def stress_difference(self, f0: Array, f1: Array) -> Array:
        """Return the difference of the stresses of both ends of a step, see `Law`."""
        return self._by_material([law.stress_difference for law in self._laws], f0, f1)

    def _by_material(self, laws: Sequence[_Function], *points: Array) -> Array:
        """Return what the law of each cell makes of its points."""
        if len(laws) == 1:
            return laws[0](*points)
        parts = [np.flatnonzero(self._of_cell == number) for number in range(len(laws))]
        found = [law(*(f[own] for f in points)) for law, own in zip(laws, parts, strict=True)]
        out: Array = np.empty((len(self._of_cell), *found[0].shape[1:]))
        for own, values in zip(parts, found, strict=True):
            out[own] = values
        return out


def _law(
    material: Material, free: int, stress: InitialStress | None, *, sheet: bool
) -> Law | PlaneStress | Flow:
    if isinstance(material, J2Plasticity) and not sheet and stress is None:
        return Flow(material)
    law = Law.of(material, free, stress)
    return PlaneStress(law) if sheet else law


def _nothing(f: Array) -> Array:
    return np.zeros(f.shape[:-2])


def _regions(regions: Sequence[Region], middles: Array, mesh: Drawn) -> Indices:
    """Return the number of the region of each cell, 0 of what is in none, shape [cell_count]."""
    of_cell = np.zeros(len(middles), dtype=np.int64)
    for number, region in enumerate(regions, start=1):
        if region.on is not None:
            of_cell[mesh.cells(region.on)] = number
            continue
        assert region.corner is not None and region.size is not None
        low = np.array(region.corner)
        high = low + np.array(region.size)
        of_cell[((low <= middles) & (middles <= high)).all(axis=1)] = number
    return of_cell
