use super::strain_law::{green_lagrange, growths};
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

impl Material for NeoHookean {
    /// By the Green–Lagrange strain, so that the energy of a small strain keeps its digits.
    #[inline]
    fn energy(&self, f: &Mat3) -> f64 {
        if f.determinant() <= 0.0 {
            return f64::NAN;
        }
        let [x1, _, x3] = growths(&green_lagrange(f));
        let log_j = 0.5 * x3.ln_1p();
        self.mu * (0.5 * x1 - log_j) + 0.5 * self.lambda * log_j * log_j
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
