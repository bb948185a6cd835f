use std::time::Duration;

use carom_fem::CellState;
use carom_mesh::Vector;
use serde::Serialize;

use crate::build::{Meshes, build};
use crate::cross_check::CrossCheckSummary;
use crate::describe::{Description, describe};
use crate::error::{InputError, RunError};
use crate::events::{ContactEvent, EventLog};
use crate::history::{History, Track};
use crate::ledger_table::LedgerTable;
use crate::model::Group;
use crate::scenario::{Scenario, TrackEntry};
use crate::step_control::advance_nominal_step;
use crate::surface_fields::{SurfaceFields, surface_fields};
use crate::workspace::{PosedProblem, Workspace};
use crate::{BodyLedger, Books, Energies, Ledger, Method, Model, PairLedger, State};

/// How [`Simulation::advance`] ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// The time asked for is reached.
    Reached,
    /// The caller asked for a pause.
    Paused,
}

/// The most steps a run may have; more is a slip of units.
const MAX_STEPS: f64 = 1e10;

/// A run: the model, its state, and the books.
pub struct Simulation<const D: usize> {
    model: Model<D>,
    method: Method<D>,
    state: State<D>,
    spare: State<D>,
    work: Workspace<D>,
    description: Description,
    time_step: f64,
    end_time: f64,
    steps: u64,
    step: u64,
    /// How often the steps of a static analysis are halved at present.
    halvings: u32,
    history_every: f64,
    history_rows: u64,
    last_recorded: Option<f64>,
    history: History<D>,
    events: EventLog,
    initial_energies: Vec<Energies>,
    books: Books,
    ledger_table: LedgerTable,
    totals: Totals,
    cross_checks: CrossCheckSummary,
    last_step: Option<Ledger>,
}

/// A step as its two states.
#[derive(Debug, Clone, Copy)]
pub struct StepPair<'a, const D: usize> {
    /// The state that it started from.
    pub start: &'a State<D>,
    /// The state that it ended in.
    pub end: &'a State<D>,
    /// Blend α of start and end stresses of every body.
    pub blend: &'a [f64],
    /// What the step says of the energy.
    pub ledger: Ledger,
}

/// Extremes and counts over the run.
#[derive(Debug, Clone, Copy)]
struct Totals {
    newton_iterations: u64,
    retried: u64,
    contacts: usize,
    max_drift: f64,
    max_defect: f64,
    max_step_defect: f64,
    /// Largest energy that was there or went into friction: what the certificate is measured by.
    max_energy: f64,
    max_certificate: f64,
    max_residual: f64,
    max_blend: f64,
    least_friction: f64,
    min_gap: f64,
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
    /// Kinetic energy [J].
    pub kinetic: f64,
    /// Strain energy [J].
    pub strain: f64,
    /// Dissipated by friction since the start [J].
    pub friction: f64,
    /// Kinetic plus strain energy [J].
    pub total: f64,
}

/// Energies of a run [J].
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct EnergySummary {
    /// Total at the start.
    pub initial: f64,
    /// Total now.
    #[serde(rename = "final")]
    pub last: f64,
    /// Kinetic energy now.
    pub kinetic: f64,
    /// Strain energy now.
    pub strain: f64,
    /// Dissipated by friction.
    pub friction: f64,
    /// Dissipated by damping and viscosity.
    pub viscous: f64,
    /// Plastic work.
    pub plastic: f64,
    /// Dissipated by the time scheme.
    pub scheme: f64,
    /// Taken by normal reactions.
    pub normal_contact: f64,
    /// Work of obstacles that move.
    pub prescribed: f64,
    /// Work of gravity and loads.
    pub external: f64,
    /// Largest |E(t) − E(0)|.
    pub max_drift: f64,
    /// Largest |defect| of the ledger.
    pub max_defect: f64,
    /// Largest |defect| of a single step.
    pub max_step_defect: f64,
}

/// How far the run was from Coulomb's law.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct CertificateSummary {
    /// Largest Σ of bi-potential gaps of a step [J].
    pub max_joule: f64,
    /// Largest residual of the contact laws.
    pub max_residual: f64,
    /// The largest Σ that a completed run may have [J]: the tolerance of the method times the largest energy of the run.
    pub tolerance_joule: f64,
}

/// The books of a body at the end.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct BodySummary {
    /// Name.
    pub name: String,
    /// What happened to its energy.
    #[serde(flatten)]
    pub ledger: BodyLedger,
    /// What its terms do not explain [J].
    pub defect: f64,
}

