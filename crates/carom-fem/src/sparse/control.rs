//! Every size and threshold of inverses.

/// From which sizes on matrices are inverted in blocks, by threads and by polynomials, and how exact a polynomial is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Control {
    /// Nodes from which nested dissection is worth its time: below it, minimum degree makes factors as sparse.
    pub dissected: usize,
    /// Values from which a factor is large: it takes seconds, and a solve a hundredth of that.
    pub large: usize,
    /// Nodes with responses from which a factor is ordered by them: solving for each takes as long as the factor.
    pub gathered: usize,
    /// and up to which it is, in faces of a cube of as many nodes as the body: their part of the factor is full.
    pub faces: f64,
    /// Values of a factor from which it is taken apart.
    pub apart: usize,
    /// A subtree with less than one part in so many of the values is a piece.
    pub share: usize,
    /// With less than one part in so many of the values a subtree is not worth a piece of its own.
    pub small_share: usize,
    /// Columns from which a panel is inverted in blocks, by faer: the large ones of bodies in space.
    pub blocked: usize,
    /// Values of a panel from which threads share its products: it takes several times as long as waking them.
    pub large_panel: usize,
    /// Entries of a graph from which a polynomial may serve better than a factor, which fits in fast memory below.
    pub many: usize,
    /// Part of a right-hand side that the approximate solution may leave over: what an iteration with a kept factor leaves, too.
    pub left: f64,
    /// How far the ends of the spectrum are taken beyond what was measured of it. Beyond the upper end a polynomial explodes, and below the
    /// lower one it is merely less exact.
    pub margins: [f64; 2],
    /// Eigenvalues below this share of the largest may be round-off of the matrix with 16 bits per number.
    pub round_off: f64,
    /// Steps of Lanczos's iteration: both ends are then known to some per cent.
    pub steps: usize,
    /// Below this share of the one before, a vector is round-off: the iteration has found all there is.
    pub nothing: f64,
    /// Entries beyond this a positive definite matrix with a diagonal of 1 cannot have, but for round-off.
    pub largest: f64,
}

/// The sizes and shares of every matrix.
pub(super) const CONTROL: Control = Control {
    dissected: 4000,
    large: 1 << 24,
    gathered: 100,
    faces: 4.0,
    apart: 1 << 21,
    share: 10,
    small_share: 200,
    blocked: 96,
    large_panel: 1 << 16,
    many: 1 << 14,
    left: 0.02,
    margins: [0.9, 1.1],
    round_off: 1e-3,
    steps: 16,
    nothing: 1e-6,
    largest: 1.0 + 1e-6,
};
