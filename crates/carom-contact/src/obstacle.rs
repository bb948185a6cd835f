use carom_mesh::Vector;

/// A rigid body that does not move.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Obstacle<const D: usize> {
    /// A half space.
    Plane {
        /// A point of the plane [m].
        point: Vector<D>,
        /// Unit normal, towards the free side.
        normal: Vector<D>,
    },
}

impl<const D: usize> Obstacle<D> {
    /// Signed distance of `x` [m], negative inside the obstacle, and the unit normal there.
    #[inline]
    #[must_use]
    pub fn gap(&self, x: &Vector<D>) -> (f64, Vector<D>) {
        match self {
            Obstacle::Plane { point, normal } => (normal.dot(&(x - point)), *normal),
        }
    }
}
