use std::time::Duration;

use carom_contact::{Boundaries, Pair};
use carom_mesh::Vector;

use super::impulse::Impulses;
use super::iterating::Iterating;
use super::report::PairReport;
use super::resting::Resting;
use super::side_by_side::SideBySide;
use super::since_look::SinceLook;
use super::springs::SpringBooks;
use super::whereabouts::Whereabouts;
use crate::body::{Body, Forecast};
use crate::contact::PosedProblem;
use crate::ledger::{BodyLedger, ByPair};
use crate::model::Model;
use crate::model::assembly::Assembly;
use crate::model::method::Method;

/// Scratch of a step: the bodies with their factors, contacts, iterations. It holds no result and may be dropped at any moment; a run that is
/// to go on to the last bit keeps what its [`crate::Checkpoint`] has of it.
pub struct Workspace<const D: usize> {
    pub(crate) iterating: Iterating<D>,
    pub(crate) side_by_side: SideBySide<D>,
    pub(crate) impulses: Impulses<D>,
    pub(crate) springs: SpringBooks<D>,
    pub(crate) boundaries: Boundaries<D>,
    pub(crate) whereabouts: Whereabouts<D>,
    pub(crate) resting: Resting<D>,
    /// Since every body was looked at for going through itself.
    pub(crate) since_look: Vec<SinceLook>,
    /// Which bodies were found inside themselves in the last step.
    pub(crate) in_itself: Vec<bool>,
    /// What every body expected of the step.
    pub(crate) forecasts: Vec<Forecast>,
    /// What pairs did in the last step, those of which anything is known.
    pub pair_reports: ByPair<PairReport>,
    /// What contacts of pairs with mass took in the last step, if it was blended [J].
    pub(crate) booked: Vec<(Pair, f64)>,
    /// What happened to the energy of each body in the last step.
    pub body_ledgers: Vec<BodyLedger>,
    /// Time spent so far in search of contacts and in measures of what is inside what.
    pub detection_time: Duration,
}

impl<const D: usize> Workspace<D> {
    /// Scratch for steps of `model`.
    #[must_use]
    pub fn new(model: &Model<D>) -> Self {
        Self::with_bodies(&model.assembly, model.stepping_bodies())
    }

    /// Scratch for steps of these `bodies`, those of the `assembly`.
    #[must_use]
    pub fn with_bodies(assembly: &Assembly<D>, bodies: Vec<Box<dyn Body<D>>>) -> Self {
        Self {
            impulses: Impulses::new(assembly.reference.len(), bodies.len()),
            springs: SpringBooks::new(assembly),
            boundaries: assembly.boundaries.clone(),
            whereabouts: Whereabouts::new(bodies.len()),
            resting: Resting::never(assembly),
            since_look: vec![SinceLook::default(); bodies.len()],
            in_itself: vec![false; bodies.len()],
            forecasts: vec![Forecast::default(); bodies.len()],
            pair_reports: ByPair::default(),
            booked: Vec::new(),
            body_ledgers: vec![BodyLedger::default(); bodies.len()],
            detection_time: Duration::ZERO,
            side_by_side: SideBySide::default(),
            iterating: Iterating::new(assembly, bodies),
        }
    }

    /// The same for a run that takes so long [s], in which bodies may come to rest.
    pub(crate) fn resting(mut self, assembly: &Assembly<D>, method: &Method<D>, duration: f64) -> Self {
        self.resting.allow(assembly, method, duration);
        self
    }

    /// The same with what `before` has counted.
    pub(crate) fn counting_on(mut self, before: &Self) -> Self {
        self.iterating.factorisations = before.iterating.factorisations;
        self.detection_time = before.detection_time;
        self.iterating.contacts.reduced.friction_time = before.friction_time();
        self
    }

    /// The blend α of start and end stresses of every body in the last step.
    #[must_use]
    pub fn blend_weights(&self) -> &[f64] {
        &self.iterating.blend.weight
    }

    /// What every body took on of its vibration at the end of the last step, as a share of it: what the blend left over.
    #[must_use]
    pub fn vibration_shares(&self) -> &[f64] {
        &self.iterating.blend.share
    }

    /// The forces [N] of the impulses that were given at the end of the last step, one of each kind for each of its so many `reactions`: those
    /// that restore what landing took, and those that settle contacts at rest. They are part of the reactions.
    #[must_use]
    pub fn impulse_forces(&self, reactions: usize) -> [Vec<Vector<D>>; 2] {
        self.impulses.forces(reactions, &self.iterating.contacts.at_end)
    }

    /// Memory of the factors of all bodies [bytes].
    #[must_use]
    pub fn factor_bytes(&self) -> usize {
        self.iterating.bodies.iter().map(|body| body.factor_bytes()).sum()
    }

    /// Factorisations made so far.
    #[must_use]
    pub fn factorisations(&self) -> u64 {
        self.iterating.factorisations
    }

    /// Time spent in the friction solver so far, by all threads together.
    #[must_use]
    pub fn friction_time(&self) -> Duration {
        self.iterating.contacts.reduced.friction_time
    }

    /// The last contact problem that a step posed, solved or not; after [`crate::StepError::Friction`] the one that failed.
    #[must_use]
    pub fn posed_problem(&self) -> Option<PosedProblem<'_, D>> {
        self.iterating.posed_problem()
    }
}
