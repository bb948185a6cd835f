use super::real::Real;

/// Right-hand sides taken together. Always as many, of which some may be zero: how a sum is rounded must not depend on the others.
pub(super) const ABREAST: usize = 32;

/// One number of every right-hand side.
pub(super) type Row<T> = [T; ABREAST];

/// Adds `other` to `row`.
pub(super) fn add<T: Real>(row: &mut Row<T>, other: &Row<T>) {
    row.iter_mut().zip(other).for_each(|(row, other)| *row += *other);
}
