"""A rubber block of felupe falls askew on a floor, carom's contact in a time loop of felupe.

Needs felupe: pip install felupe.
"""

import argparse
from dataclasses import dataclass, field
from typing import Any

import felupe
import numpy as np
from numpy.typing import NDArray
from scipy.sparse.linalg import splu

import carom
from carom import contact

SHEAR, BULK, DENSITY, FRICTION = 1.0e5, 5.0e5, 1000.0, 0.3
TIME_STEP = 1e-4  # [s]

Array = NDArray[np.float64]


class Block:
    """A block of compressible Neo-Hooke's law, plain felupe that knows no contact."""

    def __init__(self, cells: int = 4) -> None:
        self.mesh = felupe.Cube(a=(0.0, 0.0, 0.0), b=(0.1, 0.1, 0.1), n=cells + 1)
        turned = self.mesh.rotate(20.0, axis=1)
        self.mesh = turned.translate(1e-3 - turned.points[:, 2].min(), axis=2)
        self.region = felupe.RegionHexahedron(self.mesh)
        self.field = felupe.FieldContainer([felupe.Field(self.region, dim=3)])
        self.solid = felupe.SolidBody(felupe.NeoHooke(mu=SHEAR, bulk=BULK), self.field)
        self.mass = self.solid.assemble.mass(density=DENSITY).tocsc()
        self.dofs = np.arange(self.mesh.points.size).reshape(-1, 3)

    def _at(self, u: Array) -> None:
        self.field[0].values[:] = u.reshape(-1, 3)

    def force(self, u: Array) -> Array:
        """Return the internal forces [N]."""
        self._at(u)
        forces: Array = self.solid.assemble.vector(self.field).toarray().ravel()
        return forces

    def stiffness(self, u: Array) -> Any:
        """Return the tangent [N/m], sparse."""
        self._at(u)
        return self.solid.assemble.matrix(self.field).tocsc()

    def strain_energy(self, u: Array) -> float:
        """Return the strain energy [J]."""
        self._at(u)
        (density,) = self.solid.umat.function([*self.field.extract(), None])
        return float((density * self.region.dV).sum())


@dataclass
class Run:
    """What happened: energies at the end of every step [J], and the books of contact."""

    kinetic: list[float] = field(default_factory=list)
    strain: list[float] = field(default_factory=list)
    ledger: contact.Ledger = field(default_factory=contact.Ledger)
    iterations: int = 0


def drop(block: Block, end_time: float = 0.02) -> Run:
    """Take the block through its impact by the midpoint rule, with Newton's method."""
    # What touches what: facets and unknowns by the numbers of felupe.
    facets = felupe.RegionHexahedronBoundary(block.mesh).mesh.cells_faces
    touch = contact.ContactModel(
        block.mesh.points,
        [contact.Surface("block", facets)],
        [carom.Plane(name="floor", point=[0.0, 0.0, 0.0], normal=[0.0, 0.0, 1.0])],
        friction=FRICTION,
        dofs=block.dofs,
    )
    run = Run()

    u = np.zeros(block.mesh.points.size)
    v = np.tile([0.5, 0.0, -1.0], len(block.mesh.points))
    force = block.force(u)
    for _ in range(round(end_time / TIME_STEP)):
        start = block.mesh.points + u[block.dofs]
        candidates: contact.Candidates | None
        candidates = touch.search(start, velocity=v[block.dofs], time_step=TIME_STEP)
        d = TIME_STEP * v
        while candidates is not None:
            for _ in range(30):
                run.iterations += 1
                new = u + d
                residual = block.mass @ (2 * d / TIME_STEP**2 - 2 * v / TIME_STEP)
                residual += 0.5 * (force + block.force(new))
                factor = splu(2 * block.mass / TIME_STEP**2 + 0.5 * block.stiffness(new))
                contacts = touch.evaluate(candidates, block.mesh.points + new[block.dofs])
                found = contact.solve(contacts, factor.solve, free=d - factor.solve(residual))
                correction = np.abs(found.motion - d).max()
                d = found.motion
                if correction < 1e-13:
                    break
            else:
                raise RuntimeError(f"Newton's method stopped at a correction of {correction:.1e} m")
            candidates = touch.missed(block.mesh.points + (u + d)[block.dofs])
        run.ledger.add(touch.accept(block.mesh.points + (u + d)[block.dofs]))
        u, v = u + d, 2 * d / TIME_STEP - v
        force = block.force(u)
        run.kinetic.append(0.5 * v @ block.mass @ v)
        run.strain.append(block.strain_energy(u))
    return run


def main(end_time: float = 0.02) -> None:
    """Let the block bounce; check that the books close but for what the scheme leaves."""
    block = Block()
    run = drop(block, end_time)
    initial = 0.5 * float(block.mass.sum()) / 3 * (0.5**2 + 1.0**2)
    total = run.kinetic[-1] + run.strain[-1]
    ledger = run.ledger
    defect = total - initial + ledger.friction + ledger.normal_contact
    print(
        f"{block.mesh.points.size} unknowns, {ledger.steps} steps, {run.iterations} iterations; "
        f"friction took {ledger.friction:.4f} J of {initial:.4f} J, "
        f"normal reactions {ledger.normal_contact:.4f} J, the scheme {-defect:.1e} J; "
        f"certificate {ledger.certificate:.1e} J, least gap {ledger.min_gap:.1e} m"
    )
    assert ledger.friction > 0.01 * initial
    assert abs(defect) < 1e-3 * initial


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--end-time", type=float, default=0.02)
    main(parser.parse_args().end_time)
