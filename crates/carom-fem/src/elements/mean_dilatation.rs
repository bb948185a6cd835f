use std::sync::Arc;

use carom_mesh::{Matrix, Vector};

use super::dilatation::Cell;
use super::grid::Grid;
use super::kinematics::Kinematics;
use super::{CellState, Elements, Past, StepForces};
use crate::Growth;
use crate::material::control::CONTROL;
use crate::material::discrete_gradient::{deformation, second_piola, stress_difference};
use crate::material::{BATCH, Batch, LANES, MAX_POINTS, Mat3, PlasticState, PointLaw, embed, green_lagrange};
use crate::sparse::NodalMatrix;

/// Elements whose points share one change of volume per cell: see [`super::dilatation`].
#[derive(Debug)]
pub(crate) struct MeanDilatation<const D: usize, const N: usize, K> {
    /// An objective law.
    pub law: Arc<dyn PointLaw<3>>,
    pub grid: Grid<D, 3, N, K>,
}

/// One value per point of a cell.
type Points = [Mat3; MAX_POINTS];

fn zeros() -> Points {
    [Mat3::zeros(); MAX_POINTS]
}

/// A cell of a pack, taken out of its batches.
struct Lane {
    count: usize,
    lane: usize,
    weights: [f64; MAX_POINTS],
    f: Points,
}

impl Lane {
    fn cell(&self) -> Cell<'_> {
        Cell { weights: &self.weights[..self.count], f: &self.f[..self.count] }
    }

    /// The part of this cell in a batch.
    fn take(&self, batch: &Batch<3>) -> Points {
        let mut points = zeros();
        points.iter_mut().take(self.count).enumerate().for_each(|(q, p)| *p = batch.get(self.at(q)));
        points
    }

    fn put(&self, points: &Points, batch: &mut Batch<3>) {
        points.iter().take(self.count).enumerate().for_each(|(q, p)| batch.set(self.at(q), p));
    }

    /// The place of a point in its batch.
    fn at(&self, q: usize) -> usize {
        q * LANES + self.lane
    }
}

impl<const D: usize, const N: usize, K: Kinematics<D, 3>> MeanDilatation<D, N, K> {
    /// The cells of a pack and the copies that fill it up, with `f` at their points.
    fn lanes<'a>(&'a self, pack: usize, f: &'a Batch<3>) -> impl Iterator<Item = Lane> + 'a {
        let (weights, count) = (self.grid.weights(pack), self.grid.batch() / LANES);
        (0..LANES).map(move |lane| {
            let mut cell = Lane { count, lane, weights: [0.0; MAX_POINTS], f: zeros() };
            (0..count).for_each(|q| cell.weights[q] = weights[cell.at(q)]);
            cell.f = cell.take(f);
            cell
        })
    }

    fn modify(&self, pack: usize, f: &Batch<3>, modified: &mut Batch<3>) {
        for lane in self.lanes(pack, f) {
            let mut points = zeros();
            lane.cell().modify(&mut points[..lane.count]);
            lane.put(&points, modified);
        }
    }

    /// Writes the energies w ψ(F̂) of the points [J] to `out`.
    fn energies(&self, pack: usize, f: &Batch<3>, history: &[PlasticState], out: &mut [f64; BATCH]) {
        let mut modified = Batch::zeros();
        self.modify(pack, f, &mut modified);
        self.law.energies(self.grid.batch(), &modified, self.grid.part(pack, history), out);
        out.iter_mut().zip(self.grid.weights(pack)).for_each(|(e, w)| *e *= w);
    }

    /// Writes the stresses P, whose work is the change of energy, to `out`.
    fn stresses(&self, pack: usize, f: &Batch<3>, history: &[PlasticState], out: &mut Batch<3>) {
        let mut modified = Batch::zeros();
        self.modify(pack, f, &mut modified);
        self.law.stresses(self.grid.batch(), &modified, self.grid.part(pack, history), out);
        for lane in self.lanes(pack, f) {
            let (modified, mut stresses) = (lane.take(&modified), lane.take(out));
            lane.cell().stresses(&modified[..lane.count], &mut stresses[..lane.count]);
            lane.put(&stresses, out);
        }
    }

