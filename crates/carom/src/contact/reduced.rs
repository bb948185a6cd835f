//! The reduced problem of the contact points, and its reactions.

use std::time::Duration;

use carom_contact::Contact;
use carom_friction::{ContactProblem, SolverKind, StoppingRule};
use carom_mesh::{Vector, nodal};

use super::active::ActiveSet;
use super::control::CONTROL;
use super::delassus::Delassus;
use super::sliding::Posed;
use super::stiffened::OfReactions;
use crate::body::Body;
use crate::error::StepError;
use crate::model::assembly::Assembly;
use crate::model::each_body::{PerBody, PerNode, each_body};
use crate::model::given::Given;
use crate::model::state::State;

/// What residuals are relative to [m]: the larger of q and, by the natural stiffness, the reactions. A residual is an error of motions over it.
fn size<const D: usize>(problem: &ContactProblem<D>, reactions: &[Vector<D>]) -> f64 {
    let squares = |vectors: &[Vector<D>]| vectors.iter().map(Vector::norm_squared).sum::<f64>();
    squares(&problem.q).max(squares(reactions) / problem.natural_stiffness().powi(2)).sqrt()
}

/// How wrong the motions of contacts may be [m].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Accuracy {
    /// In an iteration after which others come.
    Passing(f64),
    /// In what may be the last one.
    Last(f64),
}

impl Accuracy {
    /// The tolerance of a problem of so many contacts and this `size` [m]. Passing it is at least the one that is `given`, and in the end at most: where nodes
    /// without mass have hardly any stiffness, motions without reactions are a million times as large as any that there are.
    fn tolerance(self, contacts: usize, size: f64, given: f64) -> f64 {
        let relative = |error: f64| error * (contacts as f64).sqrt() / size;
        match self {
            Self::Passing(error) => relative(error).min(CONTROL.loosest).max(given),
            Self::Last(error) => relative(error).max(CONTROL.finest).min(given),
        }
    }
}

/// The reduced problem of a step and what leads to it.
#[derive(Debug)]
pub(crate) struct Reduced<const D: usize> {
    pub delassus: Delassus<D>,
    pub problem: ContactProblem<D>,
    /// What the normal motions lack of the variable of the condition [m].
    pub offsets: Vec<Vector<D>>,
    /// The reactions that the friction solver last started from.
    pub guess: Vec<Vector<D>>,
    /// Those that its last call started from which was finer than it was given.
    start: Vec<Vector<D>>,
    /// The solver that gave the last reactions.
    pub solved_by: SolverKind,
    /// Time spent in the friction solver so far, by all threads together.
    pub friction_time: Duration,
    /// The nodes of every body that contacts act on, ascending, and the bodies of which they were listed; others have none.
    nodes: Vec<Vec<u32>>,
    listed: Vec<usize>,
    /// The motion with the reactions known so far, at these nodes and of obstacles [m].
    known_motion: Vec<Vector<D>>,
    /// The change of the nodal forces by that of the reactions, at these nodes [N].
    change: Vec<Vector<D>>,
}

impl<const D: usize> Reduced<D> {
    /// Of an assembly.
    pub fn new(assembly: &Assembly<D>) -> Self {
        let count = assembly.reference.len();
        Self {
            delassus: Delassus::new(assembly),
            problem: ContactProblem::default(),
            offsets: Vec::new(),
            guess: Vec::new(),
            start: Vec::new(),
            solved_by: SolverKind::default(),
            friction_time: Duration::ZERO,
            nodes: vec![Vec::new(); assembly.body_count()],
            listed: Vec::new(),
            known_motion: nodal::zeros(count),
            change: nodal::zeros(count),
        }
    }

    /// What the motions of the last problem are relative to [m]: what residuals are, or what adhesion keeps from moving.
    pub fn size(&self, active: &ActiveSet<D>) -> f64 {
        let adhesion = active.adhesions.iter().flatten().map(|a| a * a).sum::<f64>().sqrt();
        size(&self.problem, &active.reactions).max(adhesion / self.problem.natural_stiffness())
    }

