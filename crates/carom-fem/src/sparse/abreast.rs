//! Substitution for many right-hand sides side by side: what is loaded of a factor serves all of them.

use pulp::{Arch, Simd, WithSimd};

use super::real::Real;
use super::substitution::{Panel, Substitution};

/// Right-hand sides taken together: a whole register of single precision.
pub(super) const ABREAST: usize = 16;
/// Rows or columns of a panel whose sums are kept in registers; divides what panels are padded to.
const STRIP: usize = 4;

/// One number of every right-hand side.
pub(super) type Row<T> = [T; ABREAST];

/// Adds `other` to `row`.
#[inline(always)]
pub(super) fn add<T: Real>(row: &mut Row<T>, other: &Row<T>) {
    row.iter_mut().zip(other).for_each(|(row, other)| *row += *other);
}

impl<T: Real> Substitution<T> {
    /// [`Self::forward`] where the right-hand sides are zero outside of a [`Self::reach`], and stay so.
    pub fn forward_abreast(&mut self, reach: &[u32], x: &mut [Row<T>]) {
        self.make_room_abreast();
        Arch::new().dispatch(Forward { substitution: self, reach, x });
    }

    /// [`Self::backward`], only for the columns of a [`Self::reach`].
    pub fn backward_abreast(&mut self, reach: &[u32], x: &mut [Row<T>]) {
        self.make_room_abreast();
        Arch::new().dispatch(Backward { substitution: self, reach, x });
    }

    fn make_room_abreast(&mut self) {
        self.gathered_abreast.resize(self.gathered.len(), [T::default(); ABREAST]);
    }
}

struct Forward<'a, T> {
    substitution: &'a mut Substitution<T>,
    reach: &'a [u32],
    x: &'a mut [Row<T>],
}

impl<T: Real> WithSimd for Forward<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { substitution: Substitution { panels, rows, values, gathered_abreast, .. }, reach, x } =
            self;
        for &p in reach {
            let p = &panels[p as usize];
            let t = &mut gathered_abreast[..p.padded];
            product(simd, p, values, &x[p.start..p.start + p.columns], t);
            x[p.start..p.start + p.columns].copy_from_slice(&t[..p.columns]);
            for (&row, t) in rows[p.first_row..p.first_row + p.below].iter().zip(&t[p.columns..]) {
                x[row as usize].iter_mut().zip(t).for_each(|(x, t)| *x -= *t);
            }
        }
    }
}

struct Backward<'a, T> {
    substitution: &'a mut Substitution<T>,
    reach: &'a [u32],
    x: &'a mut [Row<T>],
}

impl<T: Real> WithSimd for Backward<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { substitution: Substitution { panels, rows, values, gathered_abreast, .. }, reach, x } =
            self;
        for &p in reach.iter().rev() {
            let p = &panels[p as usize];
            let t = &mut gathered_abreast[..p.padded];
            t[..p.columns].copy_from_slice(&x[p.start..p.start + p.columns]);
            for (&row, t) in rows[p.first_row..p.first_row + p.below].iter().zip(&mut t[p.columns..]) {
                *t = x[row as usize].map(|x| -x);
            }
            t[p.columns + p.below..].fill([T::default(); ABREAST]);
            transposed_product(simd, p, values, t, &mut x[p.start..p.start + p.columns]);
        }
    }
}

/// `t` = Z `x` for the panel Z.
#[inline(always)]
fn product<T: Real, S: Simd>(simd: S, panel: &Panel, values: &[T], x: &[Row<T>], t: &mut [Row<T>]) {
    let z = &values[panel.first_value..panel.first_value + panel.padded * panel.columns];
    for (strip, t) in t.chunks_exact_mut(STRIP).enumerate() {
        for lane in 0..T::lanes::<S>(&t[0]).0.len() {
            let mut sums = [T::splat(simd, T::default()); STRIP];
            for (z, x) in z.chunks_exact(panel.padded).zip(x) {
                let (z, x) = (&z[strip * STRIP..][..STRIP], T::lanes::<S>(x).0[lane]);
                for (sum, &z) in sums.iter_mut().zip(z) {
                    *sum = T::mul_add(simd, T::splat(simd, z), x, *sum);
                }
            }
            for (t, sum) in t.iter_mut().zip(sums) {
                T::lanes_mut::<S>(t).0[lane] = sum;
            }
        }
    }
}

/// `x` = Zᵀ `t` for the panel Z.
#[inline(always)]
fn transposed_product<T: Real, S: Simd>(
    simd: S,
    panel: &Panel,
    values: &[T],
    t: &[Row<T>],
    x: &mut [Row<T>],
) {
    let z = &values[panel.first_value..panel.first_value + panel.padded * panel.columns];
    let mut strips = z.chunks_exact(STRIP * panel.padded);
    let mut results = x.chunks_exact_mut(STRIP);
    for (z, x) in strips.by_ref().zip(results.by_ref()) {
        transposed_strip::<T, S, STRIP>(simd, z, t, x);
    }
    for (z, x) in strips.remainder().chunks_exact(panel.padded).zip(results.into_remainder()) {
        transposed_strip::<T, S, 1>(simd, z, t, std::slice::from_mut(x));
    }
}

/// [`transposed_product`] for `N` columns.
#[inline(always)]
fn transposed_strip<T: Real, S: Simd, const N: usize>(simd: S, z: &[T], t: &[Row<T>], x: &mut [Row<T>]) {
    let columns: [&[T]; N] = std::array::from_fn(|k| &z[k * t.len()..(k + 1) * t.len()]);
    for lane in 0..T::lanes::<S>(&x[0]).0.len() {
        let mut sums = [T::splat(simd, T::default()); N];
        for (i, t) in t.iter().enumerate() {
            let t = T::lanes::<S>(t).0[lane];
            for (sum, z) in sums.iter_mut().zip(columns) {
                *sum = T::mul_add(simd, T::splat(simd, z[i]), t, *sum);
            }
        }
        for (x, sum) in x.iter_mut().zip(sums) {
            T::lanes_mut::<S>(x).0[lane] = sum;
        }
    }
}