    /// Writes the stresses of a step whose work is ΔE, cell by cell, to `out`. They are a discrete gradient (Gonzalez 2000) in the
    /// space of the Green–Lagrange strains E of all points of a cell. It is ½(F₀ + F₁)(S + κ ΔE), where S is the stress at the
    /// mean strains and κ one number per cell.
    fn discrete_stresses(
        &self,
        pack: usize,
        f0: &Batch<3>,
        f1: &Batch<3>,
        history: &[PlasticState],
        out: &mut Batch<3>,
    ) {
        let mut mean = Batch::zeros();
        for q in 0..self.grid.batch() {
            let (f0, f1) = (f0.get(q), f1.get(q));
            mean.set(q, &deformation(&((f0.transpose() * f0 + f1.transpose() * f1) * 0.5)));
        }
        self.stresses(pack, &mean, history, out);
        let (mut start, mut end) = ([0.0; BATCH], [0.0; BATCH]);
        self.energies(pack, f0, history, &mut start);
        self.energies(pack, f1, history, &mut end);
        for lane in self.lanes(pack, &mean) {
            let (f0, f1, mut stresses) = (lane.take(f0), lane.take(f1), lane.take(out));
            let cell = lane.cell();
            let (mut missing, mut size) = (0.0, 0.0);
            let strain = |q: usize| (f1[q].transpose() * f1[q] - f0[q].transpose() * f0[q]) * 0.5;
            for (q, weight) in cell.weights.iter().enumerate() {
                stresses[q] = second_piola(&cell.f[q], &stresses[q]);
                let strain = strain(q);
                missing += end[lane.at(q)] - start[lane.at(q)] - weight * stresses[q].dot(&strain);
                size += weight * strain.norm_squared();
            }
            let volume: f64 = cell.weights.iter().sum();
            let kappa = if size > volume * CONTROL.small_strain * CONTROL.small_strain {
                missing / size
            } else {
                0.0
            };
            for q in 0..lane.count {
                stresses[q] = (f0[q] + f1[q]) * 0.5 * (stresses[q] + strain(q) * kappa);
            }
            lane.put(&stresses, out);
        }
    }
}

impl<const D: usize, const N: usize, K: Kinematics<D, 3>> Elements<D> for MeanDilatation<D, N, K> {
    fn point_count(&self) -> usize {
        self.grid.point_count()
    }

    fn energy(&self, u: &[Vector<D>], past: Past<'_>) -> f64 {
        let (mut f, mut energies) = (Batch::zeros(), [0.0; BATCH]);
        let mut sum = 0.0;
        for pack in 0..self.grid.packs() {
            self.grid.deform_elastically(pack, u, past.growth, &mut f);
            self.energies(pack, &f, past.history, &mut energies);
            sum += self.grid.sum(pack, |q| energies[q]);
        }
        sum
    }

    fn add_internal_force(&self, u: &[Vector<D>], past: Past<'_>, force: &mut [Vector<D>]) {
        self.grid.assemble([force], Batch::zeros, |pack, f, [stresses]| {
            self.grid.deform_elastically(pack, u, past.growth, f);
            self.stresses(pack, f, past.history, stresses);
            0.0
        });
    }

