use serde::{Deserialize, Serialize};

use crate::FemError;

/// Isotropic elastic constants.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ElasticConstants {
    /// Young's modulus E [Pa].
    pub young: f64,
    /// Poisson's ratio ν, between −1 and ½.
    pub poisson: f64,
}

impl ElasticConstants {
    /// Lamé's constants (λ, μ) [Pa].
    ///
    /// # Errors
    /// If E is not positive or ν is not between −1 and ½ (both excluded).
    pub fn lame(&self) -> Result<(f64, f64), FemError> {
        let Self { young, poisson } = *self;
        if !(young.is_finite() && young > 0.0) {
            return Err(FemError::MaterialConstant {
                name: "young",
                value: young,
                remedy: "Young's modulus must be greater than 0 Pa",
            });
        }
        if !(poisson > -1.0 && poisson < 0.5) {
            return Err(FemError::MaterialConstant {
                name: "poisson",
                value: poisson,
                remedy: "Poisson's ratio must be between -1 and 0.5, both excluded",
            });
        }
        Ok((young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)), young / (2.0 * (1.0 + poisson))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn impossible_constants_are_refused() {
        let good = ElasticConstants { young: 1.0, poisson: 0.25 };
        let (lambda, mu) = good.lame().expect("valid");
        assert!((lambda - 0.4).abs() < 1e-15 && (mu - 0.4).abs() < 1e-15);
        for (young, poisson) in
            [(0.0, 0.3), (-1.0, 0.3), (f64::NAN, 0.3), (1.0, 0.5), (1.0, -1.0), (1.0, f64::NAN)]
        {
            assert!(ElasticConstants { young, poisson }.lame().is_err(), "{young} {poisson}");
        }
    }
}
