//! The steps of others, as far as contact is concerned.

use carom_contact::{Candidate, Contact};
use carom_friction::{ContactProblem, Matrix, SolveReport};
use carom_mesh::compiled;
use carom_mesh::{Vector, nodal};

use super::mass::{ForeignMass, OnSurfaces};
use super::numbering::Numbering;
use crate::body::Interval;
use crate::contact::PosedProblem;
use crate::contact::active::ActiveSet;
use crate::contact::candidates::Finder;
use crate::contact::closing::{for_each_work, keep};
use crate::contact::delassus::support;
use crate::error::StepError;
use crate::ledger::{BodyLedger, ByPair, Energies, PairLedger};
use crate::model::assembly::Assembly;
use crate::model::at_rest::AtRest;
use crate::model::given::Given;
use crate::model::method::Method;
use crate::model::state::State;
use crate::scheme::Scheme;
use crate::step::control::SEARCH;
use crate::step::impulse::Impulses;
use crate::step::landing::{Landing, restore};
use crate::step::newton::control::CONTROL;
use crate::step::search_margin;

/// Surfaces, obstacles and pairs in somebody else's time loop, and what the present step knows of its contacts.
pub struct PlantedContact<const D: usize> {
    setting: Setting<D>,
    numbering: Numbering,
    /// Where the step is thought to end.
    next: State<D>,
    finder: Finder<D>,
    active: ActiveSet<D>,
    /// d [m] of the nodes on surfaces, obstacles after them, and as it was when contacts were evaluated before.
    motion: Vec<Vector<D>>,
    before: Vec<Vector<D>>,
    margin: f64,
    /// Searches of the step beyond the first, and evaluations since the last.
    repetition: usize,
    evaluations: usize,
    offsets: Vec<Vector<D>>,
    problem: ContactProblem<D>,
    guess: Vec<Vector<D>>,
    at_end: Vec<Contact<D>>,
    impulses: Impulses<D>,
    ledgers: Vec<BodyLedger>,
}

/// What a step has come to.
#[derive(Debug, Clone, PartialEq)]
pub struct PlantedStep {
    /// What the reactions did in every named pair [J].
    pub pairs: ByPair<PairLedger>,
    /// Distance from the contact laws, the sum of bi-potential gaps [J].
    pub certificate: f64,
    /// Smallest gap at the end of the contacts that took part [m]; infinite without any.
    pub min_gap: f64,
    /// How many pressed.
    pub pressing: usize,
    /// By how much of what the mass answered last for each surface its velocities have changed; zeros where nothing landed.
    pub landed: Vec<f64>,
}

/// What is given in a step.
struct Setting<const D: usize> {
    assembly: Assembly<D>,
    method: Method<D>,
    /// Where the step starts, with the reactions of the one before.
    state: State<D>,
    interval: Interval,
}

impl<const D: usize> Setting<D> {
    fn given(&self) -> Given<'_, D> {
        Given { assembly: &self.assembly, method: &self.method, state: &self.state, interval: &self.interval }
    }
}

type FindAndSelect<const D: usize> = fn(&mut PlantedContact<D>);
type EvaluateAt<const D: usize> = fn(&mut PlantedContact<D>, &[Vector<D>]);
type HasMissed<const D: usize> = fn(&mut PlantedContact<D>, &[Vector<D>]) -> Result<bool, StepError>;
type End<const D: usize> =
    fn(&mut PlantedContact<D>, &[Vector<D>], Option<(&[Vector<D>], &mut dyn ForeignMass<D>)>) -> PlantedStep;

impl<const D: usize> PlantedContact<D> {
    pub(super) fn new(assembly: Assembly<D>, method: Method<D>, numbering: Numbering) -> Self {
        let still = vec![Vector::zeros(); assembly.node_count()];
        let bodies = assembly.body_count();
        let mut state = State::initial(&assembly, &[], still);
        state.history = vec![Vec::new(); bodies];
        state.body_energies = vec![Energies::default(); bodies];
        let zeros = vec![Vector::zeros(); assembly.reference.len()];
        Self {
            next: state.clone(),
            finder: Finder::new(assembly.body_count()),
            active: ActiveSet::new(assembly.body_count()),
            motion: zeros.clone(),
            before: zeros.clone(),
            margin: 0.0,
            repetition: 0,
            evaluations: 0,
            offsets: Vec::new(),
            problem: ContactProblem::default(),
            guess: Vec::new(),
            at_end: Vec::new(),
            impulses: Impulses::new(zeros.len(), bodies),
            ledgers: vec![BodyLedger::default(); bodies],
            setting: Setting { interval: method.interval(0.0, 1.0), assembly, method, state },
            numbering,
        }
    }

