//! Laws of the Green–Lagrange strain at as many points at once as a SIMD register has lanes.
//!
//! What handles registers here is loops and functions that are always inlined, no closures: what is not inlined is not compiled for the registers.

use pulp::{Arch, Simd, WithSimd};

use super::Batch;
use super::control::CONTROL;

/// A D × D tensor at every lane.
pub(super) type Tensor<V, const D: usize> = [[<V as Simd>::f64s; D]; D];

/// A strain at every lane.
#[derive(Clone, Copy)]
pub(super) struct Strain<V: Simd, const D: usize> {
    /// X = 2E = C − 1; the lower triangle.
    pub x: Tensor<V, D>,
    /// J². Of what is strained little it has fewer digits than X.
    pub square: V::f64s,
}

/// A stored energy ψ(E) as the lanes of a register know it. What lies beyond the D dimensions is not strained.
pub(super) trait LaneLaw: Copy {
    /// The constants of the law, the same in every lane.
    type Constants<V: Simd>: Copy;
    /// Whether ψ is quadratic in E, so that the stress at the mean of two strains does the work between them (Simo & Tarnow 1992). Such a law sees
    /// no volume. Others are not a number where J = det F ≤ 0.
    const IS_QUADRATIC: bool;

    /// The constants in every lane.
    fn splat<V: Simd>(&self, simd: V) -> Self::Constants<V>;

    /// ψ [J/m³] and S [Pa] at a strain. What nobody asks for is not computed: it is inlined.
    fn energy_and_stress<V: Simd, const D: usize>(
        simd: V,
        constants: Self::Constants<V>,
        strain: &Strain<V, D>,
    ) -> (V::f64s, Tensor<V, D>);
}

/// ψ at the first `count` points of a batch.
pub(super) fn energies<L: LaneLaw, const D: usize>(law: L, count: usize, f: &Batch<D>, out: &mut [f64]) {
    Arch::new().dispatch(Energies { law, count, f, out });
}

/// P at the first `count` points of a batch.
pub(super) fn stresses<L: LaneLaw, const D: usize>(law: L, count: usize, f: &Batch<D>, out: &mut Batch<D>) {
    Arch::new().dispatch(Stresses { law, count, f, out });
}

/// [`super::Material::discrete_stress`] at the first `count` points of a batch.
pub(super) fn discrete_stresses<L: LaneLaw, const D: usize>(
    law: L,
    count: usize,
    ends: [&Batch<D>; 2],
    out: &mut Batch<D>,
) {
    Arch::new().dispatch(DiscreteStresses { law, count, ends, out });
}

/// [`super::Material::step_stresses`] at the first `count` points of a batch.
pub(super) fn step_stresses<L: LaneLaw, const D: usize>(
    law: L,
    count: usize,
    ends: [&Batch<D>; 2],
    out: &mut [Batch<D>; 3],
) {
    Arch::new().dispatch(StepStresses { law, count, ends, out });
}

/// What `f` makes of the number in every lane.
#[inline(always)]
pub(super) fn each_lane<V: Simd>(mut x: V::f64s, f: impl Fn(f64) -> f64) -> V::f64s {
    let lanes: &mut [f64] = pulp::bytemuck::cast_slice_mut(std::slice::from_mut(&mut x));
    lanes.iter_mut().for_each(|x| *x = f(*x));
    x
}

