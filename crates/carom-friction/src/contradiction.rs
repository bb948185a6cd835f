use crate::{ContactProblem, Vector};

/// Whether the step from `before` to `r` shows that no reactions keep the contacts apart.
///
/// Let z ≥ 0 be normal reactions with W z = 0. Whatever the reactions, z · w_n = z · q_n; where that is negative some contact
/// penetrates (Farkas' lemma). A small W z ≠ 0 rules out all reactions shorter than |z · q_n|/|W z|, and that has to be
/// out of all proportion.
pub(crate) fn contradicts<const D: usize>(
    problem: &ContactProblem<D>,
    r: &[Vector<D>],
    before: &[Vector<D>],
    stiffness: f64,
) -> bool {
    let z: Vec<Vector<D>> = r
        .iter()
        .zip(before)
        .map(|(r, b)| {
            let mut z = Vector::zeros();
            z[0] = (r[0] - b[0]).max(0.0);
            z
        })
        .collect();
    let length = z.iter().map(Vector::norm_squared).sum::<f64>().sqrt();
    let closing: f64 = -z.iter().zip(&problem.q).map(|(z, q)| z[0] * q[0]).sum::<f64>();
    let size_q = problem.q.iter().map(Vector::norm_squared).sum::<f64>().sqrt();
    let response: f64 =
        (0..problem.len()).map(|i| problem.w.row_times(i, &z).norm_squared()).sum::<f64>().sqrt();
    closing > 1e-9 * length * size_q && closing > OUT_OF_PROPORTION * stiffness * size_q * response
}

/// Size of reactions, relative to those that the motions call for, that nothing physical needs.
const OUT_OF_PROPORTION: f64 = 1e8;
