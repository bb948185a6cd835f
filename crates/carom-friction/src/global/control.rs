//! Every threshold of global problems.

/// How M is factorised, and what the two ways to solve a problem are expected to cost.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Control {
    /// Right-hand sides solved for at once, so that the factor is read once for all of them.
    pub at_once: usize,
    /// Unknowns up to which the inverse is written out.
    pub small: usize,
    /// Error of a known solution, relative to it, from which on no digit of the inverse is trusted.
    pub lost: f64,
    /// Difference of two opposite entries of M, relative to the diagonal ones, up to which it is round-off.
    pub round_off: f64,
    /// Cost of a multiplication in a solve with one right-hand side, compared with one in a factorisation or in a solve with
    /// many (measured: 4 to 8). The former reads the factor from memory.
    pub read: f64,
    /// Iterations of ADMM that are expected: between elastic bodies it takes 15 to 60.
    pub iterations: f64,
    /// Iterations that it is allowed at least before it is given up.
    pub patience: f64,
    /// Factors of M + H ρ Hᵀ that are expected, since penalties are seldom changed, times two for small supernodes.
    pub factors: f64,
    /// Dense factors of W to which solving the condensed problem amounts.
    pub factors_of_w: f64,
    /// Numbers in a W that is never written out unasked: 2 GiB.
    pub largest: f64,
}

/// The thresholds of every global problem.
pub(super) const CONTROL: Control = Control {
    at_once: 48,
    small: 12,
    lost: 1e-2,
    round_off: 32.0 * f64::EPSILON,
    read: 6.0,
    iterations: 30.0,
    patience: 100.0,
    factors: 3.0,
    factors_of_w: 2.0,
    largest: (1u64 << 28) as f64,
};
