use std::time::Duration;

use carom_fem::CellState;
use carom_mesh::Vector;
use carom_mesh::compiled;
use serde::Serialize;

use super::error::RunError;
use crate::build::{Inputs, Meshes};
use crate::contact::PosedProblem;
use crate::contact::cross_check::CrossCheckSummary;
use crate::error::InputError;
use crate::ledger::table::LedgerTable;
use crate::model::assembly::Assembly;
use crate::run::account::Account;
use crate::run::describe::{Description, describe};
use crate::run::events::EventLog;
use crate::run::history::History;
use crate::run::impact::Whole;
use crate::run::nominal_step::NominalStep;
use crate::run::stage::Stage;
use crate::run::stepper::{Nominal, Stepper};
use crate::run::surface_fields::{SurfaceFields, surface_fields};
use crate::run::time_grid::TimeGrid;
use crate::run::totals::Totals;
use crate::run::tracked::tracks;
use crate::scenario::Scenario;
use crate::step::workspace::Workspace;
use crate::{Books, Energies, Ledger, Model, State};

/// How [`Simulation::advance`] ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// The time asked for is reached.
    Reached,
    /// The caller asked for a pause.
    Paused,
}

/// A run: its stages, the state, and the books.
pub struct Simulation<const D: usize> {
    pub(crate) stages: Vec<Stage<D>>,
    /// The stage that the run is in.
    pub(crate) current: usize,
    pub(crate) state: State<D>,
    pub(crate) spare: State<D>,
    pub(crate) work: Workspace<D>,
    pub(crate) description: Description,
    /// The steps of the stage.
    pub(crate) grid: TimeGrid,
    /// How often the steps of a static analysis are halved at present.
    pub(crate) halvings: u32,
    pub(crate) history_rows: u64,
    pub(crate) last_recorded: Option<f64>,
    pub(crate) history: History<D>,
    pub(crate) events: EventLog,
    pub(crate) initial_energies: Vec<Energies>,
    pub(crate) books: Books,
    /// The books of each stage that has begun.
    pub(crate) accounts: Vec<Account>,
    pub(crate) ledger_table: LedgerTable,
    pub(crate) totals: Totals,
    pub(crate) cross_checks: CrossCheckSummary,
    pub(crate) last_step: Option<Ledger>,
    pub(crate) nominal_step: NominalStep,
    /// Whether all nodes are where they are: see [`Self::complete`].
    pub(super) is_complete: bool,
}

/// A step as its two states.
#[derive(Debug, Clone)]
pub struct StepPair<'a, const D: usize> {
    /// The state that it started from.
    pub start: &'a State<D>,
    /// The state that it ended in.
    pub end: &'a State<D>,
    /// Blend α of start and end stresses of every body.
    pub blend: &'a [f64],
    /// See [`Workspace::vibration_shares`].
    pub vibration: &'a [f64],
    /// See [`Workspace::impulse_forces`].
    pub impulses: [Vec<Vector<D>>; 2],
    /// What the step says of the energy.
    pub ledger: Ledger,
}

/// A quick look at a run.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Progress {
    /// Steps done.
    pub step: u64,
    /// Time [s].
    pub time: f64,
    /// Contacts with a reaction in the last step.
    pub contacts: usize,
    /// Steps or substeps that failed and were halved.
    pub retried: u64,
    /// Kinetic energy [J].
    pub kinetic: f64,
    /// Strain energy [J].
    pub strain: f64,
    /// Energy of springs [J].
    pub springs: f64,
    /// Dissipated by friction since the start [J].
    pub friction: f64,
    /// All energy [J].
    pub total: f64,
}

/// Fields of a state, node by node and cell by cell.
#[derive(Debug, Clone, PartialEq)]
pub struct Fields<'a, const D: usize> {
    /// Displacements [m].
    pub displacement: &'a [Vector<D>],
    /// Velocities [m/s].
    pub velocity: &'a [Vector<D>],
    /// Contact forces [N].
    pub reaction: &'a [Vector<D>],
    /// Mean state of every cell.
    pub cells: Vec<CellState>,
}

type Build<const D: usize> = fn(&Scenario, Inputs<D>) -> Result<Simulation<D>, InputError>;
type MakeOneStep<const D: usize> = fn(&mut Simulation<D>) -> Result<(), RunError>;

impl<const D: usize> Simulation<D> {
    /// Builds a run from its scenario, which generates all its meshes.
    ///
    /// # Errors
    /// If the scenario cannot be run; see [`build`](crate::build).
    pub fn new(scenario: &Scenario) -> Result<Self, InputError> {
        Self::with_meshes(scenario, Meshes::new())
    }

