//! Units in which squares neither overflow nor vanish.

use crate::binary::{exponent, power_of_two, times_power};
use crate::{BlockMatrix, ContactProblem, Matrix, Vector};

/// Powers of two in which the motions and reactions of a problem are counted: w = 2^motion w′ and r = 2^force r′.
///
/// But for these powers, whatever is computed of w′ and r′ is the same to the last bit. That includes square roots, since
/// the unit of compliance is a power of four.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Units {
    pub motion: i32,
    pub force: i32,
}

/// Powers of two beyond which numbers are counted in other units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Exponents {
    /// Largest exponent of the largest number of W and of that of q up to which a problem is solved in its own units. Fourth powers of
    /// everything computed from them are still finite numbers.
    pub condensed: i32,
    /// The same of the largest numbers of M, H, f and b of a global problem.
    pub global: i32,
    /// Largest exponent of the stiffness that counts as 1 (see [`unit`](crate::StoppingRule::unit)): beyond, one of the two is lost beside
    /// the other.
    pub unit: i32,
}

/// Of every problem.
pub(crate) const LARGEST: Exponents = Exponents { condensed: 100, global: 50, unit: 300 };

impl Units {
    /// The units of `problem`: its own, unless they are out of all proportion.
    pub fn of<const D: usize>(problem: &ContactProblem<D>) -> Self {
        let q = problem.q.iter().map(Vector::amax).fold(0.0, f64::max);
        // No number of a semidefinite matrix is larger than those on its diagonal.
        let w = (0..problem.len()).map(|i| problem.w.diagonal(i).amax()).fold(0.0, f64::max);
        Self::from_largest(w, q)
    }

    /// Units for problems with these largest numbers of W and q. Nothing is needed of a zero, and nothing helps what is not finite.
    pub fn from_largest(w: f64, q: f64) -> Self {
        let exponent = |x: f64| if x > 0.0 && x.is_finite() { exponent(x) } else { 0 };
        let (compliance, motion) = (exponent(w), exponent(q));
        if compliance.abs() <= LARGEST.condensed && motion.abs() <= LARGEST.condensed {
            return Self::default();
        }
        Self { motion, force: motion - (compliance - compliance.rem_euclid(2)) }
    }

    /// Whether they are the problem's own.
    pub fn are_own(self) -> bool {
        self == Self::default()
    }

    /// The problem in these units.
    pub fn enter<const D: usize>(self, problem: &ContactProblem<D>) -> ContactProblem<D> {
        let scale = |x: f64| times_power(x, self.force - self.motion);
        let mut w = BlockMatrix::default();
        for i in 0..problem.len() {
            w.push_row(problem.w.row(i).map(|(j, block): (usize, &Matrix<D>)| (j, block.map(scale))));
        }
        let q = problem.q.iter().map(|q| q.map(|x| times_power(x, -self.motion))).collect();
        ContactProblem { w, q, mu: problem.mu.clone() }
    }

    /// Reactions in these units.
    pub fn enter_reactions<const D: usize>(self, r: &mut [Vector<D>]) {
        r.iter_mut().for_each(|r| r.apply(|x| *x = times_power(*x, -self.force)));
    }

    /// Reactions in the problem's own units: what is too large or too small for a number there becomes infinite or zero.
    pub fn leave_reactions<const D: usize>(self, r: &mut [Vector<D>]) {
        r.iter_mut().for_each(|r| r.apply(|x| *x = times_power(*x, self.force)));
    }

    /// In these units the stiffness that is `unit` in the problem's own.
    pub fn stiffness(self, unit: f64) -> f64 {
        let largest = power_of_two(LARGEST.unit);
        times_power(unit, self.motion - self.force).clamp(1.0 / largest, largest)
    }

    /// An energy in the problem's own units.
    pub fn leave_energy(self, energy: f64) -> f64 {
        times_power(energy, self.motion + self.force)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_are_left_alone_unless_out_of_proportion() {
        for (w, q) in [(1.0, 1.0), (0.0, 0.0), (1e-30, 1e30), (f64::INFINITY, 1.0), (1.0, f64::NAN)] {
            assert!(Units::from_largest(w, q).are_own(), "{w:e} {q:e}");
        }
        for (w, q) in [(1.0, 1e-31), (1.0, 1e31), (1e-31, 0.0), (1e31, 1.0), (5e-324, 1e308)] {
            let units = Units::from_largest(w, q);
            let compliance = times_power(w, units.force - units.motion);
            assert!((1.0..4.0).contains(&compliance), "{w:e} {q:e}");
            assert!(q == 0.0 || (1.0..2.0).contains(&times_power(q, -units.motion)));
            assert_eq!((units.force - units.motion).rem_euclid(2), 0, "roots of powers of four are exact");
        }
    }
}
