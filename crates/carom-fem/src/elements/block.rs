use std::sync::Arc;

use carom_mesh::{Matrix, Vector};

use super::grid::Grid;
use super::kinematics::Kinematics;
use super::{CellState, Elements, Past, StepForces};
use crate::Growth;
use crate::material::{BATCH, Batch, Mat3, PlasticState, PointLaw, embed, green_lagrange};
use crate::sparse::NodalMatrix;

/// Elements whose points follow their law one by one.
#[derive(Debug)]
pub(crate) struct Block<const D: usize, const S: usize, const N: usize, K> {
    pub law: Arc<dyn PointLaw<S>>,
    pub grid: Grid<D, S, N, K>,
}

impl<const D: usize, const S: usize, const N: usize, K: Kinematics<D, S>> Elements<D> for Block<D, S, N, K> {
    fn point_count(&self) -> usize {
        self.grid.point_count()
    }

    fn energy(&self, u: &[Vector<D>], past: Past<'_>) -> f64 {
        let (mut f, mut densities) = (Batch::zeros(), [0.0; BATCH]);
        let mut energy = 0.0;
        for pack in 0..self.grid.packs() {
            self.grid.deform_elastically(pack, u, past.growth, &mut f);
            let history = self.grid.part(pack, past.history);
            self.law.energies(self.grid.batch(), &f, history, &mut densities);
            let weights = self.grid.weights(pack);
            energy += self.grid.sum(pack, |q| weights[q] * densities[q]);
        }
        energy
    }

    fn add_internal_force(&self, u: &[Vector<D>], past: Past<'_>, force: &mut [Vector<D>]) {
        self.grid.assemble([force], Batch::zeros, |pack, f, [stresses]| {
            self.grid.deform_elastically(pack, u, past.growth, f);
            self.law.stresses(self.grid.batch(), f, self.grid.part(pack, past.history), stresses);
            0.0
        });
    }

    fn add_internal_force_of_energy(&self, u: &[Vector<D>], past: Past<'_>, force: &mut [Vector<D>]) -> f64 {
        let scratch = || (Batch::zeros(), [0.0; BATCH]);
        self.grid.assemble([force], scratch, |pack, (f, densities), [stresses]| {
            self.grid.deform_elastically(pack, u, past.growth, f);
            let history = self.grid.part(pack, past.history);
            self.law.stresses(self.grid.batch(), f, history, stresses);
            self.law.energies(self.grid.batch(), f, history, densities);
            let weights = self.grid.weights(pack);
            self.grid.sum(pack, |q| weights[q] * densities[q])
        })
    }

    fn add_conserving_force(
        &self,
        u0: &[Vector<D>],
        u1: &[Vector<D>],
        past: Past<'_>,
        force: &mut [Vector<D>],
    ) {
        self.grid.assemble_step([u0, u1], past.growth, [force], |pack, [f0, f1], [stresses]| {
            let history = self.grid.part(pack, past.history);
            self.law.discrete_stresses(self.grid.batch(), f0, f1, history, stresses);
            0.0
        });
    }

    fn add_step_forces(
        &self,
        u0: &[Vector<D>],
        u1: &[Vector<D>],
        past: Past<'_>,
        forces: &mut StepForces<'_, D>,
        with_energy: bool,
    ) -> f64 {
        self.grid.assemble_step([u0, u1], past.growth, forces.each(), |pack, [f0, f1], stresses| {
            let history = self.grid.part(pack, past.history);
            self.law.all_step_stresses(self.grid.batch(), f0, f1, history, stresses);
            if !with_energy {
                return 0.0;
            }
            let mut densities = [0.0; BATCH];
            self.law.energies(self.grid.batch(), f1, history, &mut densities);
            let weights = self.grid.weights(pack);
            self.grid.sum(pack, |q| weights[q] * densities[q])
        })
    }

    fn add_stiffness(&self, u: &[Vector<D>], past: Past<'_>, k: &mut NodalMatrix<Matrix<D>>) {
        let scratch = || (Batch::zeros(), self.grid.tangents());
        self.grid.assemble_matrix(k, scratch, |pack, (f, tangents), locals| {
            self.grid.deform_elastically(pack, u, past.growth, f);
            self.law.tangents(self.grid.batch(), f, self.grid.part(pack, past.history), tangents);
            self.grid.write_stiffness(pack, tangents, locals);
        });
    }

    fn cell_states(&self, u: &[Vector<D>], past: Past<'_>, out: &mut Vec<CellState>) {
        let (mut f, mut densities, mut stresses) = (Batch::zeros(), [0.0; BATCH], [Mat3::zeros(); BATCH]);
        let mut motion = Batch::zeros();
        for pack in 0..self.grid.packs() {
            self.grid.deform(pack, u, &mut motion);
            self.grid.deform_elastically(pack, u, past.growth, &mut f);
            let own = self.grid.part(pack, past.history);
            self.law.energies(self.grid.batch(), &f, own, &mut densities);
            self.law.cauchy_stresses(self.grid.batch(), &f, own, &mut stresses);
            let weights = self.grid.weights(pack);
            for lane in 0..self.grid.cells(pack).len() {
                let mut mean = CellState::empty(self.grid.plastic_strain(pack, lane, past.history));
                let mut volume = 0.0;
                for q in self.grid.points(lane) {
                    mean.stress += stresses[q] * weights[q];
                    mean.strain += green_lagrange(&embed(&motion.get(q))) * weights[q];
                    mean.energy_density += densities[q] * weights[q];
                    volume += weights[q];
                }
                mean.stress /= volume;
                mean.strain /= volume;
                mean.energy_density /= volume;
                out.push(mean);
            }
        }
    }

    fn update(&self, u: &[Vector<D>], growth: Growth, history: &mut [PlasticState]) -> f64 {
        if history.is_empty() {
            return 0.0;
        }
        let (mut f, mut densities) = (Batch::zeros(), [0.0; BATCH]);
        let mut work = 0.0;
        for pack in 0..self.grid.packs() {
            self.grid.deform_elastically(pack, u, growth, &mut f);
            let states = self.grid.part_mut(pack, history);
            for (q, (state, density)) in states.iter_mut().zip(&mut densities).enumerate() {
                (*state, *density) = self.law.update(&f.get(q), state);
            }
            let weights = self.grid.weights(pack);
            work += self.grid.sum(pack, |q| weights[q] * densities[q]);
        }
        work
    }
}
