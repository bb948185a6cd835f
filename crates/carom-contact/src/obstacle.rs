use carom_mesh::Vector;

/// A rigid body that moves as prescribed, without turning.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Obstacle<const D: usize> {
    /// Its shape where it has not moved.
    pub shape: RigidShape<D>,
    /// The number under which positions say how far it has moved [m]: to contact it is one more node.
    pub node: u32,
}

/// Shapes of obstacles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RigidShape<const D: usize> {
    /// A half space.
    Plane {
        /// A point of the plane [m].
        point: Vector<D>,
        /// Unit normal, towards the free side.
        normal: Vector<D>,
    },
}

impl<const D: usize> Obstacle<D> {
    /// A half space; `node` is the number of its motion.
    #[must_use]
    pub fn plane(point: Vector<D>, normal: Vector<D>, node: u32) -> Self {
        Self { shape: RigidShape::Plane { point, normal }, node }
    }

    /// Signed distance of `x` [m], negative inside the obstacle, and the unit normal there.
    #[inline]
    #[must_use]
    pub fn gap(&self, x: &Vector<D>, position: &impl Fn(u32) -> Vector<D>) -> (f64, Vector<D>) {
        match &self.shape {
            RigidShape::Plane { point, normal } => (normal.dot(&(x - point - position(self.node))), *normal),
        }
    }
}