impl BodySummary {
    fn new(name: &str, ledger: &BodyLedger) -> Self {
        Self { name: name.to_string(), ledger: *ledger, defect: ledger.defect() }
    }
}

/// The books of a pair at the end.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PairSummary {
    /// The two names.
    pub between: [String; 2],
    /// What it did to the energy.
    #[serde(flatten)]
    pub ledger: PairLedger,
}

impl PairSummary {
    fn new(group: &Group, ledger: &PairLedger) -> Self {
        Self { between: group.between.clone(), ledger: *ledger }
    }
}

/// The native part of summary.json.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Summary {
    /// Nominal steps done.
    pub steps: u64,
    /// Unknown displacements.
    pub dofs: usize,
    /// Time reached [s].
    pub end_time: f64,
    /// Length of a nominal step [s].
    pub time_step: f64,
    /// Newton iterations.
    pub newton_iterations: u64,
    /// Factorisations of iteration matrices.
    pub factorisations: u64,
    /// Steps or substeps that failed and were halved.
    pub retried_steps: u64,
    /// Energies.
    pub energy: EnergySummary,
    /// Distance from Coulomb's law.
    pub certificate: CertificateSummary,
    /// The books of every body.
    pub bodies: Vec<BodySummary>,
    /// The books of every pair that may touch.
    pub pairs: Vec<PairSummary>,
    /// Largest blend |α| of start and end stresses; 0 unless massless contacts conserve.
    pub max_blend: f64,
    /// Smallest dissipation by friction of a contact in a step [J]; never negative by more than round-off.
    pub least_friction: f64,
    /// Smallest gap seen [m].
    pub min_gap: f64,
    /// What a second solver said of the contact problems, if it was asked.
    pub cross_check: Option<CrossCheckSummary>,
    /// Contact events.
    pub contacts: Vec<ContactEvent>,
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

impl<const D: usize> Simulation<D> {
    /// Builds a run from its scenario, which generates all its meshes.
    ///
    /// # Errors
    /// If the scenario cannot be run; see [`build`].
    pub fn new(scenario: &Scenario) -> Result<Self, InputError> {
        Self::with_meshes(scenario, Meshes::new())
    }

    /// Builds a run from its scenario and the `meshes` that it takes from files.
    ///
    /// # Errors
    /// If the scenario cannot be run; see [`build`].
    pub fn with_meshes(scenario: &Scenario, meshes: Meshes<D>) -> Result<Self, InputError> {
        let (model, method, state) = build(scenario, meshes)?;
        let mut tracks = Vec::new();
        for (i, entry) in scenario.output.track.iter().enumerate() {
            tracks.push(track(&model, i, entry)?);
        }
        let (dt, end) = (scenario.analysis.time_step, scenario.analysis.end_time);
        for (key, every) in [
            ("output.history_every", scenario.output.history_every),
            ("output.fields_every", scenario.output.fields_every),
        ] {
            if !(every.is_finite() && every > 0.0) {
                return Err(InputError::new(key, format!("{every}: the interval must be greater than 0 s")));
            }
        }
        if end / dt > MAX_STEPS {
            let message =
                format!("{dt}: the run would have {:.1e} steps, more than {MAX_STEPS:.0e}", end / dt);
            return Err(InputError::new("analysis.time_step", message));
        }
        // A last step shorter than this fraction of the others would only be round-off of end_time/time_step.
        let steps = (end / dt - 1e-6).ceil().max(1.0) as u64;
        let work = Workspace::new(&model).map_err(|e| InputError::new("bodies", e.to_string()))?;
        let mut simulation = Self {
            description: describe(&scenario.title, &model, &state, steps),
            events: EventLog::new(&model, scenario.output.merge_contacts),
            history: History::new(&model, &state, tracks),
            spare: state.clone(),
            time_step: dt,
            end_time: end,
            steps,
            step: 0,
            halvings: 0,
            history_every: scenario.output.history_every,
            history_rows: 0,
            last_recorded: None,
            initial_energies: state.body_energies.clone(),
            books: Books::new(model.bodies.len(), model.groups.len()),
            ledger_table: LedgerTable::default(),
            totals: Totals {
                newton_iterations: 0,
                retried: 0,
                contacts: 0,
                max_drift: 0.0,
                max_defect: 0.0,
                max_step_defect: 0.0,
                max_energy: state.energies.total(),
                max_certificate: 0.0,
                max_residual: 0.0,
                max_blend: 0.0,
                least_friction: 0.0,
                min_gap: f64::INFINITY,
            },
            cross_checks: CrossCheckSummary::default(),
            last_step: None,
            model,
            method,
            state,
            work,
        };
        simulation.record();
        Ok(simulation)
    }
}

