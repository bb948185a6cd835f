//! Hyperelastic laws, written once in 3D. A new law is a file here, a line in [`LawSpec`] and
//! one where [`crate::Body::new`] makes it.

#[cfg(test)]
mod contract;
mod elastic_constants;
mod linear_elastic;
mod neo_hookean;
mod point_law;
mod saint_venant_kirchhoff;

use std::fmt::Debug;

use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};

pub use elastic_constants::ElasticConstants;
pub use linear_elastic::LinearElastic;
pub use neo_hookean::NeoHookean;
pub use point_law::{Confined, PointLaw};
pub use saint_venant_kirchhoff::SaintVenantKirchhoff;

/// A second-order tensor in 3D.
pub type Mat3 = Matrix3<f64>;
/// The tangent A[i][J][k][L] = ∂P_iJ/∂F_kL [Pa] in D dimensions.
pub type Tangent<const D: usize> = [[[[f64; D]; D]; D]; D];

/// Below this change of strain the discrete gradient's correction, of its third order, is smaller than round-off.
const SMALL_STRAIN: f64 = 1e-6;

/// A hyperelastic law, as a function of the deformation gradient F in 3D.
pub trait Material: Send + Sync + Debug {
    /// Stored energy ψ(F) per reference volume [J/m³].
    fn energy(&self, f: &Mat3) -> f64;

    /// First Piola–Kirchhoff stress P = ∂ψ/∂F [Pa].
    fn stress(&self, f: &Mat3) -> Mat3;

    /// Stress P and tangent ∂P/∂F [Pa].
    fn stress_and_tangent(&self, f: &Mat3) -> (Mat3, Tangent<3>);

    /// The stress P̄ [Pa] of a step from F₀ to F₁ whose work is the change of energy: P̄:(F₁ − F₀) = ψ(F₁) − ψ(F₀).
    ///
    /// P̄ = ½(F₀ + F₁) S̄ with a symmetric S̄, so that angular momentum is kept, by the discrete gradient of Gonzalez (2000) in the
    /// Green–Lagrange strain E: S̄ = S(Ē) + [Δψ − S(Ē):ΔE] ΔE/|ΔE|², where Ē is the mean strain. Any objective law needs no more
    /// than this.
    fn discrete_stress(&self, f0: &Mat3, f1: &Mat3) -> Mat3 {
        let (c0, c1) = (f0.transpose() * f0, f1.transpose() * f1);
        // S(C̄) = G⁻¹ P(G) for any G with GᵀG = C̄: here the triangular one. A stretch by eigenvectors would lose six digits where
        // stretches are nearly equal, and Newton's iterations would not converge.
        let Some(root) = ((c0 + c1) * 0.5).cholesky() else { return Mat3::repeat(f64::NAN) };
        let mean = root.l().transpose();
        let stress = carom_mesh::tensor::inverse(&mean).0 * self.stress(&mean);
        let mut stress = (stress + stress.transpose()) * 0.5;
        let change = (c1 - c0) * 0.5;
        let size = change.norm_squared();
        if size > SMALL_STRAIN * SMALL_STRAIN {
            let missing = self.energy(f1) - self.energy(f0) - stress.dot(&change);
            stress += change * (missing / size);
        }
        (f0 + f1) * 0.5 * stress
    }

    /// The stresses [Pa] of a step from F₀ to F₁ that a blend of its start and end is made of, with F̄ = ½(F₀ + F₁):
    /// the discrete stress P̄; the difference F̄ (S₁ − S₀), whose moment vanishes too; and P₁.
    fn step_stresses(&self, f0: &Mat3, f1: &Mat3) -> [Mat3; 3] {
        let end = self.stress(f1);
        let second_piola = |f: &Mat3, p: &Mat3| carom_mesh::tensor::inverse(f).0 * p;
        let difference = second_piola(f1, &end) - second_piola(f0, &self.stress(f0));
        let symmetric = (difference + difference.transpose()) * 0.5;
        [self.discrete_stress(f0, f1), (f0 + f1) * 0.5 * symmetric, end]
    }

    /// Whether ψ(QF) = ψ(F) for every rotation Q. Only a law of small displacements is not.
    fn is_objective(&self) -> bool {
        true
    }
}

/// A law and its constants, as the case file names them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum LawSpec {
    /// Saint-Venant–Kirchhoff: large displacement, small strain.
    SaintVenantKirchhoff(ElasticConstants),
    /// Linear elasticity: small displacement.
    LinearElastic(ElasticConstants),
    /// Compressible neo-Hookean: large strain.
    NeoHookean(ElasticConstants),
}
