use smallvec::SmallVec;

use super::Line;
use super::line::held;
use crate::path::Positions;

/// An edge by the nodes that it follows, in the sense in which one goes along it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Strand {
    /// Its ends.
    pub nodes: [u32; 2],
    /// The curve that it is half of, beside facets of second order.
    pub bow: Option<Bow>,
}

/// The rest of a curve of second order.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Bow {
    /// The end of the curve that its half does not have.
    pub far: u32,
    /// Which end of the half is the node between the ends of the curve.
    pub between: usize,
}

impl Strand {
    /// The straight one between two nodes.
    pub fn straight(nodes: [u32; 2]) -> Self {
        Self { nodes, bow: None }
    }

    /// The same edge the other way.
    pub fn reversed(self) -> Self {
        let [a, b] = self.nodes;
        let bow = self.bow.map(|bow| Bow { between: 1 - bow.between, ..bow });
        Self { nodes: [b, a], bow }
    }

    /// Where it is.
    pub fn line<const D: usize>(&self, position: &Positions<'_, D>) -> Line<D> {
        let ends = self.nodes.map(position);
        let straight = Line::straight(ends);
        self.bow.map_or(straight, |Bow { far, between }| Line {
            bow: (ends[1 - between] + position(far)) * 0.5 - ends[between],
            ..straight
        })
    }

    /// The nodes that its point at s follows, and how much of it each is.
    pub fn weights(&self, s: f64) -> SmallVec<[(u32, f64); 3]> {
        let [a, b] = self.nodes;
        let mut weights = SmallVec::<[(u32, f64); 3]>::from_iter([(a, 1.0 - s), (b, s)]);
        if let Some(Bow { far, between }) = self.bow {
            let (held, rest) = held(s);
            let bent = 0.5 * (held * (1.0 - held) + (1.0 - 2.0 * held) * rest);
            weights[1 - between].1 -= bent;
            weights[between].1 += 2.0 * bent;
            weights.push((far, -bent));
        }
        weights
    }
}
