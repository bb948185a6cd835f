//! The rows of nodes without mass, beside those of K̄.

use carom_fem::Body;
use carom_mesh::Vector;

use crate::scheme::StepMap;

/// How rows of nodes without mass differ from those of K̄. They are those of the end of the step and resist the rate d/Δt, others the mean velocity
/// of the step: damping has another share in them. K̄ is symmetric, and where damping is that of the stiffness, these rows of the equation are a multiple
/// of its own.
#[derive(Debug)]
pub(super) struct Light {
    /// Of every node, whether it has none; empty where all have mass.
    nodes: Vec<bool>,
    /// What forces on these nodes are multiplied with.
    share: f64,
}

/// All nodes have mass.
impl Default for Light {
    fn default() -> Self {
        Self { nodes: Vec::new(), share: 1.0 }
    }
}

impl Light {
    pub fn of<const D: usize>(body: &Body<D>) -> Self {
        let mut nodes = Vec::new();
        if !body.massless().is_empty() {
            nodes.resize(body.node_count(), false);
            body.massless().iter().for_each(|&n| nodes[n as usize] = true);
        }
        Self { nodes, share: 1.0 }
    }

    /// Fits K̄ of steps like `map`, in which a body has this stiffness damping [s].
    pub fn fit(&mut self, map: &StepMap, damping: f64) {
        let is_moving = !map.is_static();
        let rows = |rate: f64| 1.0 + damping * rate;
        self.share = if is_moving { rows(map.velocity_of_motion) / rows(1.0 / map.dt) } else { 1.0 };
    }

    /// Fits tangents, whose rows are alike.
    pub fn leave(&mut self) {
        self.share = 1.0;
    }

    /// What a force on a node is multiplied with.
    pub fn share_of(&self, node: usize) -> f64 {
        if self.nodes.get(node) == Some(&true) { self.share } else { 1.0 }
    }

    /// Multiplies the `forces` on all nodes.
    pub fn scale<const D: usize>(&self, forces: &mut [Vector<D>]) {
        if self.share != 1.0 {
            let light = forces.iter_mut().zip(&self.nodes).filter(|(_, is_light)| **is_light);
            light.for_each(|(force, _)| *force *= self.share);
        }
    }
}