/// The node of a body nearest to a tracked point.
fn track<const D: usize>(model: &Model<D>, index: usize, entry: &TrackEntry) -> Result<Track, InputError> {
    let key = format!("output.track.{index}");
    let body = model.bodies.iter().find(|b| b.name == entry.body).ok_or_else(|| {
        let known: Vec<&str> = model.bodies.iter().map(|b| b.name.as_str()).collect();
        InputError::new(
            format!("{key}.body"),
            format!("there is no body {:?}; known are {known:?}", entry.body),
        )
    })?;
    if entry.point.len() != D || !entry.point.iter().all(|x| x.is_finite()) {
        return Err(InputError::new(
            format!("{key}.point"),
            format!("{:?} must be {D} finite numbers", entry.point),
        ));
    }
    let point = Vector::from_column_slice(&entry.point);
    let distance = |n: &usize| (model.reference[*n] - point).norm();
    let nearest = body.nodes().min_by(|a, b| distance(a).total_cmp(&distance(b)));
    match nearest {
        Some(node) if distance(&node) <= 0.25 * body.body.mesh().diameter() => {
            Ok(Track { name: entry.name.clone(), node })
        }
        _ => Err(InputError::new(
            format!("{key}.point"),
            format!(
                "{:?} is far from body {:?}; give a point of it in the reference configuration",
                entry.point, entry.body
            ),
        )),
    }
}

impl<const D: usize> Simulation<D> {
    /// What is run.
    #[must_use]
    pub fn description(&self) -> &Description {
        &self.description
    }

    /// The model.
    #[must_use]
    pub fn model(&self) -> &Model<D> {
        &self.model
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
        Some(StepPair { start: &self.spare, end: &self.state, blend: self.work.blend_weights(), ledger })
    }

    /// Overwrites the velocities [m/s], one per node: initial conditions that no scenario describes. Only before the first step.
    ///
    /// # Panics
    /// If steps were made already or the number of nodes is not that of the model.
    pub fn set_initial_velocity(&mut self, velocity: Vec<Vector<D>>) {
        assert_eq!(self.step, 0, "initial velocities belong before the first step");
        self.state = State::initial(&self.model, velocity);
        self.initial_energies.clone_from(&self.state.body_energies);
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
        self.step
    }

    /// Nominal steps of the whole run.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.steps
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

    /// Newton iterations made so far.
    #[must_use]
    pub fn newton_iterations(&self) -> u64 {
        self.totals.newton_iterations
    }

    /// Time spent in the friction solver so far.
    #[must_use]
    pub fn friction_time(&self) -> Duration {
        self.work.friction_time
    }

    /// The books since the start.
    #[must_use]
    pub fn books(&self) -> &Books {
        &self.books
    }

    /// Runs until time `until` [s] (the end of the run at most), or until `pause`, asked after every step, says so.
    ///
    /// # Errors
    /// If a step fails after all retries; the state is then that after the last good step.
    pub fn advance(&mut self, until: f64, mut pause: impl FnMut() -> bool) -> Result<Outcome, RunError> {
        while self.step < self.steps && self.state.time < until - 1e-6 * self.time_step {
            self.one_step()?;
            if pause() {
                return Ok(Outcome::Paused);
            }
        }
        Ok(Outcome::Reached)
    }

