use serde::{Deserialize, Serialize};

use super::invariants::{InvariantEnergy, Jet};
use super::ranges::positive;
use crate::FemError;

/// Blatz–Ko, for foams and rubbers (Blatz & Ko 1962), with β = ν/(1 − 2ν):
///
/// ψ = ½ f μ [I₁ − 3 + (J^(−2β) − 1)/β] + ½ (1 − f) μ [I₂/J² − 3 + (J^(2β) − 1)/β].
///
/// f = 0 and ν = ¼ give the foam rubber of the original paper, ψ = ½ μ (I₂/J² + 2 J − 5).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct BlatzKo {
    /// Shear modulus μ [Pa].
    pub shear: f64,
    /// Poisson's ratio ν of small strains, between 0 and ½.
    pub poisson: f64,
    /// f, the share of the part that is linear in I₁, from 0 to 1.
    pub fraction: f64,
}

impl BlatzKo {
    /// The law with these constants, checked.
    ///
    /// # Errors
    /// If μ is not positive, ν is not between 0 and ½ (both excluded) or f is not in [0, 1].
    pub fn checked(self) -> Result<Self, FemError> {
        positive("shear", self.shear, "the shear modulus must be greater than 0 Pa")?;
        let refused = |name, value, remedy| Err(FemError::MaterialConstant { name, value, remedy });
        if !(self.poisson > 0.0 && self.poisson < 0.5) {
            let remedy = "Poisson's ratio of this law must be between 0 and 0.5, both excluded";
            return refused("poisson", self.poisson, remedy);
        }
        if !(0.0..=1.0).contains(&self.fraction) {
            return refused("fraction", self.fraction, "the fraction must be from 0 to 1");
        }
        Ok(self)
    }
}

impl InvariantEnergy for BlatzKo {
    #[inline]
    fn jet(&self, [x1, x2, x3]: [f64; 3]) -> Jet {
        let beta = self.poisson / (1.0 - 2.0 * self.poisson);
        let (solid, foam) = (0.5 * self.fraction * self.shear, 0.5 * (1.0 - self.fraction) * self.shear);
        let growth = beta * x3.ln_1p();
        let (squares, power, i2) = (1.0 + x3, growth.exp(), 3.0 + x2);
        let j = squares.sqrt();
        let value = solid * (x1 + (-growth).exp_m1() / beta)
            + foam * ((x2 - 3.0 * x3) / squares + growth.exp_m1() / beta);
        let by_volume = 2.0 * (foam * (power - i2 / squares) - solid / power) / j;
        let mut second = [[0.0; 3]; 3];
        second[1][2] = -2.0 * foam / (squares * j);
        second[2][1] = second[1][2];
        second[2][2] = 2.0
            * (solid * (2.0 * beta + 1.0) / power + foam * (3.0 * i2 / squares + (2.0 * beta - 1.0) * power))
            / squares;
        Jet { value, first: [solid, foam / squares, by_volume], second }
    }
}
