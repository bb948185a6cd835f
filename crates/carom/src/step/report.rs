use carom_contact::{Contact, Solid};
use carom_mesh::Vector;

use crate::contact::cross_check::CrossCheck;
use crate::ledger::{Ledger, PairLedger};
use crate::step::free_motion::FreeMotion;

/// The impulse of reactions on the first of two solids, where bodies come before obstacles. Vectors have three components.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PairImpulse {
    /// Of the normal reactions [N s].
    pub normal: [f64; 3],
    /// Of friction [N s].
    pub friction: [f64; 3],
    /// Σ |p| x of all impulses p at places x [N s m],
    pub moment: [f64; 3],
    /// and Σ |p| [N s].
    pub weight: f64,
}

impl PairImpulse {
    /// Adds an impulse p [N s], in the frame of its `contact`, at the place of that, `onto` its source or from it.
    pub fn add<const D: usize>(
        &mut self,
        contact: &Contact<D>,
        impulse: &Vector<D>,
        is_source: bool,
        position: impl Fn(usize) -> Vector<D>,
    ) {
        let sign = if is_source { 1.0 } else { -1.0 };
        let size = impulse.norm();
        let place = contact.sources().fold(Vector::<D>::zeros(), |sum, (n, share)| sum + position(n) * share);
        let normal = contact.frame.row(0).transpose() * impulse[0];
        let whole = contact.frame.tr_mul(impulse);
        for i in 0..D {
            self.normal[i] += sign * normal[i];
            self.friction[i] += sign * (whole[i] - normal[i]);
            self.moment[i] += size * place[i];
        }
        self.weight += size;
    }

    /// Where the impulses acted in the mean [m]; none without any.
    pub(crate) fn place(&self) -> Option<[f64; 3]> {
        (self.weight > 0.0).then(|| self.moment.map(|moment| moment / self.weight))
    }
}

/// What a pair did in a step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PairReport {
    /// Sum of the normal reactions [N].
    pub normal_force: f64,
    /// What the reactions gave.
    pub given: PairImpulse,
    /// What happened to the energy.
    pub ledger: PairLedger,
}

/// How deep solids that may touch are inside one another, or bodies inside themselves, at the end of a step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PenetrationReport {
    /// The largest depth [m].
    pub depth: f64,
    /// Where it is largest in terms of what the cells there allow, if anywhere.
    pub worst: Option<Inside>,
}

/// A place where two solids are inside one another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inside {
    /// The two, bodies before obstacles.
    pub between: [Solid; 2],
    /// How deep [m].
    pub depth: f64,
    /// What is smaller there [m]: the diameter of a facet, or how thick the wall behind it was first, or the obstacle is.
    pub cell: f64,
    /// How far the arcs that the facets there stand for are in front of them [m].
    pub arcs: f64,
    /// Where [m]; the third coordinate is zero in the plane.
    pub at: [f64; 3],
}

/// What a step says about itself.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct StepReport {
    /// Newton iterations.
    pub newton_iterations: usize,
    /// Contacts with a reaction.
    pub contacts: usize,
    /// Smallest gap of a contact candidate at the end of the step [m]; infinite without candidates.
    pub min_gap: f64,
    /// How deep solids are inside one another at its end.
    pub penetration: PenetrationReport,
    /// Largest motion of a node or an obstacle in the step [m].
    pub travel: f64,
    /// Sum of the normal reactions [N].
    pub normal_force: f64,
    /// Largest blend |α| of start and end stresses: see the scheme `conserving` with `massless` contact.
    pub blend: f64,
    /// What nodes without mass gave way to where loads set in or they started out of balance [J], of which blends may leave over any part.
    pub onset: f64,
    /// What blends left over and vibration took or gave [J], without its sign.
    pub repaid: f64,
    /// Smallest dissipation by friction of a contact [J]; negative = friction did work on the bodies.
    pub least_friction: f64,
    /// Residual of the contact laws (see `carom_friction::Measure`).
    pub residual: f64,
    /// Σ of the bi-potential gaps [J].
    pub certificate: f64,
    /// The part of it that the contact problem was left with [J]; the rest is of the motion that Newton's iterations were left with.
    pub solver_certificate: f64,
    /// Largest distance of a friction coefficient from what its law says of the motion at the end.
    pub friction_defect: f64,
    /// Σ |r·q| [J]: what the reactions do over the motion that they prevent.
    pub reaction_work: f64,
    /// What a second solver says of the last contact problem, if it was asked.
    pub cross_check: Option<CrossCheck>,
    /// What drives a motion of a load step that nothing resists, and that was left undone.
    pub free_motion: Option<FreeMotion>,
    /// What happened to the energy.
    pub ledger: Ledger,
}

impl StepReport {
    /// Whether every number is finite, but for the smallest gap where there is none.
    pub(crate) fn is_finite(&self) -> bool {
        let Self { normal_force, blend, least_friction, residual, .. } = *self;
        let Self { certificate, solver_certificate, reaction_work, mut ledger, .. } = *self;
        let Self { penetration, travel, friction_defect, repaid, .. } = *self;
        let numbers = [normal_force, blend, repaid, least_friction, residual, penetration.depth, travel];
        let laws = [certificate, solver_certificate, reaction_work, friction_defect];
        let terms = ledger.terms_mut().map(|term| *term);
        numbers.iter().chain(&laws).chain(&terms).all(|x| x.is_finite()) && !self.min_gap.is_nan()
    }
}