    /// Starts a step of length `dt` [s] from where the caller's points are `at` [m], with their `velocity` [m/s], and finds what may touch in it.
    ///
    /// Without a `reach` [m] it looks as far as carom's own step does: twice as far as anything flies or is driven.
    ///
    /// # Errors
    /// If the prescribed motion of an obstacle is not finite.
    pub fn search(
        &mut self,
        at: &[Vector<D>],
        velocity: &[Vector<D>],
        dt: f64,
        reach: Option<f64>,
    ) -> Result<(), StepError> {
        let Self { setting, numbering, motion, .. } = self;
        let Setting { assembly, method, state, interval } = setting;
        *interval = method.interval(state.time, dt);
        let places = numbering.nodes().zip(&assembly.reference);
        for (((n, x), u), v) in places.zip(&mut state.displacement).zip(&mut state.velocity) {
            (*u, *v) = (at[n] - x, velocity[n]);
        }
        let obstacles = &mut state.velocity[assembly.node_count()..];
        for (v, motion) in obstacles.iter_mut().zip(&assembly.obstacle_motions) {
            *v = motion.velocity(state.time);
        }
        let flight = if interval.map.is_static() { 0.0 } else { dt };
        nodal::each(motion, [&state.velocity], |d, [v]| *d = v * flight);
        let given = setting.given();
        let driven = given.move_obstacles(motion)?;
        let speed = given.state.velocity.iter().map(Vector::norm_squared).fold(0.0, f64::max).sqrt();
        let drift = || {
            let of = |body: usize| &given.state.velocity[given.assembly.nodes(body)];
            let mean = |v: &[Vector<D>]| v.iter().sum::<Vector<D>>().norm() / v.len() as f64;
            (0..given.assembly.body_count()).map(|body| mean(of(body))).fold(0.0, f64::max) * dt
        };
        self.margin = reach.unwrap_or_else(|| search_margin(&given, speed * dt, driven, drift));
        self.repetition = 0;
        self.look();
        Ok(())
    }

    /// Finds what may touch on the way of the present motion, and which of that takes part.
    fn look(&mut self) {
        compiled!(D, PlantedContact::find_and_select as FindAndSelect)(self);
    }

    fn find_and_select(&mut self) {
        let Self { setting, finder, active, motion, margin, repetition, .. } = self;
        let given = setting.given();
        let nothing = AtRest::default();
        finder.find(&given, &nothing, motion, (*margin, *repetition), active);
        active.select(&given, (&finder.search, finder.needed()), &nothing, 0.0);
        (self.evaluations, self.problem.q) = (0, Vec::new());
    }

    /// Evaluates the contacts that take part where the caller's points are `at` [m] at the end of the step, as it is guessed now. Where its condition
    /// is written in between, the place is that between start and end.
    pub fn evaluate(&mut self, at: &[Vector<D>]) {
        compiled!(D, PlantedContact::evaluate_at as EvaluateAt)(self, at);
    }

    fn evaluate_at(&mut self, at: &[Vector<D>]) {
        self.move_to(at);
        let Self { setting, active, motion, before, evaluations, offsets, .. } = self;
        let given = setting.given();
        *evaluations += 1;
        if *evaluations > CONTROL.late {
            nodal::each(before, [motion], |b, [d]| *b -= d);
            let correction = nodal::largest(before);
            active.evaluate_late(&given, motion, correction);
        } else {
            active.evaluate(&given, motion);
        }
        before.copy_from_slice(motion);
        active.meet(&given, &[]);
        offsets.clear();
        offsets.extend(active.offsets(&given, motion));
    }

    /// Takes the end of the step from where the caller's points are.
    fn move_to(&mut self, at: &[Vector<D>]) {
        let Setting { assembly, state, .. } = &self.setting;
        let start = assembly.reference.iter().zip(&state.displacement);
        for ((n, d), (x, u)) in self.numbering.nodes().zip(&mut self.motion).zip(start) {
            *d = at[n] - (x + u);
        }
        let ends = [&state.displacement[..], &self.motion[..]];
        nodal::each(&mut self.next.displacement, ends, |u1, [u0, d]| *u1 = u0 + d);
    }

