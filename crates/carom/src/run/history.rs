use carom_contact::{Gauge, KnownGaps, Pair};
use carom_fem::KineticParts;
use carom_mesh::Vector;

use crate::run::stage::Stage;
use crate::scenario::Axis;
use crate::step::report::StepReport;
use crate::{Ledger, Model, State};

/// What kinetic energy is split into: see [`KineticParts`].
const PARTS: [&str; 3] = ["translation", "rotation", "vibration"];

/// How far behind a facet nodes are found, in facets.
const SEARCHED: f64 = 0.5;

/// What is added to the depth that a step has measured before nothing is thought to be deeper, in sizes of the largest body.
const DEEPER: f64 = 0.01;

/// A node whose motion is in the history.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Track {
    pub name: String,
    pub node: usize,
}

/// Where a tracked node was and how fast it moved on average in the last step.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Trail<const D: usize> {
    pub displacement: Vector<D>,
    pub mean_velocity: Vector<D>,
}

/// Rows of numbers over time, recorded natively.
#[derive(Debug)]
pub(crate) struct History<const D: usize> {
    tracks: Vec<Track>,
    /// Whether rows say which stage they are of.
    has_stages: bool,
    /// Whether they say how far friction is from its laws.
    has_laws: bool,
    /// Whether they say how many contacts hold together.
    holds: bool,
    /// Names of the supports of all stages.
    supports: Vec<String>,
    pub trails: Vec<Trail<D>>,
    columns: Vec<String>,
    pub rows: Vec<f64>,
    pub since: Since,
    /// The kinetic energies of the bodies of the row that is being written, by [`PARTS`].
    parts: Vec<[f64; 3]>,
    gauge: Gauge<D>,
}

/// What is gathered between two rows.
#[derive(Debug, Default)]
pub(crate) struct Since {
    pub steps: usize,
    pub iterations: usize,
    /// Steps that failed and were taken again in halves.
    pub retried: u64,
    /// Length of the shortest step [s]; zero without steps.
    pub shortest_step: f64,
    pub certificate: f64,
    pub residual: f64,
    pub blend: f64,
    pub step_defect: f64,
    pub friction_defect: f64,
    /// Of the last step alone, like the next two.
    pub contacts: usize,
    pub min_gap: f64,
    /// Largest of the steps.
    pub penetration: f64,
    pub normal_force: f64,
}

impl<const D: usize> History<D> {
    /// A history of a run in these `stages` that starts from `state`.
    pub fn new(stages: &[Stage<D>], state: &State<D>, tracks: Vec<Track>) -> Self {
        let axes = &Axis::NAMES[..D];
        let (model, has_stages) = (&stages[0].model, !stages[0].name.is_empty());
        let mut supports: Vec<String> = Vec::new();
        for motion in stages.iter().flat_map(|stage| &stage.model.motions) {
            if !supports.contains(&motion.name) {
                supports.push(motion.name.clone());
            }
        }
        let mut columns = vec!["time".to_string()];
        columns.extend(has_stages.then(|| "stage".to_string()));
        columns.extend(Ledger::NAMES.iter().chain(&["total", "defect"]).map(|name| name.to_string()));
        columns.extend(axes.iter().map(|a| format!("momentum_{a}")));
        if D == 2 {
            columns.push("angular_momentum".to_string());
        } else {
            columns.extend(axes.iter().map(|a| format!("angular_momentum_{a}")));
        }
        columns.extend(PARTS.map(String::from));
        for b in &model.bodies {
            columns.extend(axes.iter().map(|a| format!("{}.{a}", b.name)));
            columns.extend(axes.iter().map(|a| format!("{}.v_{a}", b.name)));
            if D == 2 {
                columns.push(format!("{}.spin", b.name));
            } else {
                columns.extend(axes.iter().map(|a| format!("{}.spin_{a}", b.name)));
            }
            columns.extend(PARTS.iter().chain(&["strain"]).map(|part| format!("{}.{part}", b.name)));
        }
        columns.extend(
            [
                "contacts",
                "min_gap",
                "penetration",
                "normal_force",
                "newton_iterations",
                "retried_steps",
                "shortest_step",
                "certificate",
                "residual",
                "blend",
                "step_defect",
            ]
            .map(String::from),
        );
        let has_laws = stages.iter().any(|stage| !stage.model.assembly.friction_laws.is_empty());
        columns.extend(has_laws.then(|| "friction_defect".to_string()));
        for name in &supports {
            columns.extend(axes.iter().map(|a| format!("{name}.force_{a}")));
        }
        for t in &tracks {
            for quantity in ["u", "v", "vmid"] {
                columns.extend(axes.iter().map(|a| format!("{}.{quantity}_{a}", t.name)));
            }
        }
        for spring in &model.assembly.springs {
            columns.extend(["length", "force"].map(|quantity| format!("{}.{quantity}", spring.name)));
        }
        let holds = stages.iter().any(|stage| !stage.model.assembly.cohesions.are_none());
        columns.extend(holds.then(|| "holding".to_string()));
        let (trails, rows) = (Vec::new(), Vec::new());
        let (parts, since, gauge) = (Vec::new(), Since::default(), Gauge::default());
        let mut history = Self {
            trails,
            tracks,
            has_stages,
            has_laws,
            holds,
            supports,
            columns,
            rows,
            since,
            parts,
            gauge,
        };
        history.restart(state);
        history
    }

