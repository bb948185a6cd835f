//! What displacements of a body are made of.

use carom_mesh::{Vector, tensor};

/// What small displacements of a body are made of: a shift of the centre of mass, a rotation about it, and amplitudes of vibrations.
#[derive(Debug, Clone, PartialEq)]
pub struct Content<const D: usize> {
    /// The shift [m]; of velocities [m/s].
    pub shift: Vector<D>,
    /// The vector of the rotation, in the plane its third component alone; of velocities [1/s].
    pub turn: [f64; 3],
    /// The amplitudes [m √kg]; of velocities [m √kg/s].
    pub amplitudes: Vec<f64>,
}

impl<const D: usize> Content<D> {
    /// Nothing, with room for so many amplitudes.
    #[must_use]
    pub fn of(count: usize) -> Self {
        Self { shift: Vector::zeros(), turn: [0.0; 3], amplitudes: vec![0.0; count] }
    }
}

/// The rigid motions of a point with this arm: shifts along the axes, and turns about those that there are in D dimensions.
pub(super) fn rigid_motions<const D: usize>(arm: &Vector<D>) -> Vec<Vector<D>> {
    let shifts = (0..D).map(|i| Vector::from_fn(|k, _| f64::from(u8::from(k == i))));
    let axes = if D == 2 { 2..3 } else { 0..3 };
    let turns = axes.map(|axis| {
        let omega: [f64; 3] = std::array::from_fn(|k| f64::from(u8::from(k == axis)));
        tensor::rotation_velocity(&omega, arm)
    });
    shifts.chain(turns).collect()
}
