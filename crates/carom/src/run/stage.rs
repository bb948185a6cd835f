//! The stages of a run: one as a rule, or analyses in sequence of the same bodies.

use carom_mesh::Vector;

use crate::build::{Built, Inputs, RigidMotion, built, start};
use crate::error::InputError;
use crate::run::events::Merge;
use crate::run::time_grid::TimeGrid;
use crate::scenario::{BodyKind, Scenario, StageEntry};
use crate::step::workspace::Workspace;
use crate::{Method, Model, Scheme, State};

/// The most steps a stage may have; more is a slip of units.
const MAX_STEPS: f64 = 1e10;

/// An analysis of a run: what is driven how, the method, and the steps.
pub(crate) struct Stage<const D: usize> {
    /// Empty in a case without stages.
    pub name: String,
    pub model: Model<D>,
    pub method: Method<D>,
    pub grid: TimeGrid,
    pub history_every: f64,
    /// How close contacts are that count as one.
    pub merge: Merge,
    /// How every body moves that is given a velocity when the stage starts.
    motions: Vec<RigidMotion<D>>,
    /// Those that are.
    given: Vec<usize>,
}

impl<const D: usize> Stage<D> {
    /// The stages of a scenario, built from all that it takes from files.
    ///
    /// # Errors
    /// If one of them cannot be run; the key names the stage.
    pub fn all(scenario: &Scenario, inputs: Inputs<D>) -> Result<Vec<Self>, InputError> {
        if scenario.stages.is_empty() {
            return Ok(vec![Self::new(scenario, None, inputs)?]);
        }
        if let Some(body) = scenario.bodies.iter().find(|body| body.kind == BodyKind::Foreign) {
            let message =
                format!("body {:?} is of another code, which knows of no stages; leave them out", body.name);
            return Err(InputError::new("stages", message));
        }
        let stages = scenario.stages.iter().enumerate().map(|(i, entry)| {
            let made = Self::new(&scenario.in_stage(i), Some(entry), inputs.clone());
            made.map_err(|error| of_stage(i, error))
        });
        stages.collect()
    }

    fn new(scenario: &Scenario, entry: Option<&StageEntry>, inputs: Inputs<D>) -> Result<Self, InputError> {
        let Built { model, method, motions } = built(scenario, inputs)?;
        let analysis = &scenario.analysis;
        for (key, every) in [
            ("output.history_every", scenario.output.history_every),
            ("output.fields_every", scenario.output.fields_every),
        ] {
            if !(every.is_finite() && every > 0.0) {
                return Err(InputError::new(key, format!("{every}: the interval must be greater than 0 s")));
            }
        }
        let (dt, [start, end]) = (analysis.time_step, analysis.span());
        let steps = (end - start) / dt;
        if steps > MAX_STEPS {
            let message = format!("{dt:?}: the run would have {steps:.1e} steps, more than {MAX_STEPS:.0e}");
            return Err(InputError::new("analysis.time_step", message));
        }
        let mut given = Vec::new();
        for (k, entry) in entry.iter().flat_map(|entry| &entry.velocities).enumerate() {
            let found = model.bodies.iter().enumerate().find(|(_, b)| b.name == entry.body);
            let (i, _) = found.ok_or_else(|| {
                let known: Vec<&str> = model.bodies.iter().map(|b| b.name.as_str()).collect();
                let message = format!("there is no body {:?}; known are {known:?}", entry.body);
                InputError::new(format!("velocities.{k}.body"), message)
            })?;
            given.push(i);
        }
        Ok(Self {
            name: entry.map_or_else(String::new, |entry| entry.name.clone()),
            grid: TimeGrid::new(dt, [start, end]),
            history_every: scenario.output.history_every,
            merge: Merge::new(&model, method.scheme, dt, scenario.output.merge_contacts),
            motions,
            given,
            model,
            method,
        })
    }

    /// Scratch of its steps.
    pub fn workspace(&self) -> Workspace<D> {
        let Self { model, method, grid, .. } = self;
        Workspace::new(model).resting(&model.assembly, method, grid.end_time - grid.start_time)
    }

    /// The state that a run starts from in which bodies are as they are drawn.
    ///
    /// # Errors
    /// If its energy is not finite.
    pub fn start(&self) -> Result<State<D>, InputError> {
        start(&self.model, &self.method, &self.motions, self.grid.start_time)
    }

    /// Lets all bodies that are where `state` has them move as they are made to at the start of a run.
    pub fn set_in_motion(&self, state: &mut State<D>) {
        if self.method.scheme != Scheme::Static {
            self.give(0..self.motions.len(), state);
        }
    }

    /// Begins with the `state` that another stage ended in, and returns the energy [J] that every body gets by the velocity that it is given.
    pub fn begin(&self, state: &mut State<D>) -> Vec<f64> {
        self.model.take_over(state);
        if !self.method.is_blended() {
            state.energy_debt.fill(0.0);
        }
        self.give(self.given.iter().copied(), state)
    }

    /// Gives bodies their velocities; returns the energy [J] that every body gets.
    fn give(&self, given: impl Iterator<Item = usize>, state: &mut State<D>) -> Vec<f64> {
        let Model { assembly, bodies, .. } = &self.model;
        let mut gained = vec![0.0; bodies.len()];
        let mut given = given.peekable();
        if given.peek().is_none() {
            return gained;
        }
        let stepping = self.model.stepping_bodies();
        for i in given {
            let at = |n: usize| assembly.reference[n] + state.displacement[n];
            let positions: Vec<Vector<D>> = bodies[i].nodes().map(at).collect();
            let velocity = self.motions[i].velocities(&bodies[i], &positions);
            gained[i] = state.give_velocity(assembly, &stepping, i, &velocity);
        }
        gained
    }
}

/// An error in stage number `index`: what a stage has of its own is found there.
fn of_stage(index: usize, error: InputError) -> InputError {
    let own = ["analysis", "loads", "motions", "contact", "velocities"];
    let first = error.key.split('.').next().unwrap_or_default();
    let key = if own.contains(&first) { format!("stages.{index}.{}", error.key) } else { error.key };
    InputError { key, ..error }
}
