//! How a reduced body yields to forces on its nodes.

use carom_mesh::{Matrix, Vector};

use super::part::ReducedPart;
use crate::body::rigid::pose::{cross_matrix, inverse_on};
use crate::body::rigid::shape::RigidShape;

/// How a node yields to a force on itself where it is drawn, with these compliances of rigid motions and of amplitudes, in the mean of the directions.
pub(super) fn own_compliance<const D: usize>(
    part: &ReducedPart<D>,
    node: u32,
    [shift, turn]: &[Matrix<3>; 2],
    compliance: impl Fn(usize) -> f64,
) -> f64 {
    let arm = cross_matrix(&part.shape.arm(node as usize));
    let rigid = shift - arm * turn * arm;
    let shapes = part.reduction.shapes_at(node as usize);
    let rigid: f64 = (0..D).map(|i| rigid[(i, i)]).sum();
    (rigid + inner(shapes, shapes, compliance).trace()) / D as f64
}

/// Σ c Φ_a ⊗ Φ_b: how the vibrations let one node yield to a force on another, in the frame of the body.
pub(super) fn inner<const D: usize>(
    a: &[Vector<D>],
    b: &[Vector<D>],
    compliance: impl Fn(usize) -> f64,
) -> Matrix<D> {
    let mut sum = Matrix::zeros();
    for (k, (a, b)) in a.iter().zip(b).enumerate() {
        sum += a * (b * compliance(k)).transpose();
    }
    sum
}

/// How shifts and turns answer to impulses: the inverse of the mass [1/kg] and of the inertia [1/(kg m²)].
pub(super) fn mobility<const D: usize>(shape: &RigidShape<D>, rotation: &Matrix<3>) -> [Matrix<3>; 2] {
    let mass = Matrix::<3>::from_diagonal_element(shape.mass);
    [inverse_on(&shape.moves_along, &mass), inverse_on(&shape.turns_about, &shape.inertia_at(rotation))]
}