/// Twice the Green–Lagrange strain, FᵀF − 1; its lower triangle.
#[inline(always)]
fn twice_strain<V: Simd, const D: usize>(simd: V, f: &Tensor<V, D>) -> Tensor<V, D> {
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

/// The same as H + Hᵀ + HᵀH with H = F − 1, so that a small strain keeps its digits.
#[inline(always)]
fn twice_small_strain<V: Simd, const D: usize>(simd: V, f: &Tensor<V, D>) -> Tensor<V, D> {
    let mut h = *f;
    for i in 0..D {
        h[i][i] = simd.sub_f64s(h[i][i], simd.splat_f64s(1.0));
    }
    let mut x = h;
    for i in 0..D {
        for j in 0..=i {
            x[i][j] = simd.add_f64s(h[i][j], h[j][i]);
            for row in &h {
                x[i][j] = simd.mul_add_e_f64s(row[i], row[j], x[i][j]);
            }
        }
    }
    x
}

impl<V: Simd, const D: usize> Strain<V, D> {
    /// That of F as the law is to see it: not a number in lanes that are inside out, if it knows.
    #[inline(always)]
    fn of<L: LaneLaw>(simd: V, f: &Tensor<V, D>) -> Self {
        if L::IS_QUADRATIC {
            let (x, square) = (twice_strain(simd, f), simd.splat_f64s(1.0));
            return Self { x, square };
        }
        let (mut x, volume) = (twice_small_strain(simd, f), determinant(simd, f));
        let is_sound = simd.greater_than_f64s(volume, simd.splat_f64s(0.0));
        x[0][0] = simd.select_f64s(is_sound, x[0][0], simd.splat_f64s(f64::NAN));
        Self { x, square: simd.mul_f64s(volume, volume) }
    }

    /// The mean of two.
    #[inline(always)]
    fn mean(simd: V, a: &Self, b: &Self) -> Self {
        let x = mean(simd, &a.x, &b.x);
        let mut c = x;
        for i in 0..D {
            c[i][i] = simd.add_f64s(c[i][i], simd.splat_f64s(1.0));
        }
        Self { x, square: symmetric_determinant(simd, &c, &cofactors(simd, &c)) }
    }
}

/// The minor of row i and column j of a symmetric tensor in space, with its sign, where the lower triangle is known.
#[inline(always)]
fn minor<V: Simd, const D: usize>(simd: V, x: &Tensor<V, D>, i: usize, j: usize) -> V::f64s {
    let ([a, b], [c, d]) = ([(i + 1) % 3, (i + 2) % 3], [(j + 1) % 3, (j + 2) % 3]);
    let across = simd.mul_f64s(below::<V, D>(x, a, d), below::<V, D>(x, b, c));
    simd.sub_f64s(simd.mul_f64s(below::<V, D>(x, a, c), below::<V, D>(x, b, d)), across)
}

/// A component of a symmetric tensor of which the lower triangle is known.
#[inline(always)]
fn below<V: Simd, const D: usize>(x: &Tensor<V, D>, i: usize, j: usize) -> V::f64s {
    if i >= j { x[i][j] } else { x[j][i] }
}

/// The cofactors of a symmetric tensor: the lower triangle.
#[inline(always)]
pub(super) fn cofactors<V: Simd, const D: usize>(simd: V, x: &Tensor<V, D>) -> Tensor<V, D> {
    let mut c = *x;
    if D == 2 {
        (c[0][0], c[1][0], c[1][1]) = (x[1][1], simd.neg_f64s(x[1][0]), x[0][0]);
    } else {
        for i in 0..D {
            for j in 0..=i {
                c[i][j] = minor(simd, x, i, j);
            }
        }
    }
    c
}

/// det x of a symmetric tensor of which the lower triangle is known, with its cofactors.
#[inline(always)]
pub(super) fn symmetric_determinant<V: Simd, const D: usize>(
    simd: V,
    x: &Tensor<V, D>,
    cofactors: &Tensor<V, D>,
) -> V::f64s {
    let mut sum = simd.mul_f64s(x[0][0], cofactors[0][0]);
    for i in 1..D {
        sum = simd.mul_add_e_f64s(x[i][0], cofactors[i][0], sum);
    }
    sum
}

#[inline(always)]
fn determinant<V: Simd, const D: usize>(simd: V, f: &Tensor<V, D>) -> V::f64s {
    if D == 2 {
        return cofactor(simd, f, [0, 1], [0, 1]);
    }
    let mut sum = simd.splat_f64s(0.0);
    for j in 0..D {
        let (k, l) = ((j + 1) % D, (j + 2) % D);
        sum = simd.mul_add_e_f64s(f[0][j], cofactor(simd, f, [1, 2], [k, l]), sum);
    }
    sum
}

/// The determinant of two rows and columns.
#[inline(always)]
fn cofactor<V: Simd, const D: usize>(
    simd: V,
    f: &Tensor<V, D>,
    [a, b]: [usize; 2],
    [c, d]: [usize; 2],
) -> V::f64s {
    simd.sub_f64s(simd.mul_f64s(f[a][c], f[b][d]), simd.mul_f64s(f[a][d], f[b][c]))
}

/// F S.
#[inline(always)]
fn product<V: Simd, const D: usize>(simd: V, f: &Tensor<V, D>, s: &Tensor<V, D>) -> Tensor<V, D> {
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

/// The mean of two tensors.
#[inline(always)]
fn mean<V: Simd, const D: usize>(simd: V, a: &Tensor<V, D>, b: &Tensor<V, D>) -> Tensor<V, D> {
    let half = simd.splat_f64s(0.5);
    let mut mean = *a;
    for i in 0..D {
        for j in 0..D {
            mean[i][j] = simd.mul_f64s(simd.add_f64s(a[i][j], b[i][j]), half);
        }
    }
    mean
}

/// a − b.
#[inline(always)]
fn difference<V: Simd, const D: usize>(simd: V, a: &Tensor<V, D>, b: &Tensor<V, D>) -> Tensor<V, D> {
    let mut difference = *a;
    for i in 0..D {
        for j in 0..D {
            difference[i][j] = simd.sub_f64s(a[i][j], b[i][j]);
        }
    }
    difference
}

/// a:b of symmetric tensors, whose lower triangles are known.
#[inline(always)]
fn dot<V: Simd, const D: usize>(simd: V, a: &Tensor<V, D>, b: &Tensor<V, D>) -> V::f64s {
    let (mut sum, mut beside) = (simd.splat_f64s(0.0), simd.splat_f64s(0.0));
    for i in 0..D {
        sum = simd.mul_add_e_f64s(a[i][i], b[i][i], sum);
        for j in 0..i {
            beside = simd.mul_add_e_f64s(a[i][j], b[i][j], beside);
        }
    }
    simd.mul_add_e_f64s(simd.splat_f64s(2.0), beside, sum)
}

/// S̄ [Pa] of a step between two strains whose work is the change of `energies` [J/m³]: see
/// [`super::discrete_gradient::with_work`].
#[inline(always)]
fn stress_of_step<V: Simd, L: LaneLaw, const D: usize>(
    simd: V,
    constants: L::Constants<V>,
    ends: [&Strain<V, D>; 2],
    energies: [V::f64s; 2],
) -> Tensor<V, D> {
    let (_, mut stress) = L::energy_and_stress(simd, constants, &Strain::mean(simd, ends[0], ends[1]));
    // Of twice the strain.
    let change = difference(simd, &ends[1].x, &ends[0].x);
    let size = dot(simd, &change, &change);
    let work = simd.sub_f64s(energies[1], energies[0]);
    let half = simd.splat_f64s(0.5);
    let missing = simd.sub_f64s(work, simd.mul_f64s(half, dot(simd, &stress, &change)));
    // What is a round-off of strain needs none: there 0/0 must not be seen.
    let least = simd.splat_f64s(4.0 * CONTROL.small_strain * CONTROL.small_strain);
    let zero = simd.splat_f64s(0.0);
    let share = simd.div_f64s(simd.add_f64s(missing, missing), size);
    let share = simd.select_f64s(simd.less_than_or_equal_f64s(size, least), zero, share);
    for i in 0..D {
        for j in 0..=i {
            stress[i][j] = simd.mul_add_e_f64s(share, change[i][j], stress[i][j]);
            stress[j][i] = stress[i][j];
        }
    }
    stress
}

struct Energies<'a, L, const D: usize> {
    law: L,
    count: usize,
    f: &'a Batch<D>,
    out: &'a mut [f64],
}

impl<L: LaneLaw, const D: usize> WithSimd for Energies<'_, L, D> {
    type Output = ();

    #[inline(always)]
    fn with_simd<V: Simd>(self, simd: V) {
        let Self { law, count, f, out } = self;
        let constants = law.splat(simd);
        let out = V::as_mut_simd_f64s(&mut out[..count]).0;
        for (k, out) in out.iter_mut().enumerate() {
            let x = Strain::of::<L>(simd, &f.load::<V>(k * V::F64_LANES));
            (*out, _) = L::energy_and_stress(simd, constants, &x);
        }
    }
}

