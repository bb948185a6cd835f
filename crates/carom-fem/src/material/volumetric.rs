/// The volumetric part of laws that split ψ = ψ_iso(J^(−2/3) C) + U(J): U = ¼ κ (J² − 1 − 2 ln J) (Simo & Taylor 1982).
///
/// It is convex in J and grows without bound for J → 0 and J → ∞.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Volumetric {
    /// Bulk modulus κ [Pa].
    pub bulk: f64,
}

impl Volumetric {
    /// U and its first two derivatives by θ = ln J [Pa]: ∂U/∂θ = J U′(J) is the mean Kirchhoff stress.
    #[inline]
    pub fn by_logarithm(&self, theta: f64) -> [f64; 3] {
        // J² − 1, exact for small θ.
        let growth = (2.0 * theta).exp_m1();
        [0.25 * self.bulk * (growth - 2.0 * theta), 0.5 * self.bulk * growth, self.bulk * (growth + 1.0)]
    }
}
