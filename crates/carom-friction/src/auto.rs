use std::ops::RangeInclusive;

use crate::block_lu::NoStructure;
use crate::local::Enumerative;
use crate::newton::Newton;
use crate::proximal::Strategy;
use crate::stopping::Monitor;
use crate::{
    ContactProblem, FrictionSolver, SolveReport, SolveStatus, SolverKind, StoppingRule, Vector, admm,
    gauss_seidel, scaled, uzawa,
};

/// Starts cheaply and escalates where that does not converge; the default.
///
/// Of many contacts that answer mostly to their own reactions, Uzawa's iteration, on all of them at once, takes more iterations than sweeps do, but less time.
///
/// Elsewhere a few accelerated Gauss–Seidel sweeps solve well-conditioned problems and improve the start of others. They go on while they promise
/// to end soon. Of many contacts, from a good start, a few of Newton's iterations come next: what is left over is which of the contacts
/// stick, slip and are open, and sweeps carry that through a pile one contact at a time. Where a few do not do, those on the natural map set out from the
/// start again: from where sweeps have led they take longer. Else sweeps go on while they are a small part of
/// what Newton's method would cost. Contacts that are densely coupled have full factors and make sweeps slow. There ADMM, which needs one
/// factor, is tried instead, unless the contacts answer mostly to their own reactions. It forgets its start: from a good one a few of
/// Newton's iterations come first there, too.
///
/// Then comes the proximal point method with Newton's iterations, and where that is trapped, sweeps again: in turn, until the problem is
/// solved or the limits are reached. Where the factors would outgrow the problem, as those of large piles do, Uzawa's iteration takes
/// over.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Auto;

/// What is tried for how long.
#[derive(Debug, Clone, PartialEq)]
struct Control {
    /// Contacts from which the iteration on all at once comes before sweeps, if they are local and have so many blocks each. Its cost is products with W, that
    /// of sweeps what is solved contact by contact. With fewer blocks contacts are those of piles, where it leads nowhere. Measured in space: with 5,041
    /// contacts of a block on a floor, 47 or 51 blocks each, it takes 0.6 of the time, with 441 of 41 nine tenths, and five quarters with 441 that all feel one
    /// another.
    many: usize,
    /// See `many`.
    blocks_of_each: RangeInclusive<usize>,
    /// Iterations that it is given.
    at_once: usize,
    /// Sweeps before anything else is considered: about the cost of ordering the contacts for Newton's method.
    first_sweeps: usize,
    /// Sweeps that those already made may promise to end within.
    promised_sweeps: f64,
    /// Blocks per contact from which contacts are thought to be redundant: many between few bodies.
    dense: usize,
    /// Coupling of a contact to all others, relative to its own compliance, up to which it is local.
    local: f64,
    /// A residual below which a start is a good one, and the factors that Newton's iterations may take from there: they take one to four.
    good_start: f64,
    from_good_start: usize,
    /// The same of piles where these do not do, from the guess that was given.
    from_start: usize,
    /// Contacts from which sweeps take long to carry what is left over from one end to the other.
    pile: usize,
    /// Iterations of ADMM, with one factor or two, that are tried before Newton's method renews its factors again and again.
    directions: usize,
    /// Cost of the sweeps that are tried before Newton's method, in iterations of it.
    sweeps_worth: usize,
    /// Blocks of the factors per block of W above which they are thought to outgrow the problem.
    fill: usize,
    /// A share of iterations for each method when they take turns: of Newton's, and sweeps.
    turn: (usize, usize),
}

/// The thresholds of every run.
const CONTROL: Control = Control {
    many: 400,
    blocks_of_each: 40..=100,
    at_once: 60,
    first_sweeps: 10,
    promised_sweeps: 60.0,
    dense: 12,
    local: 4.0,
    good_start: 0.1,
    from_good_start: 6,
    from_start: 1000,
    pile: 200,
    directions: 60,
    sweeps_worth: 5,
    fill: 8,
    turn: (1000, 500),
};

