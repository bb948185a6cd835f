use std::fmt::Debug;
use std::ops::{AddAssign, Mul, Neg, SubAssign};

use bytemuck::Pod;
use faer::linalg::matmul::matmul;
use faer::{Accum, MatMut, MatRef, Par};
use pulp::Simd;

/// A number that a factor can be kept in: `f64`, or `f32` where a solve only has to be good enough to iterate with.
pub(super) trait Real:
    Pod + Debug + Default + Neg<Output = Self> + Mul<Output = Self> + AddAssign + SubAssign + Send + Sync
{
    /// Numbers in 256 bits, to which panels are padded so that SIMD loops have no remainder.
    const PADDING: usize;
    /// A SIMD register of these numbers.
    type Lanes<S: Simd>: Copy;

    /// What is smaller than this in terms of a number that it goes together with is taken as zero: far below round-off. What a force
    /// does dies away exponentially with the distance, and with numbers below the normal range a processor is a hundred times slower.
    const NEGLIGIBLE: f64;

    /// The number closest to `x`.
    fn of(x: f64) -> Self;
    /// The number as an `f64`.
    fn to_f64(self) -> f64;
    /// A slice as registers, and what is left.
    fn lanes<S: Simd>(x: &[Self]) -> (&[Self::Lanes<S>], &[Self]);
    /// A slice as registers, and what is left.
    fn lanes_mut<S: Simd>(x: &mut [Self]) -> (&mut [Self::Lanes<S>], &mut [Self]);
    /// `x` in every lane.
    fn splat<S: Simd>(simd: S, x: Self) -> Self::Lanes<S>;
    /// a b + c, rounded once or twice.
    fn mul_add<S: Simd>(simd: S, a: Self::Lanes<S>, b: Self::Lanes<S>, c: Self::Lanes<S>) -> Self::Lanes<S>;
    /// The sum of all lanes.
    fn sum<S: Simd>(simd: S, a: Self::Lanes<S>) -> Self;
    /// Writes A B to `out`.
    fn multiply(out: MatMut<'_, Self>, a: MatRef<'_, Self>, b: MatRef<'_, Self>);
}

macro_rules! real {
    ($real:ident, $padding:literal, $negligible:literal, $lanes:ident, $split:ident, $split_mut:ident, $splat:ident, $mul_add:ident, $sum:ident) => {
        impl Real for $real {
            const PADDING: usize = $padding;
            const NEGLIGIBLE: f64 = $negligible;
            type Lanes<S: Simd> = S::$lanes;

            #[inline(always)]
            #[allow(clippy::cast_possible_truncation, reason = "to the closest number is what is wanted")]
            fn of(x: f64) -> Self {
                x as $real
            }

            #[inline(always)]
            fn to_f64(self) -> f64 {
                f64::from(self)
            }

            #[inline(always)]
            fn lanes<S: Simd>(x: &[Self]) -> (&[S::$lanes], &[Self]) {
                S::$split(x)
            }

            #[inline(always)]
            fn lanes_mut<S: Simd>(x: &mut [Self]) -> (&mut [S::$lanes], &mut [Self]) {
                S::$split_mut(x)
            }

            #[inline(always)]
            fn splat<S: Simd>(simd: S, x: Self) -> S::$lanes {
                simd.$splat(x)
            }

            #[inline(always)]
            fn mul_add<S: Simd>(simd: S, a: S::$lanes, b: S::$lanes, c: S::$lanes) -> S::$lanes {
                simd.$mul_add(a, b, c)
            }

            #[inline(always)]
            fn sum<S: Simd>(simd: S, a: S::$lanes) -> Self {
                simd.$sum(a)
            }

            fn multiply(out: MatMut<'_, Self>, a: MatRef<'_, Self>, b: MatRef<'_, Self>) {
                matmul(out, Accum::Replace, a, b, 1.0, Par::Seq);
            }
        }
    };
}

real!(f32, 8, 1e-14, f32s, as_simd_f32s, as_mut_simd_f32s, splat_f32s, mul_add_e_f32s, reduce_sum_f32s);
real!(f64, 4, 1e-100, f64s, as_simd_f64s, as_mut_simd_f64s, splat_f64s, mul_add_e_f64s, reduce_sum_f64s);
