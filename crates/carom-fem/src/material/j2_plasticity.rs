use serde::{Deserialize, Serialize};

use super::control::CONTROL;
use super::ranges::{check, not_negative, positive};
use super::spectrum::{ByStretches, Spectrum, StretchEnergy};
use super::strain_law::{Hyperelastic, StrainLaw, green_lagrange};
use super::{ElasticConstants, Mat3, Tangent};
use crate::FemError;

/// Elastoplasticity of metals at finite strain: isotropic hardening on von Mises' criterion, multiplicative, with Hencky's elasticity.
///
/// F = Fᵉ Fᵖ with ψ(Fᵉ) = ½ κ (tr ε)² + μ |dev ε|², ε = ln Vᵉ the logarithmic elastic strain, and τ = ∂ψ/∂ε the Kirchhoff stress.
/// √(3/2) |dev τ| ≤ σ_y(α) with σ_y(α) = σ₀ + H α + (σ_∞ − σ₀)(1 − e^(−δα)), α the equivalent plastic strain (Simo 1992; Voce
/// 1948).
///
/// Over a step the exponential map and the associated flow are the minimum of
///
/// w(C₁) = ψ(Fᵉ₁) + ∫_{α₀}^{α₁} σ_y dα
///
/// over α₁ (Ortiz & Stainier 1999), so that within a step the law is hyperelastic with the potential w, S₁ = ∂w/∂E₁: see [`J2Plasticity::after`].
/// ∫ σ_y dα ≥ 0 is the plastic work, all of which counts as dissipated.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct J2Plasticity {
    /// Elastic constants.
    #[serde(flatten)]
    pub elastic: ElasticConstants,
    /// Initial yield stress σ₀ [Pa].
    pub yield_stress: f64,
    /// Linear hardening H [Pa].
    #[serde(default)]
    pub hardening: f64,
    /// Saturation stress σ_∞ [Pa]; σ₀ if not given.
    #[serde(default)]
    pub saturation_stress: Option<f64>,
    /// Rate of saturation δ.
    #[serde(default)]
    pub saturation_rate: f64,
}

/// What a point of an elastoplastic body remembers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlasticState {
    /// C_p⁻¹ = Fᵖ⁻¹ Fᵖ⁻ᵀ.
    pub inverse_strain: Mat3,
    /// Equivalent plastic strain α.
    pub equivalent_strain: f64,
}

impl Default for PlasticState {
    fn default() -> Self {
        Self { inverse_strain: Mat3::identity(), equivalent_strain: 0.0 }
    }
}

/// An elastoplastic law that has checked its constants.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flow {
    bulk: f64,
    shear: f64,
    yield_stress: f64,
    hardening: f64,
    /// σ_∞ − σ₀.
    saturation: f64,
    rate: f64,
}

impl J2Plasticity {
    /// The law with these constants, checked.
    ///
    /// # Errors
    /// If a constant is out of range; σ_y must not fall.
    pub fn checked(&self) -> Result<Flow, FemError> {
        let (lambda, shear) = self.elastic.lame()?;
        positive("yield_stress", self.yield_stress, "the yield stress must be greater than 0 Pa")?;
        not_negative("hardening", self.hardening, "the hardening cannot be negative")?;
        not_negative("saturation_rate", self.saturation_rate, "the rate of saturation cannot be negative")?;
        let saturation_stress = self.saturation_stress.unwrap_or(self.yield_stress);
        let saturation = saturation_stress - self.yield_stress;
        let remedy = "the saturation stress cannot be below the yield stress";
        check("saturation_stress", saturation_stress, saturation.is_finite() && saturation >= 0.0, remedy)?;
        Ok(Flow {
            bulk: lambda + 2.0 / 3.0 * shear,
            shear,
            yield_stress: self.yield_stress,
            hardening: self.hardening,
            saturation,
            rate: self.saturation_rate,
        })
    }
}

/// The flow of a step: the increment Δα, and the equivalent trial stress √(3/2) |dev τ| it starts from [Pa].
#[derive(Debug, Clone, Copy)]
struct Return {
    increment: f64,
    trial: f64,
}

