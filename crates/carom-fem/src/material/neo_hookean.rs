use super::{ElasticConstants, Mat3, Material, Tangent};
use crate::FemError;

/// Compressible neo-Hookean: ψ = ½ μ (tr FᵀF − 3) − μ ln J + ½ λ (ln J)², J = det F (Simo & Pister 1984).
///
/// Where J ≤ 0 the energy is not a number, so that a step which turns a cell inside out fails instead of passing unseen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NeoHookean {
    lambda: f64,
    mu: f64,
}

impl NeoHookean {
    /// The law with these constants of small strain.
    ///
    /// # Errors
    /// If the constants are out of range.
    pub fn new(constants: &ElasticConstants) -> Result<Self, FemError> {
        let (lambda, mu) = constants.lame()?;
        Ok(Self { lambda, mu })
    }
}

/// E = ½(H + Hᵀ + HᵀH), H = F − 1.
#[inline]
fn green_lagrange(f: &Mat3) -> Mat3 {
    let h = f - Mat3::identity();
    (h + h.transpose() + h.tr_mul(&h)) * 0.5
}

impl Material for NeoHookean {
    /// By the Green–Lagrange strain E: tr C − 3 = 2 tr E, J² − 1 = 2 tr E + 2(tr²E − E:E) + 8 det E. From tr C and J themselves a small
    /// energy would be known to ε μ only, and so would its change in a step, which the stress of a conserving step must do the work of.
    #[inline]
    fn energy(&self, f: &Mat3) -> f64 {
        if f.determinant() <= 0.0 {
            return f64::NAN;
        }
        let e = green_lagrange(f);
        let trace = e.trace();
        let change = 2.0 * (trace + trace * trace - e.norm_squared()) + 8.0 * e.determinant();
        let log_j = 0.5 * change.ln_1p();
        self.mu * (trace - log_j) + 0.5 * self.lambda * log_j * log_j
    }

    /// P = μ (F − F⁻ᵀ) + λ ln J F⁻ᵀ.
    #[inline]
    fn stress(&self, f: &Mat3) -> Mat3 {
        let (inverse, j) = carom_mesh::tensor::inverse(f);
        f * self.mu + inverse.transpose() * (self.lambda * j.ln() - self.mu)
    }

    /// A_iJkL = μ δ_ik δ_JL + (μ − λ ln J) F⁻¹_Jk F⁻¹_Li + λ F⁻¹_Ji F⁻¹_Lk.
    fn stress_and_tangent(&self, f: &Mat3) -> (Mat3, Tangent<3>) {
        let (inverse, j) = carom_mesh::tensor::inverse(f);
        let log_j = j.ln();
        let mut a: Tangent<3> = [[[[0.0; 3]; 3]; 3]; 3];
        for i in 0..3 {
            for j in 0..3 {
                for k in 0..3 {
                    for l in 0..3 {
                        let mut value = (self.mu - self.lambda * log_j) * inverse[(j, k)] * inverse[(l, i)]
                            + self.lambda * inverse[(j, i)] * inverse[(l, k)];
                        if i == k && j == l {
                            value += self.mu;
                        }
                        a[i][j][k][l] = value;
                    }
                }
            }
        }
        (self.stress(f), a)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The change of a small energy in a small step is the work of the mean stress, but for terms of third order: 10⁻¹⁸ μ here. Were ψ known to
    /// ε μ only, the stress of a conserving step would be noise of 10⁻⁹ μ, and Newton's iterations would not end.
    #[test]
    fn the_change_of_a_small_energy_keeps_its_digits() {
        let law = NeoHookean::new(&ElasticConstants { young: 2700.0, poisson: 0.33 }).expect("valid");
        let f0 = Mat3::identity() + Mat3::new(3.0, 1.0, -2.0, 0.5, -1.0, 2.0, 1.0, -0.7, 0.4) * 1e-4;
        let step = Mat3::new(0.2, -0.5, 0.3, 0.1, 0.7, -0.4, 0.6, -0.1, 0.3) * 1e-6;
        let work = law.stress(&(f0 + step * 0.5)).dot(&step);
        let change = law.energy(&(f0 + step)) - law.energy(&f0);
        assert!((change - work).abs() < 1e-17 * law.mu, "{change:e} {work:e}");
    }
}
