//! Hyperelastic laws as functions of the Green–Lagrange strain E = ½(FᵀF − I).
//!
//! Of E and not of C = I + 2E, so that the energy of a small strain keeps its digits. From C it would be known to ε μ only, and so would its
//! change in a step. The stress of a conserving step must do the work of that change.

use std::fmt::Debug;

use super::discrete_gradient::with_work;
use super::{Mat3, Material, Tangent};

/// A stored energy ψ(E) with its derivatives.
pub trait StrainLaw: Send + Sync + Debug {
    /// ψ [J/m³].
    fn energy(&self, e: &Mat3) -> f64;
    /// Second Piola–Kirchhoff stress S = ∂ψ/∂E [Pa].
    fn second_piola(&self, e: &Mat3) -> Mat3;
    /// S and ∂S/∂E [Pa].
    fn elasticity(&self, e: &Mat3) -> (Mat3, Tangent<3>);
}

/// A law of E as a law of F: objective by construction.
///
/// Where J = det F ≤ 0 it is not a number, so that a step which turns a cell inside out fails instead of passing unseen.
#[derive(Debug, Clone, PartialEq)]
pub struct Hyperelastic<L>(pub L);

impl<L: StrainLaw> Hyperelastic<L> {
    /// E, or NaN where the material is inside out.
    #[inline]
    fn strain(f: &Mat3) -> Mat3 {
        if f.determinant() > 0.0 { green_lagrange(f) } else { Mat3::from_element(f64::NAN) }
    }
}

impl<L: StrainLaw> Material for Hyperelastic<L> {
    #[inline]
    fn energy(&self, f: &Mat3) -> f64 {
        self.0.energy(&Self::strain(f))
    }

    #[inline]
    fn stress(&self, f: &Mat3) -> Mat3 {
        f * self.0.second_piola(&Self::strain(f))
    }

    fn stress_and_tangent(&self, f: &Mat3) -> (Mat3, Tangent<3>) {
        let (stress, elasticity) = self.0.elasticity(&Self::strain(f));
        (f * stress, nominal_tangent(f, f, &stress, &elasticity))
    }

    fn discrete_stress(&self, f0: &Mat3, f1: &Mat3) -> Mat3 {
        let (e0, e1) = (Self::strain(f0), Self::strain(f1));
        let stress = self.0.second_piola(&((e0 + e1) * 0.5));
        (f0 + f1) * 0.5 * with_work(&stress, &(e1 - e0), || self.0.energy(&e1) - self.0.energy(&e0))
    }

    fn step_stresses(&self, f0: &Mat3, f1: &Mat3) -> [Mat3; 3] {
        let (start, end) = (self.0.second_piola(&Self::strain(f0)), self.0.second_piola(&Self::strain(f1)));
        [self.discrete_stress(f0, f1), (f0 + f1) * 0.5 * (end - start), f1 * end]
    }
}

/// E = ½(H + Hᵀ + HᵀH) with H = F − I.
#[inline]
pub(crate) fn green_lagrange(f: &Mat3) -> Mat3 {
    let h = f - Mat3::identity();
    (h + h.transpose() + h.tr_mul(&h)) * 0.5
}

/// (I₁ − 3, I₂ − 3, J² − 1) of C = I + 2E: 2t, 4t + 2(t² − E:E) and 2t + 2(t² − E:E) + 8 det E with t = tr E.
#[inline]
pub(super) fn growths(e: &Mat3) -> [f64; 3] {
    let trace = e.trace();
    let second = 2.0 * (trace * trace - e.norm_squared());
    [2.0 * trace, 4.0 * trace + second, 2.0 * trace + second + 8.0 * e.determinant()]
}

/// ∂P/∂F₁ [Pa] of P = F S(E₁) with a modulus ∂S/∂E₁: A_iJkL = δ_ik S_JL + F_iM (∂S/∂E)_MJNL (F₁)_kN. F is F₁ itself or a mean.
pub(super) fn nominal_tangent(f: &Mat3, end: &Mat3, stress: &Mat3, modulus: &Tangent<3>) -> Tangent<3> {
    let mut half: Tangent<3> = [[[[0.0; 3]; 3]; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            for m in 0..3 {
                for n in 0..3 {
                    for l in 0..3 {
                        half[i][j][n][l] += f[(i, m)] * modulus[m][j][n][l];
                    }
                }
            }
        }
    }
    let mut a: Tangent<3> = [[[[0.0; 3]; 3]; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            for l in 0..3 {
                a[i][j][i][l] = stress[(j, l)];
                for k in 0..3 {
                    for n in 0..3 {
                        a[i][j][k][l] += half[i][j][n][l] * end[(k, n)];
                    }
                }
            }
        }
    }
    a
}