struct Stresses<'a, L, const D: usize> {
    law: L,
    count: usize,
    f: &'a Batch<D>,
    out: &'a mut Batch<D>,
}

impl<L: LaneLaw, const D: usize> WithSimd for Stresses<'_, L, D> {
    type Output = ();

    #[inline(always)]
    fn with_simd<V: Simd>(self, simd: V) {
        let Self { law, count, f, out } = self;
        let constants = law.splat(simd);
        for point in (0..count).step_by(V::F64_LANES) {
            let f = f.load::<V>(point);
            let (_, stress) = L::energy_and_stress(simd, constants, &Strain::of::<L>(simd, &f));
            out.store::<V>(point, product(simd, &f, &stress));
        }
    }
}

struct DiscreteStresses<'a, L, const D: usize> {
    law: L,
    count: usize,
    ends: [&'a Batch<D>; 2],
    out: &'a mut Batch<D>,
}

impl<L: LaneLaw, const D: usize> WithSimd for DiscreteStresses<'_, L, D> {
    type Output = ();

    #[inline(always)]
    fn with_simd<V: Simd>(self, simd: V) {
        let Self { law, count, ends, out } = self;
        let constants = law.splat(simd);
        for point in (0..count).step_by(V::F64_LANES) {
            let (f0, f1) = (ends[0].load::<V>(point), ends[1].load::<V>(point));
            let (x0, x1) = (Strain::of::<L>(simd, &f0), Strain::of::<L>(simd, &f1));
            let stress = if L::IS_QUADRATIC {
                L::energy_and_stress(simd, constants, &Strain::mean(simd, &x0, &x1)).1
            } else {
                let (w0, _) = L::energy_and_stress(simd, constants, &x0);
                let (w1, _) = L::energy_and_stress(simd, constants, &x1);
                stress_of_step::<V, L, D>(simd, constants, [&x0, &x1], [w0, w1])
            };
            out.store::<V>(point, product(simd, &mean(simd, &f0, &f1), &stress));
        }
    }
}

