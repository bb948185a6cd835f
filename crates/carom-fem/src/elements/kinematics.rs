use std::fmt::Debug;

use carom_mesh::{Matrix, Vector};

use crate::material::Tangent;

/// How the deformation gradient F, S × S, follows from nodal displacements in D dimensions, F = I + Σ L(u_a, g_a), with one
/// gradient g_a of every node at every quadrature point.
pub(crate) trait Kinematics<const D: usize, const S: usize>: Send + Sync + Debug + 'static {
    /// The gradient g of a node from that of its shape function ∂N/∂X [1/m].
    fn gradient(shape: &Vector<D>) -> Vector<S>;
    /// Adds L(u, g) to `f`.
    fn add_displacement(f: &mut Matrix<S>, u: &Vector<D>, g: &Vector<S>);
    /// The nodal force of a stress P: Σ_ij P_ij ∂L_ij/∂u.
    fn force(p: &Matrix<S>, g: &Vector<S>) -> Vector<D>;
    /// For every component of the displacement of a node the stress that it causes, Σ_ij w ∂L_ij/∂u A_ijkl.
    fn stress_of_displacement(tangent: &Tangent<S>, g: &Vector<S>, weight: f64) -> [Matrix<S>; D];
    /// Adds the forces [`Self::force`] of these stresses, one per row, to `k`.
    fn add_forces(k: &mut Matrix<D>, stresses: &[Matrix<S>; D], g: &Vector<S>);
}

/// F = I + Σ u_a ⊗ ∂N_a/∂X: in space, and in a plane.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Solid;

impl<const D: usize> Kinematics<D, D> for Solid {
    fn gradient(shape: &Vector<D>) -> Vector<D> {
        *shape
    }

    #[inline]
    fn add_displacement(f: &mut Matrix<D>, u: &Vector<D>, g: &Vector<D>) {
        *f += u * g.transpose();
    }

    #[inline]
    fn force(p: &Matrix<D>, g: &Vector<D>) -> Vector<D> {
        p * g
    }

    #[inline]
    fn stress_of_displacement(tangent: &Tangent<D>, g: &Vector<D>, weight: f64) -> [Matrix<D>; D] {
        let mut stress = [Matrix::zeros(); D];
        for i in 0..D {
            for j in 0..D {
                let g = g[j] * weight;
                for k in 0..D {
                    for l in 0..D {
                        stress[i][(k, l)] += g * tangent[i][j][k][l];
                    }
                }
            }
        }
        stress
    }

    #[inline]
    fn add_forces(matrix: &mut Matrix<D>, stresses: &[Matrix<D>; D], g: &Vector<D>) {
        for i in 0..D {
            for k in 0..D {
                for l in 0..D {
                    matrix[(i, k)] += stresses[i][(k, l)] * g[l];
                }
            }
        }
    }
}
