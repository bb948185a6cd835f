//! How Newton's iterations go on and end.

pub(super) mod acceleration;
pub(crate) mod control;
pub(super) mod convergence;
pub(super) mod holding;
pub(super) mod left_alone;
pub(super) mod load_step;

use carom_mesh::{Vector, nodal};

use self::acceleration::Acceleration;
use self::convergence::BodyProgress;
use self::holding::Holding;
use self::left_alone::leave_out;
use super::free_motion::FreeMotion;
use super::giving_way::GivingWay;
use crate::contact::active::ActiveSet;
use crate::error::StepError;
use crate::model::assembly::Assembly;

/// The iterations of a step.
#[derive(Debug)]
pub(crate) struct Newton<const D: usize> {
    /// Residuals [N] of all nodes and obstacles.
    pub residual: Vec<Vector<D>>,
    /// The last correction of d [m].
    pub correction: Vec<Vector<D>>,
    pub progress: Vec<BodyProgress>,
    pub acceleration: Acceleration<D>,
    /// How much corrections of every body are held back in load steps.
    pub holding: Vec<Holding>,
    /// The last guess of a load step that led on: d [m] and the reactions known there.
    guess: Vec<Vector<D>>,
    guess_reactions: Vec<Vector<D>>,
    /// Orthonormal motions of all nodes that corrections of this load step leave out, as nothing resists them,
    pub left_alone: Vec<Vec<Vector<D>>>,
    /// and what drives them at its end.
    pub free_motion: Option<FreeMotion>,
    /// Why a load step failed in truth where it said that a body is not held: it falls on what will hold it.
    pub caught: Option<StepError>,
    /// The motion by which a load step found that a body gives way.
    pub giving_way: Option<GivingWay<D>>,
    /// Bodies whose K̄ is to be renewed.
    pub slow: Vec<usize>,
}

impl<const D: usize> Newton<D> {
    /// Of an assembly.
    pub fn new(assembly: &Assembly<D>) -> Self {
        let count = assembly.reference.len();
        Self {
            acceleration: Acceleration::new(count, assembly.body_count()),
            residual: nodal::zeros(count),
            correction: nodal::zeros(count),
            progress: vec![BodyProgress::new(0.0); assembly.body_count()],
            holding: vec![Holding::default(); assembly.body_count()],
            guess: Vec::new(),
            guess_reactions: Vec::new(),
            left_alone: Vec::new(),
            free_motion: None,
            caught: None,
            giving_way: None,
            slow: Vec::with_capacity(assembly.body_count()),
        }
    }

    /// Begins the iterations of some `bodies` in a step from this `motion` [m].
    pub fn begin(&mut self, bodies: &[usize], assembly: &Assembly<D>, motion: &[Vector<D>]) {
        for &i in bodies {
            self.progress[i] = BodyProgress::new(assembly.largest(i, motion));
        }
        self.acceleration.restart(bodies);
        self.free_motion = None;
    }

    /// Keeps a guess of a load step of the `bodies`, to return to if it leads nowhere.
    pub fn keep_guess(
        &mut self,
        bodies: &[usize],
        assembly: &Assembly<D>,
        motion: &[Vector<D>],
        active: &ActiveSet<D>,
    ) {
        self.guess.resize(motion.len(), Vector::zeros());
        for nodes in bodies.iter().map(|&i| assembly.nodes(i)) {
            self.guess[nodes.clone()].copy_from_slice(&motion[nodes]);
        }
        self.guess_reactions.clear();
        self.guess_reactions.extend(active.all_acting());
    }

    /// Goes back to that guess.
    pub fn return_to_guess(
        &self,
        bodies: &[usize],
        assembly: &Assembly<D>,
        motion: &mut [Vector<D>],
        active: &mut ActiveSet<D>,
    ) {
        for nodes in bodies.iter().map(|&i| assembly.nodes(i)) {
            motion[nodes.clone()].copy_from_slice(&self.guess[nodes]);
        }
        active.act(&self.guess_reactions);
    }

    /// Leaves out of the correction what is left alone.
    pub fn leave_out(&mut self) {
        for field in &self.left_alone {
            leave_out(field, &mut self.correction[..field.len()]);
        }
    }

    /// The largest component of the last correction of the `bodies` [m].
    pub fn largest_correction(&self, bodies: &[usize], assembly: &Assembly<D>) -> f64 {
        bodies.iter().map(|&i| assembly.largest(i, &self.correction)).fold(0.0, f64::max)
    }
}
