//! The viscous resistance of cells, beside whatever their law is.

use std::fmt::Debug;

use carom_mesh::{Matrix, Vector};

use super::grid::Grid;
use super::kinematics::Kinematics;
use crate::Growth;
use crate::material::{Batch, Viscosity, embed, restrict};
use crate::sparse::NodalMatrix;

/// The viscosity of one block of cells; `u` and `f` hold one vector per node of the body.
pub trait Dashpots<const D: usize>: Send + Sync + Debug {
    /// Adds the viscous force [N] of a step from `u0` to `u1` in `dt` [s] to `f`: its work is what the step dissipates.
    fn add_force(&self, u0: &[Vector<D>], u1: &[Vector<D>], dt: f64, f: &mut [Vector<D>]);
    /// Adds the derivative of the force by the velocities [N s/m] at `u` to `c`.
    fn add_damping(&self, u: &[Vector<D>], c: &mut NodalMatrix<Matrix<D>>);
}

/// Cells with `N` nodes that have a viscosity at every quadrature point.
#[derive(Debug)]
pub(crate) struct ViscousBlock<const D: usize, const S: usize, const N: usize, K> {
    pub viscosity: Viscosity,
    /// Whether strains are large; if not, rotations count as strain.
    pub objective: bool,
    pub grid: Grid<D, S, N, K>,
}

impl<const D: usize, const S: usize, const N: usize, K: Kinematics<D, S>> Dashpots<D>
    for ViscousBlock<D, S, N, K>
{
    fn add_force(&self, u0: &[Vector<D>], u1: &[Vector<D>], dt: f64, force: &mut [Vector<D>]) {
        self.grid.assemble_step([u0, u1], Growth::default(), [force], |_, [f0, f1], [stresses]| {
            for q in 0..self.grid.batch() {
                let (f0, f1) = (embed(&f0.get(q)), embed(&f1.get(q)));
                let stress = if self.objective {
                    self.viscosity.stress(&f0, &f1, dt)
                } else {
                    self.viscosity.small_stress(&f0, &f1, dt)
                };
                stresses.set(q, &restrict(&stress));
            }
            0.0
        });
    }

    fn add_damping(&self, u: &[Vector<D>], c: &mut NodalMatrix<Matrix<D>>) {
        let scratch = || (Batch::zeros(), self.grid.tangents());
        self.grid.assemble_matrix(c, scratch, |pack, (f, tangents), locals| {
            self.grid.deform(pack, u, f);
            for (q, tangent) in tangents.iter_mut().enumerate() {
                let f = if self.objective { embed(&f.get(q)) } else { Matrix::identity() };
                let full = self.viscosity.tangent(&f);
                *tangent = std::array::from_fn(|i| {
                    std::array::from_fn(|j| {
                        std::array::from_fn(|k| std::array::from_fn(|l| full[i][j][k][l]))
                    })
                });
            }
            self.grid.write_stiffness(pack, tangents, locals);
        });
    }
}
