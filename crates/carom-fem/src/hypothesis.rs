use serde::{Deserialize, Serialize};

/// What a 2D body is in space.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Hypothesis {
    /// A slice of a long body: no strain across the plane. Bodies in 3D have this one, for want of another.
    #[default]
    PlaneStrain,
    /// A sheet: no stress across the plane.
    PlaneStress,
    /// A body of revolution: x is the radius and y runs along the axis. Forces, masses and energies are those of the whole body.
    Axisymmetric,
}

/// How elements make the deformation at their points from the displacements of their nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Formulation {
    /// By the gradients of the shape functions.
    #[default]
    Standard,
    /// With one change of volume per cell, the mean, so that nearly incompressible bodies do not lock: for quad4 and hex8 cells.
    MeanDilatation,
}
