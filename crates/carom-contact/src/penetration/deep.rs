use carom_mesh::Vector;

/// A place inside a solid: its depth [m], where it is, and which facets are there, of its own boundary and of the other.
#[derive(Debug, Clone, Copy)]
pub(super) struct Deep<const D: usize> {
    pub depth: f64,
    pub at: Vector<D>,
    pub facet: Option<u32>,
    pub other: Option<u32>,
}

impl<const D: usize> Deep<D> {
    /// Nowhere inside.
    pub fn none() -> Self {
        Self { depth: 0.0, at: Vector::zeros(), facet: None, other: None }
    }

    pub fn deeper(self, other: Self) -> Self {
        if other.depth > self.depth { other } else { self }
    }
}
