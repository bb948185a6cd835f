//! Hyperelastic laws, written once in 3D. A new law is a file here, a line in [`LawSpec`] and
//! one in [`LawSpec::point_law`].

mod batch;
mod blatz_ko;
#[cfg(test)]
mod contract;
pub(crate) mod control;
pub(crate) mod discrete_gradient;
mod elastic_constants;
mod flowing;
mod invariants;
mod j2_plasticity;
mod lanes;
mod linear_elastic;
mod mooney_rivlin;
mod neo_hookean;
mod ogden;
mod plane_stress;
#[cfg(test)]
mod plasticity_contract;
mod point_law;
mod prestressed;
pub(crate) mod ranges;
#[cfg(test)]
mod rubber_contract;
mod saint_venant_kirchhoff;
mod spectrum;
mod strain_law;
mod unstressed;
mod viscosity;
mod volumetric;
mod yeoh;

use std::fmt::Debug;
use std::sync::Arc;

use carom_mesh::compiled;
use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};

use crate::{FemError, Hypothesis};
pub use batch::{BATCH, Batch, LANES, MAX_POINTS};
pub use blatz_ko::BlatzKo;
pub use elastic_constants::ElasticConstants;
pub use flowing::Flowing;
pub use invariants::{ByInvariants, InvariantEnergy, Jet};
pub use j2_plasticity::{Flow, J2Plasticity, PlasticState, Relative};
pub use linear_elastic::LinearElastic;
pub use mooney_rivlin::MooneyRivlin;
pub use neo_hookean::NeoHookean;
pub use ogden::Ogden;
pub use plane_stress::PlaneStress;
pub use point_law::{Confined, PointLaw};
pub(crate) use point_law::{embed, restrict};
pub(crate) use prestressed::Prestressed;
pub use saint_venant_kirchhoff::SaintVenantKirchhoff;
pub use spectrum::{ByStretches, Spectrum, StretchEnergy};
pub(crate) use strain_law::green_lagrange;
pub use strain_law::{Hyperelastic, StrainLaw};
pub use unstressed::Unstressed;
pub use viscosity::Viscosity;
pub use yeoh::Yeoh;

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
    /// P̄ = ½(F₀ + F₁) S̄ with a symmetric S̄, so that angular momentum is kept. It is the discrete gradient of Gonzalez (2000) in
    /// the Green–Lagrange strain E: S̄ = S(Ē) + [Δψ − S(Ē):ΔE] ΔE/|ΔE|², where Ē is the mean strain. Any objective law needs no
    /// more than this.
    fn discrete_stress(&self, f0: &Mat3, f1: &Mat3) -> Mat3 {
        discrete_gradient::discrete_stress(f0, f1, |f| self.energy(f), |f| self.stress(f))
    }

    /// The stresses [Pa] of a step from F₀ to F₁ that a blend of its start and end is made of, with F̄ = ½(F₀ + F₁).
    /// They are the discrete stress P̄; the difference F̄ (S₁ − S₀), whose moment vanishes too; and P₁.
    fn step_stresses(&self, f0: &Mat3, f1: &Mat3) -> [Mat3; 3] {
        let (start, end) = (self.stress(f0), self.stress(f1));
        let difference = discrete_gradient::stress_difference(f0, &start, f1, &end);
        [self.discrete_stress(f0, f1), difference, end]
    }

    /// [`Self::energy`] at the first `count` points of a batch, whose deformation beyond the D dimensions is held at zero. This and
    /// the next three are what a time step consists of: a law that can works on many points at once.
    fn energies<const D: usize>(&self, count: usize, f: &Batch<D>, out: &mut [f64])
    where
        Self: Sized,
    {
        out[..count].iter_mut().enumerate().for_each(|(k, out)| *out = self.energy(&embed(&f.get(k))));
    }

    /// [`Self::stress`] at the first `count` points of a batch.
    fn stresses<const D: usize>(&self, count: usize, f: &Batch<D>, out: &mut Batch<D>)
    where
        Self: Sized,
    {
        (0..count).for_each(|k| out.set(k, &restrict(&self.stress(&embed(&f.get(k))))));
    }

    /// [`Self::discrete_stress`] at the first `count` points of a batch.
    fn discrete_stresses<const D: usize>(
        &self,
        count: usize,
        f0: &Batch<D>,
        f1: &Batch<D>,
        out: &mut Batch<D>,
    ) where
        Self: Sized,
    {
        for k in 0..count {
            out.set(k, &restrict(&self.discrete_stress(&embed(&f0.get(k)), &embed(&f1.get(k)))));
        }
    }

    /// [`Self::step_stresses`] at the first `count` points of a batch.
    fn all_step_stresses<const D: usize>(
        &self,
        count: usize,
        f0: &Batch<D>,
        f1: &Batch<D>,
        out: &mut [Batch<D>; 3],
    ) where
        Self: Sized,
    {
        for k in 0..count {
            let stresses = self.step_stresses(&embed(&f0.get(k)), &embed(&f1.get(k)));
            out.iter_mut().zip(&stresses).for_each(|(out, stress)| out.set(k, &restrict(stress)));
        }
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
    /// Elastoplasticity: metal.
    #[serde(rename = "j2-plasticity")]
    J2Plasticity(J2Plasticity),
    /// No law: that of rigid bodies, which the case file knows by their kind.
    #[serde(skip)]
    Unstressed,
}

type BuildPointLaw<const D: usize> = fn(&LawSpec, Hypothesis) -> Result<Arc<dyn PointLaw<D>>, FemError>;

impl LawSpec {
    /// The law as elements see it under a hypothesis; where that takes nothing from the law, the law itself.
    ///
    /// # Errors
    /// If a material constant is out of range.
    pub fn point_law<const D: usize>(
        &self,
        hypothesis: Hypothesis,
    ) -> Result<Arc<dyn PointLaw<D>>, FemError> {
        compiled!(D, LawSpec::build_point_law as BuildPointLaw)(self, hypothesis)
    }

    fn build_point_law<const D: usize>(
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
            Self::MooneyRivlin(c) => under(hypothesis, Hyperelastic(ByInvariants(c.checked()?))),
            Self::Yeoh(c) => under(hypothesis, Hyperelastic(ByInvariants(c.checked()?))),
            Self::Ogden(c) => under(hypothesis, Hyperelastic(ByStretches(c.clone().checked()?))),
            Self::BlatzKo(c) => under(hypothesis, Hyperelastic(ByInvariants(c.checked()?))),
            Self::J2Plasticity(_) if hypothesis == Hypothesis::PlaneStress => {
                return Err(FemError::PlaneStress { what: "j2-plasticity" });
            }
            Self::J2Plasticity(c) => Arc::new(Flowing(c.checked()?)),
            Self::Unstressed => Arc::new(Confined(Unstressed)),
        })
    }
}
