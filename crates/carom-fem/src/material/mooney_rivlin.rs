use serde::{Deserialize, Serialize};

use super::invariants::{InvariantEnergy, Jet, split};
use super::ranges::{check, finite, positive};
use super::volumetric::Volumetric;
use crate::FemError;

/// Mooney–Rivlin: ψ = c₁₀ (Ī₁ − 3) + c₀₁ (Ī₂ − 3) + ¼ κ (J² − 1 − 2 ln J) (Rivlin 1948); shear modulus 2(c₁₀ + c₀₁).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct MooneyRivlin {
    /// c₁₀ [Pa].
    pub c10: f64,
    /// c₀₁ [Pa].
    pub c01: f64,
    /// Bulk modulus κ [Pa].
    pub bulk: f64,
}

impl MooneyRivlin {
    /// The law with these constants, checked.
    ///
    /// # Errors
    /// If c₁₀ + c₀₁ or κ is not positive.
    pub fn checked(self) -> Result<Self, FemError> {
        finite("c10", self.c10)?;
        finite("c01", self.c01)?;
        positive("bulk", self.bulk, "the bulk modulus must be greater than 0 Pa")?;
        let remedy = "c10 + c01, half the shear modulus, must be greater than 0 Pa";
        check("c01", self.c01, self.c10 + self.c01 > 0.0, remedy)?;
        Ok(self)
    }
}

impl InvariantEnergy for MooneyRivlin {
    #[inline]
    fn jet(&self, growths: [f64; 3]) -> Jet {
        let isochoric = |x1: f64, x2: f64| (self.c10 * x1 + self.c01 * x2, [self.c10, self.c01], [0.0; 3]);
        split(growths, isochoric, &Volumetric { bulk: self.bulk })
    }
}
