//! Problems that a solver may give up, but not get wrong.

use proptest::prelude::*;

use super::assert_law;
use crate::{
    BlockMatrix, ContactProblem, Criterion, Matrix, SolveReport, SolveStatus, SolverKind, StoppingRule,
    Vector,
};

/// n contacts on as many `modes` as wanted: W = H Hᵀ, which is singular if they are fewer than n D, and q = H v + `opening` n.
/// With an opening > 0 there is a solution, since −v opens every contact; with one < 0 there may be none.
fn redundant<const D: usize>(
    n: usize,
    modes: usize,
    entries: &[f64],
    mu: &[f64],
    opening: f64,
) -> ContactProblem<D> {
    let h =
        nalgebra::DMatrix::from_fn(n * D, modes, |i, k| entries[(i * (modes + 1) + 5 * k) % entries.len()]);
    let v = nalgebra::DVector::from_fn(modes, |k, _| entries[(3 * k + 1) % entries.len()]);
    let (dense, q) = (&h * h.transpose(), &h * v);
    let mut w = BlockMatrix::default();
    for i in 0..n {
        w.push_row((0..n).map(|j| (j, Matrix::from_fn(|a, b| dense[(i * D + a, j * D + b)]))));
    }
    let q =
        (0..n).map(|i| Vector::from_fn(|a, _| q[i * D + a] + if a == 0 { opening } else { 0.0 })).collect();
    ContactProblem { w, q, mu: (0..n).map(|i| mu[i % mu.len()]).collect() }
}

/// The same problem with the reactions of contact i in the unit 1/s_i and its motions in s_i.
fn scaled<const D: usize>(problem: &ContactProblem<D>, s: &[f64]) -> ContactProblem<D> {
    let mut w = BlockMatrix::default();
    for i in 0..problem.len() {
        w.push_row(problem.w.row(i).map(|(j, block)| (j, block * (s[i] * s[j]))));
    }
    let q = problem.q.iter().zip(s).map(|(q, s)| q * *s).collect();
    ContactProblem { w, q, mu: problem.mu.clone() }
}

/// The same problem with a W that is unsymmetric by a few parts in a thousand, as in files written with few digits.
fn skewed<const D: usize>(problem: &ContactProblem<D>) -> ContactProblem<D> {
    let mut w = BlockMatrix::default();
    for i in 0..problem.len() {
        w.push_row(problem.w.row(i).map(|(j, block)| (j, block * (1.0 + 2e-3 * f64::from(u8::from(i < j))))));
    }
    ContactProblem { w, q: problem.q.clone(), mu: problem.mu.clone() }
}

fn solve<const D: usize>(
    kind: SolverKind,
    problem: &ContactProblem<D>,
    rule: &StoppingRule,
) -> (SolveReport, Vec<Vector<D>>) {
    let mut r = vec![Vector::zeros(); problem.len()];
    let report = kind.solver().solve(problem, &mut r, rule);
    let is_finite = r.iter().all(|r| r.iter().all(|x| x.is_finite()));
    assert!(is_finite || report.status == SolveStatus::Diverged, "{kind:?}");
    (report, r)
}

/// Whether the law holds wherever the status says so, in units in which the residual counts: ρ W, ρ q/size and r/size.
fn holds_if_solved<const D: usize>(kind: SolverKind, problem: &ContactProblem<D>) -> bool {
    let rule = StoppingRule { tolerance: 1e-10, max_iterations: 3000, ..Default::default() };
    let (report, mut r) = solve(kind, problem, &rule);
    if report.is_solved() {
        let rho = problem.natural_stiffness();
        let norm = |x: &[Vector<D>]| x.iter().map(Vector::norm_squared).sum::<f64>().sqrt();
        let size = norm(&r).max(rho * norm(&problem.q));
        let mut natural = scaled(problem, &vec![rho.sqrt(); problem.len()]);
        natural.q = problem.q.iter().map(|q| q * (rho / size)).collect();
        r.iter_mut().for_each(|r| *r /= size);
        assert_law(&natural, &r, 1e-8);
    }
    report.is_solved()
}

