//! Motions that corrections of a load step leave out.

use carom_mesh::{Vector, nodal};

/// Leaves a motion of unit length out of another.
pub(crate) fn leave_out<const D: usize>(unit: &[Vector<D>], of: &mut [Vector<D>]) {
    let part = nodal::dot(unit, of);
    of.iter_mut().zip(unit).for_each(|(x, unit)| *x -= unit * part);
}

/// Makes the length of a motion, which is not zero, one.
pub(crate) fn normalise<const D: usize>(motion: &mut [Vector<D>]) {
    let length = nodal::dot(motion, motion).sqrt();
    motion.iter_mut().for_each(|x| *x /= length);
}
