use std::time::Duration;

use carom_contact::{Candidate, Contact, Mortar, Search};
use carom_friction::{ContactProblem, SolverKind};
use carom_mesh::{Matrix, Vector};

use crate::body::fe::drive::BodyDrive;
use crate::body::fe::equation::{Pose, ResidualScratch};
use crate::body::fe::operator::BodyOperator;
use crate::contact::compliance::Compliance;
use crate::contact::coupling::Coupling;
use crate::contact::cross_check::CrossCheck;
use crate::ledger::{BodyLedger, PairLedger};
use crate::step::blend::{Blend, Rubbing};
use crate::step::newton::acceleration::Acceleration;
use crate::step::newton::convergence::BodyProgress;
use crate::{Ledger, Model};

/// What one group of contacts did in a step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct GroupReport {
    /// Sum of the normal reactions [N].
    pub normal_force: f64,
    /// What happened to the energy.
    pub ledger: PairLedger,
}

/// Scratch of a step: factors, tables and vectors. It holds no result and may be dropped at any moment; a run that is to go on to the last bit
/// keeps what its [`crate::Checkpoint`] has of it.
pub struct Workspace<const D: usize> {
    pub(crate) operators: Vec<BodyOperator<D>>,
    pub(crate) compliances: Vec<Compliance<D>>,
    pub(crate) residual_scratch: Vec<ResidualScratch<D>>,
    pub(crate) poses: Vec<Pose<D>>,
    pub(crate) drives: Vec<BodyDrive<D>>,
    /// d = u₊ − u.
    pub(crate) motion: Vec<Vector<D>>,
    /// The correction of d, and before that the residual.
    pub(crate) correction: Vec<Vector<D>>,
    pub(crate) residual: Vec<Vector<D>>,
    pub(crate) momentum: Vec<Vector<D>>,
    pub(crate) search: Search<D>,
    pub(crate) candidates: Vec<Candidate>,
    /// All that the search found, ascending.
    pub(crate) searched: Vec<Candidate>,
    pub(crate) missed: Vec<Candidate>,
    pub(crate) contacts: Vec<Contact<D>>,
    /// The frame that every contact had when it was last evaluated, in this step or as a reaction of the last one; zeros where there is none.
    pub(crate) frames: Vec<Matrix<D>>,
    /// The nodes of every body that contacts act on, ascending.
    pub(crate) contact_nodes: Vec<Vec<u32>>,
    /// Contacts at the end of the step.
    pub(crate) end_contacts: Vec<Contact<D>>,
    pub(crate) mortar: Mortar<D>,
    pub(crate) missed_mortar: Mortar<D>,
    pub(crate) friction: Vec<f64>,
    /// Penetration [m] that a contact may keep, negative: see `ContactCondition::normal_offset`.
    pub(crate) start_gaps: Vec<f64>,
    pub(crate) offsets: Vec<f64>,
    /// Reactions as the reduced problem has them: see `ContactCondition::reaction_weight`.
    pub(crate) reactions: Vec<Vector<D>>,
    /// Reactions [N] that the step starts with, in the frame of the last step.
    pub(crate) start_forces: Vec<Vector<D>>,
    /// Reactions of the state whose contacts have no part in the step.
    pub(crate) lost: Vec<usize>,
    pub(crate) rubbing: Vec<Rubbing>,
    /// For every node the sum of weights and of weighted sliding distances [m] of its contacts; zero between steps.
    pub(crate) slid: Vec<[f64; 2]>,
    pub(crate) blend: Blend<D>,
    pub(crate) problem: ContactProblem<D>,
    pub(crate) coupling: Coupling,
    /// A row of W on its way to the problem.
    pub(crate) row_blocks: Vec<(usize, Matrix<D>)>,
    /// The reactions that the friction solver last started from.
    pub(crate) guess: Vec<Vector<D>>,
    /// The solver that gave the last reactions.
    pub(crate) solved_by: SolverKind,
    /// Whether contacts act on a body.
    pub(crate) touched: Vec<bool>,
    /// The bodies that contacts act on.
    pub(crate) in_contact: Vec<usize>,
    pub(crate) progress: Vec<BodyProgress>,
    pub(crate) acceleration: Acceleration<D>,
    /// What the groups did in the last step, in the order of the model.
    pub groups: Vec<GroupReport>,
    /// What happened to the energy of each body in the last step.
    pub bodies: Vec<BodyLedger>,
    /// Factorisations made so far.
    pub factorisations: u64,
    /// Time spent in the friction solver so far.
    pub friction_time: Duration,
}

/// A contact problem as a step posed it: motions in m, reactions in N (with massless contact ξ times these).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PosedProblem<'a, const D: usize> {
    /// W, q and μ.
    pub problem: &'a ContactProblem<D>,
    /// The reactions that its solver started from.
    pub guess: &'a [Vector<D>],
}

