use faer::sparse::SparseColMat;

use super::problem::GlobalProblem;
use crate::Vector;
use crate::binary::{exponent, times_power};
use crate::units::{LARGEST, Units};

/// Powers of two in which a global problem is counted: M = 2^m M′, H = 2^h H′, and motions and reactions in [`Units`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct GlobalUnits {
    m: i32,
    h: i32,
    pub contacts: Units,
}

impl GlobalUnits {
    /// The units of `problem`: its own, unless they are out of all proportion.
    pub fn of<const D: usize>(problem: &GlobalProblem<D>) -> Self {
        let largest = |values: &[f64]| values.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
        let b = problem.b.iter().map(Vector::amax).fold(0.0, f64::max);
        let sizes = [largest(problem.m.val()), largest(problem.h.val()), largest(&problem.f), b];
        let [m, h, f, b] = sizes.map(|x| (x > 0.0 && x.is_finite()).then(|| exponent(x)));
        if [m, h, f, b].into_iter().flatten().all(|e| e.abs() <= LARGEST.global) {
            return Self::default();
        }
        // A power of four, so that the roots of compliances are exact.
        let (m, h) = (m.unwrap_or(0), h.unwrap_or(0));
        let m = m - m.rem_euclid(2);
        let motion = b.max(f.map(|f| h + f - m)).unwrap_or(0);
        Self { m, h, contacts: Units { motion, force: motion + m - 2 * h } }
    }

    pub fn are_own(self) -> bool {
        self == Self::default()
    }

    /// The unit of the velocities.
    fn velocity(self) -> i32 {
        self.contacts.motion - self.h
    }

    /// The problem in these units.
    pub fn enter<const D: usize>(self, problem: &GlobalProblem<D>) -> GlobalProblem<D> {
        let scaled = |matrix: &SparseColMat<usize, f64>, k: i32| {
            let mut matrix = matrix.clone();
            matrix.val_mut().iter_mut().for_each(|x| *x = times_power(*x, k));
            matrix
        };
        let (load, motion) = (-self.velocity() - self.m, -self.contacts.motion);
        GlobalProblem {
            m: scaled(&problem.m, -self.m),
            h: scaled(&problem.h, -self.h),
            f: problem.f.iter().map(|x| times_power(*x, load)).collect(),
            b: problem.b.iter().map(|b| b.map(|x| times_power(x, motion))).collect(),
            mu: problem.mu.clone(),
        }
    }

    /// Velocities and motions in the problem's own units.
    pub fn leave<const D: usize>(self, velocities: &mut [f64], motions: &mut [Vector<D>]) {
        velocities.iter_mut().for_each(|x| *x = times_power(*x, self.velocity()));
        motions.iter_mut().for_each(|w| w.apply(|x| *x = times_power(*x, self.contacts.motion)));
    }
}
