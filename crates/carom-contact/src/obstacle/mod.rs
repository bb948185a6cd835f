//! Rigid obstacles: for any point the signed distance to them and the unit normal there.

mod closed;
mod convex;
mod direction;

use std::sync::Arc;

use carom_mesh::Vector;

pub use closed::{ClosedSurface, SurfaceDefect};

/// A rigid body that moves as prescribed, without turning.
#[derive(Debug, Clone, PartialEq)]
pub struct Obstacle<const D: usize> {
    /// Its shape where it has not moved.
    pub shape: RigidShape<D>,
    /// The number under which positions say how far it has moved [m]: to contact it is one more node.
    pub node: u32,
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
    /// What a closed surface encloses.
    Surface(Arc<ClosedSurface<D>>),
}

impl<const D: usize> Obstacle<D> {
    /// An obstacle of this shape; the model gives it the number of its motion.
    #[must_use]
    pub fn new(shape: RigidShape<D>) -> Self {
        Self { shape, node: u32::MAX }
    }

    /// A half space; `node` is the number of its motion.
    #[must_use]
    pub fn plane(point: Vector<D>, normal: Vector<D>, node: u32) -> Self {
        Self { shape: RigidShape::Plane { point, normal }, node }
    }

    /// Signed distance of `x` [m], negative inside the obstacle, and the unit normal there: the gradient of the distance.
    #[inline]
    #[must_use]
    pub fn gap(&self, x: &Vector<D>, position: &impl Fn(u32) -> Vector<D>) -> (f64, Vector<D>) {
        self.shape.gap(&(x - position(self.node)))
    }

    /// Whether `x` may be within `margin` [m] of the obstacle or inside it; as sharp as it is cheap to say.
    #[inline]
    pub(crate) fn is_near(&self, x: &Vector<D>, margin: f64, position: &impl Fn(u32) -> Vector<D>) -> bool {
        let x = x - position(self.node);
        match &self.shape {
            RigidShape::Surface(surface) if !surface.bounds().inflated(margin).contains(&x) => false,
            shape => shape.gap(&x).0 <= margin,
        }
    }
}

impl<const D: usize> RigidShape<D> {
    pub(crate) fn gap(&self, x: &Vector<D>) -> (f64, Vector<D>) {
        match self {
            Self::Plane { point, normal } => (normal.dot(&(x - point)), *normal),
            Self::Sphere { centre, radius, cavity } => convex::round(&(x - centre), *radius, *cavity),
            Self::Cylinder { point, axis, radius, cavity } => {
                let offset = x - point;
                convex::round(&(offset - axis * axis.dot(&offset)), *radius, *cavity)
            }
            Self::Box { corner, size } => convex::cuboid(&(x - corner - size * 0.5), &(size * 0.5)),
            Self::Surface(surface) => surface.gap(x),
        }
    }
}
