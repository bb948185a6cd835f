//! What the pairs of a body depend on.

use carom_mesh::{Facet, Surface, Vector};

/// A body in its pairs.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Side {
    pub name: String,
    pub touches_itself: bool,
    pub is_periodic: bool,
    /// Mean width of its facets [m].
    pub facet_width: f64,
}

impl Side {
    /// Whether the facets are on average clearly smaller than those of another.
    pub fn is_finer_than(&self, other: &Self) -> bool {
        self.facet_width < 0.99 * other.facet_width
    }
}

/// Mean width of the facets of a surface [m], of which nodes are at `position`.
pub(crate) fn facet_width<const D: usize>(
    surface: &Surface,
    position: impl Fn(usize) -> Vector<D> + Copy,
) -> f64 {
    let facets = surface.facets();
    let width = |f: &Facet| f.area_vector_at(position).norm().powf(1.0 / (D as f64 - 1.0));
    facets.iter().map(width).sum::<f64>() / facets.len() as f64
}
