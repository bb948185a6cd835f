//! The corners and edges of obstacles.

use carom_mesh::Vector;

use crate::RigidShape;

/// Where an obstacle has corners and edges, before it has moved [m].
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Skin<const D: usize> {
    pub corners: Vec<Vector<D>>,
    pub edges: Vec<[Vector<D>; 2]>,
}

impl<const D: usize> Skin<D> {
    pub fn of(shape: &RigidShape<D>) -> Self {
        match shape {
            RigidShape::Box { corner, size } => Self::of_box(corner, size),
            RigidShape::Surface(surface) => {
                Self { corners: surface.vertices().to_vec(), edges: surface.edges().collect() }
            }
            RigidShape::Plane { .. } | RigidShape::Sphere { .. } | RigidShape::Cylinder { .. } => {
                Self { corners: Vec::new(), edges: Vec::new() }
            }
        }
    }

    /// Corner k has the far end of axis i if bit i of k is set.
    fn of_box(corner: &Vector<D>, size: &Vector<D>) -> Self {
        let at = |k: usize| Vector::from_fn(|i, _| corner[i] + if k >> i & 1 == 1 { size[i] } else { 0.0 });
        let count = 1 << D;
        let along = |i: usize| (0..count).filter(move |k| k >> i & 1 == 0).map(move |k| [k, k | 1 << i]);
        Self {
            corners: (0..count).map(at).collect(),
            edges: (0..D).flat_map(along).map(|ends| ends.map(at)).collect(),
        }
    }
}
