//! How a reduced body yields to forces on its nodes.

use carom_mesh::Matrix;

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
    let rigid: f64 = (0..D).map(|i| rigid[(i, i)]).sum();
    let shapes =
        part.reduction.shapes_at(node as usize).into_iter().flat_map(|along| along.iter().enumerate());
    (rigid + shapes.map(|(k, shape)| compliance(k) * shape * shape).sum::<f64>()) / D as f64
}

/// The shapes of a node, each times how its amplitude yields.
pub(super) fn weighed<const D: usize>(
    part: &ReducedPart<D>,
    node: u32,
    compliance: impl Fn(usize) -> f64,
) -> [Vec<f64>; D] {
    let weigh = |shapes: &[f64]| shapes.iter().enumerate().map(|(k, shape)| compliance(k) * shape).collect();
    part.reduction.shapes_at(node as usize).map(weigh)
}

/// Σ c Φ_a ⊗ Φ_b: how the vibrations let the node `a` yield to a force on `b`, in the frame of the body.
pub(super) fn inner<const D: usize>(part: &ReducedPart<D>, a: &[Vec<f64>; D], b: u32) -> Matrix<D> {
    let rows = part.reduction.displacements(b as usize, a.each_ref().map(Vec::as_slice));
    Matrix::from_fn(|i, j| rows[i][j])
}

/// How shifts and turns answer to impulses: the inverse of the mass [1/kg] and of the inertia [1/(kg m²)].
pub(super) fn mobility<const D: usize>(shape: &RigidShape<D>, rotation: &Matrix<3>) -> [Matrix<3>; 2] {
    let mass = Matrix::<3>::from_diagonal_element(shape.mass);
    [inverse_on(&shape.moves_along, &mass), inverse_on(&shape.turns_about, &shape.inertia_at(rotation))]
}