    /// Solves w = W r + q with the contact laws from the reactions known so far. Here `w` gives the blocks (i, j) of W = Hᵀ K̄⁻¹ H, and `free` are the
    /// motions Hᵀ d of the contacts without reactions [m].
    ///
    /// # Errors
    /// If the friction solver does not reach its tolerance, or a number is not finite. The problem is [kept](Self::posed_problem) then.
    pub fn solve(
        &mut self,
        w: impl Fn(usize, usize) -> Matrix<D>,
        free: &[Vector<D>],
    ) -> Result<SolveReport, StepError> {
        let Self { setting: Setting { assembly, method, .. }, active, problem, guess, motion, .. } = self;
        let parts = self.offsets.iter().zip(&active.contacts);
        let known = parts.map(|(offset, c)| offset + prescribed(assembly, c, motion));
        problem.q.clear();
        problem.q.extend(known.zip(free).map(|(known, free)| free + known));
        problem.mu.clone_from(&active.friction);
        problem.w.clear();
        for (i, contact) in active.contacts.iter().enumerate() {
            let row = (0..active.contacts.len()).filter_map(|j| {
                // W is symmetric, also where round-off is not.
                let mut block = if j < i { w(j, i).transpose() } else { w(i, j) };
                if i == j {
                    block += support(assembly, contact, &problem.q[i], motion, &block);
                }
                (i == j || block != Matrix::<D>::zeros()).then_some((j, block))
            });
            problem.w.push_row(row);
        }
        let is_finite = problem.q.iter().all(|q| q.iter().all(|x| x.is_finite()));
        if !is_finite {
            return Err(StepError::NotFinite("free motion of the contacts"));
        }
        guess.clone_from(&active.reactions);
        let report = method.solver.solve(problem, &mut active.reactions, &method.stopping);
        if report.is_solved() {
            return Ok(report);
        }
        let contacts = problem.q.len();
        active.reactions.clone_from(guess);
        Err(StepError::Friction { contacts, report: Box::new(report) })
    }

    /// Whether something that the search did not find has gone through its target where the caller's points end up `at` [m] or, with the condition
    /// `endpoint`, arrives there. If so it is among the contacts from now on, and the step is to be made again.
    ///
    /// # Errors
    /// If that has happened too often.
    pub fn missed(&mut self, at: &[Vector<D>]) -> Result<bool, StepError> {
        compiled!(D, PlantedContact::has_missed as HasMissed)(self, at)
    }

    fn has_missed(&mut self, at: &[Vector<D>]) -> Result<bool, StepError> {
        self.move_to(at);
        let Self { setting, finder, next, motion, active, repetition, .. } = self;
        let given = setting.given();
        let may_be_repeated = *repetition + 1 < SEARCH.repetitions;
        if !finder.missed_one(&given, &AtRest::default(), (motion, next), active, may_be_repeated) {
            return Ok(false);
        }
        self.repetition += 1;
        if self.repetition == SEARCH.repetitions {
            return Err(StepError::MissedContact { margin: self.margin });
        }
        self.look();
        Ok(true)
    }

    /// Ends the step where the caller's points are `at` [m]: keeps its reactions, from which the next one starts, and books their work.
    pub fn accept(&mut self, at: &[Vector<D>]) -> PlantedStep {
        self.close(at, None)
    }

    /// The same with the velocities [m/s] of the caller's points at the end of the step, and their mass. With the condition `midpoint` they are
    /// changed by impulses that give back what normal reactions took on landing: by what the mass answered last for every surface times what
    /// of it has [landed](PlantedStep::landed).
    pub fn accept_moving(
        &mut self,
        at: &[Vector<D>],
        velocity: &[Vector<D>],
        mass: &mut dyn ForeignMass<D>,
    ) -> PlantedStep {
        self.close(at, Some((velocity, mass)))
    }

    fn close(
        &mut self,
        at: &[Vector<D>],
        moving: Option<(&[Vector<D>], &mut dyn ForeignMass<D>)>,
    ) -> PlantedStep {
        compiled!(D, PlantedContact::end as End)(self, at, moving)
    }

