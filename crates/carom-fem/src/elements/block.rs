use std::marker::PhantomData;
use std::ops::Range;
use std::sync::Arc;

use carom_mesh::{Matrix, Vector};

use super::kinematics::Kinematics;
use super::{CellState, Elements, StepForces, green_lagrange};
use crate::FemError;
use crate::material::{Mat3, PlasticState, PointLaw, Tangent};
use crate::quadrature::Integrand;
use crate::shape_table::{Cells, ShapeTable};
use crate::sparse::{NodalMatrix, NodeGraph};

/// Quadrature points at which a law is asked at once, so that the call costs nothing; no cell has more.
pub(crate) const BATCH: usize = 32;

/// Cells with `N` nodes and their quadrature points, whatever their law.
#[derive(Debug)]
pub(crate) struct Grid<const D: usize, const S: usize, const N: usize, K> {
    pub cells: Vec<[u32; N]>,
    pub points_per_cell: usize,
    /// The gradients g_a of [`Kinematics`] [1/m], cell by cell and point by point.
    pub gradients: Vec<[Vector<S>; N]>,
    /// Reference volumes of the points [m³].
    pub weights: Vec<f64>,
    /// Where the N × N node pairs of each cell stand in a matrix over the graph of the body.
    entries: Vec<[[u32; N]; N]>,
    kinematics: PhantomData<K>,
}

impl<const D: usize, const S: usize, const N: usize, K: Kinematics<D, S>> Grid<D, S, N, K> {
    /// # Errors
    /// If a cell is inverted or degenerate.
    pub fn new(cells: &Cells<'_, D>, graph: &NodeGraph) -> Result<Self, FemError> {
        let table = ShapeTable::<D, N>::new(cells, Integrand::Gradients)?;
        let cells: Vec<[u32; N]> =
            cells.block.cells().map(|nodes| std::array::from_fn(|a| nodes[a])).collect();
        let entries = cells
            .iter()
            .map(|c| std::array::from_fn(|a| std::array::from_fn(|b| graph.entry(c[a], c[b]) as u32)))
            .collect();
        Ok(Self {
            cells,
            points_per_cell: table.points_per_cell,
            gradients: (0..table.gradients.len())
                .map(|q| std::array::from_fn(|a| K::gradient(&table.gradients[q][a], table.hoop(q, a))))
                .collect(),
            weights: table.weights,
            entries,
            kinematics: PhantomData,
        })
    }

    /// The cells in runs of at most [`BATCH`] points.
    pub fn batches(&self) -> impl Iterator<Item = Range<usize>> + use<D, S, N, K> {
        let (count, run) = (self.cells.len(), BATCH / self.points_per_cell);
        (0..count).step_by(run).map(move |first| first..(first + run).min(count))
    }

    /// The points of a run of cells.
    #[inline]
    pub fn points(&self, cells: &Range<usize>) -> Range<usize> {
        cells.start * self.points_per_cell..cells.end * self.points_per_cell
    }

