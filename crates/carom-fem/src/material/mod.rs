//! Hyperelastic laws, written once in 3D. A new law is a file here, a line in [`LawSpec`] and
//! one in [`LawSpec::point_law`].

#[cfg(test)]
mod contract;
pub(crate) mod discrete_gradient;
mod elastic_constants;
mod linear_elastic;
mod neo_hookean;
mod plane_stress;
mod point_law;
mod saint_venant_kirchhoff;

use std::fmt::Debug;
use std::sync::Arc;

use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};

use crate::{FemError, Hypothesis};
pub use elastic_constants::ElasticConstants;
pub use linear_elastic::LinearElastic;
pub use neo_hookean::NeoHookean;
pub use plane_stress::PlaneStress;
pub use point_law::{Confined, PointLaw};
pub use saint_venant_kirchhoff::SaintVenantKirchhoff;

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
        discrete_gradient::discrete_stress(f0, f1, |f| self.energy(f), |f| self.stress(f))
    }

    /// The stresses [Pa] of a step from F₀ to F₁ that a blend of its start and end is made of, with F̄ = ½(F₀ + F₁):
    /// the discrete stress P̄; the difference F̄ (S₁ − S₀), whose moment vanishes too; and P₁.
    fn step_stresses(&self, f0: &Mat3, f1: &Mat3) -> [Mat3; 3] {
        let (start, end) = (self.stress(f0), self.stress(f1));
        let difference = discrete_gradient::stress_difference(f0, &start, f1, &end);
        [self.discrete_stress(f0, f1), difference, end]
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

impl LawSpec {
    /// The law as elements see it under a hypothesis; where that takes nothing from the law, the law itself.
    ///
    /// # Errors
    /// If a material constant is out of range.
    pub fn point_law<const D: usize>(
        &self,
        hypothesis: Hypothesis,
    ) -> Result<Arc<dyn PointLaw<D>>, FemError> {
        fn under<const D: usize, M: Material + 'static>(
            hypothesis: Hypothesis,
            material: M,
        ) -> Arc<dyn PointLaw<D>> {
            match hypothesis {
                Hypothesis::PlaneStress => Arc::new(PlaneStress(material)),
                Hypothesis::PlaneStrain | Hypothesis::Axisymmetric => Arc::new(Confined(material)),
            }
        }
        Ok(match self {
            Self::SaintVenantKirchhoff(c) => under(hypothesis, SaintVenantKirchhoff::new(c)?),
            Self::LinearElastic(c) => under(hypothesis, LinearElastic::new(c)?),
            Self::NeoHookean(c) => under(hypothesis, NeoHookean::new(c)?),
        })
    }
}
