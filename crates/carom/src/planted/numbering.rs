//! The caller's numbers of the nodes on surfaces.

use std::ops::Range;

/// The nodes of all surfaces, one surface after the other, by the caller's numbers.
#[derive(Debug, Default)]
pub(super) struct Numbering {
    nodes: Vec<u32>,
}

impl Numbering {
    /// Adds the nodes of a surface, ascending.
    pub fn add(&mut self, nodes: &[u32]) {
        self.nodes.extend_from_slice(nodes);
    }

    /// The caller's numbers in order.
    pub fn nodes(&self) -> impl Iterator<Item = usize> {
        self.nodes.iter().map(|&n| n as usize)
    }

    /// The caller's numbers of a range of nodes.
    pub fn range(&self, nodes: Range<usize>) -> &[u32] {
        &self.nodes[nodes]
    }

    /// The caller's number of a node; none of what is no node.
    pub fn callers(&self, node: usize) -> Option<u32> {
        self.nodes.get(node).copied()
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.nodes.len()
    }
}
