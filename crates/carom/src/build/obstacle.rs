use std::sync::Arc;

use carom_contact::{ClosedSurface, Obstacle, RigidShape};
use carom_mesh::Vector;

use super::values::{number, vector};
use crate::error::InputError;
use crate::scenario::ObstacleShape;

/// The obstacle under `key` in the case file.
pub(super) fn obstacle<const D: usize>(key: &str, shape: &ObstacleShape) -> Result<Obstacle<D>, InputError> {
    let of = |name: &str| format!("{key}.{name}");
    let radius =
        |radius: f64| number(&of("radius"), radius, radius > 0.0, "the radius must be greater than 0 m");
    let in_space = |what: &str| {
        let remedy = "is an obstacle in 3D; in the plane take a sphere, which is a circle there, or a box";
        if D == 3 { Ok(()) } else { Err(InputError::new(of("kind"), format!("{what} {remedy}"))) }
    };
    let shape = match shape {
        ObstacleShape::Plane { point, normal } => {
            let remedy = "the normal must not be zero and points to the free side";
            let normal = direction(&of("normal"), normal, remedy)?;
            RigidShape::Plane { point: vector(&of("point"), point)?, normal }
        }
        ObstacleShape::Sphere { centre, radius: r, cavity } => {
            radius(*r)?;
            RigidShape::Sphere { centre: vector(&of("centre"), centre)?, radius: *r, cavity: *cavity }
        }
        ObstacleShape::Cylinder { point, axis, radius: r, cavity } => {
            in_space("a cylinder")?;
            radius(*r)?;
            let axis = direction(&of("axis"), axis, "the axis must not be zero")?;
            RigidShape::Cylinder { point: vector(&of("point"), point)?, axis, radius: *r, cavity: *cavity }
        }
        ObstacleShape::Box { corner, size } => {
            let size: Vector<D> = vector(&of("size"), size)?;
            for side in &size {
                number(&of("size"), *side, *side > 0.0, "every side must be greater than 0 m")?;
            }
            RigidShape::Box { corner: vector(&of("corner"), corner)?, size }
        }
        ObstacleShape::Surface { vertices, triangles } => {
            in_space("a surface")?;
            let vertices = vertices.iter().map(|x| vector(&of("vertices"), x)).collect::<Result<_, _>>()?;
            let surface = ClosedSurface::new(vertices, triangles);
            RigidShape::Surface(Arc::new(surface.map_err(|e| InputError::mesh(key, e.to_string()))?))
        }
    };
    Ok(Obstacle::new(shape))
}

/// A unit vector along `values`.
fn direction<const D: usize>(key: &str, values: &[f64], remedy: &str) -> Result<Vector<D>, InputError> {
    let direction: Vector<D> = vector(key, values)?;
    let length = direction.norm();
    number(key, length, length > 0.0, remedy)?;
    Ok(direction / length)
}
