use std::ops::Range;
use std::sync::Arc;

use carom_mesh::{Matrix, Vector};

use super::block::{BATCH, Grid};
use super::dilatation::Cell;
use super::kinematics::Kinematics;
use super::{CellState, Elements, StepForces, green_lagrange};
use crate::material::discrete_gradient::{SMALL_STRAIN, deformation, second_piola, stress_difference};
use crate::material::{Mat3, PlasticState, PointLaw, Tangent};
use crate::sparse::NodalMatrix;

/// Elements whose points share one change of volume per cell: see [`super::dilatation`].
#[derive(Debug)]
pub(crate) struct MeanDilatation<const D: usize, const N: usize, K> {
    /// An objective law.
    pub law: Arc<dyn PointLaw<3>>,
    pub grid: Grid<D, 3, N, K>,
}

/// One value per point of a batch.
type Points = [Mat3; BATCH];

const ZEROS: Points = [Mat3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0); BATCH];

impl<const D: usize, const N: usize, K: Kinematics<D, 3>> MeanDilatation<D, N, K> {
    /// The cells of a batch, with `f` at its points, and their points within the batch.
    fn split<'a>(
        &'a self,
        cells: &Range<usize>,
        f: &'a [Mat3],
    ) -> impl Iterator<Item = (Cell<'a>, Range<usize>)> {
        let count = self.grid.points_per_cell;
        let weights = self.grid.weights[self.grid.points(cells)].chunks_exact(count);
        weights
            .zip(f.chunks_exact(count))
            .enumerate()
            .map(move |(k, (weights, f))| (Cell { weights, f }, k * count..(k + 1) * count))
    }

    fn modify(&self, cells: &Range<usize>, f: &[Mat3], modified: &mut Points) {
        for (cell, points) in self.split(cells, f) {
            cell.modify(&mut modified[points]);
        }
    }

    /// Writes the energies w ψ(F̂) of the points [J] to `out`.
    fn energies(&self, cells: &Range<usize>, f: &[Mat3], history: &[PlasticState], out: &mut [f64; BATCH]) {
        let mut modified = ZEROS;
        self.modify(cells, f, &mut modified);
        self.law.energies(&modified[..f.len()], self.grid.part(cells, history), out);
        out.iter_mut().zip(&self.grid.weights[self.grid.points(cells)]).for_each(|(e, w)| *e *= w);
    }

    /// Writes the stresses P, whose work is the change of energy, to `out`.
    fn stresses(&self, cells: &Range<usize>, f: &[Mat3], history: &[PlasticState], out: &mut Points) {
        let mut modified = ZEROS;
        self.modify(cells, f, &mut modified);
        self.law.stresses(&modified[..f.len()], self.grid.part(cells, history), out);
        for (cell, points) in self.split(cells, f) {
            cell.stresses(&modified[points.clone()], &mut out[points]);
        }
    }

    /// Writes the stresses of a step whose work is ΔE, cell by cell, to `out`: a discrete gradient (Gonzalez 2000) in the space of
    /// the Green–Lagrange strains E of all points of a cell, ½(F₀ + F₁)(S + κ ΔE), where S is the stress at the mean strains
    /// and κ one number per cell.
    fn discrete_stresses(
        &self,
        cells: &Range<usize>,
        f0: &[Mat3],
        f1: &[Mat3],
        history: &[PlasticState],
        out: &mut Points,
    ) {
        let mut mean = ZEROS;
        for (mean, (f0, f1)) in mean.iter_mut().zip(f0.iter().zip(f1)) {
            *mean = deformation(&((f0.transpose() * f0 + f1.transpose() * f1) * 0.5));
        }
        let mean = &mean[..f0.len()];
        self.stresses(cells, mean, history, out);
        let (mut start, mut end) = ([0.0; BATCH], [0.0; BATCH]);
        self.energies(cells, f0, history, &mut start);
        self.energies(cells, f1, history, &mut end);
        for (cell, points) in self.split(cells, mean) {
            let (mut missing, mut size) = (0.0, 0.0);
            let strain = |q: usize| (f1[q].transpose() * f1[q] - f0[q].transpose() * f0[q]) * 0.5;
            for (q, weight) in points.clone().zip(cell.weights) {
                out[q] = second_piola(&mean[q], &out[q]);
                let strain = strain(q);
                missing += end[q] - start[q] - weight * out[q].dot(&strain);
                size += weight * strain.norm_squared();
            }
            let volume: f64 = cell.weights.iter().sum();
            let kappa = if size > volume * SMALL_STRAIN * SMALL_STRAIN { missing / size } else { 0.0 };
            for q in points {
                out[q] = (f0[q] + f1[q]) * 0.5 * (out[q] + strain(q) * kappa);
            }
        }
    }
}

impl<const D: usize, const N: usize, K: Kinematics<D, 3>> Elements<D> for MeanDilatation<D, N, K> {
    fn point_count(&self) -> usize {
        self.grid.weights.len()
    }

    fn energy(&self, u: &[Vector<D>], history: &[PlasticState]) -> f64 {
        let (mut f, mut energies) = (ZEROS, [0.0; BATCH]);
        let mut sum = 0.0;
        for cells in self.grid.batches() {
            let f = self.grid.deform(&cells, u, &mut f);
            self.energies(&cells, f, history, &mut energies);
            sum += energies[..f.len()].iter().sum::<f64>();
        }
        sum
    }

