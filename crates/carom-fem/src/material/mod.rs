//! Hyperelastic laws, written once in 3D. A new law is a file here, a line in [`LawSpec`] and
//! one in [`LawSpec::point_law`].

mod blatz_ko;
#[cfg(test)]
mod contract;
mod elastic_constants;
mod invariants;
mod j2_plasticity;
mod linear_elastic;
mod mooney_rivlin;
mod neo_hookean;
mod ogden;
#[cfg(test)]
mod plasticity_contract;
mod point_law;
pub(crate) mod ranges;
#[cfg(test)]
mod rubber_contract;
mod saint_venant_kirchhoff;
mod spectrum;
mod strain_law;
mod viscosity;
mod volumetric;
mod with_work;
mod yeoh;

use std::fmt::Debug;
use std::sync::Arc;

use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};

use crate::FemError;
pub use blatz_ko::BlatzKo;
pub use elastic_constants::ElasticConstants;
pub use invariants::{ByInvariants, InvariantEnergy, Jet};
pub use j2_plasticity::{Flow, J2Plasticity, PlasticState};
pub use linear_elastic::LinearElastic;
pub use mooney_rivlin::MooneyRivlin;
pub use neo_hookean::NeoHookean;
pub use ogden::Ogden;
pub use point_law::{Confined, PointLaw};
pub(crate) use point_law::{embed, restrict};
pub use saint_venant_kirchhoff::SaintVenantKirchhoff;
pub use spectrum::{ByStretches, Spectrum, StretchEnergy};
pub use strain_law::{Hyperelastic, StrainLaw};
pub use viscosity::Viscosity;
pub use yeoh::Yeoh;

use with_work::with_work;

/// A second-order tensor in 3D.
pub type Mat3 = Matrix3<f64>;
/// The tangent A[i][J][k][L] = ∂P_iJ/∂F_kL [Pa] in D dimensions.
pub type Tangent<const D: usize> = [[[[f64; D]; D]; D]; D];

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
        let stress = (stress + stress.transpose()) * 0.5;
        let change = (c1 - c0) * 0.5;
        (f0 + f1) * 0.5 * with_work(&stress, &change, || self.energy(f1) - self.energy(f0))
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
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum LawSpec {
    /// Saint-Venant–Kirchhoff: large displacement, small strain.
    SaintVenantKirchhoff(ElasticConstants),
    /// Linear elasticity: small displacement.
    LinearElastic(ElasticConstants),
    /// Compressible neo-Hookean: large strain.
    NeoHookean(ElasticConstants),
    /// Mooney–Rivlin: rubber.
    MooneyRivlin(MooneyRivlin),
    /// Yeoh: rubber that stiffens.
    Yeoh(Yeoh),
    /// Ogden: rubber by its principal stretches.
    Ogden(Ogden),
    /// Blatz–Ko: foam.
    BlatzKo(BlatzKo),
}

impl LawSpec {
    /// The law as elements see it.
    ///
    /// # Errors
    /// If a material constant is out of range.
    pub fn point_law<const D: usize>(&self) -> Result<Arc<dyn PointLaw<D>>, FemError> {
        Ok(match self {
            Self::SaintVenantKirchhoff(c) => Arc::new(Confined(SaintVenantKirchhoff::new(c)?)),
            Self::LinearElastic(c) => Arc::new(Confined(LinearElastic::new(c)?)),
            Self::NeoHookean(c) => Arc::new(Confined(NeoHookean::new(c)?)),
            Self::MooneyRivlin(c) => Arc::new(Confined(Hyperelastic(ByInvariants(c.checked()?)))),
            Self::Yeoh(c) => Arc::new(Confined(Hyperelastic(ByInvariants(c.checked()?)))),
            Self::Ogden(c) => Arc::new(Confined(Hyperelastic(ByStretches(c.clone().checked()?)))),
            Self::BlatzKo(c) => Arc::new(Confined(Hyperelastic(ByInvariants(c.checked()?)))),
        })
    }
}