    fn add_conserving_force(
        &self,
        u0: &[Vector<D>],
        u1: &[Vector<D>],
        past: Past<'_>,
        force: &mut [Vector<D>],
    ) {
        self.grid.assemble_step([u0, u1], past.growth, [force], |pack, [f0, f1], [stresses]| {
            self.discrete_stresses(pack, f0, f1, past.history, stresses);
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
        let stress = |pack: usize, [f0, f1]: [&Batch<3>; 2], stresses: &mut [Batch<3>; 3]| {
            let [conserving, difference, end] = stresses;
            self.discrete_stresses(pack, f0, f1, past.history, conserving);
            self.stresses(pack, f0, past.history, difference);
            self.stresses(pack, f1, past.history, end);
            for q in 0..self.grid.batch() {
                let (start, end) = (difference.get(q), end.get(q));
                difference.set(q, &stress_difference(&f0.get(q), &start, &f1.get(q), &end));
            }
            if !with_energy {
                return 0.0;
            }
            let mut energies = [0.0; BATCH];
            self.energies(pack, f1, past.history, &mut energies);
            self.grid.sum(pack, |q| energies[q])
        };
        self.grid.assemble_step([u0, u1], past.growth, forces.each(), stress)
    }

    fn add_stiffness(&self, u: &[Vector<D>], past: Past<'_>, k: &mut NodalMatrix<Matrix<D>>) {
        let scratch = || ([const { Batch::zeros() }; 5], self.grid.tangents());
        self.grid.assemble_matrix(k, scratch, |pack, (batches, tangents), locals| {
            let [f, modified, stresses, swelling, pressing] = batches;
            self.grid.deform_elastically(pack, u, past.growth, f);
            self.modify(pack, f, modified);
            let history = self.grid.part(pack, past.history);
            self.law.stresses(self.grid.batch(), modified, history, stresses);
            self.law.tangents(self.grid.batch(), modified, history, tangents);
            let couplings: Vec<_> = self
                .lanes(pack, f)
                .map(|lane| {
                    let (modified, stresses) = (lane.take(modified), lane.take(stresses));
                    let (mut swells, mut presses) = (zeros(), zeros());
                    let mut own: Vec<_> = (0..lane.count).map(|q| tangents[lane.at(q)]).collect();
                    let coupling = lane.cell().tangents(
                        &modified[..lane.count],
                        &stresses[..lane.count],
                        &mut own,
                        &mut swells,
                        &mut presses,
                    );
                    own.iter().enumerate().for_each(|(q, tangent)| tangents[lane.at(q)] = *tangent);
                    lane.put(&swells, swelling);
                    lane.put(&presses, pressing);
                    coupling
                })
                .collect();
            let (mut n, mut g) = (Grid::<D, 3, N, K>::NOWHERE, Grid::<D, 3, N, K>::NOWHERE);
            self.grid.local_forces(pack, swelling, &mut n);
            self.grid.local_forces(pack, pressing, &mut g);
            self.grid.write_stiffness(pack, tangents, locals);
            for (lane, (local, coupling)) in locals.iter_mut().zip(&couplings).enumerate() {
                let vector = |all: &[[f64; LANES]; D]| Vector::<D>::from_fn(|i, _| all[i][lane]);
                for a in 0..N {
                    for b in 0..N {
                        let [n_a, n_b] = [vector(&n[a]), vector(&n[b])];
                        let [g_a, g_b] = [vector(&g[a]), vector(&g[b])];
                        local[a][b] += (g_a * n_b.transpose() + n_a * g_b.transpose()) / coupling.volume
                            + n_a * n_b.transpose() * coupling.stiffness;
                    }
                }
            }
        });
    }

    fn cell_states(&self, u: &[Vector<D>], past: Past<'_>, out: &mut Vec<CellState>) {
        let (mut f, mut stresses, mut energies) = (Batch::zeros(), Batch::zeros(), [0.0; BATCH]);
        let mut motion = Batch::zeros();
        for pack in 0..self.grid.packs() {
            self.grid.deform(pack, u, &mut motion);
            self.grid.deform_elastically(pack, u, past.growth, &mut f);
            self.stresses(pack, &f, past.history, &mut stresses);
            self.energies(pack, &f, past.history, &mut energies);
            let weights = self.grid.weights(pack);
            for lane in 0..self.grid.cells(pack).len() {
                let volume: f64 = self.grid.points(lane).map(|q| weights[q]).sum();
                let mut mean = CellState::empty(self.grid.plastic_strain(pack, lane, past.history));
                for q in self.grid.points(lane) {
                    let f = f.get(q);
                    mean.stress +=
                        stresses.get(q) * f.transpose() * (weights[q] / (volume * f.determinant()));
                    mean.strain += green_lagrange(&embed(&motion.get(q))) * (weights[q] / volume);
                    mean.energy_density += energies[q] / volume;
                }
                out.push(mean);
            }
        }
    }

    fn update(&self, u: &[Vector<D>], growth: Growth, history: &mut [PlasticState]) -> f64 {
        if history.is_empty() {
            return 0.0;
        }
        let (mut f, mut modified, mut densities) = (Batch::zeros(), Batch::zeros(), [0.0; BATCH]);
        let mut work = 0.0;
        for pack in 0..self.grid.packs() {
            self.grid.deform_elastically(pack, u, growth, &mut f);
            self.modify(pack, &f, &mut modified);
            let states = self.grid.part_mut(pack, history);
            for (q, (state, density)) in states.iter_mut().zip(&mut densities).enumerate() {
                (*state, *density) = self.law.update(&modified.get(q), state);
            }
            let weights = self.grid.weights(pack);
            work += self.grid.sum(pack, |q| weights[q] * densities[q]);
        }
        work
    }
}
