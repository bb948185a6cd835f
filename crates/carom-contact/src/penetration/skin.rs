//! The corners and edges of obstacles.

use carom_mesh::Vector;

use crate::RigidShape;
use crate::aabb::Aabb;
use crate::obstacle::box_corners;

/// Where an obstacle has corners and edges, before it has moved [m].
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Skin<const D: usize> {
    pub corners: Vec<Vector<D>>,
    pub edges: Vec<[Vector<D>; 2]>,
    /// The middle of what is round on all sides, and its radius [m].
    pub ball: Option<(Vector<D>, f64)>,
    /// How thin it is [m]: its shortest side, or that of the box around it; none if it has no end.
    pub thickness: f64,
}

impl<const D: usize> Skin<D> {
    pub fn of(shape: &RigidShape<D>) -> Self {
        match shape {
            RigidShape::Box { corner, size } => Self::of_box(corner, size),
            RigidShape::Surface(surface) => {
                let corners = surface.vertices().to_vec();
                let thickness = Aabb::of(corners.iter().copied()).shortest_side();
                Self { corners, edges: surface.edges().collect(), ball: None, thickness }
            }
            RigidShape::Sphere { centre, radius, cavity: false } => {
                Self { ball: Some((*centre, *radius)), ..Self::round(2.0 * radius) }
            }
            RigidShape::Cylinder { radius, cavity: false, .. } => Self::round(2.0 * radius),
            // Nobody comes out on the other side of these.
            RigidShape::Plane { .. } | RigidShape::Sphere { .. } | RigidShape::Cylinder { .. } => {
                Self::round(f64::INFINITY)
            }
        }
    }

    fn round(thickness: f64) -> Self {
        Self { corners: Vec::new(), edges: Vec::new(), ball: None, thickness }
    }

    fn of_box(corner: &Vector<D>, size: &Vector<D>) -> Self {
        let corners = box_corners(corner, size);
        let along = |i: usize| (0..1 << D).filter(move |k| k >> i & 1 == 0).map(move |k| [k, k | 1 << i]);
        let edges = (0..D).flat_map(along).map(|ends| ends.map(|k: usize| corners[k])).collect();
        Self { corners, edges, ball: None, thickness: size.min() }
    }
}