    fn one_step(&mut self) -> Result<(), RunError> {
        // Times are multiples of the step, not sums, so that they do not drift; all steps but a shorter last one have the very
        // same length, so that they share their factors.
        let start = self.step as f64 * self.time_step;
        let rest = self.end_time - start;
        let length = if rest < (1.0 - 1e-6) * self.time_step { rest } else { self.time_step };
        let last = self.step + 1 == self.steps;
        let end = if last { self.end_time } else { (self.step + 1) as f64 * self.time_step };
        let Self {
            model,
            method,
            state,
            spare,
            work,
            events,
            history,
            books,
            totals,
            cross_checks,
            initial_energies,
            last_step,
            halvings,
            ..
        } = self;
        let mut previous_time = state.time;
        let initial = initial_energies.iter().map(Energies::total).sum::<f64>();
        let mut failed = 0;
        let outcome = advance_nominal_step(
            model,
            method,
            state,
            spare,
            end,
            length,
            work,
            &mut failed,
            halvings,
            |state, report, work| {
                books.add(report.ledger, &work.bodies, work.groups.iter().map(|g| g.ledger));
                books.set_changes(initial_energies, &state.body_energies);
                *last_step = Some(report.ledger);
                events.record(&model.groups, &work.groups, previous_time, state.time);
                history.observe(report, state, state.time - previous_time);
                report.cross_check.iter().for_each(|check| cross_checks.note(check, state.time));
                previous_time = state.time;
                totals.newton_iterations += report.newton_iterations as u64;
                totals.contacts = report.contacts;
                totals.max_drift = totals.max_drift.max((state.energies.total() - initial).abs());
                totals.max_defect = totals.max_defect.max(books.total.defect().abs());
                totals.max_step_defect = totals.max_step_defect.max(report.ledger.defect().abs());
                totals.max_energy = totals.max_energy.max(state.energies.total() + books.total.friction);
                totals.max_certificate = totals.max_certificate.max(report.certificate);
                totals.max_residual = totals.max_residual.max(report.residual);
                totals.max_blend = totals.max_blend.max(report.blend);
                totals.least_friction = totals.least_friction.min(report.least_friction);
                totals.min_gap = totals.min_gap.min(report.min_gap);
            },
        );
        self.totals.retried += failed;
        outcome?;
        self.step += 1;
        let due = (self.history_rows as f64) * self.history_every;
        if self.state.time >= due - 1e-6 * self.time_step {
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
        let min_gap = self.history.record(&self.model, &self.state, &self.books.total);
        self.ledger_table.record(self.state.time, &self.books);
        self.totals.min_gap = self.totals.min_gap.min(min_gap);
        self.last_recorded = Some(self.state.time);
        // The next multiple of the interval after now.
        self.history_rows =
            ((self.state.time + 1e-6 * self.time_step) / self.history_every).floor() as u64 + 1;
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
        surface_fields(&self.model, &self.state)
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
            step: self.step,
            time: self.state.time,
            contacts: self.totals.contacts,
            kinetic: e.kinetic,
            strain: e.strain,
            friction: self.books.total.friction,
            total: e.total(),
        }
    }

    /// The fields of the present state.
    #[must_use]
    pub fn fields(&self) -> Fields<'_, D> {
        let (s, nodes) = (&self.state, self.model.node_count());
        Fields {
            displacement: &s.displacement[..nodes],
            velocity: &s.velocity[..nodes],
            reaction: &s.contact_force[..nodes],
            cells: self
                .model
                .bodies
                .iter()
                .zip(&s.history)
                .flat_map(|(b, history)| b.body.after(history).cell_states(&s.displacement[b.nodes()]))
                .collect(),
        }
    }

    /// The summary so far.
    #[must_use]
    pub fn summary(&self) -> Summary {
        let (e, t, l) = (self.state.energies, &self.totals, &self.books.total);
        Summary {
            steps: self.step,
            dofs: self.model.dofs(),
            end_time: self.state.time,
            time_step: self.time_step,
            newton_iterations: t.newton_iterations,
            factorisations: self.work.factorisations,
            retried_steps: t.retried,
            energy: EnergySummary {
                initial: self.initial_energies.iter().map(Energies::total).sum(),
                last: e.total(),
                kinetic: e.kinetic,
                strain: e.strain,
                friction: l.friction,
                viscous: l.viscous,
                plastic: l.plastic,
                scheme: l.scheme,
                normal_contact: l.normal_contact,
                prescribed: l.prescribed,
                external: l.external,
                max_drift: t.max_drift,
                max_defect: t.max_defect,
                max_step_defect: t.max_step_defect,
            },
            certificate: CertificateSummary {
                max_joule: t.max_certificate,
                max_residual: t.max_residual,
                tolerance_joule: self.method.certificate_tolerance * t.max_energy,
            },
            bodies: self
                .model
                .bodies
                .iter()
                .zip(&self.books.bodies)
                .map(|(b, l)| BodySummary::new(&b.name, l))
                .collect(),
            pairs: self
                .model
                .groups
                .iter()
                .zip(&self.books.pairs)
                .map(|(g, l)| PairSummary::new(g, l))
                .collect(),
            max_blend: t.max_blend,
            least_friction: t.least_friction,
            min_gap: t.min_gap,
            cross_check: self.method.cross_check.then(|| self.cross_checks.clone()),
            contacts: self.events.events(self.state.time),
        }
    }
}