impl Flow {
    /// σ_y(α) [Pa].
    #[must_use]
    pub fn yield_stress(&self, strain: f64) -> f64 {
        self.yield_stress + self.hardening * strain - self.saturation * (-self.rate * strain).exp_m1()
    }

    /// ∂σ_y/∂α [Pa].
    fn hardening(&self, strain: f64) -> f64 {
        self.hardening + self.saturation * self.rate * (-self.rate * strain).exp()
    }

    /// The plastic work ∫ σ_y dα [J/m³] from `strain` on over an `increment`.
    #[must_use]
    pub fn plastic_work(&self, strain: f64, increment: f64) -> f64 {
        let linear = self.yield_stress + self.hardening * (strain + 0.5 * increment);
        // ∫ (1 − e^(−δα)) dα; δ = 0 saturates nothing.
        let saturated = if self.rate > 0.0 {
            increment + (-self.rate * strain).exp() * (-self.rate * increment).exp_m1() / self.rate
        } else {
            0.0
        };
        linear * increment + self.saturation * saturated
    }

    /// The hyperelastic law of a step that starts from `state`.
    #[must_use]
    pub fn after(&self, state: &PlasticState) -> Hyperelastic<Relative> {
        Hyperelastic(Relative {
            principal: ByStretches(Principal { flow: *self, strain: state.equivalent_strain }),
            mapping: Mapping::since(state),
        })
    }

    /// The state at the end of a step from `state` to the deformation gradient `f`, and the plastic work of the step [J/m³].
    #[must_use]
    pub fn update(&self, state: &PlasticState, f: &Mat3) -> (PlasticState, f64) {
        let mapping = Mapping::since(state);
        let spectrum = Spectrum::of(&mapping.strain(&green_lagrange(f)));
        let trial = spectrum.logarithms();
        let strain = state.equivalent_strain;
        let Return { increment, trial: stress } = self.flow(strain, &trial);
        if increment == 0.0 {
            return (*state, 0.0);
        }
        // Δεᵖ = Δα (3/2) dev τ/(√(3/2)|dev τ|), along the trial stress.
        let mean = trial.iter().sum::<f64>() / 3.0;
        let shrunk = trial.map(|e| (-6.0 * self.shear * increment / stress * (e - mean)).exp());
        let inverse = mapping.map * spectrum.compose(&shrunk) * mapping.map.transpose();
        let next = PlasticState {
            inverse_strain: (inverse + inverse.transpose()) * 0.5,
            equivalent_strain: strain + increment,
        };
        (next, self.plastic_work(strain, increment))
    }

    /// Radial return from the logarithmic trial strains: q − 3 μ Δα = σ_y(α₀ + Δα).
    ///
    /// σ_y is concave, so that Newton's iterations from Δα = 0 rise to the root and never pass it.
    #[inline]
    fn flow(&self, strain: f64, trial: &[f64; 3]) -> Return {
        let mean = trial.iter().sum::<f64>() / 3.0;
        let norm = trial.iter().map(|e| (e - mean) * (e - mean)).sum::<f64>().sqrt();
        let trial = 6.0_f64.sqrt() * self.shear * norm;
        let mut increment = 0.0;
        if trial > self.yield_stress(strain) {
            for _ in 0..50 {
                let excess = trial - 3.0 * self.shear * increment - self.yield_stress(strain + increment);
                let correction = excess / (3.0 * self.shear + self.hardening(strain + increment));
                increment += correction;
                if correction <= 1e-15 * increment {
                    break;
                }
            }
        }
        Return { increment: if increment > CONTROL.no_flow { increment } else { 0.0 }, trial }
    }
}

/// From strains to those since a plastic deformation.
#[derive(Debug, Clone, PartialEq)]
struct Mapping {
    /// Q with Q Qᵀ = C_p⁻¹ (Cholesky), so that Fᵉ = F Q up to a rotation.
    map: Mat3,
    /// ½(QᵀQ − I), the strain since then of a body that is not deformed.
    own: Mat3,
}

