use carom_mesh::Matrix;

use super::point_law::{Confined, PointLaw, embed};
use super::strain_law::Hyperelastic;
use super::{Batch, Flow, Mat3, PlasticState, Relative, Tangent};

/// An elastoplastic law whose deformation beyond the D dimensions is held at zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flowing(pub Flow);

impl Flowing {
    /// The law of a step of a point.
    #[inline]
    fn after(&self, state: &PlasticState) -> Confined<Hyperelastic<Relative>> {
        Confined(self.0.after(state))
    }

    /// The law of the step of point `k`; a virgin one where there is no history.
    #[inline]
    fn at(&self, k: usize, history: &[PlasticState]) -> Confined<Hyperelastic<Relative>> {
        history.get(k).map_or_else(|| self.after(&PlasticState::default()), |h| self.after(h))
    }
}

impl<const D: usize> PointLaw<D> for Flowing {
    fn energy(&self, f: &Matrix<D>) -> f64 {
        self.after(&PlasticState::default()).energy(f)
    }

    fn stress(&self, f: &Matrix<D>) -> Matrix<D> {
        self.after(&PlasticState::default()).stress(f)
    }

    fn discrete_stress(&self, f0: &Matrix<D>, f1: &Matrix<D>) -> Matrix<D> {
        self.after(&PlasticState::default()).discrete_stress(f0, f1)
    }

    fn step_stresses(&self, f0: &Matrix<D>, f1: &Matrix<D>) -> [Matrix<D>; 3] {
        self.after(&PlasticState::default()).step_stresses(f0, f1)
    }

    fn stress_and_tangent(&self, f: &Matrix<D>) -> (Matrix<D>, Tangent<D>) {
        self.after(&PlasticState::default()).stress_and_tangent(f)
    }

    fn cauchy_stress(&self, f: &Matrix<D>) -> Mat3 {
        self.after(&PlasticState::default()).cauchy_stress(f)
    }

    fn is_objective(&self) -> bool {
        true
    }

    fn remembers(&self) -> bool {
        true
    }

    fn update(&self, f: &Matrix<D>, state: &PlasticState) -> (PlasticState, f64) {
        self.0.update(state, &embed(f))
    }

    fn energies(&self, count: usize, f: &Batch<D>, history: &[PlasticState], out: &mut [f64]) {
        (0..count).for_each(|k| out[k] = self.at(k, history).energy(&f.get(k)));
    }

    fn stresses(&self, count: usize, f: &Batch<D>, history: &[PlasticState], out: &mut Batch<D>) {
        (0..count).for_each(|k| out.set(k, &self.at(k, history).stress(&f.get(k))));
    }

    fn discrete_stresses(
        &self,
        count: usize,
        f0: &Batch<D>,
        f1: &Batch<D>,
        history: &[PlasticState],
        out: &mut Batch<D>,
    ) {
        for k in 0..count {
            out.set(k, &self.at(k, history).discrete_stress(&f0.get(k), &f1.get(k)));
        }
    }

    fn all_step_stresses(
        &self,
        count: usize,
        f0: &Batch<D>,
        f1: &Batch<D>,
        history: &[PlasticState],
        out: &mut [Batch<D>; 3],
    ) {
        for k in 0..count {
            let stresses = self.at(k, history).step_stresses(&f0.get(k), &f1.get(k));
            out.iter_mut().zip(&stresses).for_each(|(out, stress)| out.set(k, stress));
        }
    }

    fn tangents(&self, count: usize, f: &Batch<D>, history: &[PlasticState], out: &mut [Tangent<D>]) {
        (0..count).for_each(|k| out[k] = self.at(k, history).stress_and_tangent(&f.get(k)).1);
    }

    fn cauchy_stresses(&self, count: usize, f: &Batch<D>, history: &[PlasticState], out: &mut [Mat3]) {
        (0..count).for_each(|k| out[k] = self.at(k, history).cauchy_stress(&f.get(k)));
    }
}
