"""Facets of boundaries: their areas and normals, and the shares of their nodes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from carom.auditing.arrays import Array, Indices, cross, einsum
from carom.auditing.mesh.kinds import Kind
from carom.auditing.mesh.quadrature import rule_of_masses


@dataclass(frozen=True)
class Facets:
    """Facets of one kind.

    Parameters
    ----------
    kind
        Their kind.
    nodes
        Their nodes, the body on their left in the plane, outward by the right-hand rule in space,
        shape [facet_count, a].
    thickness
        Thickness of the body [m]; 1 in space.
    revolution
        Whether they are of a body of revolution around x = 0, of which they are the whole rings.
    """

    kind: Kind
    nodes: Indices
    thickness: float
    revolution: bool = False

    def areas(self, position: Array) -> Array:
        """Return their areas ∫dA where nodes are at `position` [m²], shape [facet_count]."""
        areas: Array = np.linalg.norm(self._at_points(position), axis=2).sum(axis=1)
        return areas

    def vectors(self, position: Array) -> Array:
        """Return their area vectors ∫n dA [m²], shape [facet_count, D]."""
        return einsum("fqi->fi", self._at_points(position))

    def normals(self, position: Array) -> Array:
        """Return the directions of their area vectors, shape [facet_count, D]."""
        whole = self.vectors(position)
        normals: Array = whole / np.linalg.norm(whole, axis=1, keepdims=True)
        return normals

    def spread(self, position: Array, traction: Array) -> Array:
        """Return ∫N_a dA times a traction [Pa], shape [D], as forces, [facet_count, a, D]."""
        sizes = np.linalg.norm(self._at_points(position), axis=2)
        return einsum("fq,qa->fa", sizes, self._values)[..., None] * traction

    def pushed(self, position: Array, pressure: float) -> Array:
        """Return −p ∫N_a n dA of a pressure [Pa] as forces [N], shape [facet_count, a, D]."""
        return -pressure * einsum("fqi,qa->fai", self._at_points(position), self._values)

    @property
    def _values(self) -> Array:
        return self.kind.values(rule_of_masses(self.kind)[0])

    def _at_points(self, position: Array) -> Array:
        """Return area vectors of the points of quadrature [m²], shape [facet_count, q, D]."""
        places, weights = rule_of_masses(self.kind)
        corners = position[self.nodes]
        tangents = einsum("fai,qak->fqki", corners, self.kind.slopes(places))
        depth = np.full((len(corners), len(weights)), self.thickness)
        if self.revolution:
            depth = 2.0 * np.pi * einsum("fa,qa->fq", corners[..., 0], self.kind.values(places))
        return (depth * weights)[..., None] * area_vector(tangents)


def area_vector(tangents: Array) -> Array:
    """Return the outward area vectors of tangents, shape [..., D − 1, D], shape [..., D]."""
    if tangents.shape[-1] == 2:
        along = tangents[..., 0, :]
        return np.stack([along[..., 1], -along[..., 0]], axis=-1)
    return cross(tangents[..., 0, :], tangents[..., 1, :])
