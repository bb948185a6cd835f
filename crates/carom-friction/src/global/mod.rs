//! Contact problems in the unknowns of the bodies: M v = H r + f, w = Hᵀ v + b.

mod admm;
mod choice;
mod compliance;
mod condense;
mod factor;
mod incidence;
mod inverse;
mod parts;
mod run;
#[cfg(test)]
mod tests;
mod trace;
mod units;

use std::borrow::Cow;

use faer::sparse::SparseColMat;

use crate::clock::{Clock, TimeIsUp};
use crate::{ContactProblem, SolveReport, SolverKind, StoppingRule, Vector};
use compliance::Compliance;
use run::Run;
use units::GlobalUnits;

/// Find r, v and w with M v = H r + f and w = Hᵀ v + b, so that r and w obey Signorini's and Coulomb's laws.
///
/// In any consistent units: v may be velocities and r impulses, or v displacements and r forces.
///
/// ```
/// use carom_friction::{GlobalMethod, GlobalProblem, SolverKind, SparseColMat, StoppingRule, Triplet, Vector};
///
/// // Two masses of 1 on a spring, the first pressed down with 1 and pushed sideways with 2, friction 0.5.
/// let matrix = |entries: &[(usize, usize, f64)], columns| {
///     let triplets: Vec<_> = entries.iter().map(|&(i, j, x)| Triplet::new(i, j, x)).collect();
///     SparseColMat::try_new_from_triplets(4, columns, &triplets).expect("inside")
/// };
/// let problem = GlobalProblem::<2> {
///     m: matrix(&[(0, 0, 1.0), (1, 1, 2.0), (1, 3, -1.0), (2, 2, 1.0), (3, 1, -1.0), (3, 3, 2.0)], 4),
///     h: matrix(&[(0, 0, 1.0), (1, 1, 1.0)], 2),
///     f: vec![-1.0, 2.0, 0.0, 0.0],
///     b: vec![Vector::zeros()],
///     mu: vec![0.5],
/// };
/// let mut r = vec![Vector::zeros()];
/// let answer = problem.solve(&mut r, GlobalMethod::Auto, SolverKind::Auto, &StoppingRule::default())?;
/// assert!(answer.report.is_solved());
/// assert!((r[0] - Vector::<2>::new(1.0, -0.5)).norm() < 1e-7);
/// assert!((answer.velocities[3] - 0.5).abs() < 1e-7);
/// # Ok::<(), carom_friction::SingularMatrix>(())
/// ```
#[derive(Debug, Clone)]
pub struct GlobalProblem<const D: usize> {
    /// Mass or stiffness matrix M, n_dof × n_dof, regular; symmetric positive definite as a rule.
    pub m: SparseColMat<usize, f64>,
    /// Maps reactions to forces on the unknowns: H, n_dof × n D, the columns of contact i being i D, …, i D + D − 1.
    pub h: SparseColMat<usize, f64>,
    /// Forces on the unknowns, n_dof.
    pub f: Vec<f64>,
    /// Motion of the contacts where the bodies rest, n.
    pub b: Vec<Vector<D>>,
    /// Friction coefficient of every contact, n.
    pub mu: Vec<f64>,
}

/// How a global problem is solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum GlobalMethod {
    /// The cheaper of the two by the count of operations; condensed where ADMM does not get there soon.
    #[default]
    Auto,
    /// W is written out and the problem in reactions solved.
    Condense,
    /// ADMM with a factor of M + H ρ Hᵀ and without W, for many contacts on elastic bodies.
    Admm,
}

impl GlobalMethod {
    /// Every method.
    pub const ALL: [GlobalMethod; 3] = [GlobalMethod::Auto, GlobalMethod::Condense, GlobalMethod::Admm];

    /// The name, as on the command line.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            GlobalMethod::Auto => "auto",
            GlobalMethod::Condense => "condense",
            GlobalMethod::Admm => "admm",
        }
    }

    /// The method of this name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|method| method.name() == name)
    }
}

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

/// M has no inverse, or none with a correct digit, at this unknown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SingularMatrix {
    /// Index of the unknown.
    pub dof: usize,
}

impl std::fmt::Display for SingularMatrix {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "M is singular, or too close to it to be inverted, at unknown {}", self.dof)
    }
}

impl std::error::Error for SingularMatrix {}

impl<const D: usize> GlobalProblem<D> {
    /// Number of contacts.
    #[must_use]
    pub fn len(&self) -> usize {
        self.b.len()
    }

    /// Whether there is no contact at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.b.is_empty()
    }

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
