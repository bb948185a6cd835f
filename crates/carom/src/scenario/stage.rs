//! Stages: analyses in sequence, each with what it has of its own.

use serde::{Deserialize, Serialize};

use super::{Analysis, ContactSpec, LoadEntry, MotionEntry, Scenario, Spin};

/// A stage of a case, complete: what it does not change is written out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StageEntry {
    /// Name.
    pub name: String,
    /// What is computed.
    pub analysis: Analysis,
    /// Interval of the history [s].
    pub history_every: f64,
    /// Forces on bodies.
    #[serde(default)]
    pub loads: Vec<LoadEntry>,
    /// Prescribed motion of parts of bodies.
    #[serde(default)]
    pub motions: Vec<MotionEntry>,
    /// Contact.
    pub contact: ContactSpec,
    /// Velocities that bodies are given when it starts; the others go on with theirs.
    #[serde(default)]
    pub velocities: Vec<VelocityEntry>,
}

/// The velocity that a body is given.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VelocityEntry {
    /// Body.
    pub body: String,
    /// Velocity [m/s]; none if not given.
    #[serde(default)]
    pub velocity: Option<Vec<f64>>,
    /// Spin about the centre of mass [rad/s].
    #[serde(default)]
    pub spin: Spin,
}

impl Scenario {
    /// The case as it is in stage number `index`, as a case of one analysis. The velocities of its bodies are those that they are given there.
    pub(crate) fn in_stage(&self, index: usize) -> Self {
        let stage = &self.stages[index];
        let mut case = Self {
            analysis: stage.analysis.clone(),
            loads: stage.loads.clone(),
            motions: stage.motions.clone(),
            contact: stage.contact.clone(),
            stages: Vec::new(),
            ..self.clone()
        };
        case.output.history_every = stage.history_every;
        let goes_on = !stage.analysis.starts_from_nothing();
        for body in case.bodies.iter_mut().filter(|_| goes_on) {
            let given = stage.velocities.iter().find(|given| given.body == body.name);
            body.velocity = given.and_then(|given| given.velocity.clone());
            body.spin = given.map_or(Spin::None, |given| given.spin);
        }
        case
    }
}
