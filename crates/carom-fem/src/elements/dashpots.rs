//! The viscous resistance of cells, beside whatever their law is.

use std::fmt::Debug;

use carom_mesh::{Matrix, Vector};

use super::block::{BATCH, Grid};
use super::kinematics::Kinematics;
use crate::material::{Tangent, Viscosity, embed, restrict};
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
        let (mut f0, mut f1, mut stresses) =
            ([Matrix::zeros(); BATCH], [Matrix::zeros(); BATCH], [Matrix::zeros(); BATCH]);
        for cells in self.grid.batches() {
            let (f0, f1) = (self.grid.deform(&cells, u0, &mut f0), self.grid.deform(&cells, u1, &mut f1));
            for (stress, (f0, f1)) in stresses.iter_mut().zip(f0.iter().zip(f1)) {
                let (f0, f1) = (embed(f0), embed(f1));
                *stress = restrict(&if self.objective {
                    self.viscosity.stress(&f0, &f1, dt)
                } else {
                    self.viscosity.small_stress(&f0, &f1, dt)
                });
            }
            self.grid.add_forces(&cells, &stresses, force);
        }
    }

    fn add_damping(&self, u: &[Vector<D>], c: &mut NodalMatrix<Matrix<D>>) {
        let mut f = [Matrix::identity(); BATCH];
        let mut tangents: Vec<Tangent<S>> = vec![[[[[0.0; S]; S]; S]; S]; BATCH];
        for cells in self.grid.batches() {
            let deformed = self.grid.deform(&cells, u, &mut f);
            for (tangent, f) in tangents.iter_mut().zip(deformed) {
                let f = if self.objective { embed(f) } else { Matrix::identity() };
                let full = self.viscosity.tangent(&f);
                *tangent = std::array::from_fn(|i| {
                    std::array::from_fn(|j| {
                        std::array::from_fn(|k| std::array::from_fn(|l| full[i][j][k][l]))
                    })
                });
            }
            for (cell, tangents) in cells.zip(tangents.chunks_exact(self.grid.points_per_cell)) {
                let mut local = [[Matrix::<D>::zeros(); N]; N];
                self.grid.add_local_stiffness(cell, tangents, &mut local);
                self.grid.scatter(cell, &local, c);
            }
        }
    }
}
