//! How much of its inertia holds the corrections of a body back in a load step.

use super::control::LOAD_STEP;

/// The share of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Holding {
    /// What K̄ has of the inertia of the lowest motion.
    pub share: f64,
    /// Below this nothing is to be gained: it was too little in this step.
    least: f64,
    /// How much is left of what holds a body that its supports leave loose.
    pub grip: f64,
    /// Whether K̄ was indefinite without it in this step.
    pub was_indefinite: bool,
}

impl Default for Holding {
    fn default() -> Self {
        Self { share: 0.0, least: 0.0, grip: 1.0, was_indefinite: false }
    }
}

impl Holding {
    /// More of it.
    pub fn raise(&mut self) {
        self.grip = 1.0;
        self.share = (self.share * LOAD_STEP.change).max(LOAD_STEP.first);
    }

    /// More of it, as K̄ was indefinite.
    pub fn raise_for_good(&mut self) {
        self.raise();
        self.least = self.share;
        self.was_indefinite = true;
    }

    /// This `share` at least, to the end of the step.
    pub fn raise_to(&mut self, share: f64) {
        self.share = self.share.max(share);
        self.least = self.share;
    }

    /// Less of it.
    pub fn lower(&mut self) {
        let share = self.share / LOAD_STEP.change;
        self.share = if share < LOAD_STEP.first { self.least } else { share.max(self.least) };
    }

    /// Less of what holds a loose body.
    pub fn loosen(&mut self) {
        self.grip = (self.grip / LOAD_STEP.change).max(LOAD_STEP.loosest);
    }
}
