//! Isotropic laws as functions of the logarithmic principal stretches ε_A = ln λ_A.

use std::fmt::Debug;

use super::control::CONTROL;
use super::strain_law::StrainLaw;
use super::{Mat3, Tangent};

/// ψ(ε₁, ε₂, ε₃), symmetric in its arguments.
pub trait StretchEnergy: Send + Sync + Debug {
    /// ψ [J/m³].
    fn energy(&self, e: &[f64; 3]) -> f64;
    /// Principal Kirchhoff stresses τ_A = ∂ψ/∂ε_A [Pa].
    fn stress(&self, e: &[f64; 3]) -> [f64; 3];
    /// ∂τ_A/∂ε_B [Pa].
    fn modulus(&self, e: &[f64; 3]) -> [[f64; 3]; 3];
}

/// Eigenvalues of E = ½(C − I) and its eigenvectors, column by column; not numbers where E is not.
#[derive(Debug, Clone, Copy)]
pub struct Spectrum {
    /// E_A = ½(λ_A² − 1).
    pub strains: [f64; 3],
    /// N_A.
    pub vectors: Mat3,
}

impl Spectrum {
    /// The spectrum of a strain, by Jacobi's rotations. In 3 × 3 they take few sweeps, and leave only round-off in
    /// eigenvalues and vectors, however close the eigenvalues are.
    #[must_use]
    pub fn of(e: &Mat3) -> Self {
        let (mut e, mut vectors) = (*e, Mat3::identity());
        for _ in 0..CONTROL.sweeps {
            let mut rotated = false;
            for (p, q) in [(0, 1), (0, 2), (1, 2)] {
                let coupling = e[(p, q)];
                // What this leaves out changes the eigenvalues by its square. What is not a number stays so.
                let small = 0.125 * f64::EPSILON * (1.0 + 2.0 * e[(p, p)].min(e[(q, q)]));
                if coupling.abs() <= small || coupling.is_nan() {
                    continue;
                }
                rotated = true;
                // The smaller root t = tan φ of t² + 2 t cot 2φ − 1 = 0.
                let cot = (e[(q, q)] - e[(p, p)]) / (2.0 * coupling);
                // No `hypot`, which takes several times as long: |tan| ≤ 1, and where cot² overflows tan vanishes as it should.
                let tan = cot.signum() / (cot.abs() + (1.0 + cot * cot).sqrt());
                let cos = 1.0 / (1.0 + tan * tan).sqrt();
                let sin = tan * cos;
                let other = 3 - p - q;
                let (to_p, to_q) = (e[(p, other)], e[(q, other)]);
                e[(p, p)] -= tan * coupling;
                e[(q, q)] += tan * coupling;
                for (i, j, value) in
                    [(p, q, 0.0), (p, other, cos * to_p - sin * to_q), (q, other, sin * to_p + cos * to_q)]
                {
                    e[(i, j)] = value;
                    e[(j, i)] = value;
                }
                for i in 0..3 {
                    let (v, w) = (vectors[(i, p)], vectors[(i, q)]);
                    vectors[(i, p)] = cos * v - sin * w;
                    vectors[(i, q)] = sin * v + cos * w;
                }
            }
            if !rotated {
                break;
            }
        }
        Self { strains: [e[(0, 0)], e[(1, 1)], e[(2, 2)]], vectors }
    }

    /// λ_A².
    #[must_use]
    pub fn squares(&self) -> [f64; 3] {
        self.strains.map(|e| 1.0 + 2.0 * e)
    }

    /// ε_A = ½ ln λ_A².
    #[must_use]
    pub fn logarithms(&self) -> [f64; 3] {
        self.strains.map(|e| 0.5 * (2.0 * e).ln_1p())
    }

    /// Σ x_A N_A ⊗ N_A.
    #[must_use]
    pub fn compose(&self, x: &[f64; 3]) -> Mat3 {
        self.vectors * Mat3::from_diagonal(&(*x).into()) * self.vectors.transpose()
    }

    /// The derivative by E = ½(C − I) of S = Σ s_A(λ²) N_A ⊗ N_A, with `slope` = 2 ∂s_A/∂λ_B². dS has the components Σ_B slope_AB dE_BB on the
    /// diagonal and 2 (s_A − s_B)/(λ_A² − λ_B²) dE_AB beside it, in the axes N.
    #[must_use]
    pub fn derivative(&self, s: &[f64; 3], slope: &[[f64; 3]; 3]) -> Tangent<3> {
        let (squares, mut shear) = (self.squares(), [[0.0; 3]; 3]);
        for a in 0..3 {
            for b in 0..3 {
                let difference = 2.0 * (self.strains[a] - self.strains[b]);
                shear[a][b] = if difference.abs() > CONTROL.coincident * squares[a] {
                    2.0 * (s[a] - s[b]) / difference
                } else {
                    0.5 * (slope[a][a] - slope[a][b] + slope[b][b] - slope[b][a])
                };
            }
        }
        let n = &self.vectors;
        let mut out: Tangent<3> = [[[[0.0; 3]; 3]; 3]; 3];
        for a in 0..3 {
            for b in 0..3 {
                for i in 0..3 {
                    for j in 0..3 {
                        let (direct, crossed) = (n[(i, a)] * n[(j, a)], n[(i, a)] * n[(j, b)]);
                        for k in 0..3 {
                            for l in 0..3 {
                                let mut sum = slope[a][b] * direct * n[(k, b)] * n[(l, b)];
                                if a != b {
                                    let twin = n[(k, a)] * n[(l, b)] + n[(k, b)] * n[(l, a)];
                                    sum += 0.5 * shear[a][b] * crossed * twin;
                                }
                                out[i][j][k][l] += sum;
                            }
                        }
                    }
                }
            }
        }
        out
    }
}

/// A law of the principal stretches as a law of E.
#[derive(Debug, Clone, PartialEq)]
pub struct ByStretches<L>(pub L);

impl<L: StretchEnergy> StrainLaw for ByStretches<L> {
    fn energy(&self, e: &Mat3) -> f64 {
        self.0.energy(&Spectrum::of(e).logarithms())
    }

    fn second_piola(&self, e: &Mat3) -> Mat3 {
        let spectrum = Spectrum::of(e);
        let (stress, squares) = (self.0.stress(&spectrum.logarithms()), spectrum.squares());
        spectrum.compose(&std::array::from_fn(|a| stress[a] / squares[a]))
    }

    /// S_A = τ_A/λ_A², 2 ∂S_A/∂λ_B² = (∂τ_A/∂ε_B)/(λ_A² λ_B²) − 2 δ_AB τ_A/λ_A⁴.
    fn elasticity(&self, e: &Mat3) -> (Mat3, Tangent<3>) {
        let spectrum = Spectrum::of(e);
        let logarithms = spectrum.logarithms();
        let (stress, modulus) = (self.0.stress(&logarithms), self.0.modulus(&logarithms));
        let squares = spectrum.squares();
        let s: [f64; 3] = std::array::from_fn(|a| stress[a] / squares[a]);
        let slope = std::array::from_fn(|a| {
            std::array::from_fn(|b| {
                let own = if a == b { 2.0 * s[a] / squares[a] } else { 0.0 };
                modulus[a][b] / (squares[a] * squares[b]) - own
            })
        });
        (spectrum.compose(&s), spectrum.derivative(&s, &slope))
    }
}
