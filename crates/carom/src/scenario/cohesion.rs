//! Cohesion as data.

use serde::{Deserialize, Serialize};

/// How two surfaces hold together.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum CohesionSpec {
    /// A stress [Pa].
    Stress(f64),
    /// More than that.
    Full(FullCohesionSpec),
}

/// How two surfaces hold together: by a stress, by a force, or by whatever it takes.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FullCohesionSpec {
    /// On every area [Pa].
    #[serde(default)]
    pub stress: Option<f64>,
    /// In every contact [N].
    #[serde(default)]
    pub force: Option<f64>,
    /// Whether nothing breaks it.
    #[serde(default)]
    pub unbreakable: bool,
    /// Whether contacts that close hold too.
    #[serde(default)]
    pub lasting: bool,
}

impl CohesionSpec {
    /// All of it.
    pub(crate) fn full(self) -> FullCohesionSpec {
        match self {
            Self::Stress(stress) => FullCohesionSpec { stress: Some(stress), ..FullCohesionSpec::default() },
            Self::Full(full) => full,
        }
    }
}
