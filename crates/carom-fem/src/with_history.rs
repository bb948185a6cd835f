use carom_mesh::{Matrix, Vector};

use crate::elements::{CellState, Elements, Past, StepForces};
use crate::material::PlasticState;
use crate::ranks::{Ranks, Summed};
use crate::sparse::NodalMatrix;
use crate::{Body, Growth};

/// A body whose material has gone through something: what its laws remember, quadrature point by quadrature point, and how it has grown.
///
/// All forces and energies are those of a step that starts from this history, with the growth as it is. Of an elastic body, and of one that
/// is virgin, the history is empty.
#[derive(Debug, Clone, Copy)]
pub struct BodyWithHistory<'a, const D: usize> {
    /// The body.
    pub body: &'a Body<D>,
    history: &'a [PlasticState],
    growth: Growth,
}

impl<'a, const D: usize> BodyWithHistory<'a, D> {
    /// What the material remembers, quadrature point by quadrature point.
    #[must_use]
    pub fn history(&self) -> &'a [PlasticState] {
        self.history
    }

    /// The same, grown by a linear `strain`.
    #[must_use]
    pub fn grown(self, strain: f64) -> Self {
        Self { growth: self.body.growth(strain), ..self }
    }

    /// The linear strain by which it has grown.
    #[must_use]
    pub fn growth(&self) -> f64 {
        self.growth.strain()
    }

    /// The blocks of elements, each with what its points are under.
    fn blocks(&self) -> impl Iterator<Item = (&'a dyn Elements<D>, Past<'a>)> {
        let growth = self.growth;
        self.body.blocks(self.history).map(move |(e, history)| (e, Past { history, growth }))
    }

    /// Makes forces of the cells that are here those of all, weighed as the law's stresses count.
    fn finish(&self, f: &mut [Vector<D>]) {
        self.body.ranks.sum_up(f);
        let factor = self.growth.stress();
        if factor != 1.0 {
            f.iter_mut().for_each(|f| *f *= factor);
        }
    }

    /// Stored energy and plastic work of the step so far [J]. At the start of a step it is the stored energy alone.
    #[must_use]
    pub fn strain_energy(&self, u: &[Vector<D>]) -> f64 {
        let energy = self.blocks().map(|(e, past)| e.energy(u, past)).sum();
        self.body.ranks.total(energy) * self.growth.energy()
    }

    /// Writes the internal force ∂E/∂u [N] to `f`.
    pub fn internal_force(&self, u: &[Vector<D>], f: &mut [Vector<D>]) {
        f.fill(Vector::zeros());
        self.blocks().for_each(|(e, past)| e.add_internal_force(u, past, f));
        self.finish(f);
    }

    /// Writes the internal force [N] to `f` and returns the [`Self::strain_energy`] [J].
    #[must_use]
    pub fn internal_force_and_energy(&self, u: &[Vector<D>], f: &mut [Vector<D>]) -> f64 {
        f.fill(Vector::zeros());
        let energy = self.blocks().map(|(e, past)| e.add_internal_force_of_energy(u, past, f)).sum();
        self.finish(f);
        self.body.ranks.total(energy) * self.growth.energy()
    }

    /// Writes the force [N] of a step from `u0` to `u1` whose work is the change of [`Self::strain_energy`] to `f`.
    pub fn conserving_force(&self, u0: &[Vector<D>], u1: &[Vector<D>], f: &mut [Vector<D>]) {
        f.fill(Vector::zeros());
        self.blocks().for_each(|(e, past)| e.add_conserving_force(u0, u1, past, f));
        self.finish(f);
    }

    /// Writes the forces [N] of a step from `u0` to `u1` that a blend of its stresses is made of.
    pub fn step_forces(&self, u0: &[Vector<D>], u1: &[Vector<D>], f: &mut StepForces<'_, D>) {
        self.blended(u0, u1, f, false);
    }

    /// Writes the [`Self::step_forces`] [N] to `f` and returns the [`Self::strain_energy`] at `u1` [J].
    #[must_use]
    pub fn step_forces_and_energy(
        &self,
        u0: &[Vector<D>],
        u1: &[Vector<D>],
        f: &mut StepForces<'_, D>,
    ) -> f64 {
        let energy = self.blended(u0, u1, f, true);
        self.body.ranks.total(energy) * self.growth.energy()
    }

    /// Writes the [`Self::step_forces`] [N] to `f`; returns what cells that are here store at `u1`, if it is asked for.
    fn blended(
        &self,
        u0: &[Vector<D>],
        u1: &[Vector<D>],
        f: &mut StepForces<'_, D>,
        with_energy: bool,
    ) -> f64 {
        f.each().into_iter().for_each(|f| f.fill(Vector::zeros()));
        let energy = self.blocks().map(|(e, past)| e.add_step_forces(u0, u1, past, f, with_energy)).sum();
        f.each().into_iter().for_each(|f| self.finish(f));
        energy
    }

    /// The stiffness ∂²E/∂u² [N/m] at `u`.
    #[must_use]
    pub fn stiffness(&self, u: &[Vector<D>]) -> NodalMatrix<Matrix<D>> {
        self.body.stiffness_after(self.history, self.growth, u)
    }

    /// Mean stress, energy density and plastic strain of every cell, in the order of the mesh.
    #[must_use]
    pub fn cell_states(&self, u: &[Vector<D>]) -> Vec<CellState> {
        let mut out = Vec::with_capacity(self.body.mesh().cell_count());
        self.blocks().for_each(|(e, past)| e.cell_states(u, past, &mut out));
        out.iter_mut().for_each(|cell| cell.energy_density *= self.growth.energy());
        if let Some(ranks) = self.body.ranks() {
            return of_all_ranks(&**ranks, self.body.mesh().cell_count(), &self.body.own_cells, &out);
        }
        let order = &self.body.cells_in_order;
        if order.is_empty() {
            return out;
        }
        let mut sorted = out.clone();
        order.iter().zip(out).for_each(|(&number, state)| sorted[number as usize] = state);
        sorted
    }

    /// Whether the material remembers nothing.
    #[must_use]
    pub fn is_virgin(&self) -> bool {
        self.history.is_empty()
    }

    /// Writes the history at the end of a step to `u` to `next`; returns the plastic work of the step [J].
    pub fn update(&self, u: &[Vector<D>], next: &mut [PlasticState]) -> f64 {
        next.copy_from_slice(self.history);
        let mut rest = next;
        let mut work = 0.0;
        for e in self.body.elements() {
            let count = e.point_count().min(rest.len());
            let (own, others) = rest.split_at_mut(count);
            work += e.update(u, self.growth, own);
            rest = others;
        }
        work * self.growth.energy()
    }
}