    /// Builds a run from its scenario and the `meshes` that it takes from files.
    ///
    /// # Errors
    /// If the scenario cannot be run; see [`build`](crate::build).
    pub fn with_meshes(scenario: &Scenario, meshes: Meshes<D>) -> Result<Self, InputError> {
        Self::with_inputs(scenario, meshes.into())
    }

    /// Builds a run from its scenario and all that it takes from elsewhere.
    ///
    /// # Errors
    /// If the scenario cannot be run; see [`build`](crate::build).
    pub fn with_inputs(scenario: &Scenario, inputs: Inputs<D>) -> Result<Self, InputError> {
        compiled!(D, Simulation::build as Build)(scenario, inputs)
    }

    fn build(scenario: &Scenario, inputs: Inputs<D>) -> Result<Self, InputError> {
        let stages = Stage::all(scenario, inputs)?;
        let state = stages[0].start()?;
        let Stage { model, grid, merge, .. } = &stages[0];
        let steps = stages.iter().map(|stage| stage.grid.steps).sum();
        let mut simulation = Self {
            description: describe(&scenario.title, model, &state, steps),
            events: EventLog::new(merge.clone()),
            history: History::new(&stages, &state, tracks(model, &scenario.output.track)?),
            spare: state.clone(),
            grid: *grid,
            halvings: 0,
            history_rows: 0,
            last_recorded: None,
            initial_energies: state.all_energies().collect(),
            books: Books::new(model.bodies.len()),
            accounts: vec![Account::new(state.all_energies().collect())],
            ledger_table: LedgerTable::default(),
            totals: Totals::new(&state.energies),
            cross_checks: CrossCheckSummary::default(),
            last_step: None,
            nominal_step: NominalStep::default(),
            is_complete: true,
            work: stages[0].workspace(),
            current: 0,
            stages,
            state,
        };
        simulation.record();
        Ok(simulation)
    }
}

impl<const D: usize> Simulation<D> {
    /// The name of an entry of the ledger table: of a body or, after these, of a pair as "a|b".
    #[must_use]
    pub fn ledger_entry(&self, number: usize) -> String {
        let Assembly { contact, .. } = &self.model().assembly;
        match number.checked_sub(self.model().bodies.len()) {
            None => self.model().bodies[number].name.clone(),
            Some(place) => {
                let between = contact.pairs.at_place(place);
                between.map_or_else(String::new, |between| self.model().assembly.names(between).join("|"))
            }
        }
    }

    /// What is run.
    #[must_use]
    pub fn description(&self) -> &Description {
        &self.description
    }

    /// The model, as it is in the present stage.
    #[must_use]
    pub fn model(&self) -> &Model<D> {
        &self.stage().model
    }

    /// The present stage.
    pub(crate) fn stage(&self) -> &Stage<D> {
        &self.stages[self.current]
    }

    /// Whether the case has stages, and be it one.
    pub(crate) fn has_stages(&self) -> bool {
        !self.stages[0].name.is_empty()
    }

    /// The number of the present stage, from 0; a run without stages has one.
    #[must_use]
    pub fn stage_number(&self) -> usize {
        self.current
    }

    /// The present state.
    #[must_use]
    pub fn state(&self) -> &State<D> {
        &self.state
    }