    /// Forgets what was recorded and starts again from `state`.
    pub fn restart(&mut self, state: &State<D>) {
        self.rows.clear();
        self.since = Since::default();
        self.trails = self
            .tracks
            .iter()
            .map(|t| Trail {
                displacement: state.displacement[t.node],
                mean_velocity: state.velocity[t.node],
            })
            .collect();
    }

    pub fn columns(&self) -> &[String] {
        &self.columns
    }

    /// Hands over the rows recorded so far, one after the other.
    pub fn take(&mut self) -> Vec<f64> {
        std::mem::take(&mut self.rows)
    }

    /// Notes a step of length `dt` [s] that ended in `state` for the next row.
    pub fn observe(&mut self, report: &StepReport, state: &State<D>, dt: f64) {
        let since = &mut self.since;
        // The steps of a bridge stand still in the time of loads.
        if dt > 0.0 {
            since.shortest_step = if since.shortest_step == 0.0 { dt } else { since.shortest_step.min(dt) };
        }
        since.steps += 1;
        since.iterations += report.newton_iterations;
        since.certificate = since.certificate.max(report.certificate);
        since.residual = since.residual.max(report.residual);
        since.blend = since.blend.max(report.blend);
        since.step_defect = since.step_defect.max(report.ledger.defect().abs());
        since.friction_defect = since.friction_defect.max(report.friction_defect);
        since.contacts = report.contacts;
        since.min_gap = report.min_gap;
        since.penetration = since.penetration.max(report.penetration.depth);
        since.normal_force = report.normal_force;
        for (trail, t) in self.trails.iter_mut().zip(&self.tracks) {
            let u = state.displacement[t.node];
            // A stabilised load step comes to rest in no time.
            let per_time = if dt > 0.0 { dt.recip() } else { 0.0 };
            *trail = Trail { displacement: u, mean_velocity: (u - trail.displacement) * per_time };
        }
    }

