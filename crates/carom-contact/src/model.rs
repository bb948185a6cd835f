use std::collections::BTreeMap;

use carom_mesh::{Facet, Surface, Vector};

use crate::Obstacle;
use crate::project::{Reach, project};

/// The boundary of a body, its nodes numbered over all bodies.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactSurface {
    /// Facets.
    pub facets: Vec<Facet>,
    /// Nodes, ascending.
    pub nodes: Vec<u32>,
    /// The nodes that may touch a target, ascending: all but those that follow another. The two would be one contact twice.
    pub sources: Vec<u32>,
    /// For every source, the facets around it and its images.
    pub(crate) facets_around: Vec<Vec<u32>>,
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
        let masters: BTreeMap<u32, u32> =
            surface.ties().iter().map(|t| (t.image + first_node, t.master + first_node)).collect();
        let sources: Vec<u32> = nodes.iter().copied().filter(|n| !masters.contains_key(n)).collect();
        let mut facets_around = vec![Vec::new(); sources.len()];
        for (f, facet) in facets.iter().enumerate() {
            for node in &facet.nodes {
                if let Ok(k) = sources.binary_search(masters.get(node).unwrap_or(node)) {
                    facets_around[k].push(f as u32);
                }
            }
        }
        Self { facets, nodes, sources, facets_around }
    }
}

/// What a source surface is checked against.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {
    /// The facets of a surface.
    Surface(usize),
    /// A rigid obstacle.
    Obstacle(usize),
}

/// Nodes of a source surface against a target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// Surface whose nodes are checked.
    pub source: usize,
    /// What they are checked against.
    pub target: Target,
    /// Friction coefficient.
    pub friction: f64,
    /// The named pair that this belongs to; both directions of a two-sided check share it.
    pub group: usize,
}

/// All surfaces, obstacles and pairs.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ContactModel<const D: usize> {
    /// Surfaces, one per body.
    pub surfaces: Vec<ContactSurface>,
    /// Rigid obstacles.
    pub obstacles: Vec<Obstacle<D>>,
    /// Pairs.
    pub pairs: Vec<Pair>,
}

impl<const D: usize> ContactModel<D> {
    /// Whether the bodies of a pair are checked from both sides.
    #[must_use]
    pub fn is_two_sided(&self, pair: usize) -> bool {
        let group = self.pairs[pair].group;
        self.pairs.iter().filter(|p| p.group == group).count() > 1
    }

    /// Mean outward normal of the facets around the `k`-th source of a surface, weighted by their size; not normalised.
    pub(crate) fn node_normal(
        surface: &ContactSurface,
        k: usize,
        position: &impl Fn(u32) -> Vector<D>,
    ) -> Vector<D> {
        let x = position(surface.sources[k]);
        surface.facets_around[k].iter().fold(Vector::zeros(), |sum, &f| {
            let facet = &surface.facets[f as usize];
            let size = (position(facet.nodes[1]) - position(facet.nodes[0])).norm();
            sum + project(&x, facet, Reach::Facet, position).normal * size
        })
    }
}
