use std::collections::BTreeMap;
use std::sync::Arc;

use carom_contact::{ClosedSurface, Obstacle, PolygonDefect, RigidShape};
use carom_mesh::Vector;

use super::values::{number, vector};
use crate::error::InputError;
use crate::scenario::ObstacleShape;

/// Vertices [m] of a surface, and those of every triangle, counter-clockwise as seen from outside.
pub type Triangles<const D: usize> = (Vec<Vector<D>>, Vec<[u32; 3]>);

/// Surfaces that a scenario takes from files, by the names of their obstacles.
pub type Surfaces<const D: usize> = BTreeMap<String, Triangles<D>>;

/// The obstacle under `key` in the case file; a surface `from_file` stands for the triangles that its shape does not say.
pub(crate) fn obstacle<const D: usize>(
    key: &str,
    shape: &ObstacleShape,
    from_file: Option<Triangles<D>>,
) -> Result<Obstacle<D>, InputError> {
    let of = |name: &str| format!("{key}.{name}");
    let radius =
        |radius: f64| number(&of("radius"), radius, radius > 0.0, "the radius must be greater than 0 m");
    let in_space = |what: &str| {
        let remedy =
            "is an obstacle in 3D; in the plane take a sphere, which is a circle there, a box or a polygon";
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
        ObstacleShape::Polygon { points } => {
            if D != 2 {
                return Err(InputError::new(of("kind"), PolygonDefect::NotInPlane.to_string()));
            }
            let key = of("points");
            let corners = points.iter().map(|x| vector(&key, x)).collect::<Result<_, _>>()?;
            let surface = ClosedSurface::polygon(corners);
            RigidShape::Surface(Arc::new(surface.map_err(|e| InputError::new(key, e.to_string()))?))
        }
        ObstacleShape::Surface { vertices, triangles } => {
            in_space("a surface")?;
            let (vertices, triangles) = match from_file {
                Some(surface) => surface,
                None => {
                    let vertex = |x: &Vec<f64>| vector(&of("vertices"), x);
                    (vertices.iter().map(vertex).collect::<Result<_, _>>()?, triangles.clone())
                }
            };
            let surface = ClosedSurface::new(vertices, &triangles);
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