    /// Writes a row of stage number `stage`, from 0; returns the smallest gap of all pairs [m]. `suspects` are the nodes that the last step may have left inside of
    /// something, each with its pair, if it has looked for them.
    pub fn record(
        &mut self,
        model: &Model<D>,
        state: &State<D>,
        ledger: &Ledger,
        stage: usize,
        suspects: Option<&[(u32, u32)]>,
    ) -> f64 {
        let e = &state.energies;
        self.rows.push(state.time);
        self.rows.extend(self.has_stages.then_some(stage as f64 + 1.0));
        self.rows.extend(ledger.with_energies(e).terms_mut().map(|term| *term));
        self.rows.extend([e.total(), ledger.defect()]);
        let mut momentum = Vector::<D>::zeros();
        let mut moment = [0.0; 3];
        let mut all = [0.0; 3];
        self.parts.clear();
        for (b, energies) in model.bodies.iter().zip(&state.body_energies) {
            let (u, v) = (&state.displacement[b.nodes()], &state.velocity[b.nodes()]);
            let own = b.momenta(u, v, energies.kinetic);
            momentum += own.momentum;
            let KineticParts { translation, rotation, vibration } = own.kinetic;
            let parts = [translation, rotation, vibration];
            for i in 0..3 {
                moment[i] += own.angular_momentum[i];
                all[i] += parts[i];
            }
            self.parts.push(parts);
        }
        self.rows.extend(momentum.iter());
        self.rows.extend(rotational::<D>(&moment));
        self.rows.extend(all);
        for ((b, energies), parts) in model.bodies.iter().zip(&state.body_energies).zip(&self.parts) {
            let (u, v) = (&state.displacement[b.nodes()], &state.velocity[b.nodes()]);
            let [centre, drift, spin] = b.drift(u, v);
            self.rows.extend(&centre[..D]);
            self.rows.extend(&drift[..D]);
            self.rows.extend(rotational::<D>(&spin));
            self.rows.extend(parts);
            self.rows.push(energies.strain);
        }
        let since = std::mem::take(&mut self.since);
        let at = |n: u32| model.assembly.reference[n as usize] + state.displacement[n as usize];
        // A static analysis applies what is there at t = 0 in its first step.
        let most = if state.time > 0.0 { f64::INFINITY } else { 0.0 };
        let interferences = &model.assembly.interferences;
        let least = |p: &Pair| interferences.of(p.between()).least(state.time).min(most);
        let at_most = interferences.all().map(|i| i.least(state.time).min(most)).fold(0.0, f64::max);
        // Nodes deep between others are closest to a side; the contacts know what they face.
        let known = if since.steps > 0 { since.min_gap } else { f64::INFINITY };
        let deepest = deepest(model, &since);
        let suspects = suspects.filter(|_| is_shallow(model, &since));
        let gaps = KnownGaps { least, most: at_most, known, deepest, suspects };
        let min_gap = self.gauge.smallest_gap(&model.assembly.contact, &gaps, &at);
        self.rows.extend([
            since.contacts as f64,
            min_gap,
            since.penetration,
            since.normal_force,
            if since.steps > 0 { since.iterations as f64 / since.steps as f64 } else { 0.0 },
            since.retried as f64,
            since.shortest_step,
            since.certificate,
            since.residual,
            since.blend,
            since.step_defect,
        ]);
        self.rows.extend(self.has_laws.then_some(since.friction_defect));
        // A support that is not there in this stage presses on nothing.
        for name in &self.supports {
            let motion = model.motions.iter().position(|motion| motion.name == *name);
            let force = motion.map_or_else(Vector::zeros, |k| state.support[k]);
            self.rows.extend(force.iter());
        }
        for (t, trail) in self.tracks.iter().zip(&self.trails) {
            self.rows.extend(state.displacement[t.node].iter());
            self.rows.extend(state.velocity[t.node].iter());
            self.rows.extend(trail.mean_velocity.iter());
        }
        for spring in &model.assembly.springs {
            self.rows.extend(spring.length_and_tension(&state.displacement, &state.velocity));
        }
        self.rows.extend(self.holds.then(|| state.holding().count() as f64));
        min_gap
    }
}

/// How deep a node may be inside anything at the end of the last step at most [m], as that has measured; infinite if it has not.
fn deepest<const D: usize>(model: &Model<D>, since: &Since) -> f64 {
    let assembly = &model.assembly;
    if since.steps == 0 || !assembly.interferences.are_none() {
        return f64::INFINITY;
    }
    // Arcs of targets are in front of the facets that depth is measured from, and further when these are bent; the rest is for round-off.
    let arcs = (0..assembly.body_count()).map(|i| assembly.boundaries.largest_arc(i)).fold(0.0, f64::max);
    since.penetration + 2.0 * arcs + DEEPER * assembly.size
}

/// Whether all that is inside something at the end of the last step is in front of the middle of the facets, where a search has found it.
fn is_shallow<const D: usize>(model: &Model<D>, since: &Since) -> bool {
    let assembly = &model.assembly;
    let sizes = |i: usize| (assembly.boundaries.least_cell(i), assembly.boundaries.largest_arc(i));
    let (cell, arc) = (0..assembly.body_count())
        .map(sizes)
        .fold((f64::INFINITY, 0.0_f64), |(cell, arc), own| (cell.min(own.0), arc.max(own.1)));
    since.steps > 0 && assembly.interferences.are_none() && since.penetration + 2.0 * arc < SEARCHED * cell
}

/// The components of a rotational quantity that exist in D dimensions: z in 2D, all in 3D.
fn rotational<const D: usize>(v: &[f64; 3]) -> &[f64] {
    if D == 2 { &v[2..] } else { v }
}