impl<const D: usize> FrictionSolver<D> for Auto {
    fn solve(&self, problem: &ContactProblem<D>, r: &mut [Vector<D>], rule: &StoppingRule) -> SolveReport {
        scaled::solve(problem, r, rule, run)
    }
}

/// Whether contacts answer mostly to their own reactions, however many others they feel. Sweeps then converge fast, and what they
/// leave in the residual is as small in the reactions.
fn is_local<const D: usize>(problem: &ContactProblem<D>) -> bool {
    (0..problem.len()).all(|i| {
        let sum: f64 = problem.w.row(i).map(|(_, block)| block.norm()).sum();
        sum <= (1.0 + CONTROL.local) * problem.w.diagonal(i).norm()
    })
}

fn run<const D: usize>(monitor: &mut Monitor<'_, D>, r: &mut [Vector<D>]) -> (SolverKind, SolveStatus) {
    let problem = monitor.problem();
    let sweep = |monitor: &mut Monitor<'_, D>, r: &mut [Vector<D>], sweeps| {
        gauss_seidel::run::<D, Enumerative>(monitor, r, sweeps)
            .map(|status| (SolverKind::GaussSeidelEnumerative, status))
    };
    let blocks = problem.w.block_count();
    let local = is_local(problem);
    let dense = blocks > CONTROL.dense * problem.len() && !local;
    let is_surface =
        local && problem.len() >= CONTROL.many && CONTROL.blocks_of_each.contains(&(blocks / problem.len()));
    let is_pile = !dense && problem.len() >= CONTROL.pile;
    let start = if is_surface || is_pile { r.to_vec() } else { Vec::new() };
    if is_surface {
        match uzawa::run(monitor, r, CONTROL.at_once) {
            Some(SolveStatus::Diverged | SolveStatus::Stalled) | None => r.copy_from_slice(&start),
            Some(status) => return (SolverKind::Uzawa, status),
        }
    }
    let first = if dense {
        monitor.check(r).map(|status| (SolverKind::Admm, status))
    } else {
        sweep(monitor, r, CONTROL.first_sweeps)
    };
    if let Some(end) = first {
        return end;
    }
    if is_surface && let Some(status) = monitor.check(r) {
        // After so many iterations sweeps are measured seldom.
        return (SolverKind::GaussSeidelEnumerative, status);
    }
    while local && monitor.expected_iterations() < CONTROL.promised_sweeps {
        if let Some(end) = sweep(monitor, r, CONTROL.first_sweeps) {
            return end;
        }
    }
    let mut newton = match Newton::new(problem, CONTROL.fill * (blocks + problem.len()), monitor.clock()) {
        Ok(newton) => newton,
        Err(NoStructure::TimeIsUp) => return (SolverKind::Proximal, SolveStatus::TimeLimit),
        Err(NoStructure::TooLarge) => {
            let status = uzawa::run(monitor, r, usize::MAX);
            return (SolverKind::Uzawa, status.unwrap_or(SolveStatus::Stalled));
        }
    };
    let sweeps = CONTROL.sweeps_worth * newton.cost(problem) / gauss_seidel::cost(problem);
    let are_slow = sweeps > 5 * CONTROL.first_sweeps;
    let is_near = monitor.residual() < CONTROL.good_start;
    if is_near && (problem.len() >= CONTROL.pile || dense && are_slow) {
        let status = Strategy::NEWTON.run(monitor, &mut newton, r, CONTROL.from_good_start);
        if status != SolveStatus::IterationLimit {
            return (SolverKind::NewtonAlartCurnier, status);
        }
        if let Some(status) = monitor.exhausted() {
            return (SolverKind::NewtonAlartCurnier, status);
        }
        if is_pile {
            r.copy_from_slice(&start);
            // The residual is that of the start, to which what is tried is relative.
            if let Some(status) = monitor.check(r) {
                return (SolverKind::NewtonNaturalMap, status);
            }
            let status = Strategy::PILE.run(monitor, &mut newton, r, CONTROL.from_start);
            if !matches!(status, SolveStatus::IterationLimit | SolveStatus::Stalled) {
                return (SolverKind::NewtonNaturalMap, status);
            }
        }
    }
    if are_slow {
        if dense {
            match admm::run(monitor, r, CONTROL.directions) {
                // A factor that would take longer than what is left of the time: others may use it.
                Some(SolveStatus::TimeLimit) if !monitor.clock().is_over() => {}
                Some(status) => return (SolverKind::Admm, status),
                None => {}
            }
        } else if let Some(end) = sweep(monitor, r, sweeps - CONTROL.first_sweeps) {
            return end;
        }
    }
    loop {
        let status = Strategy::PROXIMAL.run(monitor, &mut newton, r, CONTROL.turn.0);
        if status != SolveStatus::IterationLimit || monitor.exhausted().is_some() {
            return (SolverKind::Proximal, status);
        }
        if let Some(end) = sweep(monitor, r, CONTROL.turn.1) {
            return end;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{BlockMatrix, Matrix};

    /// A tall stack whose guess is nearly right: sweeps would carry what is left over from one end to the other.
    #[test]
    fn a_good_start_ends_in_a_few_of_newtons_iterations() {
        let n = 400;
        let mut w = BlockMatrix::<2>::default();
        for i in 0..n {
            let block = |j: usize| Matrix::identity() * if i == j { 2.0 } else { -1.0 };
            w.push_row((i.saturating_sub(1)..(i + 2).min(n)).map(|j| (j, block(j))));
        }
        let q = (0..n).map(|i| Vector::<2>::new(-1.0, 0.3 * (0.05 * i as f64).sin())).collect();
        let problem = ContactProblem { w, q, mu: vec![0.2; n] };
        let rule = StoppingRule { tolerance: 1e-12, ..StoppingRule::default() };
        let mut r = vec![Vector::zeros(); n];
        assert!(Auto.solve(&problem, &mut r, &rule).is_solved());
        for (i, r) in r.iter_mut().enumerate() {
            *r *= 1.0 + 1e-6 * (0.1 * i as f64).sin();
        }
        let report = Auto.solve(&problem, &mut r, &rule);
        assert!(report.is_solved());
        assert_eq!(report.solver, SolverKind::NewtonAlartCurnier);
        let most = 2 * CONTROL.first_sweeps + CONTROL.from_good_start;
        assert!(report.iterations <= most, "{} iterations", report.iterations);
    }

    /// A long row of contacts, each of which feels those near it, pressed and pushed along.
    #[test]
    fn many_local_contacts_are_solved_at_once_with_the_same_bits_by_any_number_of_threads() {
        let (n, reach) = (1600_usize, 22);
        let mut w = BlockMatrix::<3>::default();
        for i in 0..n {
            let block = |j: usize| Matrix::identity() * 0.6_f64.powi(i.abs_diff(j) as i32);
            w.push_row((i.saturating_sub(reach)..(i + reach + 1).min(n)).map(|j| (j, block(j))));
        }
        let push =
            |i: usize| Vector::<3>::new(-1.0, 0.4 * (0.01 * i as f64).sin(), 0.1 * (0.02 * i as f64).cos());
        let problem = ContactProblem { w, q: (0..n).map(push).collect(), mu: vec![0.3; n] };
        let solve = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            let mut r = vec![Vector::zeros(); n];
            let report = pool.install(|| {
                assert_eq!(problem.w.is_shared(), threads > 1);
                Auto.solve(&problem, &mut r, &StoppingRule::default())
            });
            assert!(report.is_solved() && report.solver == SolverKind::Uzawa, "{report:?}");
            (report.measure, r)
        };
        let one = solve(1);
        assert!(one.1.iter().any(|r| r[1] > 0.29 * r[0]) && one.1.iter().any(|r| r[1].abs() < 0.2 * r[0]));
        assert_eq!(solve(2), one);
        assert_eq!(solve(3), one);
    }
}
