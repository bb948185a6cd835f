//! What writing W out costs against doing without it, in multiplications at the rate of dense algebra.

use super::compliance::Compliance;
use crate::sparse_factor::Size;

/// Cost of a multiplication in a solve with one right-hand side, which reads the factor from memory, compared with one
/// in a factorisation or in a solve with many right-hand sides (measured: 4 to 8).
const READ: f64 = 6.0;
/// Iterations of ADMM that are expected: between elastic bodies it takes 15 to 60.
const ITERATIONS: f64 = 30.0;
/// Iterations that it is allowed at least before it is given up.
const PATIENCE: f64 = 100.0;
/// Factors of M + H ρ Hᵀ that are expected, since penalties are seldom changed, times two for small supernodes.
const FACTORS: f64 = 3.0;
/// Dense factors of W to which solving the condensed problem amounts.
const FACTORS_OF_W: f64 = 2.0;

/// Numbers in a W that is never written out unasked: 2 GiB.
const LARGEST: f64 = (1u64 << 28) as f64;

impl<const D: usize> Compliance<'_, D> {
    /// Writing W out, column by column, and solving the condensed problem. Every part makes a dense block of W.
    pub fn cost_of_condensing(&self) -> f64 {
        let columns = |part| (self.incidence.of_part(part).len() * D) as f64;
        (0..self.inverse.parts.len())
            .map(|p| 2.0 * columns(p) * self.inverse.fill(p) + FACTORS_OF_W / 3.0 * columns(p).powi(3))
            .sum()
    }

    /// At least what the iterations of ADMM cost: a factor of M + H ρ Hᵀ is hardly smaller than that of M.
    pub fn least_cost_of_admm(&self) -> f64 {
        let fill: f64 = (0..self.inverse.parts.len()).map(|p| self.inverse.fill(p)).sum();
        cost_of_admm(Size { fill, work: 0.0 })
    }

    /// Iterations after which ADMM is given up where W can be written out: when it has cost as much as that would have.
    pub fn patience(&self, size: Size) -> usize {
        let iterations = (self.cost_of_condensing() - FACTORS * size.work) / cost_of_iteration(size);
        iterations.max(PATIENCE) as usize
    }

    /// Whether W, of which this is an upper bound, is too large to be stored.
    pub fn is_too_large_to_condense(&self) -> bool {
        let numbers = |part| ((self.incidence.of_part(part).len() * D) as f64).powi(2);
        (0..self.inverse.parts.len()).map(numbers).sum::<f64>() > LARGEST
    }
}

/// The factors and iterations of ADMM.
pub(super) fn cost_of_admm(size: Size) -> f64 {
    FACTORS * size.work + ITERATIONS * cost_of_iteration(size)
}

fn cost_of_iteration(size: Size) -> f64 {
    2.0 * READ * size.fill
}