    /// Lists the nodes of `bodies` that these contacts of theirs, springs of the model, and springs in K̄, act on.
    fn list_nodes<'a>(
        &mut self,
        assembly: &Assembly<D>,
        bodies: &[usize],
        touched: &[bool],
        contacts: impl Iterator<Item = &'a Contact<D>>,
    ) {
        self.listed.iter().for_each(|&i| self.nodes[i].clear());
        self.listed.clear();
        self.listed.extend_from_slice(bodies);
        // The motion of obstacles is prescribed: they do not respond.
        for (b, own) in contacts.flat_map(Contact::stencil).filter_map(|(n, _)| assembly.place_of(n)) {
            self.nodes[b].push(own as u32);
        }
        assembly.connected().for_each(|(b, own)| self.nodes[b].push(own as u32));
        let stiffened = &self.delassus.stiffened;
        for &i in bodies {
            let nodes = &mut self.nodes[i];
            if touched[i] && stiffened.is_sprung[i] {
                nodes.extend(stiffened.springs[i].iter().map(|&(node, _)| node));
            }
            nodes.sort_unstable();
            nodes.dedup();
        }
    }

    /// Tells the bodies which nodes the contacts of the state act on: those of a load step are next to them.
    pub fn expect_those_of(
        &mut self,
        state: &State<D>,
        assembly: &Assembly<D>,
        bodies: &mut [Box<dyn Body<D>>],
    ) {
        let touched = vec![false; bodies.len()];
        self.list_nodes(assembly, &assembly.everyone, &touched, state.reactions.iter().map(|r| &r.contact));
        self.nodes.iter().zip(bodies).for_each(|(nodes, body)| body.expect_contacts(nodes));
    }

    /// The same of the contacts that the bodies were last [prepared](Self::prepare) for.
    pub fn expect_more(&self, bodies: &mut [Box<dyn Body<D>>]) {
        self.nodes.iter().zip(bodies).for_each(|(nodes, body)| body.expect_contacts(nodes));
    }

    /// Gets those of the bodies that are `touching` ready to respond at the nodes of their contacts: their compliance there, and the reach of these nodes.
    pub fn prepare(
        &mut self,
        given: &Given<'_, D>,
        active: &ActiveSet<D>,
        touching: &[usize],
        bodies: &mut [Box<dyn Body<D>>],
    ) {
        self.list_nodes(given.assembly, touching, &active.touched, active.contacts.iter());
        let everywhere = given.interval.map.is_static();
        let Self { nodes, listed, delassus, .. } = self;
        let all = (PerBody(bodies), PerBody(&mut delassus.compliances));
        each_body(given.assembly, listed, all, &|i, (body, compliance)| {
            let (body, nodes) = (body.own(), &nodes[i]);
            if !nodes.is_empty() {
                compliance.own().prepare(&mut **body, nodes, everywhere);
                body.set_reach(nodes);
            }
        });
    }

    /// Takes note of how much the prepared bodies feel of reactions of nodes without mass.
    pub fn feel(&mut self, felt: impl Fn(usize) -> f64) {
        let Self { listed, delassus, .. } = self;
        listed.iter().for_each(|&i| delassus.compliances[i].feel(felt(i)));
    }

    /// Makes what contacts add to the tangents of a load step at a guess, and adds the forces that go with it to the `residual` [N].
    pub fn stiffen(
        &mut self,
        given: &Given<'_, D>,
        active: &ActiveSet<D>,
        motion: &[Vector<D>],
        bodies: &mut [Box<dyn Body<D>>],
        residual: &mut [Vector<D>],
    ) {
        let Delassus { stiffened, compliances, .. } = &mut self.delassus;
        stiffened.add_forces(given, active, motion, bodies, residual);
        stiffened.prepare(given, active, motion, compliances);
    }

    /// Solves the reduced problem of the contacts to some `accuracy`. The bodies in contact are between [`Body::begin_solve`] and
    /// [`Body::end_solve`], and are given the change of the reactions. Returns what the tolerance that was reached leaves of any motion [m]: less cannot be had by
    /// iterating on.
    pub fn solve(
        &mut self,
        given: &Given<'_, D>,
        active: &mut ActiveSet<D>,
        motion: &[Vector<D>],
        accuracy: Accuracy,
        bodies: &mut [Box<dyn Body<D>>],
    ) -> Result<f64, StepError> {
        let Given { assembly, method, .. } = *given;
        self.offsets.clear();
        self.offsets.extend(active.offsets(given, motion));
        self.look(assembly, motion, bodies);
        if self.delassus.stiffened.is_needed() {
            self.delassus.stiffened.see(motion, &mut self.known_motion);
        }
        let Self { delassus, problem, offsets, known_motion, .. } = self;
        delassus.condense(assembly, active, offsets, known_motion, problem);
        self.guess.clone_from(&active.reactions);
        if self.problem.is_empty() {
            self.give(assembly, active, bodies);
            return Ok(0.0);
        }
        let motions = size(&self.problem, &[]);
        let size = size(&self.problem, &active.reactions);
        let given_tolerance = method.stopping.tolerance;
        let mut tolerance = accuracy.tolerance(active.reactions.len(), size, given_tolerance);
        let mut time = Duration::ZERO;
        let mut start = std::mem::take(&mut self.start);
        let mut solve = |problem: &ContactProblem<D>, reactions: &mut [Vector<D>]| {
            let is_fine = tolerance < given_tolerance;
            let iterations = if is_fine { CONTROL.fine_iterations } else { usize::MAX };
            let max_iterations = iterations.min(method.stopping.max_iterations);
            let stopping = StoppingRule { tolerance, max_iterations, ..method.stopping };
            if is_fine {
                start.clear();
                start.extend_from_slice(reactions);
            }
            let mut report = method.solver.solve(problem, reactions, &stopping);
            time += report.time;
            if is_fine && !report.is_solved() {
                // Round-off is in the way: as if nothing finer had been tried.
                reactions.copy_from_slice(&start);
                tolerance = given_tolerance;
                report = method.solver.solve(problem, reactions, &method.stopping);
                time += report.time;
            }
            report
        };
        let report = loop {
            let Self { delassus, problem, offsets, guess, .. } = &mut *self;
            let report = if active.sliders.is_empty() {
                solve(problem, &mut active.reactions)
            } else {
                let mut posed = Posed { problem, guess, offsets, stand_ins: &mut delassus.stand_ins };
                let made = active.solve_with_laws(given, &mut posed, &mut solve);
                // Laws stretch tangents, and W with them.
                delassus.begin_anew();
                made?
            };
            // It ends, as what holds grows by many times.
            if !report.is_solved() || !active.hold_on(&mut self.problem, &mut self.guess) {
                break report;
            }
        };
        self.start = start;
        self.solved_by = report.solver;
        self.friction_time += time;
        if !report.is_solved() {
            let q = &self.problem.q;
            return Err(if q.iter().all(|q| q.iter().all(|x| x.is_finite())) {
                StepError::Friction { contacts: q.len(), report: Box::new(report) }
            } else {
                StepError::NotFinite("free motion of the contacts")
            });
        }
        self.give(assembly, active, bodies);
        // With the stiffness of reactions W may be indefinite, and has no natural stiffness by which reactions were motions.
        let size = if self.delassus.stiffened.of_reactions == OfReactions::None { size } else { motions };
        Ok(tolerance.min(given_tolerance) * size)
    }

    /// Writes the motion with the reactions known so far.
    fn look(&mut self, assembly: &Assembly<D>, motion: &[Vector<D>], bodies: &mut [Box<dyn Body<D>>]) {
        let obstacles = assembly.node_count()..;
        self.known_motion[obstacles.clone()].copy_from_slice(&motion[obstacles]);
        let Self { nodes, listed, known_motion, .. } = self;
        let all = (PerBody(bodies), PerNode(known_motion));
        each_body(assembly, listed, all, &|i, (body, seen)| {
            let (nodes, seen) = (&nodes[i], seen.0);
            if nodes.is_empty() {
                return;
            }
            body.own().partial_solve(nodes, seen);
            let motion = &motion[assembly.nodes(i)];
            nodes.iter().map(|&n| n as usize).for_each(|n| seen[n] = motion[n] + seen[n]);
        });
    }

    /// Gives the bodies the change of the reactions.
    fn give(&mut self, assembly: &Assembly<D>, active: &ActiveSet<D>, bodies: &mut [Box<dyn Body<D>>]) {
        // Obstacles do not respond, but their places take what contacts leave there.
        self.change[assembly.node_count()..].fill(Vector::zeros());
        for (i, nodes) in self.listed.iter().map(|&i| (i, &self.nodes[i])) {
            let first = assembly.nodes(i).start;
            nodes.iter().for_each(|&node| self.change[first + node as usize] = Vector::zeros());
        }
        for (k, contact) in active.contacts.iter().enumerate() {
            let force = contact.frame.tr_mul(&(active.reactions[k] - self.guess[k]));
            for (node, weight) in contact.stencil() {
                self.change[node] += force * weight * self.delassus.felt(assembly, active, k, node);
            }
        }
        if self.delassus.stiffened.is_needed() {
            self.delassus.stiffened.stand_in(&mut self.change);
        }
        let Self { nodes, listed, change, .. } = self;
        each_body(assembly, listed, PerBody(bodies), &|i, body| {
            if !nodes[i].is_empty() {
                body.own().add_forces(&nodes[i], &change[assembly.nodes(i)]);
            }
        });
    }
}
