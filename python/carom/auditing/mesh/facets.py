"""Facets of boundaries: their areas and normals, and the shares of their nodes.

The boundary of a body may have facets of several kinds. Then all have as many entries as those with
the most nodes, and others end with their first node.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from carom.auditing.arrays import Array, Indices, cross, einsum
from carom.auditing.mesh.kinds import Kind, kind_with
from carom.auditing.mesh.quadrature import rule_of_masses

Group = tuple[Kind, Indices, Indices]
"""A kind, the facets that are of it, shape [count], and their nodes, shape [count, a]."""


def node_counts(facets: Indices) -> Indices:
    """Return how many nodes facets have, shape [facet_count]."""
    counts: Indices = 1 + (facets[:, 1:] != facets[:, :1]).sum(axis=1)
    return counts


def grouped(facets: Indices, dimension: int) -> list[Group]:
    """Return the facets of bodies of so many dimensions by their kinds."""
    counts = node_counts(facets)
    groups = []
    for count in np.unique(counts):
        rows = np.flatnonzero(counts == count)
        groups.append((kind_with(dimension - 1, int(count)), rows, facets[rows, :count]))
    return groups


def corners_of(facets: Indices, dimension: int) -> Indices:
    """Return the corners of facets, the first of their nodes, shape [facet_count, corner]."""
    if dimension == 2:
        return facets[:, :2]
    triangular = np.isin(node_counts(facets), (3, 6))
    if triangular.all():
        return facets[:, :3]
    return np.where(triangular[:, None] & (np.arange(4) == 3), facets[:, :1], facets[:, :4])


@dataclass(frozen=True)
class Facets:
    """Facets of one body.

    Parameters
    ----------
    dimension
        2 in the plane, 3 in space.
    nodes
        Their nodes, the body on their left in the plane, outward by the right-hand rule in space,
        shape [facet_count, a].
    thickness
        Thickness of the body [m]; 1 in space.
    revolution
        Whether they are of a body of revolution around x = 0, of which they are the whole rings.
    """

    dimension: int
    nodes: Indices
    thickness: float
    revolution: bool = False

    @cached_property
    def groups(self) -> list[Group]:
        """The facets by their kinds."""
        return grouped(self.nodes, self.dimension)

    def areas(self, position: Array) -> Array:
        """Return their areas ∫dA where nodes are at `position` [m²], shape [facet_count]."""
        areas = np.zeros(len(self.nodes))
        for group in self.groups:
            areas[group[1]] = np.linalg.norm(self._at_points(group, position), axis=2).sum(axis=1)
        return areas

    def vectors(self, position: Array) -> Array:
        """Return their area vectors ∫n dA [m²], shape [facet_count, D]."""
        vectors = np.zeros((len(self.nodes), self.dimension))
        for group in self.groups:
            vectors[group[1]] = einsum("fqi->fi", self._at_points(group, position))
        return vectors

    def normals(self, position: Array) -> Array:
        """Return the directions of their area vectors, shape [facet_count, D]."""
        whole = self.vectors(position)
        normals: Array = whole / np.linalg.norm(whole, axis=1, keepdims=True)
        return normals

    def spread(self, position: Array, traction: Array) -> Array:
        """Return ∫N_a dA times a traction [Pa], shape [D], as forces, [facet_count, a, D]."""
        forces = np.zeros((*self.nodes.shape, self.dimension))
        for group in self.groups:
            sizes = np.linalg.norm(self._at_points(group, position), axis=2)
            shares = einsum("fq,qa->fa", sizes, _values(group[0]))
            forces[group[1], : shares.shape[1]] = shares[..., None] * traction
        return forces

    def pushed(self, position: Array, pressure: float) -> Array:
        """Return −p ∫N_a n dA of a pressure [Pa] as forces [N], shape [facet_count, a, D]."""
        forces = np.zeros((*self.nodes.shape, self.dimension))
        for group in self.groups:
            shares = einsum("fqi,qa->fai", self._at_points(group, position), _values(group[0]))
            forces[group[1], : shares.shape[1]] = -pressure * shares
        return forces

    def _at_points(self, group: Group, position: Array) -> Array:
        """Return area vectors of the points of quadrature [m²], shape [count, q, D]."""
        kind, _, nodes = group
        places, weights = rule_of_masses(kind)
        corners = position[nodes]
        tangents = einsum("fai,qak->fqki", corners, kind.slopes(places))
        depth = np.full((len(corners), len(weights)), self.thickness)
        if self.revolution:
            depth = 2.0 * np.pi * einsum("fa,qa->fq", corners[..., 0], kind.values(places))
        return (depth * weights)[..., None] * area_vector(tangents)


def _values(kind: Kind) -> Array:
    return kind.values(rule_of_masses(kind)[0])


def area_vector(tangents: Array) -> Array:
    """Return the outward area vectors of tangents, shape [..., D − 1, D], shape [..., D]."""
    if tangents.shape[-1] == 2:
        along = tangents[..., 0, :]
        return np.stack([along[..., 1], -along[..., 0]], axis=-1)
    return cross(tangents[..., 0, :], tangents[..., 1, :])
