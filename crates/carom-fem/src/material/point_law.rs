use std::fmt::Debug;

use carom_mesh::Matrix;

use super::{Batch, Mat3, Material, PlasticState, Tangent};

/// A law as elements see it at their quadrature points, where F is D × D.
///
/// Elements ask about many points at once, so that a law chosen at run time costs one call for all of them.
pub trait PointLaw<const D: usize>: Send + Sync + Debug {
    /// Stored energy per reference volume [J/m³].
    fn energy(&self, f: &Matrix<D>) -> f64;
    /// First Piola–Kirchhoff stress [Pa].
    fn stress(&self, f: &Matrix<D>) -> Matrix<D>;
    /// The stress [Pa] whose work over a step is the change of energy, see [`Material::discrete_stress`].
    fn discrete_stress(&self, f0: &Matrix<D>, f1: &Matrix<D>) -> Matrix<D>;
    /// The stresses [Pa] of a step: see [`Material::step_stresses`].
    fn step_stresses(&self, f0: &Matrix<D>, f1: &Matrix<D>) -> [Matrix<D>; 3];
    /// Stress and tangent [Pa].
    fn stress_and_tangent(&self, f: &Matrix<D>) -> (Matrix<D>, Tangent<D>);
    /// Cauchy stress in 3D [Pa].
    fn cauchy_stress(&self, f: &Matrix<D>) -> Mat3;
    /// Whether the energy does not see a rotation, see [`Material::is_objective`].
    fn is_objective(&self) -> bool;

    /// Whether the law depends on what a point has gone through. If so, the methods above are those of a virgin point. Those
    /// below take what the points remember at the start of the step, nothing if they are virgin. If not, they ignore it.
    fn remembers(&self) -> bool {
        false
    }
    /// What a point remembers at the end of a step to F, and the plastic work of the step per reference volume [J/m³].
    fn update(&self, _f: &Matrix<D>, state: &PlasticState) -> (PlasticState, f64) {
        (*state, 0.0)
    }

    /// [`Self::energy`] at the first `count` points of a batch.
    fn energies(&self, count: usize, f: &Batch<D>, _history: &[PlasticState], out: &mut [f64]) {
        out[..count].iter_mut().enumerate().for_each(|(k, out)| *out = self.energy(&f.get(k)));
    }
    /// [`Self::stress`] at the first `count` points of a batch.
    fn stresses(&self, count: usize, f: &Batch<D>, _history: &[PlasticState], out: &mut Batch<D>) {
        (0..count).for_each(|k| out.set(k, &self.stress(&f.get(k))));
    }
    /// [`Self::discrete_stress`] at the first `count` points of a batch.
    fn discrete_stresses(
        &self,
        count: usize,
        f0: &Batch<D>,
        f1: &Batch<D>,
        _history: &[PlasticState],
        out: &mut Batch<D>,
    ) {
        (0..count).for_each(|k| out.set(k, &self.discrete_stress(&f0.get(k), &f1.get(k))));
    }
    /// [`Self::step_stresses`] at the first `count` points of a batch.
    fn all_step_stresses(
        &self,
        count: usize,
        f0: &Batch<D>,
        f1: &Batch<D>,
        _history: &[PlasticState],
        out: &mut [Batch<D>; 3],
    ) {
        for k in 0..count {
            let stresses = self.step_stresses(&f0.get(k), &f1.get(k));
            out.iter_mut().zip(&stresses).for_each(|(out, stress)| out.set(k, stress));
        }
    }
    /// The tangents of [`Self::stress_and_tangent`] at the first `count` points of a batch.
    fn tangents(&self, count: usize, f: &Batch<D>, _history: &[PlasticState], out: &mut [Tangent<D>]) {
        out[..count].iter_mut().enumerate().for_each(|(k, out)| *out = self.stress_and_tangent(&f.get(k)).1);
    }
    /// [`Self::cauchy_stress`] at the first `count` points of a batch.
    fn cauchy_stresses(&self, count: usize, f: &Batch<D>, _history: &[PlasticState], out: &mut [Mat3]) {
        out[..count].iter_mut().enumerate().for_each(|(k, out)| *out = self.cauchy_stress(&f.get(k)));
    }
}

/// A law whose deformation beyond the D dimensions is held at zero: the law itself in 3D, plane strain in 2D.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Confined<M>(pub M);

#[inline]
pub(crate) fn embed<const D: usize>(f: &Matrix<D>) -> Mat3 {
    let mut full = Mat3::identity();
    for i in 0..D {
        for j in 0..D {
            full[(i, j)] = f[(i, j)];
        }
    }
    full
}

#[inline]
pub(crate) fn restrict<const D: usize>(full: &Mat3) -> Matrix<D> {
    Matrix::from_fn(|i, j| full[(i, j)])
}

impl<const D: usize, M: Material> PointLaw<D> for Confined<M> {
    #[inline]
    fn energy(&self, f: &Matrix<D>) -> f64 {
        self.0.energy(&embed(f))
    }

    #[inline]
    fn stress(&self, f: &Matrix<D>) -> Matrix<D> {
        restrict(&self.0.stress(&embed(f)))
    }

    #[inline]
    fn discrete_stress(&self, f0: &Matrix<D>, f1: &Matrix<D>) -> Matrix<D> {
        restrict(&self.0.discrete_stress(&embed(f0), &embed(f1)))
    }

    #[inline]
    fn step_stresses(&self, f0: &Matrix<D>, f1: &Matrix<D>) -> [Matrix<D>; 3] {
        self.0.step_stresses(&embed(f0), &embed(f1)).map(|p| restrict(&p))
    }

    #[inline]
    fn stress_and_tangent(&self, f: &Matrix<D>) -> (Matrix<D>, Tangent<D>) {
        let (stress, full) = self.0.stress_and_tangent(&embed(f));
        let tangent = std::array::from_fn(|i| {
            std::array::from_fn(|j| std::array::from_fn(|k| std::array::from_fn(|l| full[i][j][k][l])))
        });
        (restrict(&stress), tangent)
    }

    fn cauchy_stress(&self, f: &Matrix<D>) -> Mat3 {
        let f = embed(f);
        self.0.stress(&f) * f.transpose() / f.determinant()
    }

    fn is_objective(&self) -> bool {
        self.0.is_objective()
    }

    fn energies(&self, count: usize, f: &Batch<D>, _: &[PlasticState], out: &mut [f64]) {
        self.0.energies(count, f, out);
    }

    fn stresses(&self, count: usize, f: &Batch<D>, _: &[PlasticState], out: &mut Batch<D>) {
        self.0.stresses(count, f, out);
    }

    fn discrete_stresses(
        &self,
        count: usize,
        f0: &Batch<D>,
        f1: &Batch<D>,
        _: &[PlasticState],
        out: &mut Batch<D>,
    ) {
        self.0.discrete_stresses(count, f0, f1, out);
    }

    fn all_step_stresses(
        &self,
        count: usize,
        f0: &Batch<D>,
        f1: &Batch<D>,
        _: &[PlasticState],
        out: &mut [Batch<D>; 3],
    ) {
        self.0.all_step_stresses(count, f0, f1, out);
    }
}
