//! Directions where distances have none.

use carom_mesh::Vector;

/// Distances below this, relative to the size of an obstacle, have a direction of round-off.
pub(super) const TOUCHING: f64 = 1e-9;

/// A vector along an axis.
pub(super) fn along<const D: usize>(axis: usize, length: f64) -> Vector<D> {
    Vector::from_fn(|i, _| if i == axis { length } else { 0.0 })
}