    fn add_internal_force(&self, u: &[Vector<D>], history: &[PlasticState], force: &mut [Vector<D>]) {
        let (mut f, mut stresses) = (ZEROS, ZEROS);
        for cells in self.grid.batches() {
            let f = self.grid.deform(&cells, u, &mut f);
            self.stresses(&cells, f, history, &mut stresses);
            self.grid.add_forces(&cells, &stresses, force);
        }
    }

    fn add_conserving_force(
        &self,
        u0: &[Vector<D>],
        u1: &[Vector<D>],
        history: &[PlasticState],
        force: &mut [Vector<D>],
    ) {
        let (mut f0, mut f1, mut stresses) = (ZEROS, ZEROS, ZEROS);
        for cells in self.grid.batches() {
            let (f0, f1) = (self.grid.deform(&cells, u0, &mut f0), self.grid.deform(&cells, u1, &mut f1));
            self.discrete_stresses(&cells, f0, f1, history, &mut stresses);
            self.grid.add_forces(&cells, &stresses, force);
        }
    }

    fn add_step_forces(
        &self,
        u0: &[Vector<D>],
        u1: &[Vector<D>],
        history: &[PlasticState],
        force: &mut StepForces<'_, D>,
    ) {
        let (mut f0, mut f1, mut start, mut end, mut other) = (ZEROS, ZEROS, ZEROS, ZEROS, ZEROS);
        for cells in self.grid.batches() {
            let (f0, f1) = (self.grid.deform(&cells, u0, &mut f0), self.grid.deform(&cells, u1, &mut f1));
            self.stresses(&cells, f0, history, &mut start);
            self.stresses(&cells, f1, history, &mut end);
            self.grid.add_forces(&cells, &end, force.end);
            self.discrete_stresses(&cells, f0, f1, history, &mut other);
            self.grid.add_forces(&cells, &other, force.conserving);
            for (q, (f0, f1)) in f0.iter().zip(f1).enumerate() {
                other[q] = stress_difference(f0, &start[q], f1, &end[q]);
            }
            self.grid.add_forces(&cells, &other, force.difference);
        }
    }

    fn add_stiffness(&self, u: &[Vector<D>], history: &[PlasticState], k: &mut NodalMatrix<Matrix<D>>) {
        let (mut f, mut modified, mut stresses) = (ZEROS, ZEROS, ZEROS);
        let (mut swelling, mut pressing) = (ZEROS, ZEROS);
        let mut tangents: Vec<Tangent<3>> = vec![[[[[0.0; 3]; 3]; 3]; 3]; BATCH];
        for cells in self.grid.batches() {
            let f = self.grid.deform(&cells, u, &mut f);
            self.modify(&cells, f, &mut modified);
            self.law.stresses(&modified[..f.len()], self.grid.part(&cells, history), &mut stresses);
            self.law.tangents(&modified[..f.len()], self.grid.part(&cells, history), &mut tangents);
            for (index, (cell, points)) in cells.clone().zip(self.split(&cells, f)) {
                let tangents = &mut tangents[points.clone()];
                let coupling = cell.tangents(
                    &modified[points.clone()],
                    &stresses[points.clone()],
                    tangents,
                    &mut swelling[points.clone()],
                    &mut pressing[points.clone()],
                );
                let mut local = [[Matrix::<D>::zeros(); N]; N];
                self.grid.add_local_stiffness(index, tangents, &mut local);
                let n = self.grid.local_forces(index, &swelling[points.clone()]);
                let g = self.grid.local_forces(index, &pressing[points]);
                for a in 0..N {
                    for b in 0..N {
                        local[a][b] += (g[a] * n[b].transpose() + n[a] * g[b].transpose()) / coupling.volume
                            + n[a] * n[b].transpose() * coupling.stiffness;
                    }
                }
                self.grid.scatter(index, &local, k);
            }
        }
    }

    fn cell_states(&self, u: &[Vector<D>], history: &[PlasticState], out: &mut Vec<CellState>) {
        let (mut f, mut stresses, mut energies) = (ZEROS, ZEROS, [0.0; BATCH]);
        for cells in self.grid.batches() {
            let f = self.grid.deform(&cells, u, &mut f);
            self.stresses(&cells, f, history, &mut stresses);
            self.energies(&cells, f, history, &mut energies);
            for (index, (cell, points)) in cells.clone().zip(self.split(&cells, f)) {
                let volume: f64 = cell.weights.iter().sum();
                let plastic_strain = self.grid.plastic_strain(index, history);
                let mut mean = CellState::empty(plastic_strain);
                for (q, weight) in points.zip(cell.weights) {
                    mean.stress += stresses[q] * f[q].transpose() * (weight / (volume * f[q].determinant()));
                    mean.strain += green_lagrange(&f[q]) * (weight / volume);
                    mean.energy_density += energies[q] / volume;
                }
                out.push(mean);
            }
        }
    }

    fn update(&self, u: &[Vector<D>], history: &mut [PlasticState]) -> f64 {
        let (mut f, mut modified) = (ZEROS, ZEROS);
        let mut work = 0.0;
        for cells in self.grid.batches() {
            let f = self.grid.deform(&cells, u, &mut f);
            self.modify(&cells, f, &mut modified);
            let points = self.grid.points(&cells);
            let Some(own) = history.get_mut(points.clone()) else { return 0.0 };
            for ((state, f), weight) in own.iter_mut().zip(&modified).zip(&self.grid.weights[points]) {
                let (next, density) = self.law.update(f, state);
                *state = next;
                work += weight * density;
            }
        }
        work
    }
}
