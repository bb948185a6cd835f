//! Directions where distances have none.

use carom_mesh::Vector;

/// A vector along an axis.
pub(super) fn along<const D: usize>(axis: usize, length: f64) -> Vector<D> {
    Vector::from_fn(|i, _| if i == axis { length } else { 0.0 })
}
