//! What came out of a run, in a page.

use carom_contact::Solid;
use serde::Serialize;

use crate::contact::cross_check::CrossCheckSummary;
use crate::model::assembly::Assembly;
use crate::run::account::Account;
use crate::run::crushed::Crushed;
use crate::run::events::ContactEvent;
use crate::run::stage::Stage;
use crate::run::totals::Worst;
use crate::step::report::Inside;
use crate::{BodyLedger, Books, Energies, Ledger, PairLedger, Simulation};

/// Energies of a run [J].
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct EnergySummary {
    /// Total at the start.
    pub initial: f64,
    /// Total now.
    #[serde(rename = "final")]
    pub last: f64,
    /// The energies now, and the terms of the ledger since the start.
    #[serde(flatten)]
    pub terms: Ledger,
    /// Largest |E(t) − E(0)|.
    pub max_drift: f64,
    /// Largest |defect| of the ledger.
    pub max_defect: f64,
    /// Largest |defect| of a single step.
    pub max_step_defect: f64,
}

impl EnergySummary {
    fn of_stage(account: &Account) -> Self {
        let sum = |energies: &[Energies]| energies.iter().copied().sum::<Energies>();
        let end = sum(&account.end);
        Self {
            initial: sum(&account.start).total(),
            last: end.total(),
            terms: account.books.total.with_energies(&end),
            max_drift: account.max_drift,
            max_defect: account.max_defect,
            max_step_defect: account.max_step_defect,
        }
    }
}

/// How far the run was from Coulomb's law.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct CertificateSummary {
    /// Largest Σ of bi-potential gaps of a step [J].
    pub max_joule: f64,
    /// The part of it that the solver of the contact problem left [J]; the rest is what Newton's iterations left.
    pub solver_joule: f64,
    /// Largest residual of the contact laws.
    pub max_residual: f64,
    /// What it is measured by [J]: the largest energy of the run or, where that is more, the largest work Σ |r·q|. That is the work of the
    /// reactions of a step over the motion that they prevent.
    pub reference_joule: f64,
    /// The largest Σ that a completed run may have [J]: the tolerance of the method times this reference.
    pub tolerance_joule: f64,
}

/// How deep solids that may touch were in one another, or bodies in themselves.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct PenetrationSummary {
    /// The largest depth at the end of a step [m].
    pub max_depth: f64,
    /// Where it was worst in terms of what is allowed; none if nothing was ever inside anything.
    pub worst: Option<WorstPenetration>,
}

/// A place where two solids were inside one another.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WorstPenetration {
    /// The two names; twice the same of a body in itself.
    pub between: [String; 2],
    /// How deep [m].
    pub depth: f64,
    /// How deep a completed run may have it there [m]: the tolerance of the method times the cell, the height of the
    /// arcs that the facets there stand for, and what the contact condition lets in.
    pub allowed: f64,
    /// Diameter of the smaller facet there [m].
    pub cell: f64,
    /// When [s].
    pub time: f64,
    /// Where [m]; the third coordinate is zero in the plane.
    pub at: [f64; 3],
    /// What may be behind it, where it is more than is allowed.
    pub crushed: Option<Crushed>,
}

/// A motion of a body that neither supports nor contacts resist, that next to nothing drives, and that static steps left undone.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FreeMotionSummary {
    /// Name of the body.
    pub body: String,
    /// The motion in words, such as "turn about z".
    pub motion: String,
    /// What drives it, in terms of the sum of all reactions: the largest of the run.
    pub driving: f64,
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
    /// Contacts of the pair that are closer than this are one [s].
    pub merge_contacts: f64,
    /// What it did to the energy.
    #[serde(flatten)]
    pub ledger: PairLedger,
}

/// The native part of summary.json.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Summary {
    /// Nominal steps done.
    pub steps: u64,
    /// Unknown displacements.
    pub dofs: usize,
    /// Diameter of the largest body [m].
    pub size: f64,
    /// Time reached [s].
    pub end_time: f64,
    /// Length of a nominal step [s].
    pub time_step: f64,
    /// Newton iterations.
    pub newton_iterations: u64,
    /// Factorisations of iteration matrices, and polynomials made in their place.
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
    /// What blends left over and vibrations took or gave [J], without its sign.
    pub repaid: f64,
    /// Smallest dissipation by friction of a contact in a step [J]; never negative by more than round-off.
    pub least_friction: f64,
    /// Smallest gap seen [m].
    pub min_gap: f64,
    /// How deep solids were in one another.
    pub penetration: PenetrationSummary,
    /// The motion that static steps left undone, if they did.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub free_motion: Option<FreeMotionSummary>,
    /// What a second solver said of the contact problems, if it was asked.
    pub cross_check: Option<CrossCheckSummary>,
    /// Contact events.
    pub contacts: Vec<ContactEvent>,
    /// What came out of each stage that has begun; none of a case that has no stages.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub stages: Vec<StageSummary>,
}

