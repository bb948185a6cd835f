use crate::{ContactProblem, Vector, cone};

/// How far reactions are from the laws of Signorini and Coulomb.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Measure {
    /// ‖r − proj_K(r − ρ(w + μ|w_t| n))‖ / max(‖r‖, ‖ρ q‖, ‖ρ w‖), with ρ_i = 1/λ_max(W_ii) so that units do not matter.
    pub residual: f64,
    /// Σ of the bi-potential gaps [J]: the certificate.
    pub certificate: f64,
}

/// Measures `r`, whose motions are computed anew from the problem.
#[must_use]
pub fn measure<const D: usize>(problem: &ContactProblem<D>, r: &[Vector<D>]) -> Measure {
    let (mut error, mut size_r, mut size_q, mut size_w) = (0.0, 0.0, 0.0, 0.0);
    let mut certificate = 0.0;
    for i in 0..problem.len() {
        let (mu, rho) = (problem.mu[i], problem.step_length(i));
        let w = problem.motion(i, r);
        error += (r[i] - cone::fixed_point(&r[i], &w, mu, rho)).norm_squared();
        size_r += r[i].norm_squared();
        size_q += (problem.q[i] * rho).norm_squared();
        size_w += (w * rho).norm_squared();
        certificate += cone::bipotential_gap(&w, &r[i], mu);
    }
    // `max` ignores NaN; what is not a number must not pass for a small residual.
    let size = if (size_r + size_q + size_w).is_nan() { f64::NAN } else { size_r.max(size_q).max(size_w) };
    let residual = if size == 0.0 { 0.0 } else { (error / size).sqrt() };
    Measure { residual, certificate }
}