    /// The part of `history` that the points of a run of cells have, if they have one.
    #[inline]
    pub fn part<'h>(&self, cells: &Range<usize>, history: &'h [PlasticState]) -> &'h [PlasticState] {
        history.get(self.points(cells)).unwrap_or_default()
    }

    /// Mean equivalent plastic strain of a cell.
    pub fn plastic_strain(&self, cell: usize, history: &[PlasticState]) -> f64 {
        let cell = cell..cell + 1;
        let weights = &self.weights[self.points(&cell)];
        let states = self.part(&cell, history).iter();
        let sum: f64 = states.zip(weights).map(|(state, w)| w * state.equivalent_strain).sum();
        sum / weights.iter().sum::<f64>()
    }

    /// Writes F at the points of `cells` to `f` and returns that part of it.
    #[inline]
    pub fn deform<'f>(
        &self,
        cells: &Range<usize>,
        u: &[Vector<D>],
        f: &'f mut [Matrix<S>; BATCH],
    ) -> &'f [Matrix<S>] {
        let mut point = cells.start * self.points_per_cell;
        let mut done = 0;
        for nodes in &self.cells[cells.clone()] {
            let u: [Vector<D>; N] = std::array::from_fn(|a| u[nodes[a] as usize]);
            for _ in 0..self.points_per_cell {
                let mut sum = Matrix::identity();
                for (u, g) in u.iter().zip(&self.gradients[point]) {
                    K::add_displacement(&mut sum, u, g);
                }
                f[done] = sum;
                (point, done) = (point + 1, done + 1);
            }
        }
        &f[..done]
    }

    /// Adds the nodal forces of the `stresses` at the points of `cells` to `f`.
    #[inline]
    pub fn add_forces(&self, cells: &Range<usize>, stresses: &[Matrix<S>], f: &mut [Vector<D>]) {
        let stresses = stresses.chunks_exact(self.points_per_cell);
        for (cell, stresses) in cells.clone().zip(stresses) {
            let local = self.local_forces(cell, stresses);
            for (&node, force) in self.cells[cell].iter().zip(&local) {
                f[node as usize] += force;
            }
        }
    }

    /// The nodal forces of the `stresses` at the points of one cell.
    #[inline]
    pub fn local_forces(&self, cell: usize, stresses: &[Matrix<S>]) -> [Vector<D>; N] {
        let points = self.points(&(cell..cell + 1));
        let mut local = [Vector::<D>::zeros(); N];
        for ((gradients, weight), stress) in
            self.gradients[points.clone()].iter().zip(&self.weights[points]).zip(stresses)
        {
            let stress = stress * *weight;
            for (local, g) in local.iter_mut().zip(gradients) {
                *local += K::force(&stress, g);
            }
        }
        local
    }

    /// Adds the stiffness of `tangents` at the points of one cell to `local`.
    #[inline]
    pub fn add_local_stiffness(&self, cell: usize, tangents: &[Tangent<S>], local: &mut [[Matrix<D>; N]; N]) {
        let points = self.points(&(cell..cell + 1));
        for ((gradients, weight), tangent) in
            self.gradients[points.clone()].iter().zip(&self.weights[points]).zip(tangents)
        {
            for a in 0..N {
                let stresses = K::stress_of_displacement(tangent, &gradients[a], *weight);
                for b in 0..N {
                    K::add_forces(&mut local[a][b], &stresses, &gradients[b]);
                }
            }
        }
    }

    /// Adds the matrix of one cell to `k`.
    #[inline]
    pub fn scatter(&self, cell: usize, local: &[[Matrix<D>; N]; N], k: &mut NodalMatrix<Matrix<D>>) {
        for (entries, row) in self.entries[cell].iter().zip(local) {
            for (&entry, block) in entries.iter().zip(row) {
                k.values[entry as usize] += block;
            }
        }
    }
}

/// Elements whose points follow their law one by one.
#[derive(Debug)]
pub(crate) struct Block<const D: usize, const S: usize, const N: usize, K> {
    pub law: Arc<dyn PointLaw<S>>,
    pub grid: Grid<D, S, N, K>,
}

impl<const D: usize, const S: usize, const N: usize, K: Kinematics<D, S>> Elements<D> for Block<D, S, N, K> {
    fn point_count(&self) -> usize {
        self.grid.weights.len()
    }

    fn energy(&self, u: &[Vector<D>], history: &[PlasticState]) -> f64 {
        let (mut f, mut densities) = ([Matrix::zeros(); BATCH], [0.0; BATCH]);
        let mut energy = 0.0;
        for cells in self.grid.batches() {
            let f = self.grid.deform(&cells, u, &mut f);
            self.law.energies(f, self.grid.part(&cells, history), &mut densities);
            for (weight, density) in self.grid.weights[self.grid.points(&cells)].iter().zip(&densities) {
                energy += weight * density;
            }
        }
        energy
    }