/// What came out of a stage.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StageSummary {
    /// Name.
    pub name: String,
    /// When it started [s].
    pub start_time: f64,
    /// Time reached [s].
    pub end_time: f64,
    /// Length of a nominal step [s].
    pub time_step: f64,
    /// Nominal steps done.
    pub steps: u64,
    /// Newton iterations.
    pub newton_iterations: u64,
    /// Steps or substeps that failed and were halved.
    pub retried_steps: u64,
    /// Its own books.
    pub energy: EnergySummary,
    /// Those of every body.
    pub bodies: Vec<BodySummary>,
    /// Those of every pair that may touch.
    pub pairs: Vec<PairSummary>,
}

impl<const D: usize> Simulation<D> {
    fn free_motion(&self) -> Option<FreeMotionSummary> {
        let found = self.totals.free_motion?;
        let body = self.model().assembly.name(found.body).to_string();
        Some(FreeMotionSummary { body, motion: found.in_words::<D>(), driving: found.driving })
    }

    fn penetration(&self) -> PenetrationSummary {
        let worst = self.totals.worst_penetration.map(|Worst { inside, allowed, time, crushed }| {
            let Inside { between, depth, cell, at, .. } = inside;
            let between = between.map(|solid| self.model().assembly.solid_name(solid).to_string());
            let crushed = crushed.map(|cells| cells.of(self.model()));
            WorstPenetration { between, depth, allowed, cell, time, at, crushed }
        });
        PenetrationSummary { max_depth: self.totals.max_penetration, worst }
    }

    /// The books of every body.
    fn bodies(&self, books: &Books) -> Vec<BodySummary> {
        let bodies = self.model().bodies.iter().zip(&books.bodies);
        bodies.map(|(b, ledger)| BodySummary::new(&b.name, ledger)).collect()
    }

    /// The books of every pair that may touch, as they are in a stage.
    fn pairs(&self, books: &Books, stage: &Stage<D>) -> Vec<PairSummary> {
        let Assembly { contact, .. } = &stage.model.assembly;
        let summary = |between: [Solid; 2], ledger: PairLedger| PairSummary {
            between: stage.model.assembly.names(between),
            merge_contacts: stage.merge.of(between),
            ledger,
        };
        // Every body may touch itself; few do. Of many pairs most never meet.
        if contact.pairs.are_many() {
            let touched = books.pairs.iter().filter(|(_, ledger)| ledger.has_touched);
            return touched.map(|(between, ledger)| summary(between, *ledger)).collect();
        }
        let all = contact.pairs.between();
        let ledgers = all.map(|between| (between, books.pairs.get(between).copied().unwrap_or_default()));
        let told = ledgers.filter(|([a, b], ledger)| a != b || ledger.has_touched);
        told.map(|(between, ledger)| summary(between, ledger)).collect()
    }

    /// What came out of the stages that have begun, where there are any.
    fn stages_so_far(&self) -> Vec<StageSummary> {
        if !self.has_stages() {
            return Vec::new();
        }
        let begun = self.stages.iter().zip(&self.accounts).enumerate();
        begun
            .map(|(i, (stage, account))| StageSummary {
                name: stage.name.clone(),
                start_time: stage.grid.start_time,
                end_time: if i == self.current { self.state.time } else { stage.grid.end_time },
                time_step: stage.grid.time_step,
                steps: account.steps,
                newton_iterations: account.newton_iterations,
                retried_steps: account.retried,
                energy: EnergySummary::of_stage(account),
                bodies: self.bodies(&account.books),
                pairs: self.pairs(&account.books, stage),
            })
            .collect()
    }

    /// The summary so far.
    #[must_use]
    pub fn summary(&self) -> Summary {
        let (e, t, l) = (self.state.energies, &self.totals, &self.books.total);
        Summary {
            steps: self.step(),
            dofs: self.model().dofs(),
            size: self.model().assembly.size,
            end_time: self.state.time,
            time_step: self.grid.time_step,
            newton_iterations: t.newton_iterations,
            factorisations: self.work.factorisations(),
            retried_steps: t.retried,
            energy: EnergySummary {
                initial: self.initial_energies.iter().map(Energies::total).sum(),
                last: e.total(),
                terms: l.with_energies(&e),
                max_drift: t.max_drift,
                max_defect: t.max_defect,
                max_step_defect: t.max_step_defect,
            },
            certificate: CertificateSummary {
                max_joule: t.max_certificate,
                solver_joule: t.solver_certificate,
                max_residual: t.max_residual,
                reference_joule: t.reference(),
                tolerance_joule: self.stage().method.certificate_tolerance * t.reference(),
            },
            bodies: self.bodies(&self.books),
            pairs: self.pairs(&self.books, self.stage()),
            max_blend: t.max_blend,
            repaid: t.repaid,
            least_friction: t.least_friction,
            min_gap: t.min_gap,
            penetration: self.penetration(),
            free_motion: self.free_motion(),
            cross_check: self.stage().method.cross_check.then(|| self.cross_checks.clone()),
            contacts: self.events.events(self.state.time),
            stages: self.stages_so_far(),
        }
    }
}
