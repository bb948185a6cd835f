use serde::{Deserialize, Serialize};

use crate::Solid;

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
    /// Whether the source is checked node by node or in the mean.
    pub discretisation: Discretisation,
}

impl Pair {
    /// The two solids, in ascending order: the same from both sides.
    #[must_use]
    pub fn between(&self) -> [Solid; 2] {
        let source = Solid::Body(self.source);
        source.pair(match self.target {
            Target::Surface(body) => Solid::Body(body),
            Target::Obstacle(obstacle) => Solid::Obstacle(obstacle),
        })
    }
}
