use serde::{Deserialize, Serialize};

use super::ranges::not_negative;
use super::{Mat3, Tangent};
use crate::FemError;

/// The viscous part of a Kelvin–Voigt material: the second Piola–Kirchhoff stress S_v = 2 η dev Ė + ζ tr(Ė) I beside that of the law.
///
/// Over a step Ė = (E₁ − E₀)/Δt, exactly the rate of the Green–Lagrange strain that the mean ½(F₀ + F₁) of the deformation gradient works with.
/// The dissipation S_v:ΔE is the work of the forces, it is not negative, and no rotation is resisted. With a law of small displacements E is
/// the small strain.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Viscosity {
    /// Shear viscosity η [Pa s].
    #[serde(default)]
    pub shear: f64,
    /// Bulk viscosity ζ [Pa s].
    #[serde(default)]
    pub bulk: f64,
}

impl Viscosity {
    /// Whether there is any viscosity.
    #[must_use]
    pub fn is_active(&self) -> bool {
        self.shear != 0.0 || self.bulk != 0.0
    }

    /// Checks that neither constant is negative.
    ///
    /// # Errors
    /// If one is.
    pub fn check(&self) -> Result<(), FemError> {
        let remedy = "a viscosity cannot be negative";
        not_negative("viscosity.shear", self.shear, remedy)?;
        not_negative("viscosity.bulk", self.bulk, remedy)
    }

    /// The first Piola–Kirchhoff stress [Pa] of a step from F₀ to F₁ in Δt = `dt` [s], at the mean of both.
    #[inline]
    #[must_use]
    pub fn stress(&self, f0: &Mat3, f1: &Mat3, dt: f64) -> Mat3 {
        let mean = (f0 + f1) * 0.5;
        // F̄ᵀ(F₁ − F₀) has the symmetric part E₁ − E₀.
        mean * self.of_rate(&(mean.transpose() * (f1 - f0) / dt))
    }

    /// The stress [Pa] of small strains.
    #[inline]
    #[must_use]
    pub fn small_stress(&self, f0: &Mat3, f1: &Mat3, dt: f64) -> Mat3 {
        self.of_rate(&((f1 - f0) / dt))
    }

    /// S_v of the symmetric part of a rate [1/s].
    #[inline]
    fn of_rate(&self, rate: &Mat3) -> Mat3 {
        let volume = rate.trace() * (self.bulk - 2.0 / 3.0 * self.shear);
        (rate + rate.transpose()) * self.shear + Mat3::from_diagonal_element(volume)
    }

    /// ∂P/∂Ḟ [Pa s] at F: η (F_iM F_kM δ_JL + F_iL F_kJ) + (ζ − ⅔ η) F_iJ F_kL.
    #[must_use]
    pub fn tangent(&self, f: &Mat3) -> Tangent<3> {
        let b = f * f.transpose();
        let volume = self.bulk - 2.0 / 3.0 * self.shear;
        let mut a: Tangent<3> = [[[[0.0; 3]; 3]; 3]; 3];
        for i in 0..3 {
            for j in 0..3 {
                for k in 0..3 {
                    for l in 0..3 {
                        let twin = f[(i, l)] * f[(k, j)] + if j == l { b[(i, k)] } else { 0.0 };
                        a[i][j][k][l] = self.shear * twin + volume * f[(i, j)] * f[(k, l)];
                    }
                }
            }
        }
        a
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const OIL: Viscosity = Viscosity { shear: 0.7, bulk: 0.4 };

    fn gradients() -> impl Iterator<Item = (Mat3, Mat3)> {
        let f = |seed: f64| Mat3::identity() + Mat3::from_fn(|i, j| 0.3 * ((3 * i + j) as f64 + seed).sin());
        (0..8).map(move |seed| (f(f64::from(seed)), f(0.3 + 1.7 * f64::from(seed))))
    }

    #[test]
    fn dissipation_is_that_of_the_strain_rates_and_has_no_moment() {
        let dt = 0.01;
        for (f0, f1) in gradients() {
            let stress = OIL.stress(&f0, &f1, dt);
            let rate = (f1.transpose() * f1 - f0.transpose() * f0) / (2.0 * dt);
            let deviator = rate - Mat3::from_diagonal_element(rate.trace() / 3.0);
            let exact = dt * (2.0 * OIL.shear * deviator.norm_squared() + OIL.bulk * rate.trace().powi(2));
            assert!((stress.dot(&(f1 - f0)) / exact - 1.0).abs() < 1e-12);
            let moment = stress * (f0 + f1).transpose();
            assert!((moment - moment.transpose()).norm() < 1e-12 * moment.norm());
        }
    }

    #[test]
    fn a_rotation_is_not_resisted() {
        let turn = nalgebra::Rotation3::from_scaled_axis([0.4, 0.9, -0.5].into()).into_inner();
        for (f0, _) in gradients() {
            assert!(OIL.stress(&f0, &(turn * f0), 0.01).norm() < 1e-12);
        }
    }

    #[test]
    fn the_tangent_is_the_derivative_by_the_rate() {
        let (dt, h) = (0.01, 1e-7);
        for (f, _) in gradients() {
            let tangent = OIL.tangent(&f);
            for k in 0..3 {
                for l in 0..3 {
                    let (mut plus, mut minus) = (f, f);
                    plus[(k, l)] += h;
                    minus[(k, l)] -= h;
                    let slope = OIL.stress(&minus, &plus, dt) * (dt / (2.0 * h));
                    for i in 0..3 {
                        for j in 0..3 {
                            assert!((tangent[i][j][k][l] - slope[(i, j)]).abs() < 1e-6);
                        }
                    }
                }
            }
        }
    }
}
