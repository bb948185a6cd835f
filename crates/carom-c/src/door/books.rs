//! What steps came to, as plain data.

use carom::PairLedger;
use carom_friction::SolveReport;

/// What reactions did [J].
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[allow(non_camel_case_types)]
pub struct carom_work {
    /// Taken by friction.
    pub friction: f64,
    /// Taken by normal reactions.
    pub normal_contact: f64,
    /// Work of what is prescribed: of obstacles that move, and of held unknowns that are pressed.
    pub prescribed: f64,
}

impl carom_work {
    pub(super) fn with(self, pair: &PairLedger) -> Self {
        Self {
            friction: self.friction + pair.friction,
            normal_contact: self.normal_contact + pair.normal_contact,
            prescribed: self.prescribed + pair.prescribed,
        }
    }
}

/// What a step came to.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[allow(non_camel_case_types)]
pub struct carom_step {
    /// What all reactions did.
    pub work: carom_work,
    /// Distance from the laws of contact and friction, the sum of the bi-potential gaps [J].
    pub certificate: f64,
    /// Smallest gap at the end among what took part [m]; infinite without contacts.
    pub min_gap: f64,
    /// How many contacts press.
    pub pressing: usize,
}

/// The books of contact over all steps that were accepted. With kinetic and strain energy your own, energy is kept where their change, plus friction and normal_contact, less
/// prescribed and the work of your loads, is zero.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[allow(non_camel_case_types)]
pub struct carom_ledger {
    /// What all reactions did.
    pub work: carom_work,
    /// Largest distance of a step from the laws [J].
    pub certificate: f64,
    /// Smallest gap [m].
    pub min_gap: f64,
    /// Time [s].
    pub time: f64,
    /// Steps.
    pub steps: usize,
}

/// What the friction solver says about its answer.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[allow(non_camel_case_types)]
pub struct carom_report {
    /// Distance from the laws, the sum of the bi-potential gaps [J].
    pub certificate: f64,
    /// Relative residual in the natural units of the problem.
    pub residual: f64,
    /// Iterations.
    pub iterations: usize,
}

impl From<&SolveReport> for carom_report {
    fn from(report: &SolveReport) -> Self {
        Self {
            certificate: report.measure.certificate,
            residual: report.measure.natural_residual,
            iterations: report.iterations,
        }
    }
}
