//! Linear combinations of nodes.

use crate::path::Positions;
use carom_mesh::Vector;

/// Weights of nodes, ascending by node: a point of the body where they sum to 1, a difference of points where they sum to 0.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Combination(Vec<(u32, f64)>);

impl Combination {
    /// The position of a node.
    pub fn of(node: u32) -> Self {
        Self(vec![(node, 1.0)])
    }

    /// The way from a node to another.
    pub fn between(from: u32, to: u32) -> Self {
        Self::of(to).plus(-1.0, &Self::of(from))
    }

    /// The sum of these terms.
    pub fn sum<'a>(terms: impl IntoIterator<Item = (f64, &'a Self)>) -> Self {
        terms.into_iter().fold(Self::default(), |sum, (factor, term)| sum.plus(factor, term))
    }

    /// The same and `factor` times another.
    pub fn plus(&self, factor: f64, other: &Self) -> Self {
        let mut terms = self.0.clone();
        for &(node, weight) in &other.0 {
            match terms.binary_search_by_key(&node, |&(n, _)| n) {
                Ok(k) => terms[k].1 += factor * weight,
                Err(k) => terms.insert(k, (node, factor * weight)),
            }
        }
        Self(terms)
    }

    /// Its nodes with their weights.
    pub fn terms(&self) -> impl Iterator<Item = (u32, f64)> {
        self.0.iter().copied()
    }

    /// What it is where nodes are at `position` [m].
    pub fn at<const D: usize>(&self, position: &Positions<'_, D>) -> Vector<D> {
        self.0.iter().fold(Vector::zeros(), |sum, &(node, weight)| sum + position(node) * weight)
    }
}
