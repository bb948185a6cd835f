//! Hyperelastic laws, written once in 3D. A new law is a file here, a line in [`LawSpec`] and
//! one where [`crate::Body::new`] makes it.

#[cfg(test)]
mod contract;
mod elastic_constants;
mod linear_elastic;
mod point_law;
mod saint_venant_kirchhoff;

use std::fmt::Debug;

use nalgebra::Matrix3;
use serde::{Deserialize, Serialize};

pub use elastic_constants::ElasticConstants;
pub use linear_elastic::LinearElastic;
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
}
