use pulp::{Arch, Simd, WithSimd};

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
        Arch::new().dispatch(Energies { law: self, count, f, out });
    }

    fn stresses<const D: usize>(&self, count: usize, f: &Batch<D>, out: &mut Batch<D>) {
        Arch::new().dispatch(Stresses { law: self, count, f0: None, f1: f, out });
    }

    fn discrete_stresses<const D: usize>(
        &self,
        count: usize,
        f0: &Batch<D>,
        f1: &Batch<D>,
        out: &mut Batch<D>,
    ) {
        Arch::new().dispatch(Stresses { law: self, count, f0: Some(f0), f1, out });
    }

    fn all_step_stresses<const D: usize>(
        &self,
        count: usize,
        f0: &Batch<D>,
        f1: &Batch<D>,
        out: &mut [Batch<D>; 3],
    ) {
        Arch::new().dispatch(StepStresses { law: self, count, f0, f1, out });
    }
}

/// Twice the Green–Lagrange strain, FᵀF − 1, at as many points as a register has lanes; its lower triangle.
#[inline(always)]
fn twice_strain<V: Simd, const D: usize>(simd: V, f: &[[V::f64s; D]; D]) -> [[V::f64s; D]; D] {
    let mut c = [[simd.splat_f64s(0.0); D]; D];
    for i in 0..D {
        c[i][i] = simd.splat_f64s(-1.0);
        for j in 0..=i {
            for row in f {
                c[i][j] = simd.mul_add_e_f64s(row[i], row[j], c[i][j]);
            }
        }
    }
    c
}

/// S = λ tr(E) 1 + 2 μ E [Pa] where the lower triangle of `c` is twice the strain E.
#[inline(always)]
fn second_piola<V: Simd, const D: usize>(
    simd: V,
    [half_lambda, mu]: [V::f64s; 2],
    c: &[[V::f64s; D]; D],
) -> [[V::f64s; D]; D] {
    let mut trace = simd.splat_f64s(0.0);
    for i in 0..D {
        trace = simd.add_f64s(trace, c[i][i]);
    }
    let pressure = simd.mul_f64s(trace, half_lambda);
    let mut s = *c;
    for i in 0..D {
        for j in 0..=i {
            s[i][j] = simd.mul_f64s(c[i][j], mu);
            s[j][i] = s[i][j];
        }
        s[i][i] = simd.add_f64s(s[i][i], pressure);
    }
    s
}

/// F S, component by component.
#[inline(always)]
fn product<V: Simd, const D: usize>(
    simd: V,
    f: &[[V::f64s; D]; D],
    s: &[[V::f64s; D]; D],
) -> [[V::f64s; D]; D] {
    let mut p = [[simd.splat_f64s(0.0); D]; D];
    for i in 0..D {
        for j in 0..D {
            for k in 0..D {
                p[i][j] = simd.mul_add_e_f64s(f[i][k], s[k][j], p[i][j]);
            }
        }
    }
    p
}

/// The mean of two matrices.
#[inline(always)]
fn mean<V: Simd, const D: usize>(simd: V, a: &[[V::f64s; D]; D], b: &[[V::f64s; D]; D]) -> [[V::f64s; D]; D] {
    let half = simd.splat_f64s(0.5);
    let mut mean = *a;
    for i in 0..D {
        for j in 0..D {
            mean[i][j] = simd.mul_f64s(simd.add_f64s(a[i][j], b[i][j]), half);
        }
    }
    mean
}

impl SaintVenantKirchhoff {
    /// ½ λ and μ, by which twice the strain gives the stress.
    #[inline(always)]
    fn splat<V: Simd>(&self, simd: V) -> [V::f64s; 2] {
        [simd.splat_f64s(0.5 * self.lambda), simd.splat_f64s(self.mu)]
    }
}

