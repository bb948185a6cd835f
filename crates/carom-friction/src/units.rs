//! Units in which squares neither overflow nor vanish.

use crate::stopping::Monitor;
use crate::{
    BlockMatrix, ContactProblem, Matrix, SolveReport, SolveStatus, SolverKind, StoppingRule, Vector,
};

/// Powers of two in which the motions and reactions of a problem are counted: w = 2^motion w′ and r = 2^force r′.
///
/// Whatever is computed of w′ and r′ is, but for these powers, the same to the last bit: also the square roots, since the
/// unit of compliance is a power of four.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Units {
    pub motion: i32,
    pub force: i32,
}

/// Largest exponent of the largest number of W and of that of q up to which a problem is solved in its own units: fourth powers of
/// all that is computed of them are numbers still.
const COMFORTABLE: i32 = 100;
/// Largest exponent of the stiffness that counts as 1 (see [`StoppingRule::unit`]): beyond, one of the two is lost beside the other.
const LARGEST_UNIT: i32 = 300;

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
        if compliance.abs() <= COMFORTABLE && motion.abs() <= COMFORTABLE {
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
        let largest = power_of_two(LARGEST_UNIT);
        times_power(unit, self.motion - self.force).clamp(1.0 / largest, largest)
    }

    /// An energy in the problem's own units.
    pub fn leave_energy(self, energy: f64) -> f64 {
        times_power(energy, self.motion + self.force)
    }
}

/// Solves `problem` by `run` in units in which that is safe. What is reported is measured of the reactions as they are handed back.
pub(crate) fn solve<const D: usize>(
    problem: &ContactProblem<D>,
    r: &mut [Vector<D>],
    rule: &StoppingRule,
    run: impl FnOnce(&mut Monitor<'_, D>, &mut [Vector<D>]) -> (SolverKind, SolveStatus),
) -> SolveReport {
    let clock = rule.clock();
    let units = Units::of(problem);
    if units.are_own() {
        let mut monitor = Monitor::new(problem, rule, clock);
        drop_idle_reactions(&mut monitor, r);
        let (kind, status) = run(&mut monitor, r);
        return monitor.report(kind, status, r);
    }
    let scaled = units.enter(problem);
    units.enter_reactions(r);
    let rule = StoppingRule { unit: units.stiffness(rule.unit), ..*rule };
    let mut monitor = Monitor::new(&scaled, &rule, clock);
    drop_idle_reactions(&mut monitor, r);
    let (kind, status) = run(&mut monitor, r);
    // There and back again: the answer is judged as the caller gets it.
    units.leave_reactions(r);
    let mut returned = r.to_vec();
    units.enter_reactions(&mut returned);
    let mut report = monitor.report(kind, status, &returned);
    report.measure.certificate = units.leave_energy(report.measure.certificate);
    report
}

/// Where no motions call for reactions none are an answer, and the residual of any others has nothing to be small beside.
fn drop_idle_reactions<const D: usize>(monitor: &mut Monitor<'_, D>, r: &mut [Vector<D>]) {
    let is_idle = monitor.problem().q.iter().all(|q| q.iter().all(|x| *x == 0.0));
    if is_idle && !monitor.is_solved_by(r) {
        r.fill(Vector::zeros());
    }
}

/// The exponent e of a finite x ≠ 0 with 2^e ≤ |x| < 2^(e+1).
pub(crate) fn exponent(x: f64) -> i32 {
    let biased = |x: f64| ((x.to_bits() >> 52) & 0x7ff) as i32 - 1023;
    if x.is_normal() { biased(x) } else { biased(x * power_of_two(100)) - 100 }
}

/// 2^k, for k from −1022 to 1023.
pub(crate) fn power_of_two(k: i32) -> f64 {
    debug_assert!((-1022..=1023).contains(&k));
    f64::from_bits(((k + 1023) as u64) << 52)
}

/// x 2^k for any k.
pub(crate) fn times_power(mut x: f64, mut k: i32) -> f64 {
    while k.abs() > 1000 {
        x *= power_of_two(1000 * k.signum());
        k -= 1000 * k.signum();
    }
    x * power_of_two(k)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponents_are_those_of_the_binary_point() {
        for (x, e) in [(1.0, 0), (1.99, 0), (2.0, 1), (0.5, -1), (-3.0, 1), (f64::MAX, 1023)] {
            assert_eq!(exponent(x), e);
        }
        assert_eq!(exponent(f64::MIN_POSITIVE / 4.0), -1024);
        assert_eq!(exponent(5e-324), -1074);
        assert_eq!(times_power(5e-324, 1074), 1.0);
        assert_eq!(times_power(1.5, -2000), 0.0);
        assert_eq!(times_power(-3.0, 2), -12.0);
        assert_eq!(times_power(times_power(3.0, -1021), 2000), 3.0 * power_of_two(979));
    }

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
