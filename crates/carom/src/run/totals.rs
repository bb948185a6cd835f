use crate::step::report::StepReport;
use crate::{Books, Energies};

/// Extremes and counts over the run.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Totals {
    pub newton_iterations: u64,
    pub retried: u64,
    pub contacts: usize,
    pub max_drift: f64,
    pub max_defect: f64,
    pub max_step_defect: f64,
    /// Largest energy that was there or went into friction.
    pub max_energy: f64,
    /// Largest work of the reactions of a step over the motion that they prevent: large where stiff bodies rest on one another and have
    /// next to no energy.
    pub max_reaction_work: f64,
    pub max_certificate: f64,
    /// The part of it that the contact problem was left with.
    pub solver_certificate: f64,
    pub max_residual: f64,
    pub max_blend: f64,
    pub least_friction: f64,
    pub min_gap: f64,
}

impl Totals {
    /// Those of a run that starts with these `energies`.
    pub fn new(energies: &Energies) -> Self {
        Self {
            newton_iterations: 0,
            retried: 0,
            contacts: 0,
            max_drift: 0.0,
            max_defect: 0.0,
            max_step_defect: 0.0,
            max_energy: energies.total(),
            max_reaction_work: 0.0,
            max_certificate: 0.0,
            solver_certificate: 0.0,
            max_residual: 0.0,
            max_blend: 0.0,
            least_friction: 0.0,
            min_gap: f64::INFINITY,
        }
    }

    /// What the certificate is measured by [J].
    pub fn reference(&self) -> f64 {
        self.max_energy.max(self.max_reaction_work)
    }

    /// Takes note of a step that ended with these `energies` and left these `books`, in a run that started with the energy `initial` [J].
    pub fn note(&mut self, report: &StepReport, energies: &Energies, books: &Books, initial: f64) {
        self.newton_iterations += report.newton_iterations as u64;
        self.contacts = report.contacts;
        self.max_drift = self.max_drift.max((energies.total() - initial).abs());
        self.max_defect = self.max_defect.max(books.total.defect().abs());
        self.max_step_defect = self.max_step_defect.max(report.ledger.defect().abs());
        self.max_energy = self.max_energy.max(energies.total() + books.total.friction);
        self.max_reaction_work = self.max_reaction_work.max(report.reaction_work);
        if report.certificate > self.max_certificate {
            (self.max_certificate, self.solver_certificate) = (report.certificate, report.solver_certificate);
        }
        self.max_residual = self.max_residual.max(report.residual);
        self.max_blend = self.max_blend.max(report.blend);
        self.least_friction = self.least_friction.min(report.least_friction);
        self.min_gap = self.min_gap.min(report.min_gap);
    }
}
