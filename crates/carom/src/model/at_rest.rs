//! What lies still in a step: bodies that rest, and obstacles that do not move.

use carom_contact::{Pair, Solid, Target};

/// What lies still in a step. Two of these are where they were, and need not be looked at.
#[derive(Debug, Clone, Default)]
pub(crate) struct AtRest {
    /// Whether a body rests; of bodies that are not listed none does.
    pub bodies: Vec<bool>,
    /// Whether an obstacle stands still.
    pub obstacles: Vec<bool>,
}

impl AtRest {
    /// Whether it lies still.
    pub fn is_still(&self, solid: Solid) -> bool {
        let (of_kind, number) = match solid {
            Solid::Body(i) => (&self.bodies, i),
            Solid::Obstacle(o) => (&self.obstacles, o),
        };
        of_kind.get(number).is_some_and(|is_still| *is_still)
    }

    /// Whether both solids of a pair do.
    pub fn are_still(&self, pair: &Pair) -> bool {
        let target = match pair.target {
            Target::Surface(t) => Solid::Body(t),
            Target::Obstacle(o) => Solid::Obstacle(o),
        };
        self.is_still(Solid::Body(pair.source)) && self.is_still(target)
    }

    /// Whether nothing moves at all.
    pub fn is_everything(&self) -> bool {
        !self.bodies.is_empty() && self.bodies.iter().chain(&self.obstacles).all(|is_still| *is_still)
    }
}
