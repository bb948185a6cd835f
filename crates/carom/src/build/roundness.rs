//! Rigid bodies that are round: as discs and balls touch, so they have mass.

use std::f64::consts::PI;

use carom_fem::Hypothesis;
use carom_mesh::{Matrix, Vector};

use super::values::vector;
use crate::error::InputError;
use crate::scenario::{BodyEntry, BodyKind, MeshSpec};

/// The disc or the ball that a round body is; its mesh has corners in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Roundness<const D: usize> {
    /// Its centre [m].
    pub centre: Vector<D>,
    /// The centre of its mass [m]: its own, or of a ring around the axis that on the axis.
    pub centre_of_mass: Vector<D>,
    /// Its radius [m].
    pub radius: f64,
    /// Its volume [m³], in the plane with its thickness, or around the axis.
    pub volume: f64,
}

impl<const D: usize> Roundness<D> {
    /// That of a body; none of one that is its mesh.
    pub fn of(key: &str, entry: &BodyEntry) -> Result<Option<Self>, InputError> {
        if !entry.round {
            return Ok(None);
        }
        let key = format!("{key}.round");
        let (centre, radius): (&[f64], f64) = match &entry.mesh {
            MeshSpec::Disc { centre, radius, .. } => (centre, *radius),
            MeshSpec::Ball { centre, radius, .. } => (centre, *radius),
            _ => {
                let message =
                    format!("body {:?} is round with a disc or a ball as its mesh; leave it out", entry.name);
                return Err(InputError::new(key, message));
            }
        };
        if entry.kind != BodyKind::Rigid {
            let message =
                format!("body {:?} deforms and is what its mesh makes it; leave it out", entry.name);
            return Err(InputError::new(key, message));
        }
        let centre: Vector<D> = vector(&key, centre)?;
        let across = PI * radius * radius;
        let volume = match entry.hypothesis {
            _ if D == 3 => across * radius * 4.0 / 3.0,
            // A ring with a round section (Pappus).
            Hypothesis::Axisymmetric => across * 2.0 * PI * centre[0],
            _ => across * entry.thickness,
        };
        let mut centre_of_mass = centre;
        if entry.hypothesis == Hypothesis::Axisymmetric {
            centre_of_mass[0] = 0.0;
        }
        Ok(Some(Self { centre, centre_of_mass, radius, volume }))
    }

    /// Its inertia about its centre [kg m²] with this `mass` [kg]: ½ m R² of a disc, ⅖ m R² of a ball.
    pub fn inertia(&self, mass: f64) -> Matrix<3> {
        let part = if D == 3 { 0.4 } else { 0.5 };
        Matrix::<3>::from_diagonal_element(part * mass * self.radius * self.radius)
    }
}
