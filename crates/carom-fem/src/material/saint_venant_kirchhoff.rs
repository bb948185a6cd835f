use super::{ElasticConstants, Mat3, Material, Tangent};
use crate::FemError;

/// Saint-Venant–Kirchhoff: ψ = ½ λ (tr E)² + μ E:E with the Green–Lagrange strain E = ½(FᵀF − I).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SaintVenantKirchhoff {
    lambda: f64,
    mu: f64,
}

impl SaintVenantKirchhoff {
    /// The law with these constants.
    ///
    /// # Errors
    /// If the constants are out of range.
    pub fn new(constants: &ElasticConstants) -> Result<Self, FemError> {
        let (lambda, mu) = constants.lame()?;
        Ok(Self { lambda, mu })
    }

    /// Green–Lagrange strain.
    #[inline]
    fn strain(f: &Mat3) -> Mat3 {
        (f.transpose() * f - Mat3::identity()) * 0.5
    }

    /// Second Piola–Kirchhoff stress S = λ tr(E) I + 2 μ E [Pa].
    #[inline]
    fn second_piola(&self, strain: &Mat3) -> Mat3 {
        Mat3::identity() * (self.lambda * strain.trace()) + strain * (2.0 * self.mu)
    }
}

impl Material for SaintVenantKirchhoff {
    #[inline]
    fn energy(&self, f: &Mat3) -> f64 {
        let strain = Self::strain(f);
        0.5 * self.lambda * strain.trace().powi(2) + self.mu * strain.norm_squared()
    }

    #[inline]
    fn stress(&self, f: &Mat3) -> Mat3 {
        f * self.second_piola(&Self::strain(f))
    }

    /// ψ is quadratic in E: the stress of the mean strain does the work of the step (Simo & Tarnow 1992).
    #[inline]
    fn discrete_stress(&self, f0: &Mat3, f1: &Mat3) -> Mat3 {
        (f0 + f1) * 0.5 * self.second_piola(&((Self::strain(f0) + Self::strain(f1)) * 0.5))
    }

    #[inline]
    fn step_stresses(&self, f0: &Mat3, f1: &Mat3) -> [Mat3; 3] {
        let (s0, s1) = (self.second_piola(&Self::strain(f0)), self.second_piola(&Self::strain(f1)));
        let middle = (f0 + f1) * 0.5;
        [middle * (s0 + s1) * 0.5, middle * (s1 - s0), f1 * s1]
    }

    /// A_iJkL = δ_ik S_JL + λ F_iJ F_kL + μ (F_iM F_kM δ_JL + F_iL F_kJ).
    fn stress_and_tangent(&self, f: &Mat3) -> (Mat3, Tangent<3>) {
        let s = self.second_piola(&Self::strain(f));
        let b = f * f.transpose();
        let mut a: Tangent<3> = [[[[0.0; 3]; 3]; 3]; 3];
        for i in 0..3 {
            for j in 0..3 {
                for k in 0..3 {
                    for l in 0..3 {
                        let mut value = self.lambda * f[(i, j)] * f[(k, l)] + self.mu * f[(i, l)] * f[(k, j)];
                        if i == k {
                            value += s[(j, l)];
                        }
                        if j == l {
                            value += self.mu * b[(i, k)];
                        }
                        a[i][j][k][l] = value;
                    }
                }
            }
        }
        (f * s, a)
    }
}
