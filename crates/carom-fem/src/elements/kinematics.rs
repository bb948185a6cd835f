use std::fmt::Debug;

use carom_mesh::{Matrix, Vector};
use pulp::Simd;

use crate::material::Tangent;

/// How the deformation gradient F, S × S, follows from nodal displacements in D dimensions: F = I + Σ L(u_a, g_a). Every
/// node has one gradient g_a at every quadrature point.
pub(crate) trait Kinematics<const D: usize, const S: usize>: Send + Sync + Debug + 'static {
    /// The gradient g of a node from that of its shape function ∂N/∂X [1/m] and its `hoop` N/R, which is zero but in a body of
    /// revolution.
    fn gradient(shape: &Vector<D>, hoop: f64) -> Vector<S>;
    /// Adds L(u, g) to `f`, at as many points as a register has lanes.
    fn add_displacement<V: Simd>(simd: V, f: &mut [[V::f64s; S]; S], u: &[V::f64s; D], g: &[V::f64s; S]);
    /// Adds the nodal force of a stress P, Σ_ij P_ij ∂L_ij/∂u, to `force`.
    fn add_force<V: Simd>(simd: V, force: &mut [V::f64s; D], p: &[[V::f64s; S]; S], g: &[V::f64s; S]);
    /// For every component of the displacement of a node the stress that it causes, Σ_ij w ∂L_ij/∂u A_ijkl.
    fn stress_of_displacement(tangent: &Tangent<S>, g: &Vector<S>, weight: f64) -> [Matrix<S>; D];
    /// Adds the forces of these stresses, one per row, to `k`.
    fn add_forces(k: &mut Matrix<D>, stresses: &[Matrix<S>; D], g: &Vector<S>);
}

/// F = I + Σ u_a ⊗ ∂N_a/∂X: in space, and in a plane.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Solid;

impl<const D: usize> Kinematics<D, D> for Solid {
    fn gradient(shape: &Vector<D>, _: f64) -> Vector<D> {
        *shape
    }

    #[inline(always)]
    fn add_displacement<V: Simd>(simd: V, f: &mut [[V::f64s; D]; D], u: &[V::f64s; D], g: &[V::f64s; D]) {
        for i in 0..D {
            for j in 0..D {
                f[i][j] = simd.mul_add_e_f64s(u[i], g[j], f[i][j]);
            }
        }
    }

    #[inline(always)]
    fn add_force<V: Simd>(simd: V, force: &mut [V::f64s; D], p: &[[V::f64s; D]; D], g: &[V::f64s; D]) {
        for i in 0..D {
            for j in 0..D {
                force[i] = simd.mul_add_e_f64s(p[i][j], g[j], force[i]);
            }
        }
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
/// entry of the gradient of a node. In plane strain that entry is zero.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Embedded;

impl<const D: usize> Kinematics<D, 3> for Embedded {
    fn gradient(shape: &Vector<D>, hoop: f64) -> Vector<3> {
        Vector::<3>::from_fn(|i, _| if i < D { shape[i] } else { hoop })
    }

    #[inline(always)]
    fn add_displacement<V: Simd>(simd: V, f: &mut [[V::f64s; 3]; 3], u: &[V::f64s; D], g: &[V::f64s; 3]) {
        for i in 0..D {
            for j in 0..D {
                f[i][j] = simd.mul_add_e_f64s(u[i], g[j], f[i][j]);
            }
        }
        if D == 2 {
            f[2][2] = simd.mul_add_e_f64s(u[0], g[2], f[2][2]);
        }
    }

    #[inline(always)]
    fn add_force<V: Simd>(simd: V, force: &mut [V::f64s; D], p: &[[V::f64s; 3]; 3], g: &[V::f64s; 3]) {
        for i in 0..D {
            for j in 0..D {
                force[i] = simd.mul_add_e_f64s(p[i][j], g[j], force[i]);
            }
        }
        if D == 2 {
            force[0] = simd.mul_add_e_f64s(p[2][2], g[2], force[0]);
        }
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
            for k in 0..D {
                matrix[(i, k)] += (0..D).map(|l| stress[(k, l)] * g[l]).sum::<f64>();
            }
            if D == 2 {
                matrix[(i, 0)] += stress[(2, 2)] * g[2];
            }
        }
    }
}
