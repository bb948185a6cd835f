use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::material::{LawSpec, Mat3, PointLaw, Prestressed, Viscosity};
use crate::{FemError, Formulation, Hypothesis, PointMass, Share};

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

/// Cells of a body that are of another material than the rest.
#[derive(Debug, Clone, PartialEq)]
pub struct RegionSpec {
    /// The numbers of the cells; what is not of the mesh does no harm. A cell of two regions is of the last.
    pub cells: Vec<u32>,
    /// Material law.
    pub law: LawSpec,
    /// Density ρ [kg/m³].
    pub density: f64,
    /// Damping.
    pub damping: RayleighDamping,
    /// Viscosity.
    pub viscosity: Viscosity,
}

/// What a body is made of.
#[derive(Debug, Clone, PartialEq)]
pub struct BodySpec {
    /// Material law, but of regions.
    pub law: LawSpec,
    /// Density ρ [kg/m³], but of regions.
    pub density: f64,
    /// Damping, but of regions; that by mass is the same in all.
    pub damping: RayleighDamping,
    /// Viscosity, but of regions.
    pub viscosity: Viscosity,
    /// What is of other materials.
    pub regions: Vec<RegionSpec>,
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
    /// Which of its cells this process has, where others have the rest.
    pub share: Option<Share>,
}

impl BodySpec {
    /// A body that is all of the material of a region.
    #[must_use]
    pub fn all_of(&self, region: &RegionSpec) -> Self {
        let RegionSpec { law, density, damping, viscosity, .. } = region.clone();
        Self { law, density, damping, viscosity, regions: Vec::new(), ..self.clone() }
    }

    /// One body of each of its materials: of that of the rest, then of those of its regions.
    #[must_use]
    pub fn by_material(&self) -> Vec<Self> {
        let rest = Self { regions: Vec::new(), ..self.clone() };
        std::iter::once(rest).chain(self.regions.iter().map(|region| self.all_of(region))).collect()
    }

    /// Checks the constants of the material of the rest.
    ///
    /// # Errors
    /// If one is out of range, or the hypothesis does not suit the law.
    pub fn check<const D: usize>(&self) -> Result<(), FemError> {
        let positive = |name, value: f64, remedy| {
            if value.is_finite() && value > 0.0 {
                Ok(())
            } else {
                Err(FemError::MaterialConstant { name, value, remedy })
            }
        };
        positive("density", self.density, "the density must be greater than 0 kg/m³")?;
        positive("thickness", self.thickness, "the thickness must be greater than 0 m")?;
        for (name, value) in
            [("damping.mass", self.damping.mass), ("damping.stiffness", self.damping.stiffness)]
        {
            if !(value.is_finite() && value >= 0.0) {
                return Err(FemError::MaterialConstant { name, value, remedy: "damping cannot be negative" });
            }
        }
        self.law.point_law::<D>(self.hypothesis)?;
        self.viscosity.check()
    }

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