    fn add_internal_force(&self, u: &[Vector<D>], history: &[PlasticState], force: &mut [Vector<D>]) {
        let (mut f, mut stresses) = ([Matrix::zeros(); BATCH], [Matrix::zeros(); BATCH]);
        for cells in self.grid.batches() {
            let f = self.grid.deform(&cells, u, &mut f);
            self.law.stresses(f, self.grid.part(&cells, history), &mut stresses);
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
        let (mut f0, mut f1, mut stresses) =
            ([Matrix::zeros(); BATCH], [Matrix::zeros(); BATCH], [Matrix::zeros(); BATCH]);
        for cells in self.grid.batches() {
            let (f0, f1) = (self.grid.deform(&cells, u0, &mut f0), self.grid.deform(&cells, u1, &mut f1));
            self.law.discrete_stresses(f0, f1, self.grid.part(&cells, history), &mut stresses);
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
        let (mut f0, mut f1, mut stresses) =
            ([Matrix::zeros(); BATCH], [Matrix::zeros(); BATCH], [[Matrix::zeros(); 3]; BATCH]);
        for cells in self.grid.batches() {
            let (f0, f1) = (self.grid.deform(&cells, u0, &mut f0), self.grid.deform(&cells, u1, &mut f1));
            self.law.all_step_stresses(f0, f1, self.grid.part(&cells, history), &mut stresses);
            let points = self.grid.points(&cells);
            let mut points =
                self.grid.gradients[points.clone()].iter().zip(&self.grid.weights[points]).zip(&stresses);
            for nodes in &self.grid.cells[cells] {
                let mut local = [[Vector::<D>::zeros(); 3]; N];
                for ((gradients, weight), stresses) in points.by_ref().take(self.grid.points_per_cell) {
                    for a in 0..N {
                        let gradient = gradients[a] * *weight;
                        for (local, stress) in local[a].iter_mut().zip(stresses) {
                            *local += K::force(stress, &gradient);
                        }
                    }
                }
                for (&node, local) in nodes.iter().zip(&local) {
                    force.conserving[node as usize] += local[0];
                    force.difference[node as usize] += local[1];
                    force.end[node as usize] += local[2];
                }
            }
        }
    }

    fn add_stiffness(&self, u: &[Vector<D>], history: &[PlasticState], k: &mut NodalMatrix<Matrix<D>>) {
        let mut f = [Matrix::zeros(); BATCH];
        let mut tangents: Vec<Tangent<S>> = vec![[[[[0.0; S]; S]; S]; S]; BATCH];
        for cells in self.grid.batches() {
            let f = self.grid.deform(&cells, u, &mut f);
            self.law.tangents(f, self.grid.part(&cells, history), &mut tangents);
            for (cell, tangents) in cells.zip(tangents.chunks_exact(self.grid.points_per_cell)) {
                let mut local = [[Matrix::<D>::zeros(); N]; N];
                self.grid.add_local_stiffness(cell, tangents, &mut local);
                self.grid.scatter(cell, &local, k);
            }
        }
    }

    fn cell_states(&self, u: &[Vector<D>], history: &[PlasticState], out: &mut Vec<CellState>) {
        let (mut f, mut densities, mut stresses) =
            ([Matrix::zeros(); BATCH], [0.0; BATCH], [Mat3::zeros(); BATCH]);
        for cells in self.grid.batches() {
            let f = self.grid.deform(&cells, u, &mut f);
            let own = self.grid.part(&cells, history);
            self.law.energies(f, own, &mut densities);
            self.law.cauchy_stresses(f, own, &mut stresses);
            let mut points = stresses.iter().zip(&densities).zip(f);
            for cell in cells {
                let plastic_strain = self.grid.plastic_strain(cell, history);
                let mut mean = CellState::empty(plastic_strain);
                let mut volume = 0.0;
                let weights = &self.grid.weights[self.grid.points(&(cell..cell + 1))];
                for (weight, ((stress, density), f)) in weights.iter().zip(points.by_ref()) {
                    mean.stress += stress * *weight;
                    mean.strain += green_lagrange(f) * *weight;
                    mean.energy_density += density * weight;
                    volume += weight;
                }
                mean.stress /= volume;
                mean.strain /= volume;
                mean.energy_density /= volume;
                out.push(mean);
            }
        }
    }

    fn update(&self, u: &[Vector<D>], history: &mut [PlasticState]) -> f64 {
        let mut f = [Matrix::zeros(); BATCH];
        let mut work = 0.0;
        for cells in self.grid.batches() {
            let f = self.grid.deform(&cells, u, &mut f);
            let points = self.grid.points(&cells);
            let Some(own) = history.get_mut(points.clone()) else { return 0.0 };
            for ((state, f), weight) in own.iter_mut().zip(f).zip(&self.grid.weights[points]) {
                let (next, density) = self.law.update(f, state);
                *state = next;
                work += weight * density;
            }
        }
        work
    }
}
