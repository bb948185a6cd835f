use carom_contact::Obstacle;
use carom_mesh::Vector;

use super::{number, vector};
use crate::error::InputError;
use crate::scenario::ObstacleShape;

/// The obstacle under `key` in the case file.
pub(super) fn obstacle<const D: usize>(key: &str, shape: &ObstacleShape) -> Result<Obstacle<D>, InputError> {
    match shape {
        ObstacleShape::Plane { point, normal } => {
            let normal: Vector<D> = vector(&format!("{key}.normal"), normal)?;
            let length = normal.norm();
            let remedy = "the normal must not be zero and points to the free side";
            number(&format!("{key}.normal"), length, length > 0.0, remedy)?;
            let point = vector(&format!("{key}.point"), point)?;
            // The model gives obstacles their numbers.
            Ok(Obstacle::plane(point, normal / length, u32::MAX))
        }
    }
}
