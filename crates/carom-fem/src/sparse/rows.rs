use std::sync::Arc;

use carom_mesh::Matrix;

use super::{NodalMatrix, NodeGraph};
use crate::ranks::Ranks;

/// The place of a node whose row is not here.
pub(super) const ELSEWHERE: u32 = u32::MAX;

/// The rows of a matrix that processes share, of which this one has a part. Numbered one after the other they are its *places*.
///
/// A product is whole in most of them. Those whose nodes others have cells around, too, are *split*: their products are sums over processes.
#[derive(Debug)]
pub(super) struct Rows {
    ranks: Arc<dyn Ranks>,
    /// The node of each place, ascending.
    nodes: Vec<u32>,
    /// The place of each node, or [`ELSEWHERE`].
    places: Vec<u32>,
    /// One over the number of processes that have a part of each row.
    shares: Vec<f64>,
    /// Whether the row of each node is split.
    is_split: Vec<bool>,
    /// All of them.
    all: Split,
}

/// Rows that are here, and those that are split, which every process has a list of in the same order: see [`ELSEWHERE`].
#[derive(Debug, Default)]
pub(super) struct Split {
    pub whole: Vec<u32>,
    pub split: Vec<u32>,
}

impl Rows {
    /// None if nobody has any of a row: all processes see that.
    pub fn of<const D: usize>(matrix: &NodalMatrix<Matrix<D>>, ranks: &Arc<dyn Ranks>) -> Option<Self> {
        let graph = matrix.graph();
        let is_here =
            |node: usize| graph.row(node).any(|(entry, _)| matrix.values[entry].iter().any(|&x| x != 0.0));
        let mut counts: Vec<f32> =
            (0..graph.node_count()).map(|node| if is_here(node) { 1.0 } else { 0.0 }).collect();
        let mut places = vec![ELSEWHERE; counts.len()];
        let nodes: Vec<u32> = (0..counts.len() as u32).filter(|&n| counts[n as usize] > 0.0).collect();
        nodes.iter().zip(0..).for_each(|(&node, place)| places[node as usize] = place);
        ranks.sum_single(&mut counts);
        if !counts.iter().all(|&count| count > 0.0) {
            return None;
        }
        let shares = nodes.iter().map(|&node| f64::from(counts[node as usize]).recip()).collect();
        let is_split = counts.iter().map(|&count| count > 1.0).collect();
        let mut rows =
            Self { ranks: Arc::clone(ranks), nodes, places, shares, is_split, all: Split::default() };
        let mut all = Split::default();
        rows.add(0..counts.len() as u32, &mut all);
        rows.all = all;
        Some(rows)
    }

    pub fn ranks(&self) -> &dyn Ranks {
        &*self.ranks
    }

    /// The node of each place, ascending.
    pub fn nodes(&self) -> &[u32] {
        &self.nodes
    }

    /// The place of a node, if its row is here.
    pub fn place(&self, node: usize) -> Option<usize> {
        Some(self.places[node]).filter(|&place| place != ELSEWHERE).map(|place| place as usize)
    }

    /// One over the number of processes that have a part of the row at a place.
    pub fn share(&self, place: usize) -> f64 {
        self.shares[place]
    }

    /// All of them.
    pub fn all(&self) -> &Split {
        &self.all
    }

    /// Replaces the parts of what split rows have, in one entry per place, by what `sum` makes of all of them.
    pub fn sum_split<T: Copy>(&self, values: &mut [T], nothing: T, sum: impl Fn(&dyn Ranks, &mut [T])) {
        let part = |&place: &u32| if place == ELSEWHERE { nothing } else { values[place as usize] };
        let mut split: Vec<T> = self.all.split.iter().map(part).collect();
        sum(self.ranks(), &mut split);
        for (&place, sum) in self.all.split.iter().zip(split) {
            if place != ELSEWHERE {
                values[place as usize] = sum;
            }
        }
    }

    /// Adds the rows of some `nodes`, which every process names in the same order.
    pub fn add(&self, nodes: impl Iterator<Item = u32>, rows: &mut Split) {
        for node in nodes {
            let place = self.places[node as usize];
            if self.is_split[node as usize] {
                rows.split.push(place);
            } else if place != ELSEWHERE {
                rows.whole.push(place);
            }
        }
    }

    /// The part of the graph of all nodes that is among these rows, by their places.
    pub fn part_of(&self, graph: &NodeGraph) -> NodeGraph {
        let among = |&node: &u32| graph.row(node as usize).filter_map(|(_, m)| self.place(m));
        NodeGraph::of_ascending(self.nodes.iter().map(|node| among(node).map(|place| place as u32)))
    }
}