    /// The last step made, which may be a part of a nominal one, for whoever wants to check it.
    #[must_use]
    pub fn last_step(&self) -> Option<StepPair<'_, D>> {
        let ledger = self.last_step?;
        Some(StepPair {
            start: &self.spare,
            end: &self.state,
            blend: self.work.blend_weights(),
            vibration: self.work.vibration_shares(),
            impulses: self.work.impulse_forces(self.state.reactions.len()),
            ledger,
        })
    }

    /// What the last nominal step says about itself; nothing before the first, or after a restart.
    #[must_use]
    pub fn nominal_step(&self) -> &NominalStep {
        &self.nominal_step
    }

    /// Overwrites the velocities [m/s], one per node: initial conditions that no scenario describes. Only before the first step.
    ///
    /// # Panics
    /// If steps were made already or the number of nodes is not that of the model.
    pub fn set_initial_velocity(&mut self, velocity: Vec<Vector<D>>) {
        assert_eq!(self.step(), 0, "initial velocities belong before the first step");
        let Self { stages, current, state, work, .. } = self;
        let model = &stages[*current].model;
        let still = std::mem::replace(state, model.initial_state(velocity));
        state.time = still.time;
        (state.displacement, state.anchor, state.reactions) =
            (still.displacement, still.anchor, still.reactions);
        state.refresh(&model.assembly, &work.iterating.bodies);
        self.restart();
    }

    /// Begins the books anew with the present state.
    pub(crate) fn restart(&mut self) {
        self.spare.clone_from(&self.state);
        self.initial_energies = self.state.all_energies().collect();
        self.accounts = vec![Account::new(self.initial_energies.clone())];
        self.description =
            describe(&self.description.title, self.model(), &self.state, self.description.steps);
        self.totals = Totals::new(&self.state.energies);
        self.ledger_table = LedgerTable::default();
        self.history.restart(&self.state);
        self.last_recorded = None;
        self.history_rows = 0;
        self.record();
    }

    /// Time [s].
    #[must_use]
    pub fn time(&self) -> f64 {
        self.state.time
    }

    /// Nominal steps done.
    #[must_use]
    pub fn step(&self) -> u64 {
        self.stages[..self.current].iter().map(|stage| stage.grid.steps).sum::<u64>() + self.grid.step
    }

    /// Nominal steps of the whole run.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.stages.iter().map(|stage| stage.grid.steps).sum()
    }

    /// The last contact problem that a step posed; after [`crate::StepError::Friction`] the one that failed, at the shortest
    /// length tried.
    #[must_use]
    pub fn posed_problem(&self) -> Option<PosedProblem<'_, D>> {
        self.work.posed_problem()
    }

    /// Memory of the factors of all bodies [bytes].
    #[must_use]
    pub fn factor_bytes(&self) -> usize {
        self.work.factor_bytes()
    }

    /// Which bodies rest: they take no part in steps until something changes.
    #[must_use]
    pub fn resting(&self) -> &[bool] {
        &self.work.resting.who.bodies
    }

    /// Newton iterations made so far.
    #[must_use]
    pub fn newton_iterations(&self) -> u64 {
        self.totals.newton_iterations
    }

    /// Time spent so far in search of contacts and in measures of what is inside what.
    #[must_use]
    pub fn detection_time(&self) -> Duration {
        self.work.detection_time
    }

    /// Time spent in the friction solver so far, by all threads together.
    #[must_use]
    pub fn friction_time(&self) -> Duration {
        self.work.friction_time()
    }

    /// The books since the start.
    #[must_use]
    pub fn books(&self) -> &Books {
        &self.books
    }

    /// [`Self::advance`] for whoever does not look at fields each time: nodes of reduced bodies that no step asks for are where they were until
    /// [`Self::complete`].
    ///
    /// # Errors
    /// If a step fails after all retries; the state is then that after the last good step.
    pub fn go_to(&mut self, until: f64, mut pause: impl FnMut() -> bool) -> Result<Outcome, RunError> {
        self.is_complete = false;
        while self.goes_on(until) {
            self.one_step()?;
            if pause() {
                return Ok(Outcome::Paused);
            }
        }
        Ok(Outcome::Reached)
    }

    /// Whether there are steps left before time `until` [s]. What is left of a run that has come to the end of a stage is in the next, which begins here.
    fn goes_on(&mut self, until: f64) -> bool {
        let next = self.stages.get(self.current + 1);
        if self.grid.has_ended() && next.is_some_and(|next| next.grid.is_before(self.state.time, until)) {
            self.complete();
            self.is_complete = false;
            self.enter(self.current + 1);
            let gained = self.stages[self.current].begin(&mut self.state);
            self.begin_stage(&gained);
        }
        self.grid.goes_on(self.state.time, until)
    }

    /// Makes a stage the present one; its state is still that of another.
    pub(crate) fn enter(&mut self, stage: usize) {
        self.current = stage;
        let stage = &self.stages[stage];
        self.grid = stage.grid;
        self.halvings = 0;
        self.events.go_on(&stage.merge);
        self.work = stage.workspace().counting_on(&self.work);
    }

    /// Opens the books of a stage in which bodies begin with so much energy more [J]: the work of what gave them their velocity.
    fn begin_stage(&mut self, gained: &[f64]) {
        let Self { state, spare, accounts, books, history_rows, grid, stages, current, .. } = self;
        let mut account = Account::new(state.all_energies().collect());
        for (i, gain) in gained.iter().enumerate() {
            account.start[i].kinetic -= gain;
            for books in [&mut account.books, &mut *books] {
                books.bodies[i].external += gain;
                books.total.external += gain;
            }
        }
        for (books, start) in [(&mut account.books, &account.start), (&mut *books, &self.initial_energies)] {
            books.set_changes(start, state.all_energies());
        }
        accounts.push(account);
        *history_rows = grid.intervals(state.time, stages[*current].history_every);
        self.totals.max_energy = self.totals.max_energy.max(state.energies.total() + books.total.friction);
        spare.clone_from(state);
        self.last_step = None;
    }

    fn one_step(&mut self) -> Result<(), RunError> {
        compiled!(D, Simulation::make_one_step as MakeOneStep)(self)
    }

    fn make_one_step(&mut self) -> Result<(), RunError> {
        let (dt, end) = self.grid.next_step();
        let nominal = Nominal { end, dt, energy: self.totals.max_energy };
        let Self { stages, current, state, spare, work, halvings, .. } = self;
        let Self { events, history, books, accounts, totals, cross_checks, initial_energies, .. } = self;
        let Self { last_step, nominal_step, .. } = self;
        let Stage { model, method, history_every, .. } = &stages[*current];
        let account = &mut accounts[*current];
        let mut previous_time = state.time;
        let initial = initial_energies.iter().map(Energies::total).sum::<f64>();
        *nominal_step = NominalStep::default();
        let mut stepper = Stepper { model, method, state, spare, work, halvings, failed: 0 };
        let outcome = stepper.advance(nominal, |[before, state], report, work| {
            let names = |between| model.assembly.names(between);
            let whole = |solid| Whole::of(model, before, &books.bodies, solid);
            let arrived = |solid| Whole::of(model, state, &books.bodies, solid).centre;
            events.record(names, &work.pair_reports, [previous_time, state.time], whole, arrived);
            for books in [&mut *books, &mut account.books] {
                let pairs = work.pair_reports.iter().map(|(between, pair)| (between, pair.ledger));
                books.add(report.ledger, &work.body_ledgers, pairs);
            }
            books.set_changes(initial_energies, state.all_energies());
            account.note(report, state);
            *last_step = Some(report.ledger);
            nominal_step.note(report);
            history.observe(report, state, state.time - previous_time);
            report.cross_check.iter().for_each(|check| cross_checks.note(check, state.time));
            previous_time = state.time;
            totals.note(report, &state.energies, books, initial);
            totals.note_penetration(report, state, model, method, account.steps == 0);
        });
        let failed = stepper.failed;
        account.retried += failed;
        self.totals.retried += failed;
        self.history.since.retried += failed;
        outcome?;
        account.steps += 1;
        self.grid.step += 1;
        let due = self.grid.start_time + (self.history_rows as f64) * history_every;
        let ends_stage = self.grid.has_ended() && self.has_stages();
        if ends_stage || !self.grid.is_before(self.state.time, due) {
            self.record();
        }
        Ok(())
    }

    /// Records the last row of the history if it is not there yet.
    pub fn finish(&mut self) {
        if self.last_recorded != Some(self.state.time) {
            self.record();
        }
    }

    fn record(&mut self) {
        self.complete_tracked();
        let stage = &self.stages[self.current];
        let contacts = &self.work.iterating.contacts;
        let pairs = &stage.model.assembly.contact.pairs;
        let suspects = contacts.finder.suspects(pairs);
        let min_gap = self.history.record(
            &stage.model,
            &self.state,
            &self.books.total,
            self.current,
            suspects.as_deref(),
        );
        self.ledger_table.record(self.state.time, &self.books, pairs);
        self.totals.min_gap = self.totals.min_gap.min(min_gap);
        self.last_recorded = Some(self.state.time);
        // The next multiple of the interval after now.
        self.history_rows = self.grid.intervals(self.state.time, stage.history_every);
    }

    /// Names of the columns of the history.
    #[must_use]
    pub fn history_columns(&self) -> &[String] {
        self.history.columns()
    }

    /// The rows of the ledger recorded since the last call, one after the other: see [`LedgerTable`].
    pub fn take_ledger(&mut self) -> Vec<f64> {
        self.ledger_table.take()
    }

    /// The fields on the boundaries.
    #[must_use]
    pub fn surface_fields(&self) -> SurfaceFields {
        surface_fields(self.model(), &self.state)
    }

    /// The rows recorded since the last call, one after the other.
    pub fn take_history(&mut self) -> Vec<f64> {
        self.history.take()
    }

    /// A quick look.
    #[must_use]
    pub fn progress(&self) -> Progress {
        let e = self.state.energies;
        Progress {
            step: self.step(),
            time: self.state.time,
            contacts: self.totals.contacts,
            retried: self.totals.retried,
            kinetic: e.kinetic,
            strain: e.strain,
            springs: e.springs,
            friction: self.books.total.friction,
            total: e.total(),
        }
    }

    /// The fields of the present state.
    #[must_use]
    pub fn fields(&self) -> Fields<'_, D> {
        let (s, nodes) = (&self.state, self.model().node_count());
        Fields {
            displacement: &s.displacement[..nodes],
            velocity: &s.velocity[..nodes],
            reaction: &s.contact_force[..nodes],
            cells: self
                .model()
                .bodies
                .iter()
                .zip(&s.history)
                .flat_map(|(b, history)| {
                    let u = &s.displacement[b.nodes()];
                    if let Some(reduced) = &b.reduced {
                        return reduced.cell_states(&b.body, u);
                    }
                    b.body.after(history).grown(b.growth_at(s.time)).cell_states(u)
                })
                .collect(),
        }
    }
}
