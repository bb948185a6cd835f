//! A second opinion on the contact problem of a step, which changes nothing in the run.

use std::collections::BTreeMap;

use carom_friction::{ContactProblem, SolveStatus, SolverKind, Vector};
use serde::Serialize;

use super::Contacts;
use crate::model::given::Given;

/// The answer of a second solver to the last contact problem of a step, from the same guess.
///
/// It is compared by the motions w = W r + q. Reactions may differ where contacts are redundant: many share the load in the same
/// way as far as anything that moves can tell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CrossCheck {
    /// The second solver.
    pub solver: SolverKind,
    /// How it ended.
    pub status: SolveStatus,
    /// ‖w₁ − w₂‖ / max(‖q‖, ‖w‖, ‖r‖/ρ) with the larger of both answers and the natural stiffness ρ = n D / tr W.
    pub difference: f64,
    /// The largest difference that the tolerance of the solvers explains.
    pub explained: f64,
    /// Σ of the bi-potential gaps of the second answer [J].
    pub certificate: f64,
}

impl CrossCheck {
    /// Whether the second solver came to an answer, and to motions of its own.
    #[must_use]
    pub fn disagrees(&self) -> bool {
        self.status == SolveStatus::Solved && self.difference > self.explained
    }
}

/// Solves the last contact problem of a converged step again, if the method wants it and there was one.
pub(crate) fn cross_check<const D: usize>(
    given: &Given<'_, D>,
    contacts: &Contacts<D>,
) -> Option<CrossCheck> {
    let (method, Contacts { active, reduced, .. }) = (given.method, contacts);
    if !method.cross_check || active.candidates.is_empty() {
        return None;
    }
    let problem = &reduced.problem;
    let solver = second_solver(reduced.solved_by);
    let mut second = reduced.guess.clone();
    let report = solver.solver().solve(problem, &mut second, &method.stopping);
    Some(CrossCheck {
        solver,
        status: report.status,
        difference: difference_of_motions(problem, &active.reactions, &second),
        explained: explained_difference(problem.len() * D, method.stopping.tolerance),
        certificate: report.measure.certificate / active.least_weight(),
    })
}

/// One that goes another way: linear systems of all contacts check sweeps, whatever these do on a contact; sweeps check the rest.
fn second_solver(first: SolverKind) -> SolverKind {
    match first {
        SolverKind::GaussSeidel
        | SolverKind::GaussSeidelEnumerative
        | SolverKind::GaussSeidelAlartCurnier => SolverKind::Proximal,
        _ => SolverKind::GaussSeidel,
    }
}

/// See [`CrossCheck::difference`].
fn difference_of_motions<const D: usize>(
    problem: &ContactProblem<D>,
    first: &[Vector<D>],
    second: &[Vector<D>],
) -> f64 {
    let rho = problem.natural_stiffness();
    let mut difference = 0.0;
    let [mut q, mut w1, mut w2, mut r1, mut r2] = [0.0; 5];
    for i in 0..problem.len() {
        let motions = [problem.motion(i, first), problem.motion(i, second)];
        difference += (motions[0] - motions[1]).norm_squared();
        q += problem.q[i].norm_squared();
        w1 += motions[0].norm_squared();
        w2 += motions[1].norm_squared();
        r1 += first[i].norm_squared();
        r2 += second[i].norm_squared();
    }
    let size = q.max(w1).max(w2).max(r1.max(r2) / (rho * rho));
    if size == 0.0 { 0.0 } else { (difference / size).sqrt() }
}

/// √(8 N ε) for N unknowns: how far apart the motions of two answers can be whose natural residuals are at most ε.
///
/// With e = r − proj_K(r − ρ w̃) and w̃ = w + μ|w_t| n the variational inequality of each answer, tested with the other, gives ρ
/// Δw̃·Δr ≤ Δe·(ρ Δw̃ + Δr).
///
/// Where |w_t| is the same in both, as always without friction, Δw̃ = Δw = W Δr. The left side is at least ρ|Δw|²/λ_max(W), and
/// ρ λ_max ≤ N. For answers of size S, |Δe| ≤ 2εS while |Δr| and ρ|Δw| are at most 2S. So (ρ|Δw|/S)² ≤ 8 N ε. A larger
/// difference is no error of either solver: the problem has more than one solution, or nearly so.
fn explained_difference(unknowns: usize, tolerance: f64) -> f64 {
    (8.0 * unknowns as f64 * tolerance).sqrt()
}

/// The cross-checks of a run.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct CrossCheckSummary {
    /// Contact problems that were solved again, one of every step or substep with contact.
    pub problems: u64,
    /// How many of them each second solver was given.
    pub solvers: BTreeMap<&'static str, u64>,
    /// Problems that the second solver did not solve.
    pub unsolved: u64,
    /// Problems whose second answer has other motions.
    pub disagreements: u64,
    /// Largest difference of the motions, relative to the size of the problem.
    pub max_difference: f64,
    /// The difference that the tolerance of the solvers explains in that problem.
    pub explained_difference: f64,
    /// End of the step of that problem [s]; null while there is none.
    pub time_of_max: Option<f64>,
    /// Largest Σ of bi-potential gaps of a second answer [J].
    pub max_certificate_joule: f64,
}

