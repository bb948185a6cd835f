use std::sync::Arc;

use carom_mesh::Matrix;
use nalgebra::{SMatrix, SVector};

use super::{Batch, Mat3, PlasticState, PointLaw, Tangent, embed, restrict};

/// A law of a body that is under a stress S₀ where it has not moved: ψ(F) + S₀:E, with the Green–Lagrange strain E; S₀:ε of a law of small
/// displacements.
///
/// A constant is added, the energy ½ S₀:C⁻¹:S₀ that the stress has stored, with the moduli C of the law where F = 1: energies are counted
/// from the state without stress, exactly of laws that are quadratic in their strain.
#[derive(Debug)]
pub(crate) struct Prestressed<const D: usize> {
    law: Arc<dyn PointLaw<D>>,
    /// S₀ [Pa] as elements see it.
    stress: Matrix<D>,
    /// S₀ in space [Pa].
    full: Mat3,
    /// ½ S₀:C⁻¹:S₀ [J/m³].
    stored: f64,
}

impl<const D: usize> Prestressed<D> {
    /// `law` under a symmetric `stress` [Pa].
    pub fn new(law: Arc<dyn PointLaw<D>>, stress: &Mat3) -> Self {
        let own = restrict(stress);
        Self {
            stored: stored_energy(&law.stress_and_tangent(&Matrix::identity()).1, &own),
            law,
            stress: own,
            full: *stress,
        }
    }

    /// E, or ε of a law of small displacements.
    fn strain(&self, f: &Matrix<D>) -> Matrix<D> {
        if self.law.is_objective() {
            (f.transpose() * f - Matrix::identity()) * 0.5
        } else {
            (f + f.transpose()) * 0.5 - Matrix::identity()
        }
    }

    /// What S₀ adds to the first Piola–Kirchhoff stress at F; to that of a step at its mean F.
    fn added(&self, f: &Matrix<D>) -> Matrix<D> {
        if self.law.is_objective() { f * self.stress } else { self.stress }
    }

    /// Adds [`Self::added`] at the mean of one or two deformation gradients of every point.
    fn add(&self, count: usize, ends: &[&Batch<D>], out: &mut Batch<D>) {
        let share = 1.0 / ends.len() as f64;
        for i in 0..D {
            for j in 0..D {
                let out = &mut out.components[i][j][..count];
                if !self.law.is_objective() {
                    out.iter_mut().for_each(|p| *p += self.stress[(i, j)]);
                    continue;
                }
                for f in ends {
                    for k in 0..D {
                        let stress = share * self.stress[(k, j)];
                        out.iter_mut().zip(&f.components[i][k]).for_each(|(p, f)| *p += f * stress);
                    }
                }
            }
        }
    }
}

/// ½ S:C⁻¹:S [J/m³] of moduli C, which have the symmetries of elasticity.
fn stored_energy<const D: usize>(moduli: &Tangent<D>, stress: &Matrix<D>) -> f64 {
    // Strains off the diagonal count twice.
    let pairs = [(0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1)];
    let own = |p: usize| pairs[p].0 < D && pairs[p].1 < D;
    let matrix = SMatrix::<f64, 6, 6>::from_fn(|p, q| {
        let ((i, j), (k, l)) = (pairs[p], pairs[q]);
        if own(p) && own(q) { moduli[i][j][k][l] } else { f64::from(u8::from(p == q)) }
    });
    let stress = SVector::<f64, 6>::from_fn(|p, _| if own(p) { stress[pairs[p]] } else { 0.0 });
    matrix.lu().solve(&stress).map_or(0.0, |strain| 0.5 * strain.dot(&stress))
}

impl<const D: usize> PointLaw<D> for Prestressed<D> {
    fn energy(&self, f: &Matrix<D>) -> f64 {
        self.law.energy(f) + self.stress.dot(&self.strain(f)) + self.stored
    }

    fn stress(&self, f: &Matrix<D>) -> Matrix<D> {
        self.law.stress(f) + self.added(f)
    }

    /// E changes by the symmetric part of ½(F₀ + F₁)ᵀ(F₁ − F₀): what is added does the work S₀:ΔE.
    fn discrete_stress(&self, f0: &Matrix<D>, f1: &Matrix<D>) -> Matrix<D> {
        self.law.discrete_stress(f0, f1) + self.added(&((f0 + f1) * 0.5))
    }

    fn step_stresses(&self, f0: &Matrix<D>, f1: &Matrix<D>) -> [Matrix<D>; 3] {
        let [discrete, difference, end] = self.law.step_stresses(f0, f1);
        [discrete + self.added(&((f0 + f1) * 0.5)), difference, end + self.added(f1)]
    }

    fn stress_and_tangent(&self, f: &Matrix<D>) -> (Matrix<D>, Tangent<D>) {
        let (stress, mut tangent) = self.law.stress_and_tangent(f);
        if self.law.is_objective() {
            for i in 0..D {
                for j in 0..D {
                    (0..D).for_each(|l| tangent[i][j][i][l] += self.stress[(j, l)]);
                }
            }
        }
        (stress + self.added(f), tangent)
    }

    fn cauchy_stress(&self, f: &Matrix<D>) -> Mat3 {
        let full = embed(f);
        let added = if self.law.is_objective() { full * self.full } else { self.full };
        self.law.cauchy_stress(f) + added * full.transpose() / full.determinant()
    }

    fn is_objective(&self) -> bool {
        self.law.is_objective()
    }

    fn energies(&self, count: usize, f: &Batch<D>, history: &[PlasticState], out: &mut [f64]) {
        self.law.energies(count, f, history, out);
        for (k, out) in out[..count].iter_mut().enumerate() {
            *out += self.stress.dot(&self.strain(&f.get(k))) + self.stored;
        }
    }

    fn stresses(&self, count: usize, f: &Batch<D>, history: &[PlasticState], out: &mut Batch<D>) {
        self.law.stresses(count, f, history, out);
        self.add(count, &[f], out);
    }

    fn discrete_stresses(
        &self,
        count: usize,
        f0: &Batch<D>,
        f1: &Batch<D>,
        history: &[PlasticState],
        out: &mut Batch<D>,
    ) {
        self.law.discrete_stresses(count, f0, f1, history, out);
        self.add(count, &[f0, f1], out);
    }

    fn all_step_stresses(
        &self,
        count: usize,
        f0: &Batch<D>,
        f1: &Batch<D>,
        history: &[PlasticState],
        out: &mut [Batch<D>; 3],
    ) {
        self.law.all_step_stresses(count, f0, f1, history, out);
        self.add(count, &[f0, f1], &mut out[0]);
        self.add(count, &[f1], &mut out[2]);
    }
}
