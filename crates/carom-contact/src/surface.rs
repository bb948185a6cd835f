use carom_mesh::{Facet, Surface, Vector};

use crate::aabb::Aabb;
use crate::project::{Projection, Reach, project};

/// The boundary of a body, its nodes numbered over all bodies.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactSurface {
    /// Facets.
    pub facets: Vec<Facet>,
    /// Nodes, ascending.
    pub nodes: Vec<u32>,
    /// For every node, the facets around it.
    facets_around: Vec<Vec<u32>>,
}

impl ContactSurface {
    /// The boundary of a body whose first node has the number `first_node`.
    #[must_use]
    pub fn new(surface: &Surface, first_node: u32) -> Self {
        let facets: Vec<Facet> = surface
            .facets()
            .iter()
            .map(|f| Facet { kind: f.kind, nodes: f.nodes.iter().map(|n| n + first_node).collect() })
            .collect();
        let nodes: Vec<u32> = surface.nodes().iter().map(|n| n + first_node).collect();
        let mut facets_around = vec![Vec::new(); nodes.len()];
        for (f, facet) in facets.iter().enumerate() {
            for node in &facet.nodes {
                if let Ok(k) = nodes.binary_search(node) {
                    facets_around[k].push(f as u32);
                }
            }
        }
        Self { facets, nodes, facets_around }
    }

    /// The facets around a node.
    pub(crate) fn around(&self, node: u32) -> &[u32] {
        self.nodes.binary_search(&node).map_or(&[], |k| &self.facets_around[k])
    }

    /// Projects `x` on what the surface is over the facet `f`.
    #[inline]
    pub(crate) fn project<const D: usize>(
        &self,
        f: u32,
        x: &Vector<D>,
        reach: Reach,
        position: &impl Fn(u32) -> Vector<D>,
    ) -> Projection<'_, D> {
        project(x, &self.facets[f as usize], reach, position)
    }

    /// A box around what the surface is over the facet `f`.
    pub(crate) fn bounds<const D: usize>(&self, f: u32, position: &impl Fn(u32) -> Vector<D>) -> Aabb<D> {
        Aabb::of(self.facets[f as usize].nodes.iter().map(|&n| position(n)))
    }

    /// Mean outward normal of the facets around a node, weighted by their size; not normalised.
    pub(crate) fn node_normal<const D: usize>(
        &self,
        node: u32,
        position: &impl Fn(u32) -> Vector<D>,
    ) -> Vector<D> {
        let x = position(node);
        self.around(node).iter().fold(Vector::zeros(), |sum, &f| {
            let facet = &self.facets[f as usize];
            let size = (position(facet.nodes[1]) - position(facet.nodes[0])).norm();
            sum + project(&x, facet, Reach::Facet, position).normal * size
        })
    }
}
