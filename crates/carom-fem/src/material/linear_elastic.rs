use super::{ElasticConstants, Mat3, Material, Tangent};
use crate::FemError;

/// Linear elasticity of small displacements: ψ = ½ λ (tr ε)² + μ ε:ε with ε = sym(F) − I.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LinearElastic {
    lambda: f64,
    mu: f64,
}

impl LinearElastic {
    /// The law with these constants.
    ///
    /// # Errors
    /// If the constants are out of range.
    pub fn new(constants: &ElasticConstants) -> Result<Self, FemError> {
        let (lambda, mu) = constants.lame()?;
        Ok(Self { lambda, mu })
    }
}

impl Material for LinearElastic {
    #[inline]
    fn energy(&self, f: &Mat3) -> f64 {
        let strain = (f + f.transpose()) * 0.5 - Mat3::identity();
        0.5 * self.lambda * strain.trace().powi(2) + self.mu * strain.norm_squared()
    }

    #[inline]
    fn stress(&self, f: &Mat3) -> Mat3 {
        let strain = (f + f.transpose()) * 0.5 - Mat3::identity();
        Mat3::identity() * (self.lambda * strain.trace()) + strain * (2.0 * self.mu)
    }

    fn stress_and_tangent(&self, f: &Mat3) -> (Mat3, Tangent<3>) {
        let delta = |i, j| if i == j { 1.0 } else { 0.0 };
        let mut a: Tangent<3> = [[[[0.0; 3]; 3]; 3]; 3];
        for i in 0..3 {
            for j in 0..3 {
                for k in 0..3 {
                    for l in 0..3 {
                        a[i][j][k][l] = self.lambda * delta(i, j) * delta(k, l)
                            + self.mu * (delta(i, k) * delta(j, l) + delta(i, l) * delta(j, k));
                    }
                }
            }
        }
        (self.stress(f), a)
    }

    /// ψ is quadratic in F: the stress at the middle does the work of the step.
    fn discrete_stress(&self, f0: &Mat3, f1: &Mat3) -> Mat3 {
        self.stress(&((f0 + f1) * 0.5))
    }

    fn step_stresses(&self, f0: &Mat3, f1: &Mat3) -> [Mat3; 3] {
        let (start, end) = (self.stress(f0), self.stress(f1));
        [(start + end) * 0.5, end - start, end]
    }

    fn is_objective(&self) -> bool {
        false
    }
}
