"""A finite element code of a page: triangles of Saint-Venant and Kirchhoff's law, plane strain."""

import numpy as np
import scipy.sparse as sp


class Triangles:
    """Force, energy, tangent and consistent mass; unknown i of node n has the number 2 n + i."""

    def __init__(self, points, cells, *, young, poisson, density):
        self.lame = young * poisson / ((1 + poisson) * (1 - 2 * poisson))
        self.shear = young / (2 * (1 + poisson))
        self.points = points
        self.count = 2 * len(points)
        corners = points[cells]
        edges = np.stack([corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]], axis=2)
        self.area = 0.5 * np.linalg.det(edges)
        reference = np.array([[-1.0, -1.0], [1.0, 0.0], [0.0, 1.0]])
        self.gradients = np.einsum("ak,ekj->eaj", reference, np.linalg.inv(edges))
        self.dofs = 2 * cells[:, :, None] + np.arange(2)
        block = density * self.area[:, None, None] / 12 * (np.ones((3, 3)) + np.eye(3))
        self.mass = self._matrix(np.einsum("eab,ij->eaibj", block, np.eye(2)))

    def _matrix(self, blocks):
        flat = self.dofs.reshape(len(self.dofs), 6)
        rows = np.repeat(flat, 6, axis=1).ravel()
        columns = np.tile(flat, (1, 6)).ravel()
        return sp.csc_array((blocks.ravel(), (rows, columns)), shape=(self.count, self.count))

    def _state(self, u):
        gradient = np.einsum("eai,eaj->eij", u[self.dofs], self.gradients)
        deformation = gradient + np.eye(2)
        strain = 0.5 * (np.einsum("eki,ekj->eij", deformation, deformation) - np.eye(2))
        return deformation, strain, self._stress(strain)

    def _stress(self, strain):
        trace = np.trace(strain, axis1=-2, axis2=-1)[..., None, None]
        return self.lame * trace * np.eye(2) + 2 * self.shear * strain

    def energy(self, u):
        _, strain, stress = self._state(u)
        return 0.5 * float(np.einsum("e,eij,eij->", self.area, strain, stress))

    def force(self, u):
        deformation, _, stress = self._state(u)
        forces = np.einsum("e,eij,ejk,eak->eai", self.area, deformation, stress, self.gradients)
        out = np.zeros(self.count)
        np.add.at(out, self.dofs.ravel(), forces.ravel())
        return out

    def stiffness(self, u):
        deformation, _, stress = self._state(u)
        geometric = np.einsum(
            "e,eak,ekl,ebl->eab", self.area, self.gradients, stress, self.gradients
        )
        blocks = np.einsum("eab,ij->eaibj", geometric, np.eye(2))
        # The change of strain by unknown j of node b, and that of stress which goes with it.
        change = np.einsum("eik,ebl->ebikl", deformation, self.gradients)
        strain = 0.5 * (change + change.swapaxes(-1, -2))
        blocks += np.einsum("e,eaikl,ebjkl->eaibj", self.area, strain, self._stress(strain))
        return self._matrix(blocks)


def outer_edges(cells):
    """The edges that belong to one cell alone, turned either way."""
    edges = np.sort(np.concatenate([cells[:, [0, 1]], cells[:, [1, 2]], cells[:, [2, 0]]]), axis=1)
    edges, counts = np.unique(edges, axis=0, return_counts=True)
    return edges[counts == 1]
