use serde::Serialize;

use crate::Ledger;
use crate::step::report::StepReport;

/// What a nominal step says about itself, the substeps that it was taken in together.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct NominalStep {
    /// Steps it was taken in: 1, or more where it had to be halved.
    pub substeps: u64,
    /// Newton iterations of all of them.
    pub newton_iterations: usize,
    /// Contacts with a reaction in the last of them.
    pub contacts: usize,
    /// Sum of the normal reactions in the last of them [N].
    pub normal_force: f64,
    /// Smallest gap of a contact candidate at the end [m]; infinite without candidates.
    pub min_gap: f64,
    /// Largest Σ of the bi-potential gaps [J].
    pub certificate: f64,
    /// What happened to the energy.
    pub ledger: Ledger,
}

impl NominalStep {
    /// Takes note of a substep.
    pub(crate) fn note(&mut self, report: &StepReport) {
        self.substeps += 1;
        self.newton_iterations += report.newton_iterations;
        self.contacts = report.contacts;
        self.normal_force = report.normal_force;
        self.min_gap = report.min_gap;
        self.certificate = self.certificate.max(report.certificate);
        self.ledger += report.ledger;
    }
}
