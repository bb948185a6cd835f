//! The books of one stage.

use crate::step::report::StepReport;
use crate::{Books, Energies, State};

/// What a stage has done so far.
#[derive(Debug, Clone)]
pub(crate) struct Account {
    /// Energies of the bodies, and of springs, when it began.
    pub start: Vec<Energies>,
    /// The same at its end, or now.
    pub end: Vec<Energies>,
    pub books: Books,
    pub steps: u64,
    pub newton_iterations: u64,
    pub retried: u64,
    pub max_drift: f64,
    pub max_defect: f64,
    pub max_step_defect: f64,
}

impl Account {
    /// Of a stage that begins with these energies of bodies and, after them, of springs.
    pub fn new(energies: Vec<Energies>) -> Self {
        Self {
            books: Books::new(energies.len() - 1),
            start: energies.clone(),
            end: energies,
            steps: 0,
            newton_iterations: 0,
            retried: 0,
            max_drift: 0.0,
            max_defect: 0.0,
            max_step_defect: 0.0,
        }
    }

    /// Takes note of a step, or a part of one, that ended in `state`; `books` has been told of it.
    pub fn note<const D: usize>(&mut self, report: &StepReport, state: &State<D>) {
        self.end.clear();
        self.end.extend(state.all_energies());
        self.books.set_changes(&self.start, state.all_energies());
        self.newton_iterations += report.newton_iterations as u64;
        let initial = self.start.iter().map(Energies::total).sum::<f64>();
        self.max_drift = self.max_drift.max((state.energies.total() - initial).abs());
        self.max_defect = self.max_defect.max(self.books.total.defect().abs());
        self.max_step_defect = self.max_step_defect.max(report.ledger.defect().abs());
    }
}
