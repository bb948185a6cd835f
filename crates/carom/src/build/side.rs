//! What the pairs of a body depend on.

use carom_mesh::{Facet, Surface, Vector};

/// Widths and masses apart by no more than this part are alike: files of meshes in single precision lose as much.
const ALIKE: f64 = 1e-6;

/// A body in its pairs.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Side {
    pub name: String,
    pub touches_itself: bool,
    pub is_periodic: bool,
    /// Mean width of its facets [m].
    pub facet_width: f64,
    /// Its mass [kg]; zero where nobody knows it.
    pub mass: f64,
}

impl Side {
    /// Whether the facets are on average smaller than those of another, or as large and the body is the lighter one.
    pub fn is_finer_than(&self, other: &Self) -> bool {
        let is_less = |x: f64, y: f64| x < (1.0 - ALIKE) * y;
        let [width, other_width] = [self.facet_width, other.facet_width];
        is_less(width, other_width) || !is_less(other_width, width) && is_less(self.mass, other.mass)
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