impl<const D: usize> Workspace<D> {
    /// Scratch for steps of `model`.
    #[must_use]
    pub fn new(model: &Model<D>) -> Self {
        let zeros = vec![Vector::zeros(); model.reference.len()];
        let (bodies, positions) = (model.bodies.len(), zeros.len());
        Self {
            operators: model.bodies.iter().map(|b| BodyOperator::new(&b.body)).collect(),
            compliances: model.bodies.iter().map(|b| Compliance::new(&b.body)).collect(),
            residual_scratch: model
                .bodies
                .iter()
                .map(|b| ResidualScratch::new(b.body.node_count()))
                .collect(),
            poses: vec![Pose::default(); bodies],
            drives: (0..bodies).map(|i| BodyDrive::new(model, i)).collect(),
            motion: zeros.clone(),
            correction: zeros.clone(),
            residual: zeros.clone(),
            momentum: zeros,
            search: Search::default(),
            candidates: Vec::new(),
            searched: Vec::new(),
            missed: Vec::new(),
            contacts: Vec::new(),
            frames: Vec::new(),
            contact_nodes: vec![Vec::new(); bodies],
            end_contacts: Vec::new(),
            mortar: Mortar::default(),
            missed_mortar: Mortar::default(),
            friction: Vec::new(),
            start_gaps: Vec::new(),
            offsets: Vec::new(),
            reactions: Vec::new(),
            start_forces: Vec::new(),
            lost: Vec::new(),
            slid: vec![[0.0; 2]; positions],
            rubbing: Vec::new(),
            blend: Blend::new(model),
            problem: ContactProblem::default(),
            coupling: Coupling::new(model.node_count(), bodies),
            row_blocks: Vec::new(),
            guess: Vec::new(),
            solved_by: SolverKind::default(),
            touched: vec![false; bodies],
            in_contact: Vec::with_capacity(bodies),
            progress: vec![BodyProgress::new(0.0); bodies],
            acceleration: Acceleration::new(positions, bodies),
            groups: vec![GroupReport::default(); model.groups.len()],
            bodies: vec![BodyLedger::default(); bodies],
            factorisations: 0,
            friction_time: Duration::ZERO,
        }
    }
}

impl<const D: usize> Workspace<D> {
    /// The blend α of start and end stresses of every body in the last step.
    #[must_use]
    pub fn blend_weights(&self) -> &[f64] {
        &self.blend.weight
    }

    /// Memory of the factors of all bodies [bytes].
    #[must_use]
    pub fn factor_bytes(&self) -> usize {
        self.operators.iter().map(BodyOperator::bytes).sum()
    }

    /// The last contact problem that a step posed, solved or not; after [`crate::StepError::Friction`] the one that failed.
    #[must_use]
    pub fn posed_problem(&self) -> Option<PosedProblem<'_, D>> {
        let (problem, guess) = (&self.problem, &self.guess[..]);
        (!problem.is_empty()).then_some(PosedProblem { problem, guess })
    }
}

/// What a step says about itself.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StepReport {
    /// Newton iterations.
    pub newton_iterations: usize,
    /// Contacts with a reaction.
    pub contacts: usize,
    /// Smallest gap of a contact candidate at the end of the step [m]; infinite without candidates.
    pub min_gap: f64,
    /// Sum of the normal reactions [N].
    pub normal_force: f64,
    /// Largest blend |α| of start and end stresses: see the scheme `conserving` with `massless` contact.
    pub blend: f64,
    /// Smallest dissipation by friction of a contact [J]; negative = friction did work on the bodies.
    pub least_friction: f64,
    /// Residual of the contact laws (see `carom_friction::Measure`).
    pub residual: f64,
    /// Σ of the bi-potential gaps [J].
    pub certificate: f64,
    /// The part of it that the contact problem was left with [J]; the rest is of the motion that Newton's iterations were left with.
    pub solver_certificate: f64,
    /// Σ |r·q| [J]: what the reactions do over the motion that they prevent.
    pub reaction_work: f64,
    /// What a second solver says of the last contact problem, if it was asked.
    pub cross_check: Option<CrossCheck>,
    /// What happened to the energy.
    pub ledger: Ledger,
}

impl StepReport {
    /// Whether every number is finite, but for the smallest gap where there is none.
    pub(crate) fn is_finite(&self) -> bool {
        let Self { normal_force, blend, least_friction, residual, .. } = *self;
        let Self { certificate, solver_certificate, reaction_work, mut ledger, .. } = *self;
        let numbers = [normal_force, blend, least_friction, residual];
        let laws = [certificate, solver_certificate, reaction_work];
        let terms = ledger.terms_mut().map(|term| *term);
        numbers.iter().chain(&laws).chain(&terms).all(|x| x.is_finite()) && !self.min_gap.is_nan()
    }
}
