"""carom's contact planted in a finite element code: an elastic block lands on a rough floor.

Run it: python planted.py. Then put your own code in the place of the class Code: what carom has to
know is marked by (1) to (6). All quantities are in SI units; the block is a slice of 1 m.
"""

import numpy as np
import scipy.sparse as sp
from numpy.typing import NDArray
from scipy.sparse.linalg import splu

import carom
from carom import contact

Array = NDArray[np.float64]

YOUNG, POISSON, DENSITY, FRICTION = 1e6, 0.3, 1000.0, 0.3
VELOCITY = (1.0, -1.0)  # m/s
TIME_STEP, STEPS = 2e-4, 300


class Code:
    """Your finite element code: here linear triangles in plane strain, small strains, no weight."""

    def __init__(self, columns: int = 12, rows: int = 6, side: float = 0.02) -> None:
        across, up = np.meshgrid(np.arange(columns + 1), np.arange(rows + 1))
        self.nodes = side * np.column_stack([across.ravel(), up.ravel() + 0.1])
        number = np.arange(len(self.nodes)).reshape(rows + 1, columns + 1)
        a, b, c, d = number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]
        halves = [np.stack([a, b, c], axis=-1), np.stack([a, c, d], axis=-1)]
        self.cells = np.concatenate([half.reshape(-1, 3) for half in halves])
        rim = [number[0], number[1:, -1], number[-1, -2::-1], number[-2::-1, 0]]
        around = np.concatenate(rim)
        self.facets = np.column_stack([around[:-1], around[1:]])
        self.dofs = np.arange(2 * len(self.nodes)).reshape(-1, 2)
        self.mass, self.stiffness = self._assembled()

    def _assembled(self) -> tuple[sp.csc_matrix, sp.csc_matrix]:
        shear = YOUNG / 2 / (1 + POISSON)
        lame = YOUNG * POISSON / (1 + POISSON) / (1 - 2 * POISSON)
        law = np.diag([2 * shear, 2 * shear, shear])
        law[:2, :2] += lame
        mass = np.zeros(self.dofs.size)
        rows, columns, values = [], [], []
        for cell in self.cells:
            edges = np.column_stack([np.ones(3), self.nodes[cell]])
            area, gradient = 0.5 * np.linalg.det(edges), np.linalg.inv(edges)[1:]
            strain = np.zeros((3, 6))
            strain[0, 0::2], strain[1, 1::2] = gradient
            strain[2, 0::2], strain[2, 1::2] = gradient[1], gradient[0]
            own = self.dofs[cell].ravel()
            mass[own] += DENSITY * area / 3.0
            rows.append(np.repeat(own, 6))
            columns.append(np.tile(own, 6))
            values.append((area * strain.T @ law @ strain).ravel())
        places = (np.concatenate(rows), np.concatenate(columns))
        stiffness = sp.csc_matrix((np.concatenate(values), places), shape=(mass.size, mass.size))
        return sp.diags(mass, format="csc"), stiffness


def main() -> None:
    """Take the block through its impact by the midpoint rule."""
    code = Code()
    touch = contact.ContactModel(
        code.nodes,  # (1) your nodes, and the facets of your surfaces by the numbers of the nodes
        [contact.Surface("block", code.facets)],
        [carom.Plane(name="floor", point=[0.0, 0.0], normal=[0.0, 1.0])],
        friction=FRICTION,
        condition="midpoint",
        mass=code.mass,
        dofs=code.dofs,  # (2) the number of your unknown of each node and component
    )
    iteration = 2.0 * code.mass / TIME_STEP**2 + 0.5 * code.stiffness
    solve = splu(iteration.tocsc()).solve  # (3) what solves with your matrix
    ledger = contact.Ledger()
    u = np.zeros(code.dofs.size)
    v = np.tile(VELOCITY, len(code.nodes))
    before = energy(code, u, v)
    for _ in range(STEPS):
        # (4) what may touch in this step, by the velocities at its start
        start = code.nodes + u.reshape(-1, 2)
        candidates: contact.Candidates | None
        candidates = touch.search(start, velocity=v.reshape(-1, 2), time_step=TIME_STEP)
        d = TIME_STEP * v
        while candidates is not None:
            for _ in range(20):
                # (5) gaps at your guess of the end; then reactions, and the motion with them
                contacts = touch.evaluate(candidates, code.nodes + (u + d).reshape(-1, 2))
                residual = code.mass @ (2.0 * d / TIME_STEP**2 - 2.0 * v / TIME_STEP)
                residual += code.stiffness @ (u + 0.5 * d)
                found = contact.solve(contacts, solve, free=d - solve(residual))
                change, d = np.abs(found.motion - d).max(), found.motion
                if change <= 1e-12 * np.abs(d).max():
                    break
            else:
                raise RuntimeError(f"no end of the iterations: the last changed {change:.1e} m")
            candidates = touch.missed(code.nodes + (u + d).reshape(-1, 2))
        # (6) the step is accepted: its books, and what landing took is given back
        u, v = u + d, 2.0 * d / TIME_STEP - v
        step = touch.accept(code.nodes + u.reshape(-1, 2), velocity=v.reshape(-1, 2))
        ledger.add(step)
        v = v + step.velocity_change
    after = energy(code, u, v)
    defect = after - before + ledger.friction + ledger.normal_contact
    print(f"friction took {ledger.friction:.4f} J of {before:.4f} J")
    print(f"not explained: {abs(defect) / before:.0e} of the energy")
    print(f"certificate {ledger.certificate:.0e} J, least gap {ledger.min_gap:.0e} m")


def energy(code: Code, u: Array, v: Array) -> float:
    """Return kinetic and strain energy [J]."""
    return float(0.5 * v @ code.mass @ v + 0.5 * u @ code.stiffness @ u)


if __name__ == "__main__":
    main()
