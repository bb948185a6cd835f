use std::ops::{Add, Div, Mul, Neg, Sub};

/// A value and its rate of change in time: arithmetic with both is exact differentiation.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Dual {
    /// The value.
    pub value: f64,
    /// Its rate [1/s].
    pub rate: f64,
}

impl Dual {
    /// A value that does not change.
    #[must_use]
    pub fn constant(value: f64) -> Self {
        Self { value, rate: 0.0 }
    }

    /// Time itself [s].
    #[must_use]
    pub fn time(t: f64) -> Self {
        Self { value: t, rate: 1.0 }
    }

    /// A function's `value` here, with its `slope` by the chain rule.
    ///
    /// What does not move has no rate, whatever the slope: √0 of a constant 0, whose slope is infinite, stays put.
    pub(super) fn chain(self, value: f64, slope: f64) -> Self {
        Self { value, rate: if self.rate == 0.0 { 0.0 } else { slope * self.rate } }
    }

    /// `self` to the power of `exponent`.
    pub(super) fn power(self, exponent: Self) -> Self {
        let value = self.value.powf(exponent.value);
        let of_base = self.chain(value, exponent.value * self.value.powf(exponent.value - 1.0));
        let of_exponent = exponent.chain(value, value * self.value.ln());
        Self { value, rate: of_base.rate + of_exponent.rate }
    }
}

impl Neg for Dual {
    type Output = Self;

    fn neg(self) -> Self {
        Self { value: -self.value, rate: -self.rate }
    }
}

impl Add for Dual {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { value: self.value + other.value, rate: self.rate + other.rate }
    }
}

impl Sub for Dual {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Dual {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self { value: self.value * other.value, rate: self.rate * other.value + self.value * other.rate }
    }
}

impl Div for Dual {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        Self { value, rate: (self.rate - value * other.rate) / other.value }
    }
}