struct StepStresses<'a, L, const D: usize> {
    law: L,
    count: usize,
    ends: [&'a Batch<D>; 2],
    out: &'a mut [Batch<D>; 3],
}

impl<L: LaneLaw, const D: usize> WithSimd for StepStresses<'_, L, D> {
    type Output = ();

    #[inline(always)]
    fn with_simd<V: Simd>(self, simd: V) {
        let Self { law, count, ends, out: [discrete, change, end] } = self;
        let constants = law.splat(simd);
        for point in (0..count).step_by(V::F64_LANES) {
            let (f0, f1) = (ends[0].load::<V>(point), ends[1].load::<V>(point));
            let (x0, x1) = (Strain::of::<L>(simd, &f0), Strain::of::<L>(simd, &f1));
            let (w0, s0) = L::energy_and_stress(simd, constants, &x0);
            let (w1, s1) = L::energy_and_stress(simd, constants, &x1);
            let stress = if L::IS_QUADRATIC {
                mean(simd, &s0, &s1)
            } else {
                stress_of_step::<V, L, D>(simd, constants, [&x0, &x1], [w0, w1])
            };
            let middle = mean(simd, &f0, &f1);
            discrete.store::<V>(point, product(simd, &middle, &stress));
            change.store::<V>(point, product(simd, &middle, &difference(simd, &s1, &s0)));
            end.store::<V>(point, product(simd, &f1, &s1));
        }
    }
}