impl CrossCheckSummary {
    /// Takes note of the check of a step that ended at `time` [s]. The sizes are those of answers, not of what was given up.
    pub(crate) fn note(&mut self, check: &CrossCheck, time: f64) {
        self.problems += 1;
        *self.solvers.entry(check.solver.name()).or_default() += 1;
        if check.status != SolveStatus::Solved {
            self.unsolved += 1;
            return;
        }
        self.disagreements += u64::from(check.disagrees());
        self.max_certificate_joule = self.max_certificate_joule.max(check.certificate);
        if self.time_of_max.is_none() || check.difference > self.max_difference {
            self.max_difference = check.difference;
            self.explained_difference = check.explained;
            self.time_of_max = Some(time);
        }
    }
}

#[cfg(test)]
mod tests {
    use carom_friction::{BlockMatrix, Matrix, StoppingRule};

    use super::*;

    fn gauss_seidel(problem: &ContactProblem<2>, guess: Vector<2>) -> Vec<Vector<2>> {
        let mut r = vec![guess; problem.len()];
        let rule = StoppingRule { tolerance: 1e-14, ..StoppingRule::default() };
        assert!(SolverKind::GaussSeidel.solver().solve(problem, &mut r, &rule).is_solved());
        r
    }

    /// The same contact twice: W is singular and the share of the load is arbitrary, the motion is not.
    #[test]
    fn redundant_contacts_that_share_the_load_in_another_way_agree() {
        let mut w = BlockMatrix::<2>::default();
        for _ in 0..2 {
            w.push_row([(0, Matrix::identity()), (1, Matrix::identity())]);
        }
        let problem = ContactProblem { w, q: vec![Vector::<2>::new(-1.0, 2.0); 2], mu: vec![0.3; 2] };
        let [even, uneven] =
            [[0.5, 0.5], [0.9, 0.1]].map(|share| share.map(|s| Vector::<2>::new(1.0, -0.3) * s));
        assert!(difference_of_motions(&problem, &even, &uneven) < 1e-15);
        assert!((even[0] - uneven[0]).norm() > 0.3);
    }

    /// Two answers to one problem, by hand: with much friction and normal motion that slip makes, a contact can stick or open.
    /// W = [[1, −1.5], [−1.5, 4]] and q = (0.5, −1.5). r = 0 leaves w = q, which is open. r = −W⁻¹q = (1/7, 3/7) holds the
    /// contact in place for μ ≥ 3.
    #[test]
    fn a_contact_that_can_stick_or_open_is_a_disagreement() {
        let mut w = BlockMatrix::<2>::default();
        w.push_row([(0, Matrix::<2>::new(1.0, -1.5, -1.5, 4.0))]);
        let problem = ContactProblem { w, q: vec![Vector::<2>::new(0.5, -1.5)], mu: vec![4.0] };
        let open = gauss_seidel(&problem, Vector::zeros());
        let stuck = vec![Vector::<2>::new(1.0, 3.0) / 7.0];
        for r in [&open, &stuck] {
            assert!(carom_friction::measure(&problem, r).natural_residual < 1e-14);
        }
        let difference = difference_of_motions(&problem, &open, &stuck);
        assert!((difference - 1.0).abs() < 1e-12, "{difference}: stuck is w = 0, open is w = q");
        let check = CrossCheck {
            solver: SolverKind::Proximal,
            status: SolveStatus::Solved,
            difference,
            explained: explained_difference(2, 1e-12),
            certificate: 0.0,
        };
        assert!(check.disagrees());
        let mut summary = CrossCheckSummary::default();
        summary.note(&check, 0.25);
        summary.note(&CrossCheck { difference: 1e-9, ..check }, 0.5);
        summary.note(&CrossCheck { status: SolveStatus::Stalled, difference: 9.0, ..check }, 0.75);
        assert_eq!((summary.problems, summary.disagreements, summary.unsolved), (3, 1, 1));
        assert_eq!((summary.max_difference, summary.time_of_max), (difference, Some(0.25)));
    }

    /// Answers that stop early at a given residual differ by less than the bound says, however ill-conditioned W is.
    #[test]
    fn the_tolerance_of_the_solvers_bounds_the_difference_of_their_motions() {
        for condition in [1.0, 1e-3, 1e-6] {
            let mut w = BlockMatrix::<2>::default();
            for i in 0..3 {
                w.push_row(
                    (0..3).map(|j| (j, Matrix::identity() * if i == j { 1.0 + condition } else { 1.0 })),
                );
            }
            let q = [-1.0, -0.8, -1.1].map(|x| Vector::<2>::new(x, 0.1));
            let problem = ContactProblem { w, q: q.to_vec(), mu: vec![0.0; 3] };
            for tolerance in [1e-3, 1e-6, 1e-9] {
                let rule = StoppingRule { tolerance, max_iterations: 10_000_000, ..StoppingRule::default() };
                let [first, second] = [0.0, 5.0].map(|guess| {
                    let mut r = vec![Vector::<2>::new(guess, 0.0), Vector::zeros(), Vector::zeros()];
                    assert!(SolverKind::GaussSeidel.solver().solve(&problem, &mut r, &rule).is_solved());
                    r
                });
                let difference = difference_of_motions(&problem, &first, &second);
                assert!(difference <= explained_difference(6, tolerance), "{difference:e} at {tolerance:e}");
            }
        }
    }
}
