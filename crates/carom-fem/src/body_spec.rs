use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::material::{LawSpec, Mat3, PointLaw, Prestressed, Viscosity};
use crate::{FemError, Formulation, Hypothesis, PointMass};

/// How the mass of a body is shared among its nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MassKind {
    /// ∫ρ N_a N_b dV.
    #[default]
    Consistent,
    /// Row sums of the consistent mass; on quadratic cells, where these may be negative, its diagonal, scaled so that every
    /// cell keeps its mass.
    Lumped,
}

/// Rayleigh damping C = α M + β K₀, with K₀ the stiffness of the reference configuration turning with the body.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct RayleighDamping {
    /// α [1/s].
    pub mass: f64,
    /// β [s].
    pub stiffness: f64,
}

impl RayleighDamping {
    /// Whether there is any damping.
    #[must_use]
    pub fn is_active(&self) -> bool {
        self.mass != 0.0 || self.stiffness != 0.0
    }
}

/// What a body is made of.
#[derive(Debug, Clone, PartialEq)]
pub struct BodySpec {
    /// Material law.
    pub law: LawSpec,
    /// Density ρ [kg/m³].
    pub density: f64,
    /// Damping.
    pub damping: RayleighDamping,
    /// Viscosity.
    pub viscosity: Viscosity,
    /// Mass matrix.
    pub mass: MassKind,
    /// What a 2D body is in space.
    pub hypothesis: Hypothesis,
    /// How the deformation follows from the displacements.
    pub formulation: Formulation,
    /// Thickness in 2D [m], but of a body of revolution; 1 in 3D.
    pub thickness: f64,
    /// The stress that the body is under where it has not moved [Pa], symmetric; zero is none. There it is Cauchy's and the second of
    /// Piola and Kirchhoff, which it stays with the body as it moves.
    pub initial_stress: Mat3,
    /// Whether the body may grow.
    pub grows: bool,
    /// Masses at points, beside that of the volume.
    pub points: Vec<PointMass>,
    /// Whether the mass of the nodes that may touch others moves inside; total mass, centre and inertia stay.
    pub massless_contact: bool,
}

impl BodySpec {
    /// The law as elements see it that see D dimensions, under the initial stress.
    ///
    /// # Errors
    /// If a material constant is out of range or there can be no initial stress.
    pub(crate) fn point_law<const D: usize>(
        &self,
        hypothesis: Hypothesis,
    ) -> Result<Arc<dyn PointLaw<D>>, FemError> {
        let law = self.law.point_law::<D>(hypothesis)?;
        if self.initial_stress == Mat3::zeros() {
            return Ok(law);
        }
        if law.remembers() {
            let remedy =
                "its flow would not see it; choose an elastic law, or reach the stress in a stage before";
            return Err(FemError::InitialStress { what: "a body whose material flows", remedy });
        }
        if hypothesis == Hypothesis::PlaneStress {
            let remedy = "its change of thickness would not see it; choose another hypothesis";
            return Err(FemError::InitialStress { what: "a sheet in plane stress", remedy });
        }
        Ok(Arc::new(Prestressed::new(law, &self.initial_stress)))
    }
}