/// The states of so many cells, those of the cells that are here with these numbers.
fn of_all_ranks(ranks: &dyn Ranks, count: usize, numbers: &[u32], own: &[CellState]) -> Vec<CellState> {
    let mut all = vec![CellState::empty(0.0); count];
    numbers.iter().zip(own).for_each(|(&cell, state)| all[cell as usize] = *state);
    let mut rows: Vec<f64> = all.iter().flat_map(CellState::numbers).collect();
    ranks.sum(&mut rows);
    rows.chunks_exact(CellState::NUMBERS).map(CellState::of_numbers).collect()
}

impl<const D: usize> Body<D> {
    /// The body with what its material remembers, quadrature point by quadrature point.
    #[must_use]
    pub fn after<'a>(&'a self, history: &'a [PlasticState]) -> BodyWithHistory<'a, D> {
        BodyWithHistory { body: self, history, growth: Growth::default() }
    }

    /// Stored energy of the virgin body [J].
    #[must_use]
    pub fn strain_energy(&self, u: &[Vector<D>]) -> f64 {
        self.after(&[]).strain_energy(u)
    }

    /// Writes the internal force ∂E/∂u [N] of the virgin body to `f`.
    pub fn internal_force(&self, u: &[Vector<D>], f: &mut [Vector<D>]) {
        self.after(&[]).internal_force(u, f);
    }

    /// Writes the force [N] of a step of the virgin body from `u0` to `u1` whose work is the change of the strain energy to `f`.
    pub fn conserving_force(&self, u0: &[Vector<D>], u1: &[Vector<D>], f: &mut [Vector<D>]) {
        self.after(&[]).conserving_force(u0, u1, f);
    }

    /// Writes the forces [N] of a step of the virgin body from `u0` to `u1` that a blend of its stresses is made of.
    pub fn step_forces(&self, u0: &[Vector<D>], u1: &[Vector<D>], f: &mut StepForces<'_, D>) {
        self.after(&[]).step_forces(u0, u1, f);
    }

    /// Mean state of every cell of the virgin body, in the order of the mesh.
    #[must_use]
    pub fn cell_states(&self, u: &[Vector<D>]) -> Vec<CellState> {
        self.after(&[]).cell_states(u)
    }
}
