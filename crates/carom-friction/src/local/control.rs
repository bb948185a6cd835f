//! Every threshold of the solvers of a single contact.

/// How long a single contact is worked at, and what passes for exact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Control {
    /// Condition number from which on a block counts as singular.
    pub singular: f64,
    /// Steps of the fixed point before the sweep goes on; neighbours change the data anyway.
    pub steps: usize,
    /// Newton's iterations before the fixed point takes over.
    pub iterations: usize,
    /// Lengths that their line search tries, each half of the one before.
    pub halvings: usize,
    /// Error of a closed form, relative to r and ρ b, that round-off explains.
    pub round_off: f64,
}

/// The thresholds of every contact.
pub(super) const CONTROL: Control =
    Control { singular: 1e12, steps: 20, iterations: 10, halvings: 5, round_off: 1e-13 };
