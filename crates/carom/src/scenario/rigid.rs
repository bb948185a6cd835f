//! What the case file says of rigid bodies.

use carom_fem::MassKind;
use serde::{Deserialize, Serialize};

/// Kinds of bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum BodyKind {
    /// Of finite elements.
    #[default]
    Deformable,
    /// Its nodes move as one.
    Rigid,
    /// It moves as a rigid one, and vibrates in few shapes.
    Reduced,
    /// Of somebody else's code.
    Foreign,
}

/// The mass of a body.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum BodyMass {
    /// Of its density, shared among its nodes like this.
    Shared(MassKind),
    /// So much [kg], of a rigid body.
    Given(f64),
}

/// The inertia of a rigid body about its centre of mass [kg m²].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Inertia {
    /// In the plane.
    InPlane(f64),
    /// About the axes of space, which are its principal axes.
    Principal([f64; 3]),
    /// All components about the axes of space.
    Tensor([[f64; 3]; 3]),
}
