//! What the pairs of a body depend on.

use carom_contact::Side;
use carom_mesh::{Facet, Surface, Vector};

/// A body in its pairs.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct NamedSide {
    pub name: String,
    pub is_periodic: bool,
    pub side: Side,
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
