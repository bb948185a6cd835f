"""Two discs of scikit-fem collide with friction, carom's contact in a time loop of scikit-fem.

Needs scikit-fem: pip install scikit-fem.
"""

import argparse
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import skfem
from numpy.typing import NDArray
from scipy.sparse.linalg import splu
from skfem.helpers import ddot, dot, grad, identity, mul, trace, transpose

from carom import contact

YOUNG, POISSON, DENSITY, FRICTION = 2700.0, 0.33, 1.0, 0.2
LAMBDA = YOUNG * POISSON / (1 + POISSON) / (1 - 2 * POISSON)
SHEAR = YOUNG / 2 / (1 + POISSON)
TIME_STEP = 1e-3  # [s]

Array = NDArray[np.float64]


class Discs:
    """Two discs of Saint-Venant and Kirchhoff's law, plain scikit-fem that knows no contact."""

    def __init__(self, refinements: int = 3) -> None:
        disc = skfem.MeshTri.init_circle(refinements)
        points = [disc.p + np.array([[x], [y]]) for x, y in ((-1.02, 0.0), (1.02, 0.6))]
        self.nodes = disc.p.shape[1]
        self.mesh = skfem.MeshTri(np.hstack(points), np.hstack([disc.t, disc.t + self.nodes]))
        self.basis = skfem.Basis(self.mesh, skfem.ElementVector(skfem.ElementTriP1()), intorder=2)
        self.mass = skfem.BilinearForm(lambda u, v, w: DENSITY * dot(u, v)).assemble(self.basis)

    @staticmethod
    def _stress(w: Any) -> tuple[Any, Any, Any]:
        gradient = grad(w["u"])
        deformation = gradient + identity(gradient)
        strain = 0.5 * (mul(transpose(deformation), deformation) - identity(gradient))
        stress = LAMBDA * trace(strain) * identity(gradient) + 2 * SHEAR * strain
        return deformation, stress, strain

    def _assemble(self, form: Any, u: Array) -> Any:
        return form.assemble(self.basis, u=self.basis.interpolate(u))

    def force(self, u: Array) -> Any:
        """Return the internal forces [N]."""

        def form(v: Any, w: Any) -> Any:
            deformation, stress, _ = self._stress(w)
            return ddot(mul(deformation, stress), grad(v))

        return self._assemble(skfem.LinearForm(form), u)

    def stiffness(self, u: Array) -> Any:
        """Return the tangent [N/m]."""

        def form(u: Any, v: Any, w: Any) -> Any:
            deformation, stress, _ = self._stress(w)
            change = mul(transpose(deformation), grad(u))
            strain = 0.5 * (change + transpose(change))
            stress_change = LAMBDA * trace(strain) * identity(strain) + 2 * SHEAR * strain
            return ddot(mul(grad(u), stress) + mul(deformation, stress_change), grad(v))

        return self._assemble(skfem.BilinearForm(form), u)

    def strain_energy(self, u: Array) -> float:
        """Return the strain energy [J]."""

        def form(w: Any) -> Any:
            _, stress, strain = self._stress(w)
            return 0.5 * ddot(stress, strain)

        return float(self._assemble(skfem.Functional(form), u))


@dataclass
class Run:
    """What happened: energies at the end of every step [J], and the books of contact."""

    kinetic: list[float] = field(default_factory=list)
    strain: list[float] = field(default_factory=list)
    friction: list[float] = field(default_factory=list)
    ledger: contact.Ledger = field(default_factory=contact.Ledger)
    iterations: int = 0


def collide(discs: Discs, end_time: float = 0.6, condition: str = "gap") -> Run:
    """Take the discs through their impact by the midpoint rule, with Newton's method."""
    # What touches what: facets and unknowns by the numbers of scikit-fem.
    mesh, dofs = discs.mesh, discs.basis.nodal_dofs.T
    facets = mesh.facets[:, mesh.boundary_facets()].T
    is_left = facets[:, 0] < discs.nodes
    surfaces = [
        contact.Surface("left", facets[is_left]),
        contact.Surface("right", facets[~is_left]),
    ]
    reference = mesh.p.T
    touch = contact.ContactModel(
        reference, surfaces, friction=FRICTION, condition=condition, dofs=dofs
    )
    run = Run()

    u, v = np.zeros(discs.basis.N), np.zeros(discs.basis.N)
    v[dofs[: discs.nodes, 0]], v[dofs[discs.nodes :, 0]] = 1.0, -1.0
    force = discs.force(u)
    for _ in range(round(end_time / TIME_STEP)):
        start = reference + u[dofs]
        candidates: contact.Candidates | None
        candidates = touch.search(start, velocity=v[dofs], time_step=TIME_STEP)
        d = TIME_STEP * v
        while candidates is not None:
            for _ in range(30):
                run.iterations += 1
                new = u + d
                residual = discs.mass @ (2 * d / TIME_STEP**2 - 2 * v / TIME_STEP)
                residual += 0.5 * (force + discs.force(new))
                tangent = 2 * discs.mass / TIME_STEP**2 + 0.5 * discs.stiffness(new)
                factor = splu(tangent.tocsc())
                contacts = touch.evaluate(candidates, reference + new[dofs])
                found = contact.solve(contacts, factor.solve, free=d - factor.solve(residual))
                correction = np.abs(found.motion - d).max()
                d = found.motion
                if correction < 1e-13:
                    break
            else:
                raise RuntimeError(f"Newton's method stopped at a correction of {correction:.1e} m")
            candidates = touch.missed(reference + (u + d)[dofs])
        run.ledger.add(touch.accept(reference + (u + d)[dofs]))
        u, v = u + d, 2 * d / TIME_STEP - v
        force = discs.force(u)
        run.kinetic.append(0.5 * v @ discs.mass @ v)
        run.strain.append(discs.strain_energy(u))
        run.friction.append(run.ledger.friction)
    return run


def main(end_time: float = 0.6) -> None:
    """Let the discs collide; check that the books close but for what the scheme leaves."""
    discs = Discs()
    run = collide(discs, end_time)
    initial = 0.5 * float(discs.mass.sum()) / 2
    total = run.kinetic[-1] + run.strain[-1]
    ledger = run.ledger
    defect = total - initial + ledger.friction + ledger.normal_contact
    print(
        f"{discs.basis.N} unknowns, {ledger.steps} steps, {run.iterations} iterations; "
        f"friction took {ledger.friction:.4f} J of {initial:.4f} J, "
        f"normal reactions {ledger.normal_contact:.4f} J, the scheme {-defect:.1e} J; "
        f"certificate {ledger.certificate:.1e} J, least gap {ledger.min_gap:.1e} m"
    )
    assert ledger.friction > 0.01 * initial
    assert abs(defect) < 1e-3 * initial


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--end-time", type=float, default=0.6)
    main(parser.parse_args().end_time)