impl Mapping {
    /// Not a number where the state is none.
    fn since(state: &PlasticState) -> Self {
        let map = state.inverse_strain.cholesky().map_or(Mat3::from_element(f64::NAN), |c| c.l());
        Self { map, own: green_lagrange(&map) }
    }

    /// ½(QᵀCQ − I).
    #[inline]
    fn strain(&self, e: &Mat3) -> Mat3 {
        self.map.transpose() * e * self.map + self.own
    }
}

/// w as a function of the logarithmic trial strains.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Principal {
    flow: Flow,
    /// α₀.
    strain: f64,
}

impl Principal {
    /// Twice the shear modulus after the return, 2 μ (1 − 3 μ Δα/q).
    fn secant(&self, Return { increment, trial }: Return) -> f64 {
        let reduction = if increment > 0.0 { 3.0 * self.flow.shear * increment / trial } else { 0.0 };
        2.0 * self.flow.shear * (1.0 - reduction)
    }
}

impl StretchEnergy for Principal {
    fn energy(&self, e: &[f64; 3]) -> f64 {
        let returned = self.flow.flow(self.strain, e);
        let Return { increment, trial } = returned;
        let volume = e.iter().sum::<f64>();
        let stress = trial - 3.0 * self.flow.shear * increment;
        0.5 * self.flow.bulk * volume * volume
            + stress * stress / (6.0 * self.flow.shear)
            + self.flow.plastic_work(self.strain, increment)
    }

    fn stress(&self, e: &[f64; 3]) -> [f64; 3] {
        let secant = self.secant(self.flow.flow(self.strain, e));
        let volume = e.iter().sum::<f64>();
        e.map(|e| self.flow.bulk * volume + secant * (e - volume / 3.0))
    }

    /// κ 1 ⊗ 1 + 2 μ (1 − 3 μ Δα/q)(I − ⅓ 1 ⊗ 1) − 6 μ² [1/(3 μ + σ_y′) − Δα/q] n ⊗ n with n = dev ε/|dev ε|.
    fn modulus(&self, e: &[f64; 3]) -> [[f64; 3]; 3] {
        let returned = self.flow.flow(self.strain, e);
        let Return { increment, trial } = returned;
        let (shear, secant) = (self.flow.shear, self.secant(returned));
        let mean = e.iter().sum::<f64>() / 3.0;
        // |dev ε|² = q²/(6 μ²).
        let softening = if increment > 0.0 {
            let slope = 1.0 / (3.0 * shear + self.flow.hardening(self.strain + increment));
            36.0 * shear.powi(4) * (slope - increment / trial) / (trial * trial)
        } else {
            0.0
        };
        std::array::from_fn(|a| {
            std::array::from_fn(|b| {
                let own = if a == b { secant } else { 0.0 };
                self.flow.bulk + own - secant / 3.0 - softening * (e[a] - mean) * (e[b] - mean)
            })
        })
    }
}

/// An isotropic law of the strain since a plastic deformation.
#[derive(Debug, Clone, PartialEq)]
pub struct Relative {
    principal: ByStretches<Principal>,
    mapping: Mapping,
}

impl StrainLaw for Relative {
    fn energy(&self, e: &Mat3) -> f64 {
        self.principal.energy(&self.mapping.strain(e))
    }

    fn second_piola(&self, e: &Mat3) -> Mat3 {
        let map = &self.mapping.map;
        map * self.principal.second_piola(&self.mapping.strain(e)) * map.transpose()
    }

    fn elasticity(&self, e: &Mat3) -> (Mat3, Tangent<3>) {
        let (stress, mut modulus) = self.principal.elasticity(&self.mapping.strain(e));
        let map = &self.mapping.map;
        for _ in 0..4 {
            modulus = turned(map, &modulus);
        }
        (map * stress * map.transpose(), modulus)
    }
}

/// Σ_a q_ia A_ajkl with the indices passed on by one place, so that four calls map all of them.
fn turned(q: &Mat3, a: &Tangent<3>) -> Tangent<3> {
    std::array::from_fn(|j| {
        std::array::from_fn(|k| {
            std::array::from_fn(|l| std::array::from_fn(|i| (0..3).map(|m| q[(i, m)] * a[m][j][k][l]).sum()))
        })
    })
}
