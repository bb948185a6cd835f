//! Isotropic laws as functions of the invariants I₁ = tr C, I₂ = ½(I₁² − C:C) and J = √det C.

use std::fmt::Debug;

use super::strain_law::{StrainLaw, growths};
use super::volumetric::Volumetric;
use super::{Mat3, Tangent};

/// A function of three invariants with its derivatives.
#[derive(Debug, Clone, Copy, Default)]
pub struct Jet {
    /// The value.
    pub value: f64,
    /// First derivatives.
    pub first: [f64; 3],
    /// Second derivatives.
    pub second: [[f64; 3]; 3],
}

/// ψ(I₁, I₂, J).
pub trait InvariantEnergy: Send + Sync + Debug {
    /// ψ [J/m³] and its derivatives by I₁, I₂ and J, where these have the `growths` I₁ − 3, I₂ − 3 and J² − 1. In these, as in E, a
    /// small strain keeps its digits.
    fn jet(&self, growths: [f64; 3]) -> Jet;
}

/// A law of the invariants as a law of E.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ByInvariants<L>(pub L);

/// J, C⁻¹ and (∂I₁/∂C, ∂I₂/∂C, ∂J/∂C).
#[inline]
fn gradients(e: &Mat3) -> (f64, Mat3, [Mat3; 3]) {
    let c = Mat3::identity() + e * 2.0;
    let (inverse, det) = carom_mesh::tensor::inverse(&c);
    let j = det.sqrt();
    (j, inverse, [Mat3::identity(), Mat3::from_diagonal_element(c.trace()) - c, inverse * (0.5 * j)])
}

impl<L: InvariantEnergy> StrainLaw for ByInvariants<L> {
    #[inline]
    fn energy(&self, e: &Mat3) -> f64 {
        self.0.jet(growths(e)).value
    }

    #[inline]
    fn second_piola(&self, e: &Mat3) -> Mat3 {
        let first = self.0.jet(growths(e)).first;
        let (_, _, [g1, g2, g3]) = gradients(e);
        (g1 * first[0] + g2 * first[1] + g3 * first[2]) * 2.0
    }

    /// S = 2 Σ ψ_a ∂I_a, and ∂S/∂E = 4 Σ ψ_ab ∂I_a ⊗ ∂I_b + 4 Σ ψ_a ∂²I_a. Here ∂²I₂ = I ⊗ I − 𝕀
    /// and ∂²J = ¼ J C⁻¹ ⊗ C⁻¹ − ½ J 𝕀(C⁻¹), 𝕀(X)_IJKL = ½(X_IK X_JL + X_IL X_JK).
    fn elasticity(&self, e: &Mat3) -> (Mat3, Tangent<3>) {
        let Jet { first, second, .. } = self.0.jet(growths(e));
        let (volume, inverse, gradients) = gradients(e);
        let unit = Mat3::identity();
        let twin = |x: &Mat3, [i, j, k, l]: [usize; 4]| 0.5 * (x[(i, k)] * x[(j, l)] + x[(i, l)] * x[(j, k)]);
        let mut modulus: Tangent<3> = [[[[0.0; 3]; 3]; 3]; 3];
        for i in 0..3 {
            for j in 0..3 {
                for k in 0..3 {
                    for l in 0..3 {
                        let mut sum = first[1] * (unit[(i, j)] * unit[(k, l)] - twin(&unit, [i, j, k, l]))
                            + first[2]
                                * volume
                                * (0.25 * inverse[(i, j)] * inverse[(k, l)]
                                    - 0.5 * twin(&inverse, [i, j, k, l]));
                        for a in 0..3 {
                            for b in 0..3 {
                                sum += second[a][b] * gradients[a][(i, j)] * gradients[b][(k, l)];
                            }
                        }
                        modulus[i][j][k][l] = 4.0 * sum;
                    }
                }
            }
        }
        let stress = (gradients[0] * first[0] + gradients[1] * first[1] + gradients[2] * first[2]) * 2.0;
        (stress, modulus)
    }
}

/// ψ_iso(Ī₁, Ī₂) + U(J) with Ī₁ = J^(−2/3) I₁ and Ī₂ = J^(−4/3) I₂.
///
/// `isochoric` gives ψ_iso, its first derivatives and (∂²/∂Ī₁², ∂²/∂Ī₁∂Ī₂, ∂²/∂Ī₂²) for Ī₁ − 3 and Ī₂ − 3.
#[inline]
pub(super) fn split(
    [x1, x2, x3]: [f64; 3],
    isochoric: impl Fn(f64, f64) -> (f64, [f64; 2], [f64; 3]),
    volumetric: &Volumetric,
) -> Jet {
    let log_j = 0.5 * x3.ln_1p();
    // J^(−2/3) − 1 and J^(−4/3) − 1.
    let (change1, change2) = ((-2.0 / 3.0 * log_j).exp_m1(), (-4.0 / 3.0 * log_j).exp_m1());
    let (scale, j) = (1.0 + change1, (1.0 + x3).sqrt());
    let (y1, y2) = (scale * x1 + 3.0 * change1, scale * scale * x2 + 3.0 * change2);
    let (b1, b2) = (y1 + 3.0, y2 + 3.0);
    let (w, [w1, w2], [w11, w12, w22]) = isochoric(y1, y2);
    let [u, u1, u2] = volumetric.by_logarithm(log_j);
    // ∂Ī/∂(I₁, I₂, J).
    let g1 = [scale, 0.0, -2.0 / 3.0 * b1 / j];
    let g2 = [0.0, scale * scale, -4.0 / 3.0 * b2 / j];
    let first = [w1 * g1[0], w2 * g2[1], w1 * g1[2] + w2 * g2[2] + u1 / j];
    let mut second = [[0.0; 3]; 3];
    for a in 0..3 {
        for b in 0..3 {
            second[a][b] = w11 * g1[a] * g1[b] + w12 * (g1[a] * g2[b] + g2[a] * g1[b]) + w22 * g2[a] * g2[b];
        }
    }
    let (mixed1, mixed2) = (-2.0 / 3.0 * scale / j * w1, -4.0 / 3.0 * scale * scale / j * w2);
    second[0][2] += mixed1;
    second[2][0] += mixed1;
    second[1][2] += mixed2;
    second[2][1] += mixed2;
    second[2][2] += (10.0 / 9.0 * b1 * w1 + 28.0 / 9.0 * b2 * w2 + u2 - u1) / (j * j);
    Jet { value: w + u, first, second }
}
