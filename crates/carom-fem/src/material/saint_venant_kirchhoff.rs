use pulp::Simd;

use super::lanes::{self, LaneLaw, Strain, Tensor};
use super::{Batch, ElasticConstants, Mat3, Material, Tangent};
use crate::FemError;

/// Saint-Venant–Kirchhoff: ψ = ½ λ (tr E)² + μ E:E with the Green–Lagrange strain E = ½(FᵀF − I).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SaintVenantKirchhoff {
    lambda: f64,
    mu: f64,
}

impl SaintVenantKirchhoff {
    /// The law with these constants.
    ///
    /// # Errors
    /// If the constants are out of range.
    pub fn new(constants: &ElasticConstants) -> Result<Self, FemError> {
        let (lambda, mu) = constants.lame()?;
        Ok(Self { lambda, mu })
    }

    /// Green–Lagrange strain.
    #[inline]
    fn strain(f: &Mat3) -> Mat3 {
        (f.transpose() * f - Mat3::identity()) * 0.5
    }

    /// Second Piola–Kirchhoff stress S = λ tr(E) I + 2 μ E [Pa].
    #[inline]
    fn second_piola(&self, strain: &Mat3) -> Mat3 {
        Mat3::identity() * (self.lambda * strain.trace()) + strain * (2.0 * self.mu)
    }
}

impl Material for SaintVenantKirchhoff {
    #[inline]
    fn energy(&self, f: &Mat3) -> f64 {
        let strain = Self::strain(f);
        0.5 * self.lambda * strain.trace().powi(2) + self.mu * strain.norm_squared()
    }

    #[inline]
    fn stress(&self, f: &Mat3) -> Mat3 {
        f * self.second_piola(&Self::strain(f))
    }

    /// ψ is quadratic in E: the stress of the mean strain does the work of the step (Simo & Tarnow 1992).
    #[inline]
    fn discrete_stress(&self, f0: &Mat3, f1: &Mat3) -> Mat3 {
        (f0 + f1) * 0.5 * self.second_piola(&((Self::strain(f0) + Self::strain(f1)) * 0.5))
    }

    #[inline]
    fn step_stresses(&self, f0: &Mat3, f1: &Mat3) -> [Mat3; 3] {
        let (s0, s1) = (self.second_piola(&Self::strain(f0)), self.second_piola(&Self::strain(f1)));
        let middle = (f0 + f1) * 0.5;
        [middle * (s0 + s1) * 0.5, middle * (s1 - s0), f1 * s1]
    }

    /// A_iJkL = δ_ik S_JL + λ F_iJ F_kL + μ (F_iM F_kM δ_JL + F_iL F_kJ).
    fn stress_and_tangent(&self, f: &Mat3) -> (Mat3, Tangent<3>) {
        let s = self.second_piola(&Self::strain(f));
        let b = f * f.transpose();
        let mut a: Tangent<3> = [[[[0.0; 3]; 3]; 3]; 3];
        for i in 0..3 {
            for j in 0..3 {
                for k in 0..3 {
                    for l in 0..3 {
                        let mut value = self.lambda * f[(i, j)] * f[(k, l)] + self.mu * f[(i, l)] * f[(k, j)];
                        if i == k {
                            value += s[(j, l)];
                        }
                        if j == l {
                            value += self.mu * b[(i, k)];
                        }
                        a[i][j][k][l] = value;
                    }
                }
            }
        }
        (f * s, a)
    }

    fn energies<const D: usize>(&self, count: usize, f: &Batch<D>, out: &mut [f64]) {
        lanes::energies(*self, count, f, out);
    }

    fn stresses<const D: usize>(&self, count: usize, f: &Batch<D>, out: &mut Batch<D>) {
        lanes::stresses(*self, count, f, out);
    }

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

impl LaneLaw for SaintVenantKirchhoff {
    /// λ and μ.
    type Constants<V: Simd> = [V::f64s; 2];
    const IS_QUADRATIC: bool = true;

    #[inline(always)]
    fn splat<V: Simd>(&self, simd: V) -> [V::f64s; 2] {
        [simd.splat_f64s(self.lambda), simd.splat_f64s(self.mu)]
    }

    /// S = λ tr(E) 1 + 2 μ E.
    #[inline(always)]
    fn energy_and_stress<V: Simd, const D: usize>(
        simd: V,
        [lambda, mu]: [V::f64s; 2],
        Strain { x, .. }: &Strain<V, D>,
    ) -> (V::f64s, Tensor<V, D>) {
        let zero = simd.splat_f64s(0.0);
        let (mut trace, mut squares, mut beside) = (zero, zero, zero);
        for i in 0..D {
            trace = simd.add_f64s(trace, x[i][i]);
            squares = simd.mul_add_e_f64s(x[i][i], x[i][i], squares);
            for x in &x[i][..i] {
                beside = simd.mul_add_e_f64s(*x, *x, beside);
            }
        }
        squares = simd.mul_add_e_f64s(simd.splat_f64s(2.0), beside, squares);
        let eighth = simd.mul_f64s(lambda, simd.splat_f64s(0.125));
        let quarter = simd.mul_f64s(mu, simd.splat_f64s(0.25));
        let energy =
            simd.mul_add_e_f64s(simd.mul_f64s(trace, trace), eighth, simd.mul_f64s(squares, quarter));
        let pressure = simd.mul_f64s(trace, simd.mul_f64s(lambda, simd.splat_f64s(0.5)));
        let mut s = *x;
        for i in 0..D {
            for j in 0..=i {
                s[i][j] = simd.mul_f64s(x[i][j], mu);
                s[j][i] = s[i][j];
            }
            s[i][i] = simd.add_f64s(s[i][i], pressure);
        }
        (energy, s)
    }
}
