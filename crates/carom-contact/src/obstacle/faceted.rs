//! The facets of obstacles that have corners: to a body they are what the facets of another body are.

use carom_mesh::{CellKind, Facet, Surface, Vector};

use super::RigidShape;
use crate::ContactSurface;
use crate::aabb::Aabb;

/// The boundary of an obstacle with corners and, in space, edges.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Faceted<const D: usize> {
    pub surface: ContactSurface,
    /// A box around the corners where the obstacle has not moved.
    pub bounds: Aabb<D>,
    /// Where the corners are then [m].
    corners: Vec<Vector<D>>,
    /// The number of the first of them.
    first: u32,
}

impl<const D: usize> Faceted<D> {
    /// That of a `shape`, its corners numbered from `first` on; none if it is round or has no end.
    pub fn of(shape: &RigidShape<D>, first: u32) -> Option<Self> {
        let (corners, facets) = match shape {
            RigidShape::Box { corner, size } => (box_corners(corner, size), box_facets(D)),
            RigidShape::Surface(surface) => (surface.vertices().to_vec(), surface.facets().to_vec()),
            RigidShape::Plane { .. } | RigidShape::Sphere { .. } | RigidShape::Cylinder { .. } => {
                return None;
            }
        };
        let at = |n: u32| corners[(n - first) as usize];
        let surface = ContactSurface::new(&Surface::of_facets(facets, &[]), first, &at);
        let surface = surface.without_flat_sources(&at);
        Some(Self { surface, bounds: Aabb::of(corners.iter().copied()), corners, first })
    }

    /// Which corner has this number, from 0 on; none if it is that of a node.
    pub fn corner_index(&self, n: u32) -> Option<u32> {
        let index = n.checked_sub(self.first)?;
        ((index as usize) < self.corners.len()).then_some(index)
    }

    /// Where a corner is before the obstacle has moved [m]; none if the number is that of a node.
    #[inline]
    pub fn corner(&self, n: u32) -> Option<&Vector<D>> {
        self.corners.get(n.checked_sub(self.first)? as usize)
    }
}

/// Corner k of a box has the far end of axis i if bit i of k is set.
pub(crate) fn box_corners<const D: usize>(corner: &Vector<D>, size: &Vector<D>) -> Vec<Vector<D>> {
    let at = |k: usize| Vector::from_fn(|i, _| corner[i] + if k >> i & 1 == 1 { size[i] } else { 0.0 });
    (0..1 << D).map(at).collect()
}

/// The sides of a box by its corners, in the sense in which they have the box behind them.
fn box_facets(dimension: usize) -> Vec<Facet> {
    const LINES: [[u32; 2]; 4] = [[0, 1], [1, 3], [3, 2], [2, 0]];
    const SQUARES: [[u32; 4]; 6] =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    if dimension == 2 {
        LINES.map(|nodes| Facet { kind: CellKind::Line2, nodes: nodes.to_vec() }).to_vec()
    } else {
        SQUARES.map(|nodes| Facet { kind: CellKind::Quad4, nodes: nodes.to_vec() }).to_vec()
    }
}
