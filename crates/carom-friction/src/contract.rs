//! What every solver must do. A new solver is proved by its line in `SolverKind::ALL`.

mod extreme;
mod hard;

use proptest::prelude::*;

use crate::{BlockMatrix, ContactProblem, Matrix, SolveStatus, SolverKind, StoppingRule, Vector, cone};

/// So strict that answers can be compared with closed forms.
fn strict() -> StoppingRule {
    StoppingRule { tolerance: 1e-12, ..Default::default() }
}

/// W = A Aᵀ + ε I of n contacts on `modes` modes, from a list of numbers.
fn problem<const D: usize>(
    n: usize,
    modes: usize,
    entries: &[f64],
    shift: f64,
    mu: f64,
) -> ContactProblem<D> {
    let rows = nalgebra::DMatrix::from_fn(n * D, modes, |i, k| entries[(i * modes + 7 * k) % entries.len()]);
    let dense = &rows * rows.transpose() + nalgebra::DMatrix::identity(n * D, n * D) * shift;
    let mut w = BlockMatrix::default();
    for i in 0..n {
        w.push_row((0..n).map(|j| (j, Matrix::from_fn(|a, b| dense[(i * D + a, j * D + b)]))));
    }
    let q = (0..n).map(|i| Vector::from_fn(|k, _| entries[(i * D + k + 11) % entries.len()])).collect();
    ContactProblem { w, q, mu: vec![mu; n] }
}

/// Signorini's and Coulomb's laws, checked one by one and not through the solver's own measure.
pub(crate) fn assert_law<const D: usize>(problem: &ContactProblem<D>, r: &[Vector<D>], tolerance: f64) {
    for i in 0..problem.len() {
        let w = problem.motion(i, r);
        let (mu, slip) = (problem.mu[i], cone::tangential_norm(&w));
        assert!(r[i][0] >= 0.0, "contact {i} pulls");
        assert!(w[0] >= -tolerance, "contact {i} penetrates: {}", w[0]);
        assert!((w[0] * r[i][0]).abs() <= tolerance, "contact {i} pushes while open");
        assert!(cone::tangential_norm(&r[i]) <= mu * r[i][0] + tolerance, "contact {i} leaves the cone");
        if slip > tolerance.sqrt() {
            let expected = -mu * r[i][0];
            for t in 1..D {
                assert!(
                    (r[i][t] - expected * w[t] / slip).abs() <= tolerance.sqrt(),
                    "contact {i} slips askew"
                );
            }
        }
    }
}

