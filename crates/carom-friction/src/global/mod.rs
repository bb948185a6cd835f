//! Contact problems in the unknowns of the bodies: M v = H r + f, w = Hᵀ v + b.

mod admm;
mod choice;
mod compliance;
mod condense;
mod control;
mod factor;
mod incidence;
mod inverse;
mod measurable;
mod method;
mod parts;
mod problem;
mod run;
#[cfg(test)]
mod tests;
mod trace;
mod units;

use std::borrow::Cow;

use crate::clock::{Clock, TimeIsUp};
use crate::{ContactProblem, SolveReport, SolverKind, StoppingRule, Vector};
use compliance::Compliance;
pub use inverse::SingularMatrix;
pub use method::GlobalMethod;
pub use problem::GlobalProblem;
use run::Run;
use units::GlobalUnits;

/// The answer to a global problem.
#[derive(Debug, Clone, PartialEq)]
pub struct GlobalReport<const D: usize> {
    /// What the solver says, with the time of all, from the factor of M on.
    pub report: SolveReport,
    /// The method that gave the answer.
    pub method: GlobalMethod,
    /// The unknowns v = M⁻¹ (H r + f), n_dof.
    pub velocities: Vec<f64>,
    /// The relative motions w = Hᵀ v + b, n.
    pub motions: Vec<Vector<D>>,
}

impl<const D: usize> GlobalProblem<D> {
    /// The same problem in reactions alone: W = Hᵀ M⁻¹ H and q = Hᵀ M⁻¹ f + b.
    ///
    /// Blocks are stored only where two contacts touch unknowns that M couples, directly or through others.
    ///
    /// # Errors
    /// If M is singular.
    pub fn condense(&self) -> Result<ContactProblem<D>, SingularMatrix> {
        match Compliance::new(self)?.condense(Clock::new(None)) {
            Ok(problem) => Ok(problem),
            Err(TimeIsUp) => unreachable!("there is no limit"),
        }
    }

    /// Improves the reactions `r`, one per contact, from the guess they hold, by `solver` where W is condensed.
    ///
    /// # Errors
    /// If M is singular.
    pub fn solve(
        &self,
        r: &mut [Vector<D>],
        method: GlobalMethod,
        solver: SolverKind,
        rule: &StoppingRule,
    ) -> Result<GlobalReport<D>, SingularMatrix> {
        let clock = rule.clock();
        let units = GlobalUnits::of(self);
        let (scaled, rule) = if units.are_own() {
            (Cow::Borrowed(self), *rule)
        } else {
            units.contacts.enter_reactions(r);
            let unit = units.contacts.stiffness(rule.unit);
            (Cow::Owned(units.enter(self)), StoppingRule { unit, ..*rule })
        };
        let compliance = Compliance::new(&scaled)?;
        let run = Run { compliance: &compliance, rule: &rule, clock };
        let (method, mut report) = run.solve(r, method, solver);
        if !units.are_own() {
            units.contacts.leave_reactions(r);
            let mut returned = r.to_vec();
            units.contacts.enter_reactions(&mut returned);
            report = run.judged_again(report, &returned);
            report.measure.certificate = units.contacts.leave_energy(report.measure.certificate);
            r.copy_from_slice(&returned);
        }
        let mut velocities = compliance.velocities(r);
        let mut motions = compliance.motions(&velocities);
        if !units.are_own() {
            units.leave(&mut velocities, &mut motions);
            units.contacts.leave_reactions(r);
        }
        report.time = clock.elapsed();
        Ok(GlobalReport { report, method, velocities, motions })
    }
}
