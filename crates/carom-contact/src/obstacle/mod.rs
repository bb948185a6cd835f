//! Rigid obstacles: for any point the signed distance to them and the unit normal there.

mod closed;
mod convex;
mod direction;
mod faceted;
mod polygon;

use crate::path::Positions;
use std::sync::Arc;

use carom_mesh::Vector;

pub use closed::{ClosedSurface, SurfaceDefect};
pub(crate) use faceted::{Faceted, box_corners};
pub use polygon::PolygonDefect;

/// Corners of obstacles without a number are numbered from here on, beyond any node.
const FIRST_CORNER: u32 = 1 << 31;

/// A rigid body that moves as prescribed, without turning.
#[derive(Debug, Clone, PartialEq)]
pub struct Obstacle<const D: usize> {
    /// Its shape where it has not moved.
    pub shape: RigidShape<D>,
    /// The number under which positions say how far it has moved [m], once it is [numbered](Self::numbered): to contact it is one more
    /// node. Without a number it rests where its shape says.
    pub node: Option<u32>,
    /// What of it has corners.
    pub(crate) faceted: Option<Faceted<D>>,
}

/// Shapes of obstacles.
#[derive(Debug, Clone, PartialEq)]
pub enum RigidShape<const D: usize> {
    /// A half space.
    Plane {
        /// A point of the plane [m].
        point: Vector<D>,
        /// Unit normal, towards the free side.
        normal: Vector<D>,
    },
    /// A ball, in 2D a disc; as a cavity all that is outside it.
    Sphere {
        /// Centre [m].
        centre: Vector<D>,
        /// Radius [m].
        radius: f64,
        /// Whether the inside is free, and not the outside.
        cavity: bool,
    },
    /// A cylinder without ends, in space; as a cavity all that is outside it.
    Cylinder {
        /// A point of the axis [m].
        point: Vector<D>,
        /// Unit vector along the axis.
        axis: Vector<D>,
        /// Radius [m].
        radius: f64,
        /// Whether the inside is free, and not the outside.
        cavity: bool,
    },
    /// A box with sides along the axes, in 2D a rectangle.
    Box {
        /// The corner with the smallest coordinates [m].
        corner: Vector<D>,
        /// Sides [m].
        size: Vector<D>,
    },
    /// What a closed surface encloses, in the plane a polygon.
    Surface(Arc<ClosedSurface<D>>),
}

impl<const D: usize> Obstacle<D> {
    /// An obstacle of this shape that rests; a model of bodies gives it the number of its motion.
    #[must_use]
    pub fn new(shape: RigidShape<D>) -> Self {
        Self { node: None, faceted: Faceted::of(&shape, FIRST_CORNER), shape }
    }

    /// The same with the number `node` of its motion, and its corners numbered from `first_corner` on: after all nodes and motions.
    #[must_use]
    pub fn numbered(self, node: u32, first_corner: u32) -> Self {
        Self { node: Some(node), faceted: Faceted::of(&self.shape, first_corner), shape: self.shape }
    }

    /// A half space that rests.
    #[must_use]
    pub fn plane(point: Vector<D>, normal: Vector<D>) -> Self {
        Self::new(RigidShape::Plane { point, normal })
    }

    /// How far it has moved [m], the nodes being at `position`.
    #[inline]
    pub(crate) fn shift(&self, position: &Positions<'_, D>) -> Vector<D> {
        self.node.map_or_else(Vector::zeros, position)
    }

    /// Signed distance of `x` [m], negative inside the obstacle, and the unit normal there: the gradient of the distance.
    #[inline]
    #[must_use]
    pub fn gap(&self, x: &Vector<D>, position: &Positions<'_, D>) -> (f64, Vector<D>) {
        self.shape.gap(&(x - self.shift(position)))
    }

    /// Whether `x` is within `margin` [m] of the obstacle or inside it.
    #[inline]
    pub(crate) fn is_near(&self, x: &Vector<D>, margin: f64, position: &Positions<'_, D>) -> bool {
        self.gap(x, position).0 <= margin
    }

    /// Whether it has corners, and facets between them.
    #[must_use]
    pub fn has_corners(&self) -> bool {
        self.faceted.is_some()
    }

    /// Whether it may be inside a body without a node of that being inside it.
    #[must_use]
    pub fn touches_between_nodes(&self) -> bool {
        self.has_corners() || self.shape.bulging_radius().is_some()
    }

    /// Whether a corner of the obstacle has this number.
    #[must_use]
    pub fn has_corner(&self, n: u32) -> bool {
        self.corner_index(n).is_some()
    }

    /// Which of its corners has this number, from 0 on; none if it is that of a node. Corner k of a box has the far end of axis i if bit i of k is set.
    #[must_use]
    pub fn corner_index(&self, n: u32) -> Option<u32> {
        self.faceted.as_ref()?.corner_index(n)
    }

    /// Where nodes and the corners of this obstacle are, the nodes being at `position`.
    pub(crate) fn placed(&self, position: &Positions<'_, D>) -> impl Fn(u32) -> Vector<D> {
        move |n| match self.faceted.as_ref().and_then(|f| f.corner(n)) {
            Some(corner) => corner + self.shift(position),
            None => position(n),
        }
    }
}

impl<const D: usize> RigidShape<D> {
    /// How far it bulges into a facet of this `size` [m] whose nodes touch it [m]. Beside what is larger it touches the facet itself.
    pub(crate) fn bulge(&self, size: f64) -> f64 {
        let radius = self.bulging_radius().filter(|radius| size <= *radius);
        radius.map_or(0.0, |radius| size * size / (8.0 * radius))
    }

    pub(crate) fn gap(&self, x: &Vector<D>) -> (f64, Vector<D>) {
        match self {
            Self::Plane { point, normal } => (normal.dot(&(x - point)), *normal),
            Self::Sphere { radius, cavity, .. } | Self::Cylinder { radius, cavity, .. } => {
                convex::round(&self.offset_of(x), *radius, *cavity)
            }
            Self::Box { corner, size } => convex::cuboid(&(x - corner - size * 0.5), &(size * 0.5)),
            Self::Surface(surface) => surface.gap(x),
        }
    }
}
