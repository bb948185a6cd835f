use std::fmt::Debug;

use carom_mesh::{Matrix, Vector};

use crate::material::Tangent;

/// How the deformation gradient F, S × S, follows from nodal displacements in D dimensions, F = I + Σ L(u_a, g_a), with one
/// gradient g_a of every node at every quadrature point.
pub(crate) trait Kinematics<const D: usize, const S: usize>: Send + Sync + Debug + 'static {
    /// The gradient g of a node from that of its shape function ∂N/∂X [1/m] and its `hoop` N/R, which is zero but in a body of
    /// revolution.
    fn gradient(shape: &Vector<D>, hoop: f64) -> Vector<S>;
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
    fn gradient(shape: &Vector<D>, _: f64) -> Vector<D> {
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

/// F is 3 × 3 in any dimension. Of a body of revolution, F₃₃ = 1 + Σ N_a/R u_r is the stretch of the hoops, with N_a/R the third
/// entry of the gradient of a node; in plane strain that entry is zero.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Embedded;

impl<const D: usize> Kinematics<D, 3> for Embedded {
    fn gradient(shape: &Vector<D>, hoop: f64) -> Vector<3> {
        Vector::<3>::from_fn(|i, _| if i < D { shape[i] } else { hoop })
    }

    #[inline]
    fn add_displacement(f: &mut Matrix<3>, u: &Vector<D>, g: &Vector<3>) {
        for i in 0..D {
            for j in 0..D {
                f[(i, j)] += u[i] * g[j];
            }
        }
        if D == 2 {
            f[(2, 2)] += u[0] * g[2];
        }
    }

    #[inline]
    fn force(p: &Matrix<3>, g: &Vector<3>) -> Vector<D> {
        let mut force = Vector::from_fn(|i, _| (0..D).map(|j| p[(i, j)] * g[j]).sum());
        if D == 2 {
            force[0] += p[(2, 2)] * g[2];
        }
        force
    }

    #[inline]
    fn stress_of_displacement(tangent: &Tangent<3>, g: &Vector<3>, weight: f64) -> [Matrix<3>; D] {
        let mut stresses = std::array::from_fn(|i| {
            Matrix::from_fn(|k, l| (0..D).map(|j| g[j] * tangent[i][j][k][l]).sum::<f64>() * weight)
        });
        if D == 2 {
            stresses[0] += Matrix::from_fn(|k, l| tangent[2][2][k][l]) * (g[2] * weight);
        }
        stresses
    }

    #[inline]
    fn add_forces(matrix: &mut Matrix<D>, stresses: &[Matrix<3>; D], g: &Vector<3>) {
        for (i, stress) in stresses.iter().enumerate() {
            let force: Vector<D> = Self::force(stress, g);
            for k in 0..D {
                matrix[(i, k)] += force[k];
            }
        }
    }
}
