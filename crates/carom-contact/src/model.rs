use std::ops::Range;

use carom_mesh::Vector;
use serde::{Deserialize, Serialize};

use crate::{Candidate, ContactSurface, Obstacle, Site};

/// What a source surface is checked against.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {
    /// The facets of a surface.
    Surface(usize),
    /// A rigid obstacle.
    Obstacle(usize),
}

/// How contact between two surfaces is written for finitely many nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Discretisation {
    /// The gap of every source node: a force at a node.
    #[default]
    NodeToSegment,
    /// The mean gap under the shape function of every source node: a pressure on the surface. Rigid obstacles have no facets
    /// to integrate over and are always checked node by node.
    Mortar,
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
    /// The named pair that this belongs to; both directions of a two-sided check share it and follow one another.
    pub named_pair: usize,
    /// Whether the source is checked node by node or in the mean.
    pub discretisation: Discretisation,
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
    /// Whether the bodies of a pair are checked from both sides, as a body with itself always is.
    #[must_use]
    pub fn is_two_sided(&self, pair: usize) -> bool {
        self.is_self_contact(pair) || self.directions(pair).len() > 1
    }

    /// The pairs of the same named pair as `pair`.
    pub(crate) fn directions(&self, pair: usize) -> Range<usize> {
        let is_of_same = |p: &Pair| p.named_pair == self.pairs[pair].named_pair;
        let before = self.pairs[..pair].iter().rev().take_while(|p| is_of_same(p)).count();
        let after = self.pairs[pair..].iter().take_while(|p| is_of_same(p)).count();
        pair - before..pair + after
    }

    /// Whether the facet of a candidate is one of the surface that it faces.
    #[must_use]
    pub fn has_facet(&self, candidate: &Candidate) -> bool {
        let count = self.faced_surface(candidate).map_or(0, |surface| surface.facets.len());
        candidate.facet.is_none_or(|f| (f as usize) < count)
    }

    /// The surface that a candidate faces a facet of.
    pub(crate) fn faced_surface(&self, candidate: &Candidate) -> Option<&ContactSurface> {
        let pair = &self.pairs[candidate.pair as usize];
        match (candidate.site, pair.target) {
            (Site::Corner(_) | Site::Facet(_), _) => Some(&self.surfaces[pair.source]),
            (_, Target::Surface(t)) => Some(&self.surfaces[t]),
            (_, Target::Obstacle(o)) => self.obstacles[o].faceted.as_ref().map(|f| &f.surface),
        }
    }

    /// Where nodes, and the corners of the obstacle of a pair, are.
    pub(crate) fn placed(
        &self,
        pair: u32,
        position: &impl Fn(u32) -> Vector<D>,
    ) -> impl Fn(u32) -> Vector<D> {
        let obstacle = match self.pairs[pair as usize].target {
            Target::Obstacle(o) => Some(&self.obstacles[o]),
            Target::Surface(_) => None,
        };
        move |n| obstacle.map_or_else(|| position(n), |obstacle| obstacle.placed(position)(n))
    }
}