fn check<const D: usize>(entries: &[f64], mu: &[f64], opening: f64, decades: &[i32]) {
    let (n, modes) = (5, 5 * D - D.min(2) - 1);
    let problem = redundant::<D>(n, modes, entries, mu, opening);
    let s: Vec<f64> = decades.iter().map(|&k| 10f64.powi(k)).collect();
    let problems = [scaled(&problem, &s[..n]), skewed(&problem), problem];
    for problem in &problems {
        for kind in SolverKind::ALL {
            let solved = holds_if_solved(kind, problem);
            assert!(solved || opening < 0.05 || kind != SolverKind::Auto, "auto gives up {problem:?}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]
    #[test]
    fn the_law_holds_or_the_status_says_no(
        entries in proptest::collection::vec(-1.0..1.0, 97),
        mu in proptest::collection::vec(prop_oneof![Just(0.0), 0.05..0.8], 5),
        opening in -0.3..0.3,
        decades in proptest::collection::vec(-3..=3, 5),
    ) {
        check::<1>(&entries, &mu, opening, &decades);
        check::<2>(&entries, &mu, opening, &decades);
        check::<3>(&entries, &mu, opening, &decades);
    }
}

/// A pile of redundant contacts with moderate friction is within the reach of every method.
#[test]
fn redundant_contacts_are_solved_by_all() {
    let entries: Vec<f64> = (0..89).map(|k| (f64::from(k) * 1.7).sin()).collect();
    for kind in SolverKind::ALL {
        let problem = redundant::<3>(8, 12, &entries, &[0.0, 0.2, 0.3], 0.2);
        assert!(holds_if_solved(kind, &problem), "{kind:?}");
    }
}

/// Lengths in millimetres and forces in kilonewtons instead of metres and newtons.
#[test]
fn other_units_give_the_same_answer() {
    let entries: Vec<f64> = (0..61).map(|k| (f64::from(k) * 2.3).sin()).collect();
    let (length, force) = (1e3_f64, 1e-3);
    let problem = super::problem::<3>(5, 20, &entries, 1.0, 0.1);
    let mut other = scaled(&problem, &[(length / force).sqrt(); 5]);
    other.q = problem.q.iter().map(|q| q * length).collect();
    let rule = StoppingRule { tolerance: 1e-12, criterion: Criterion::Natural, ..Default::default() };
    for kind in SolverKind::ALL {
        let (report, r) = solve(kind, &problem, &rule);
        let (other_report, other_r) = solve(kind, &other, &rule);
        assert!(report.is_solved() && other_report.is_solved(), "{kind:?}");
        for (a, b) in r.iter().zip(&other_r) {
            assert!((a * force - b).norm() <= 1e-8 * force, "{kind:?}: {a} and {b}");
        }
    }
}

/// Contacts between bodies that cannot move do not disturb the others; apart they are no trouble, overlapping they cannot be solved.
#[test]
fn contacts_that_nothing_can_move_have_no_reaction() {
    for kind in SolverKind::ALL {
        for (gap, solvable) in [(0.3, true), (0.0, true), (-0.3, false)] {
            let mut w = BlockMatrix::default();
            w.push_row([(0, Matrix::<2>::identity())]);
            w.push_row([(1, Matrix::zeros())]);
            let q = vec![Vector::<2>::new(-1.0, 0.2), Vector::<2>::new(gap, 0.1)];
            let problem = ContactProblem { w, q, mu: vec![0.5; 2] };
            let rule = StoppingRule { max_iterations: 5000, ..Default::default() };
            let (report, r) = solve(kind, &problem, &rule);
            assert_eq!(report.is_solved(), solvable, "{kind:?} with gap {gap}: {report:?}");
            if solvable {
                assert!((r[0] - Vector::<2>::new(1.0, -0.2)).norm() < 1e-7, "{kind:?}");
                assert!(r[1].norm() < 1e-7, "{kind:?}");
            }
        }
    }
}

/// A body squeezed between two walls that are closer than it is wide.
///
/// Symptom guarded against: reactions grew without bound, the residual relative to them fell, and the answer passed for one.
#[test]
fn a_squeezed_body_is_never_a_success() {
    for kind in SolverKind::ALL {
        let mut w = BlockMatrix::<2>::default();
        let (plus, minus) = (Matrix::identity(), Matrix::<2>::new(-1.0, 0.0, 0.0, 1.0));
        w.push_row([(0, plus), (1, minus)]);
        w.push_row([(0, minus), (1, plus)]);
        let problem = ContactProblem { w, q: vec![Vector::<2>::new(-1.0, 0.0); 2], mu: vec![0.3; 2] };
        let (report, _) = solve(kind, &problem, &StoppingRule::default());
        assert!(!report.is_solved(), "{kind:?}: {report:?}");
    }
}
