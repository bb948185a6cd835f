use serde::{Deserialize, Serialize};

use super::invariants::{InvariantEnergy, Jet, split};
use super::ranges::{finite, positive};
use super::volumetric::Volumetric;
use crate::FemError;

/// Yeoh: ψ = c₁₀ x + c₂₀ x² + c₃₀ x³ + ¼ κ (J² − 1 − 2 ln J), x = Ī₁ − 3 (Yeoh 1993); shear modulus 2 c₁₀.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Yeoh {
    /// c₁₀ [Pa].
    pub c10: f64,
    /// c₂₀ [Pa].
    pub c20: f64,
    /// c₃₀ [Pa].
    pub c30: f64,
    /// Bulk modulus κ [Pa].
    pub bulk: f64,
}

impl Yeoh {
    /// The law with these constants, checked.
    ///
    /// # Errors
    /// If c₁₀ or κ is not positive.
    pub fn checked(self) -> Result<Self, FemError> {
        positive("c10", self.c10, "c10, half the shear modulus, must be greater than 0 Pa")?;
        finite("c20", self.c20)?;
        finite("c30", self.c30)?;
        positive("bulk", self.bulk, "the bulk modulus must be greater than 0 Pa")?;
        Ok(self)
    }
}

impl InvariantEnergy for Yeoh {
    #[inline]
    fn jet(&self, growths: [f64; 3]) -> Jet {
        let Self { c10, c20, c30, bulk } = *self;
        let isochoric = |x: f64, _| {
            let value = x * (c10 + x * (c20 + x * c30));
            (value, [c10 + x * (2.0 * c20 + x * 3.0 * c30), 0.0], [2.0 * c20 + 6.0 * c30 * x, 0.0, 0.0])
        };
        split(growths, isochoric, &Volumetric { bulk })
    }
}
