use serde::{Deserialize, Serialize};

use super::ranges::{finite, positive};
use super::spectrum::StretchEnergy;
use super::volumetric::Volumetric;
use crate::FemError;

/// Ogden: ψ = Σ_p (μ_p/α_p) (λ̄₁^α_p + λ̄₂^α_p + λ̄₃^α_p − 3) + ¼ κ (J² − 1 − 2 ln J), λ̄ = J^(−1/3) λ (Ogden 1972);
/// shear modulus ½ Σ μ_p α_p.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Ogden {
    /// μ_p [Pa].
    pub mu: Vec<f64>,
    /// α_p, any numbers but 0.
    pub alpha: Vec<f64>,
    /// Bulk modulus κ [Pa].
    pub bulk: f64,
}

impl Ogden {
    /// The law with these constants, checked.
    ///
    /// # Errors
    /// If the lists are empty or of different lengths, an exponent is 0, or Σ μ_p α_p or κ is not positive.
    pub fn checked(self) -> Result<Self, FemError> {
        let terms = self.mu.len();
        if terms == 0 || terms != self.alpha.len() {
            let remedy = "mu and alpha must have the same number of terms, one at least";
            return Err(FemError::MaterialConstant { name: "alpha", value: self.alpha.len() as f64, remedy });
        }
        for (&mu, &alpha) in self.mu.iter().zip(&self.alpha) {
            finite("mu", mu)?;
            finite("alpha", alpha)?;
            if alpha == 0.0 {
                let remedy = "an exponent cannot be 0; leave the term out";
                return Err(FemError::MaterialConstant { name: "alpha", value: alpha, remedy });
            }
        }
        positive("bulk", self.bulk, "the bulk modulus must be greater than 0 Pa")?;
        let shear = 0.5 * self.terms().map(|(mu, alpha)| mu * alpha).sum::<f64>();
        let remedy = "half the sum of mu times alpha, the shear modulus, must be greater than 0 Pa";
        positive("mu", shear, remedy)?;
        Ok(self)
    }

    fn terms(&self) -> impl Iterator<Item = (f64, f64)> {
        self.mu.iter().copied().zip(self.alpha.iter().copied())
    }

    fn volumetric(&self, e: &[f64; 3]) -> [f64; 3] {
        Volumetric { bulk: self.bulk }.by_logarithm(e.iter().sum())
    }
}

/// λ̄_A^α − 1.
#[inline]
fn growths(e: &[f64; 3], alpha: f64) -> [f64; 3] {
    let mean = e.iter().sum::<f64>() / 3.0;
    e.map(|e| (alpha * (e - mean)).exp_m1())
}

impl StretchEnergy for Ogden {
    fn energy(&self, e: &[f64; 3]) -> f64 {
        let isochoric: f64 =
            self.terms().map(|(mu, alpha)| mu / alpha * growths(e, alpha).iter().sum::<f64>()).sum();
        isochoric + self.volumetric(e)[0]
    }

    fn stress(&self, e: &[f64; 3]) -> [f64; 3] {
        let mut stress = [self.volumetric(e)[1]; 3];
        for (mu, alpha) in self.terms() {
            let growths = growths(e, alpha);
            let mean = growths.iter().sum::<f64>() / 3.0;
            stress.iter_mut().zip(growths).for_each(|(s, x)| *s += mu * (x - mean));
        }
        stress
    }

    fn modulus(&self, e: &[f64; 3]) -> [[f64; 3]; 3] {
        let mut modulus = [[self.volumetric(e)[2]; 3]; 3];
        for (mu, alpha) in self.terms() {
            let powers = growths(e, alpha).map(|x| x + 1.0);
            let mean = powers.iter().sum::<f64>() / 3.0;
            for a in 0..3 {
                modulus[a][a] += mu * alpha * powers[a];
                for b in 0..3 {
                    modulus[a][b] += mu * alpha * (mean - powers[a] - powers[b]) / 3.0;
                }
            }
        }
        modulus
    }
}
