use pulp::Simd;

use super::control::CONTROL;
use super::lanes::{self, LaneLaw, Strain, Tensor};
use super::strain_law::{green_lagrange, growths};
use super::{Batch, ElasticConstants, Mat3, Material, Tangent};
use crate::FemError;

/// Compressible neo-Hookean: ψ = ½ μ (tr FᵀF − 3) − μ ln J + ½ λ (ln J)², J = det F (Simo & Pister 1984).
///
/// Where J ≤ 0 the energy is not a number, so that a step which turns a cell inside out fails instead of passing unseen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NeoHookean {
    lambda: f64,
    mu: f64,
}

impl NeoHookean {
    /// The law with these constants of small strain.
    ///
    /// # Errors
    /// If the constants are out of range.
    pub fn new(constants: &ElasticConstants) -> Result<Self, FemError> {
        let (lambda, mu) = constants.lame()?;
        Ok(Self { lambda, mu })
    }
}

impl Material for NeoHookean {
    /// By the Green–Lagrange strain, so that the energy of a small strain keeps its digits.
    #[inline]
    fn energy(&self, f: &Mat3) -> f64 {
        if f.determinant() <= 0.0 {
            return f64::NAN;
        }
        let [x1, _, x3] = growths(&green_lagrange(f));
        let log_j = 0.5 * x3.ln_1p();
        self.mu * (0.5 * x1 - log_j) + 0.5 * self.lambda * log_j * log_j
    }

    /// P = μ (F − F⁻ᵀ) + λ ln J F⁻ᵀ.
    #[inline]
    fn stress(&self, f: &Mat3) -> Mat3 {
        let (inverse, j) = carom_mesh::tensor::inverse(f);
        f * self.mu + inverse.transpose() * (self.lambda * j.ln() - self.mu)
    }

    /// A_iJkL = μ δ_ik δ_JL + (μ − λ ln J) F⁻¹_Jk F⁻¹_Li + λ F⁻¹_Ji F⁻¹_Lk.
    fn stress_and_tangent(&self, f: &Mat3) -> (Mat3, Tangent<3>) {
        let (inverse, j) = carom_mesh::tensor::inverse(f);
        let log_j = j.ln();
        let mut a: Tangent<3> = [[[[0.0; 3]; 3]; 3]; 3];
        for i in 0..3 {
            for j in 0..3 {
                for k in 0..3 {
                    for l in 0..3 {
                        let mut value = (self.mu - self.lambda * log_j) * inverse[(j, k)] * inverse[(l, i)]
                            + self.lambda * inverse[(j, i)] * inverse[(l, k)];
                        if i == k && j == l {
                            value += self.mu;
                        }
                        a[i][j][k][l] = value;
                    }
                }
            }
        }
        (self.stress(f), a)
    }

    // Only in conserving steps, which take their time here. Load steps keep the stress of one point: the other differs by round-off, and with it a
    // block on the way to buckling was refused without a word of how it gives way.
    fn discrete_stresses<const D: usize>(
        &self,
        count: usize,
        f0: &Batch<D>,
        f1: &Batch<D>,
        out: &mut Batch<D>,
    ) {
        lanes::discrete_stresses(*self, count, [f0, f1], out);
    }

    fn all_step_stresses<const D: usize>(
        &self,
        count: usize,
        f0: &Batch<D>,
        f1: &Batch<D>,
        out: &mut [Batch<D>; 3],
    ) {
        lanes::step_stresses(*self, count, [f0, f1], out);
    }
}

impl LaneLaw for NeoHookean {
    /// λ and μ.
    type Constants<V: Simd> = [V::f64s; 2];
    const IS_QUADRATIC: bool = false;

    #[inline(always)]
    fn splat<V: Simd>(&self, simd: V) -> [V::f64s; 2] {
        [simd.splat_f64s(self.lambda), simd.splat_f64s(self.mu)]
    }

    /// S = μ (1 − C⁻¹) + λ ln J C⁻¹, with 1 − C⁻¹ = C⁻¹ X. Where the strain is large the terms of its [`small_growth`] cancel, those of J² do not.
    #[inline(always)]
    fn energy_and_stress<V: Simd, const D: usize>(
        simd: V,
        [lambda, mu]: [V::f64s; 2],
        Strain { x, square }: &Strain<V, D>,
    ) -> (V::f64s, Tensor<V, D>) {
        let (half, one) = (simd.splat_f64s(0.5), simd.splat_f64s(1.0));
        let mut c = *x;
        let mut trace = simd.splat_f64s(0.0);
        for i in 0..D {
            c[i][i] = simd.add_f64s(x[i][i], one);
            trace = simd.add_f64s(trace, x[i][i]);
        }
        let cofactors = lanes::cofactors(simd, &c);
        let growth = simd.select_f64s(
            simd.greater_than_f64s(trace, simd.splat_f64s(CONTROL.large_strain)),
            simd.sub_f64s(*square, one),
            small_growth(simd, x),
        );
        let log_j = simd.mul_f64s(half, lanes::each_lane::<V>(growth, f64::ln_1p));
        let pressure = simd.mul_f64s(lambda, log_j);
        let shear = simd.mul_f64s(mu, simd.sub_f64s(simd.mul_f64s(half, trace), log_j));
        let energy = simd.mul_add_e_f64s(simd.mul_f64s(half, pressure), log_j, shear);
        // C⁻¹ (μ X + λ ln J 1), C⁻¹ = cof C / J².
        let mut inner = *x;
        for i in 0..D {
            for j in 0..=i {
                inner[i][j] = simd.mul_f64s(mu, x[i][j]);
                inner[j][i] = inner[i][j];
            }
            inner[i][i] = simd.add_f64s(inner[i][i], pressure);
        }
        let scale = simd.div_f64s(one, simd.add_f64s(one, growth));
        let mut stress = inner;
        for i in 0..D {
            for j in 0..=i {
                let mut sum = simd.splat_f64s(0.0);
                for k in 0..D {
                    let cofactor = if i >= k { cofactors[i][k] } else { cofactors[k][i] };
                    sum = simd.mul_add_e_f64s(cofactor, inner[k][j], sum);
                }
                stress[i][j] = simd.mul_f64s(scale, sum);
            }
        }
        for i in 0..D {
            for j in 0..i {
                stress[j][i] = stress[i][j];
            }
        }
        (energy, stress)
    }
}

/// J² − 1 = tr X + Σ principal minors of X + det X: see [`growths`].
#[inline(always)]
fn small_growth<V: Simd, const D: usize>(simd: V, x: &Tensor<V, D>) -> V::f64s {
    let cofactors = lanes::cofactors(simd, x);
    let mut growth = lanes::symmetric_determinant(simd, x, &cofactors);
    for i in 0..D {
        // In the plane the only minor is the determinant.
        if D == 3 {
            growth = simd.add_f64s(growth, cofactors[i][i]);
        }
        growth = simd.add_f64s(growth, x[i][i]);
    }
    growth
}
