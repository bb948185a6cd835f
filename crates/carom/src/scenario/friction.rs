//! Friction as data: a coefficient or a law.

use carom_friction::{RateAndState, StaticKinetic, Weakening};
use serde::{Deserialize, Serialize};

/// Friction of a pair.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum FrictionSpec {
    /// Coulomb's coefficient.
    Coefficient(f64),
    /// Its formula.
    Formula(FrictionFormulaSpec),
    /// Rate and state friction.
    RateAndState(RateAndStateSpec),
    /// Friction that depends on the direction.
    Orthotropic(OrthotropicSpec),
    /// Static and kinetic friction.
    StaticKinetic(StaticKineticSpec),
}

impl FrictionSpec {
    /// Whether the coefficient depends on the motion.
    pub(crate) fn is_law(&self) -> bool {
        match self {
            Self::Coefficient(_) => false,
            Self::Orthotropic(spec) => spec.along.is_law() || spec.across.is_law(),
            _ => true,
        }
    }
}

/// μ₁ along a direction that a surface carries, and μ₂ across it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OrthotropicSpec {
    /// μ₁: a coefficient or a law.
    pub along: Box<FrictionSpec>,
    /// μ₂, likewise.
    pub across: Box<FrictionSpec>,
    /// The direction of μ₁ in the reference configuration, of any length.
    pub direction: Vec<f64>,
    /// The name of what carries it.
    pub of: String,
}

/// μ as a formula of the slip speed v [m/s] and the distance s [m] that a contact has slid.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrictionFormulaSpec {
    /// The formula.
    pub formula: String,
}

/// μ that depends on speed and age of the contact.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RateAndStateSpec {
    /// μ₀.
    pub reference: f64,
    /// a.
    pub direct: f64,
    /// b.
    pub evolution: f64,
    /// v* [m/s].
    pub speed: f64,
    /// D_c [m].
    pub distance: f64,
    /// Age of a new contact [s]; D_c/v* if not given.
    #[serde(default)]
    pub age: Option<f64>,
}

impl RateAndStateSpec {
    /// The law.
    pub(crate) fn law(&self) -> RateAndState {
        let Self { reference, direct, evolution, speed, distance, age } = *self;
        let age = age.unwrap_or(distance / speed);
        RateAndState { reference, direct, evolution, speed, distance, age }
    }
}

/// μ between a static and a kinetic value.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StaticKineticSpec {
    /// μ_s; that of sliding if not given.
    #[serde(rename = "static", default)]
    pub static_coefficient: Option<f64>,
    /// μ_k.
    pub kinetic: f64,
    /// The speed v_s over which the difference falls by 1/e [m/s].
    #[serde(default)]
    pub speed: Option<f64>,
    /// The distance D_c over which it falls to zero [m].
    #[serde(default)]
    pub distance: Option<f64>,
    /// What μ grows by per speed of slip [s/m].
    #[serde(default)]
    pub viscous: f64,
}

impl StaticKineticSpec {
    /// A coefficient that is constant.
    pub(crate) fn constant(kinetic: f64) -> Self {
        Self { static_coefficient: None, kinetic, speed: None, distance: None, viscous: 0.0 }
    }

    /// The law. Of speed and distance there is one at most.
    pub(crate) fn law(&self) -> StaticKinetic {
        let weakening = match (self.speed, self.distance) {
            (Some(speed), _) => Weakening::OverSpeed(speed),
            (None, Some(distance)) => Weakening::OverDistance(distance),
            (None, None) => Weakening::AtOnce,
        };
        StaticKinetic {
            static_coefficient: self.static_coefficient.unwrap_or(self.kinetic),
            kinetic: self.kinetic,
            weakening,
            viscous: self.viscous,
        }
    }
}
