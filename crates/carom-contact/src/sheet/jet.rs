//! Functions of two variables with their first and second derivatives, exactly: what is built of them by the four operations is
//! differentiated along with its value.

use std::ops::{Add, Mul, Sub};

/// A value with its derivatives.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Jet {
    pub value: f64,
    /// ∂/∂ξ, ∂/∂η.
    pub slope: [f64; 2],
    /// ∂²/∂ξ², ∂²/∂ξ∂η, ∂²/∂η².
    pub bend: [f64; 3],
}

impl Jet {
    /// A constant.
    pub fn constant(value: f64) -> Self {
        Self { value, ..Self::default() }
    }

    /// An affine function.
    pub fn affine(value: f64, slope: [f64; 2]) -> Self {
        Self { value, slope, bend: [0.0; 3] }
    }

    /// own/(own + other); ½ where both are zero.
    pub fn share(self, other: Self) -> Self {
        let whole = self + other;
        if whole.value <= 0.0 { Self::constant(0.5) } else { self * whole.reciprocal() }
    }

    fn reciprocal(self) -> Self {
        let r = 1.0 / self.value;
        let [a, b] = self.slope;
        let products = [a * a, a * b, b * b];
        Self {
            value: r,
            slope: self.slope.map(|s| -s * r * r),
            bend: std::array::from_fn(|i| (2.0 * products[i] * r - self.bend[i]) * r * r),
        }
    }

    /// The same times a number.
    pub fn times(self, factor: f64) -> Self {
        let scale = |x: f64| factor * x;
        Self { value: factor * self.value, slope: self.slope.map(scale), bend: self.bend.map(scale) }
    }
}

impl Add for Jet {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            slope: [self.slope[0] + other.slope[0], self.slope[1] + other.slope[1]],
            bend: std::array::from_fn(|i| self.bend[i] + other.bend[i]),
        }
    }
}

impl Sub for Jet {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + other.times(-1.0)
    }
}

impl Mul for Jet {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let (a, b) = (&self, &other);
        Self {
            value: a.value * b.value,
            slope: std::array::from_fn(|i| a.slope[i] * b.value + a.value * b.slope[i]),
            bend: [
                a.bend[0] * b.value + 2.0 * a.slope[0] * b.slope[0] + a.value * b.bend[0],
                a.bend[1] * b.value + a.slope[0] * b.slope[1] + a.slope[1] * b.slope[0] + a.value * b.bend[1],
                a.bend[2] * b.value + 2.0 * a.slope[1] * b.slope[1] + a.value * b.bend[2],
            ],
        }
    }
}
