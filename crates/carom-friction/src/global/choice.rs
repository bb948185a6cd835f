//! What writing W out costs against doing without it, in multiplications at the rate of dense algebra.

use super::compliance::Compliance;
use super::control::CONTROL;
use crate::sparse_factor::Size;

impl<const D: usize> Compliance<'_, D> {
    /// Writing W out, column by column, and solving the condensed problem. Every part makes a dense block of W.
    pub fn cost_of_condensing(&self) -> f64 {
        let columns = |part| (self.incidence.of_part(part).len() * D) as f64;
        (0..self.inverse.parts.len())
            .map(|p| {
                2.0 * columns(p) * self.inverse.fill(p) + CONTROL.factors_of_w / 3.0 * columns(p).powi(3)
            })
            .sum()
    }

    /// At least what the iterations of ADMM cost: a factor of M + H ρ Hᵀ is hardly smaller than that of M.
    pub fn least_cost_of_admm(&self) -> f64 {
        let fill: f64 = (0..self.inverse.parts.len()).map(|p| self.inverse.fill(p)).sum();
        cost_of_admm(Size { fill, work: 0.0 })
    }

    /// Iterations after which ADMM is given up where W can be written out: when it has cost as much as that would have.
    pub fn patience(&self, size: Size) -> usize {
        let iterations = (self.cost_of_condensing() - CONTROL.factors * size.work) / cost_of_iteration(size);
        iterations.max(CONTROL.patience) as usize
    }

    /// Whether W, of which this is an upper bound, is too large to be stored.
    pub fn is_too_large_to_condense(&self) -> bool {
        let numbers = |part| ((self.incidence.of_part(part).len() * D) as f64).powi(2);
        (0..self.inverse.parts.len()).map(numbers).sum::<f64>() > CONTROL.largest
    }
}

/// The factors and iterations of ADMM.
pub(super) fn cost_of_admm(size: Size) -> f64 {
    CONTROL.factors * size.work + CONTROL.iterations * cost_of_iteration(size)
}

fn cost_of_iteration(size: Size) -> f64 {
    2.0 * CONTROL.read * size.fill
}