fn check<const D: usize>(entries: &[f64], mu: f64) {
    let problem = problem::<D>(4, 9, entries, 0.3, mu);
    let rule = StoppingRule { tolerance: 1e-11, max_iterations: 200_000, ..Default::default() };
    let mut answers: Vec<Vec<Vector<D>>> = Vec::new();
    for kind in SolverKind::ALL {
        let mut r = vec![Vector::zeros(); problem.len()];
        let report = kind.solver().solve(&problem, &mut r, &rule);
        assert_eq!(report.status, SolveStatus::Solved, "{kind:?} on {problem:?}: {report:?}");
        assert_law(&problem, &r, 1e-8);
        assert!(report.measure.certificate <= 1e-8);
        answers.push(r);
    }
    // Without friction the solution is unique, since W is positive definite here.
    if mu == 0.0 {
        for (a, b) in answers[0].iter().zip(&answers[1]) {
            assert!((a - b).norm() < 1e-7);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn every_solver_finds_reactions_that_obey_the_law(
        entries in proptest::collection::vec(-1.0..1.0, 40),
        mu in prop_oneof![Just(0.0), 0.05..0.7],
    ) {
        check::<1>(&entries, mu);
        check::<2>(&entries, mu);
        check::<3>(&entries, mu);
    }
}

/// One mass on a plane: W = I/m, closed forms for separation, stick and slip.
#[test]
fn single_contact_separates_sticks_and_slips_as_by_hand() {
    let cases = [
        (Vector::<3>::new(0.5, 3.0, 4.0), Vector::<3>::zeros()),
        (Vector::<3>::new(-2.0, 0.3, -0.4), Vector::<3>::new(2.0, -0.3, 0.4)),
        (Vector::<3>::new(-2.0, 3.0, 4.0), Vector::<3>::new(2.0, -0.6, -0.8)),
    ];
    for kind in SolverKind::ALL {
        for (q, expected) in &cases {
            let problem = ContactProblem { w: BlockMatrix::identity(1), q: vec![*q], mu: vec![0.5] };
            let mut r = vec![Vector::<3>::zeros()];
            assert!(kind.solver().solve(&problem, &mut r, &strict()).is_solved());
            assert!((r[0] - expected).norm() < 1e-11, "{kind:?}: {} for q = {q}", r[0]);
        }
    }
}

/// The same contact twice: W is singular, the reactions are not unique, but their sum is.
#[test]
fn redundant_contacts_share_the_load() {
    for kind in SolverKind::ALL {
        let mut w = BlockMatrix::<2>::default();
        for _ in 0..2 {
            w.push_row([(0, Matrix::identity()), (1, Matrix::identity())]);
        }
        let problem = ContactProblem { w, q: vec![Vector::<2>::new(-1.0, 0.1); 2], mu: vec![0.3; 2] };
        let mut r = vec![Vector::<2>::zeros(); 2];
        assert!(kind.solver().solve(&problem, &mut r, &strict()).is_solved(), "{kind:?}");
        assert!((r[0] + r[1] - Vector::<2>::new(1.0, -0.1)).norm() < 1e-11);
    }
}

#[test]
fn an_unsolved_problem_is_never_reported_as_solved() {
    for kind in SolverKind::ALL {
        let entries: Vec<f64> = (0..40).map(|k| (k as f64 * 1.3).sin()).collect();
        let mut hard = problem::<3>(4, 9, &entries, 1e-6, 0.5);
        let rule = StoppingRule { tolerance: 1e-14, max_iterations: 2, ..Default::default() };
        let mut r = vec![Vector::zeros(); 4];
        assert_eq!(kind.solver().solve(&hard, &mut r, &rule).status, SolveStatus::IterationLimit);
        hard.q[0][0] = f64::NAN;
        let mut r = vec![Vector::zeros(); 4];
        assert_eq!(kind.solver().solve(&hard, &mut r, &rule).status, SolveStatus::Diverged);
    }
}

#[test]
fn no_contacts_are_solved_at_once() {
    for kind in SolverKind::ALL {
        let report = kind.solver().solve(&ContactProblem::<2>::default(), &mut [], &strict());
        assert!(report.is_solved());
    }
}

/// Two walls that close on a body from both sides, and one that is pressed into what cannot move.
fn contradictions() -> [ContactProblem<2>; 2] {
    let (one, mu) = (Matrix::<2>::identity(), 0.4);
    let mut squeezed = BlockMatrix::default();
    squeezed.push_row([(0, one), (1, -one)]);
    squeezed.push_row([(0, -one), (1, one)]);
    let mut fixed = BlockMatrix::default();
    fixed.push_row([(0, one), (1, Matrix::zeros())]);
    fixed.push_row([(0, Matrix::zeros()), (1, Matrix::zeros())]);
    let q = vec![Vector::<2>::new(-1.0, 0.2); 2];
    [squeezed, fixed].map(|w| ContactProblem { w, q: q.clone(), mu: vec![mu; 2] })
}

#[test]
fn contradictory_contacts_are_never_solved() {
    for problem in contradictions() {
        for kind in SolverKind::ALL {
            let rule = StoppingRule { max_iterations: 5000, ..Default::default() };
            let mut r = vec![Vector::zeros(); 2];
            let status = kind.solver().solve(&problem, &mut r, &rule).status;
            assert_ne!(status, SolveStatus::Solved, "{kind:?} pulls contacts apart with {r:?}");
        }
    }
}

#[test]
fn contradictory_contacts_are_recognised() {
    for problem in contradictions() {
        for kind in [SolverKind::Auto, SolverKind::Proximal] {
            let mut r = vec![Vector::zeros(); 2];
            let report = kind.solver().solve(&problem, &mut r, &StoppingRule::default());
            assert_eq!(report.status, SolveStatus::Inconsistent, "{kind:?}");
        }
    }
}

/// Twenty copies of a contact, so densely coupled that `auto` leaves out its sweeps.
#[test]
fn solution_to_start_from_is_recognised_at_once() {
    for copies in [1, 20] {
        let mut w = BlockMatrix::<3>::default();
        for _ in 0..copies {
            w.push_row((0..copies).map(|j| (j, Matrix::identity())));
        }
        let q = vec![Vector::<3>::new(-1.0, 0.1, 2.0); copies];
        let problem = ContactProblem { w, q, mu: vec![0.3; copies] };
        for kind in SolverKind::ALL {
            let mut r = vec![Vector::zeros(); copies];
            assert!(kind.solver().solve(&problem, &mut r, &strict()).is_solved(), "{kind:?}");
            let rule = StoppingRule { tolerance: 2e-12, ..Default::default() };
            let again = kind.solver().solve(&problem, &mut r, &rule);
            assert_eq!((again.status, again.iterations), (SolveStatus::Solved, 0), "{kind:?}");
        }
    }
}