/// The stresses of a step from F₀ to F₁, many points at once; P of F₁ where there is no step.
struct Stresses<'a, const D: usize> {
    law: &'a SaintVenantKirchhoff,
    count: usize,
    f0: Option<&'a Batch<D>>,
    f1: &'a Batch<D>,
    out: &'a mut Batch<D>,
}

impl<const D: usize> WithSimd for Stresses<'_, D> {
    type Output = ();

    #[inline(always)]
    fn with_simd<V: Simd>(self, simd: V) {
        let Self { law, count, f0, f1, out } = self;
        let constants = law.splat(simd);
        for point in (0..count).step_by(V::F64_LANES) {
            // F and twice the strain, at the end or in the mean.
            let mut f = f1.load::<V>(point);
            let mut c = twice_strain(simd, &f);
            if let Some(f0) = f0 {
                let f0 = f0.load::<V>(point);
                c = mean(simd, &twice_strain(simd, &f0), &c);
                f = mean(simd, &f0, &f);
            }
            out.store::<V>(point, product(simd, &f, &second_piola(simd, constants, &c)));
        }
    }
}

/// The stresses that a blend of start and end is made of, many points at once.
struct StepStresses<'a, const D: usize> {
    law: &'a SaintVenantKirchhoff,
    count: usize,
    f0: &'a Batch<D>,
    f1: &'a Batch<D>,
    out: &'a mut [Batch<D>; 3],
}

impl<const D: usize> WithSimd for StepStresses<'_, D> {
    type Output = ();

    #[inline(always)]
    fn with_simd<V: Simd>(self, simd: V) {
        let Self { law, count, f0, f1, out: [discrete, difference, end] } = self;
        let constants = law.splat(simd);
        for point in (0..count).step_by(V::F64_LANES) {
            let (f0, f1) = (f0.load::<V>(point), f1.load::<V>(point));
            let s0 = second_piola(simd, constants, &twice_strain(simd, &f0));
            let s1 = second_piola(simd, constants, &twice_strain(simd, &f1));
            let middle = mean(simd, &f0, &f1);
            let mut change = s1;
            for i in 0..D {
                for j in 0..D {
                    change[i][j] = simd.sub_f64s(s1[i][j], s0[i][j]);
                }
            }
            discrete.store::<V>(point, product(simd, &middle, &mean(simd, &s0, &s1)));
            difference.store::<V>(point, product(simd, &middle, &change));
            end.store::<V>(point, product(simd, &f1, &s1));
        }
    }
}

/// Energy densities, many points at once.
struct Energies<'a, const D: usize> {
    law: &'a SaintVenantKirchhoff,
    count: usize,
    f: &'a Batch<D>,
    out: &'a mut [f64],
}

impl<const D: usize> WithSimd for Energies<'_, D> {
    type Output = ();

    #[inline(always)]
    fn with_simd<V: Simd>(self, simd: V) {
        let Self { law, count, f, out } = self;
        let zero = simd.splat_f64s(0.0);
        // Of twice the strain.
        let (lambda, mu) = (simd.splat_f64s(0.125 * law.lambda), simd.splat_f64s(0.25 * law.mu));
        let two = simd.splat_f64s(2.0);
        let out = V::as_mut_simd_f64s(&mut out[..count]).0;
        for (k, out) in out.iter_mut().enumerate() {
            let c = twice_strain(simd, &f.load::<V>(k * V::F64_LANES));
            let (mut trace, mut squares, mut beside) = (zero, zero, zero);
            for i in 0..D {
                trace = simd.add_f64s(trace, c[i][i]);
                squares = simd.mul_add_e_f64s(c[i][i], c[i][i], squares);
                for c in &c[i][..i] {
                    beside = simd.mul_add_e_f64s(*c, *c, beside);
                }
            }
            squares = simd.mul_add_e_f64s(two, beside, squares);
            *out = simd.mul_add_e_f64s(simd.mul_f64s(trace, trace), lambda, simd.mul_f64s(squares, mu));
        }
    }
}