    fn end(
        &mut self,
        at: &[Vector<D>],
        moving: Option<(&[Vector<D>], &mut dyn ForeignMass<D>)>,
    ) -> PlantedStep {
        self.move_to(at);
        let Self { setting, next, active, offsets, motion, at_end, impulses, ledgers, numbering, .. } = self;
        let given = setting.given();
        let Given { assembly, state, .. } = given;
        next.time = given.interval.end;
        let kept = keep(&given, active, offsets, motion, at_end, next);
        let restores = moving.is_some() && given.method.restores();
        if let Some((velocity, mass)) = moving {
            numbering.nodes().zip(&mut next.velocity).for_each(|(n, v)| *v = velocity[n]);
            let obstacles = &mut next.velocity[assembly.node_count()..];
            for (v, motion) in obstacles.iter_mut().zip(&assembly.obstacle_motions) {
                *v = motion.velocity(next.time);
            }
            let masses = &mut OnSurfaces { mass, assembly, numbering };
            restore(&given, next, Landing { active, at_end, motion, masses, ledgers }, impulses);
        }
        let mut pairs: ByPair<PairLedger> = ByPair::default();
        let between = |pair: u32| assembly.contact.pairs.get(pair as usize).between();
        let arriving: &[usize] = if restores { &impulses.arriving } else { &[] };
        let pressing = next.reactions.iter().enumerate().filter(|(k, _)| arriving.binary_search(k).is_err());
        pressing.for_each(|(_, r)| pairs.or_default(between(r.pair)).has_touched = true);
        for_each_work(&given, motion, [&state.reactions, &next.reactions], |reaction, work| {
            let pair = pairs.or_default(between(reaction.pair));
            pair.normal_contact -= work.normal;
            pair.prescribed += work.prescribed;
            pair.friction += work.dissipation;
        });
        let pressing = next.reactions.len() - arriving.len();
        let mut landed = vec![0.0; assembly.body_count()];
        if restores {
            impulses.join(at_end, &mut next.reactions, |reaction, done, _, _| {
                let pair = pairs.or_default(between(reaction.pair));
                let [along, across] = done.taken;
                pair.normal_contact += along;
                pair.prescribed += done.prescribed;
                pair.friction += across;
            });
            landed.copy_from_slice(&impulses.scales);
        }
        std::mem::swap(&mut setting.state, next);
        PlantedStep { pairs, certificate: kept.certificate, min_gap: kept.min_gap, pressing, landed }
    }

    /// Sets the reactions [N], in the order of the contacts.
    ///
    /// # Panics
    /// If there are not as many.
    pub fn set_reactions(&mut self, reactions: &[Vector<D>]) {
        self.active.reactions.copy_from_slice(reactions);
    }

    /// The problem of the contacts as it was last posed, and the reactions from which its solver started.
    #[must_use]
    pub fn posed_problem(&self) -> PosedProblem<'_, D> {
        PosedProblem { problem: &self.problem, guess: &self.guess }
    }

    /// Everything found in the search that takes part in the step, ascending.
    #[must_use]
    pub fn candidates(&self) -> &[Candidate] {
        &self.active.candidates
    }

    /// The same as they were last evaluated.
    #[must_use]
    pub fn contacts(&self) -> &[Contact<D>] {
        &self.active.contacts
    }

    /// Their friction coefficients.
    #[must_use]
    pub fn friction(&self) -> &[f64] {
        &self.active.friction
    }

    /// Their reactions as they are known [N].
    #[must_use]
    pub fn reactions(&self) -> &[Vector<D>] {
        &self.active.reactions
    }

    /// What their motions Hᵀ d, of which the caller's free unknowns are all, lack of the variables of condition and friction [m].
    pub fn offsets(&self) -> impl Iterator<Item = Vector<D>> {
        let parts = self.offsets.iter().zip(&self.active.contacts);
        parts.map(|(offset, contact)| offset + prescribed(&self.setting.assembly, contact, &self.motion))
    }

    /// The caller's number of a node; none of an obstacle.
    #[must_use]
    pub fn callers_node(&self, node: usize) -> Option<u32> {
        self.numbering.callers(node)
    }

    /// The bodies, obstacles and pairs.
    #[must_use]
    pub fn assembly(&self) -> &Assembly<D> {
        &self.setting.assembly
    }

    /// Time [s], which accepted steps add up to.
    #[must_use]
    pub fn time(&self) -> f64 {
        self.setting.state.time
    }

    /// Whether the steps are without inertia.
    #[must_use]
    pub fn is_static(&self) -> bool {
        self.setting.method.scheme == Scheme::Static
    }
}

/// The part of the motion of a contact that is prescribed [m].
fn prescribed<const D: usize>(
    assembly: &Assembly<D>,
    contact: &Contact<D>,
    motion: &[Vector<D>],
) -> Vector<D> {
    contact.relative(|n| assembly.prescribed_part(n, &motion[n]))
}
