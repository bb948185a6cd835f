use carom_mesh::Matrix;

use super::control::CONTROL;
use super::discrete_gradient::{discrete_stress, stress_difference};
use super::point_law::restrict;
use super::{Mat3, Material, PointLaw, Tangent};

/// A law in a sheet that is free of stress across its plane: P₃₃ = 0 gives F₃₃, and the energy of the sheet is ψ with that F₃₃.
///
/// That energy is a function of the deformation in the plane, its derivative is P in the plane, and the thickness is F₃₃ times
/// that of the reference configuration. Where there is no such F₃₃ all results are not a number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaneStress<M>(pub M);

impl<M: Material> PlaneStress<M> {
    /// F in space, with F₃₃ by Newton's iteration for the Kirchhoff stress F₃₃ P₃₃ as a function of ln F₃₃, which grows with it far
    /// beyond where P₃₃ does. A law of small displacements is linear: P₃₃ as a function of F₃₃ needs one step.
    fn in_space<const D: usize>(&self, f: &Matrix<D>) -> Mat3 {
        let mut full = Mat3::identity();
        for i in 0..2 {
            for j in 0..2 {
                full[(i, j)] = f[(i, j)];
            }
        }
        for _ in 0..CONTROL.steps {
            let stretch = full[(2, 2)];
            let (stress, tangent) = self.0.stress_and_tangent(&full);
            let (p, a) = (stress[(2, 2)], tangent[2][2][2][2]);
            let change = if self.0.is_objective() {
                let change = -p / (p + a * stretch);
                full[(2, 2)] *= change.clamp(-1.0, 1.0).exp();
                change
            } else {
                full[(2, 2)] -= p / a;
                p / a
            };
            if change.abs() <= CONTROL.converged {
                return full;
            }
        }
        Mat3::from_element(f64::NAN)
    }
}

impl<const D: usize, M: Material> PointLaw<D> for PlaneStress<M> {
    fn energy(&self, f: &Matrix<D>) -> f64 {
        self.0.energy(&self.in_space(f))
    }

    fn stress(&self, f: &Matrix<D>) -> Matrix<D> {
        restrict(&self.0.stress(&self.in_space(f)))
    }

    fn discrete_stress(&self, f0: &Matrix<D>, f1: &Matrix<D>) -> Matrix<D> {
        if self.0.is_objective() {
            discrete_stress(f0, f1, |f| self.energy(f), |f| self.stress(f))
        } else {
            self.stress(&((f0 + f1) * 0.5))
        }
    }

    fn step_stresses(&self, f0: &Matrix<D>, f1: &Matrix<D>) -> [Matrix<D>; 3] {
        let (start, end) = (self.stress(f0), self.stress(f1));
        if self.0.is_objective() {
            [self.discrete_stress(f0, f1), stress_difference(f0, &start, f1, &end), end]
        } else {
            [(start + end) * 0.5, end - start, end]
        }
    }

    /// The tangent with δP₃₃ = 0: A_ijkl − A_ij33 A_33kl / A_3333.
    fn stress_and_tangent(&self, f: &Matrix<D>) -> (Matrix<D>, Tangent<D>) {
        let (stress, a) = self.0.stress_and_tangent(&self.in_space(f));
        let condensed = |i: usize, j: usize, k: usize, l: usize| {
            a[i][j][k][l] - a[i][j][2][2] * a[2][2][k][l] / a[2][2][2][2]
        };
        let tangent = std::array::from_fn(|i| {
            std::array::from_fn(|j| std::array::from_fn(|k| std::array::from_fn(|l| condensed(i, j, k, l))))
        });
        (restrict(&stress), tangent)
    }

    fn cauchy_stress(&self, f: &Matrix<D>) -> Mat3 {
        let f = self.in_space(f);
        self.0.stress(&f) * f.transpose() / f.determinant()
    }

    fn is_objective(&self) -> bool {
        self.0.is_objective()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{ElasticConstants, LinearElastic, NeoHookean, SaintVenantKirchhoff};

    const CONSTANTS: ElasticConstants = ElasticConstants { young: 2700.0, poisson: 0.33 };

    /// σ₁₁ = E/(1 − ν²) (ε₁₁ + ν ε₂₂), σ₁₂ = E/(1 + ν) ε₁₂ (Timoshenko & Goodier).
    #[test]
    fn small_strains_meet_the_moduli_of_a_sheet() {
        let law = PlaneStress(LinearElastic::new(&CONSTANTS).expect("valid"));
        let f = Matrix::<2>::new(1.0 + 2e-3, 3e-3, 3e-3, 1.0 - 1e-3);
        let stress = PointLaw::<2>::stress(&law, &f);
        let (e, nu) = (CONSTANTS.young, CONSTANTS.poisson);
        assert!((stress[(0, 0)] - e / (1.0 - nu * nu) * (2e-3 - nu * 1e-3)).abs() < 1e-12);
        assert!((stress[(0, 1)] - e / (1.0 + nu) * 3e-3).abs() < 1e-12);
    }

    /// A bar pulled by S₁₁ alone has E₁₁ = S₁₁/E, whatever its size, and E₂₂ = E₃₃ = −ν E₁₁.
    #[test]
    fn a_sheet_of_saint_venant_kirchhoff_in_uniaxial_tension_has_youngs_modulus() {
        let law = PlaneStress(SaintVenantKirchhoff::new(&CONSTANTS).expect("valid"));
        let strain = 0.4;
        let stretch = |e: f64| (1.0 + 2.0 * e).sqrt();
        let f = Matrix::<2>::new(stretch(strain), 0.0, 0.0, stretch(-0.33 * strain));
        let stress = PointLaw::<2>::stress(&law, &f);
        assert!((stress[(0, 0)] / f[(0, 0)] - 2700.0 * strain).abs() < 1e-11);
        assert!(stress[(1, 1)].abs() < 1e-11);
        assert!((PointLaw::<2>::energy(&law, &f) - 0.5 * 2700.0 * strain * strain).abs() < 1e-11);
        assert!((law.in_space(&f)[(2, 2)] - stretch(-0.33 * strain)).abs() < 1e-15);
    }

    /// Rubber next to incompressible: P₃₃ as a function of F₃₃ falls beyond ln J = 2 μ/λ, where its own tangent leads astray.
    #[test]
    fn the_thickness_of_nearly_incompressible_rubber_is_found_at_large_stretches() {
        let constants = ElasticConstants { poisson: 0.4999, ..CONSTANTS };
        let law = PlaneStress(NeoHookean::new(&constants).expect("valid"));
        for (a, b) in [(3.0, 2.0), (0.3, 0.5), (4.0, 0.2)] {
            let f = law.in_space(&Matrix::<2>::new(a, 0.2, -0.1, b));
            assert!(law.0.stress(&f)[(2, 2)].abs() < 1e-8, "{a} {b}");
            assert!((f.determinant() - 1.0).abs() < 0.03, "{a} {b}: {}", f.determinant());
        }
    }

    #[test]
    fn where_no_thickness_frees_the_sheet_of_stress_the_energy_is_not_a_number() {
        let law = PlaneStress(SaintVenantKirchhoff::new(&CONSTANTS).expect("valid"));
        // E₃₃ = −ν/(1 − ν)(E₁₁ + E₂₂) = −0.98 is below −½.
        let torn = Matrix::<2>::from_diagonal_element(2.0_f64.sqrt() + 0.4);
        assert!(PointLaw::<2>::energy(&law, &torn).is_nan());
        assert!(PointLaw::<2>::stress(&law, &torn).iter().all(|p| p.is_nan()));
    }
}
