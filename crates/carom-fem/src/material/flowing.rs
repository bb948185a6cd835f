use carom_mesh::Matrix;

use super::point_law::{Confined, PointLaw, embed};
use super::strain_law::Hyperelastic;
use super::{Flow, Mat3, PlasticState, Relative, Tangent};

/// An elastoplastic law whose deformation beyond the D dimensions is held at zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flowing(pub Flow);

impl Flowing {
    /// The law of a step of a point.
    #[inline]
    fn after(&self, state: &PlasticState) -> Confined<Hyperelastic<Relative>> {
        Confined(self.0.after(state))
    }

    /// Calls `each` with the result to write, the law of the step and the place of every point.
    #[inline]
    fn at<T>(
        &self,
        count: usize,
        history: &[PlasticState],
        out: &mut [T],
        each: impl Fn(&Confined<Hyperelastic<Relative>>, usize) -> T,
    ) {
        for (k, out) in out.iter_mut().enumerate().take(count) {
            let law = history.get(k).map_or_else(|| self.after(&PlasticState::default()), |h| self.after(h));
            *out = each(&law, k);
        }
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

    fn energies(&self, f: &[Matrix<D>], history: &[PlasticState], out: &mut [f64]) {
        self.at(f.len(), history, out, |law, k| law.energy(&f[k]));
    }

    fn stresses(&self, f: &[Matrix<D>], history: &[PlasticState], out: &mut [Matrix<D>]) {
        self.at(f.len(), history, out, |law, k| law.stress(&f[k]));
    }

    fn discrete_stresses(
        &self,
        f0: &[Matrix<D>],
        f1: &[Matrix<D>],
        history: &[PlasticState],
        out: &mut [Matrix<D>],
    ) {
        self.at(f0.len(), history, out, |law, k| law.discrete_stress(&f0[k], &f1[k]));
    }

    fn all_step_stresses(
        &self,
        f0: &[Matrix<D>],
        f1: &[Matrix<D>],
        history: &[PlasticState],
        out: &mut [[Matrix<D>; 3]],
    ) {
        self.at(f0.len(), history, out, |law, k| law.step_stresses(&f0[k], &f1[k]));
    }

    fn tangents(&self, f: &[Matrix<D>], history: &[PlasticState], out: &mut [Tangent<D>]) {
        self.at(f.len(), history, out, |law, k| law.stress_and_tangent(&f[k]).1);
    }

    fn cauchy_stresses(&self, f: &[Matrix<D>], history: &[PlasticState], out: &mut [Mat3]) {
        self.at(f.len(), history, out, |law, k| law.cauchy_stress(&f[k]));
    }
}
