//! Contact problems on their own: W, q and μ in, reactions out.

use carom_friction::{BlockMatrix, ContactProblem, Criterion, SolveReport, SolverKind, StoppingRule};

use crate::status::{Failure, carom_status};
use crate::steps::{flat, vectors};

/// When to stop, and by which method.
pub struct Method {
    pub kind: SolverKind,
    pub rule: StoppingRule,
}

impl Method {
    /// The solver of this name; 0 stands for what is usual.
    pub fn new(name: &str, tolerance: f64, max_iterations: usize) -> Result<Self, Failure> {
        let kind = SolverKind::from_name(name).ok_or_else(|| {
            let names: Vec<&str> = SolverKind::ALL.iter().map(|kind| kind.name()).collect();
            Failure::invalid(format!(
                "there is no friction solver named {name:?}; there are {}",
                names.join(", ")
            ))
        })?;
        if !(tolerance.is_finite() && tolerance >= 0.0) {
            return Err(Failure::invalid(format!(
                "tolerance = {tolerance}: must be greater than 0, or 0 for 1e-12"
            )));
        }
        let rule = StoppingRule {
            tolerance: if tolerance > 0.0 { tolerance } else { 1e-12 },
            criterion: Criterion::Natural,
            max_iterations: if max_iterations > 0 { max_iterations } else { 10_000 },
            ..StoppingRule::default()
        };
        Ok(Self { kind, rule })
    }
}

/// Reactions [N] that obey the laws, from a guess.
pub fn solve<const D: usize>(
    [w, q, mu]: [&[f64]; 3],
    guess: &[f64],
    method: &Method,
) -> Result<(Vec<f64>, SolveReport), Failure> {
    let width = q.len();
    if let Some(contact) = mu.iter().position(|mu| *mu < 0.0) {
        return Err(Failure::invalid(format!("friction[{contact}] = {}: must be at least 0", mu[contact])));
    }
    let mut matrix = BlockMatrix::default();
    for i in 0..mu.len() {
        // The half above the diagonal counts.
        let entry = |a: usize, b: usize| w[a.min(b) * width + a.max(b)];
        let block = |j: usize| carom_friction::Matrix::from_fn(|a, b| entry(i * D + a, j * D + b));
        matrix.push_row((0..mu.len()).map(|j| (j, block(j))));
    }
    let problem = ContactProblem::<D> { w: matrix, q: vectors(q), mu: mu.to_vec() };
    let mut reactions = vectors(guess);
    let report = method.kind.solver().solve(&problem, &mut reactions, &method.rule);
    if !report.is_solved() {
        return Err(Failure::new(
            carom_status::NOT_CONVERGED,
            format!(
                "the contact problem of {} contacts ended as {} after {} iterations at a residual of {:.3e}",
                mu.len(),
                report.status.name(),
                report.iterations,
                report.measure.natural_residual
            ),
        ));
    }
    Ok((flat(reactions), report))
}
