//! What a thread keeps while it looks for candidates, pair by pair.

use crate::Candidate;
use crate::edge::Found;
use crate::facing::Projected;

/// Of a group of pairs.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Looking<const D: usize> {
    pub scratch: Scratch<D>,
    /// What it has found.
    pub found: Vec<Candidate>,
}

/// Room for what is asked of one node or pair.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Scratch<const D: usize> {
    /// Facets near a node: how close to it they may come [m], their number, and the size of the box in which they find nodes [m].
    pub near: Vec<(f64, u32, f64)>,
    pub projected: Vec<Projected<D>>,
    /// Edges of a pair that cross.
    pub crossings: Vec<Found>,
}

impl<const D: usize> Default for Looking<D> {
    fn default() -> Self {
        let scratch = Scratch { near: Vec::new(), projected: Vec::new(), crossings: Vec::new() };
        Self { scratch, found: Vec::new() }
    }
}
