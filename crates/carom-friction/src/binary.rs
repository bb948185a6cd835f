//! Numbers by powers of two, which round nothing.

/// The exponent e of a finite x ≠ 0 with 2^e ≤ |x| < 2^(e+1).
pub(crate) fn exponent(x: f64) -> i32 {
    let biased = |x: f64| ((x.to_bits() >> 52) & 0x7ff) as i32 - 1023;
    if x.is_normal() { biased(x) } else { biased(x * power_of_two(100)) - 100 }
}

/// 2^k, for k from −1022 to 1023.
pub(crate) fn power_of_two(k: i32) -> f64 {
    debug_assert!((-1022..=1023).contains(&k));
    f64::from_bits(((k + 1023) as u64) << 52)
}

/// x 2^k for any k.
pub(crate) fn times_power(mut x: f64, mut k: i32) -> f64 {
    while k.abs() > 1000 {
        x *= power_of_two(1000 * k.signum());
        k -= 1000 * k.signum();
    }
    x * power_of_two(k)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponents_are_those_of_the_binary_point() {
        for (x, e) in [(1.0, 0), (1.99, 0), (2.0, 1), (0.5, -1), (-3.0, 1), (f64::MAX, 1023)] {
            assert_eq!(exponent(x), e);
        }
        assert_eq!(exponent(f64::MIN_POSITIVE / 4.0), -1024);
        assert_eq!(exponent(5e-324), -1074);
        assert_eq!(times_power(5e-324, 1074), 1.0);
        assert_eq!(times_power(1.5, -2000), 0.0);
        assert_eq!(times_power(-3.0, 2), -12.0);
        assert_eq!(times_power(times_power(3.0, -1021), 2000), 3.0 * power_of_two(979));
    }
}
