use carom_contact::Solid;

use super::crushed::CrushedCells;
use crate::step::free_motion::FreeMotion;
use crate::step::report::{Inside, StepReport};
use crate::{Books, Energies, Method, Model, State};

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
    /// See [`super::summary::Summary::repaid`].
    pub repaid: f64,
    pub least_friction: f64,
    pub min_gap: f64,
    /// How deep solids were in one another after first steps of stages [m], as far as something moved: what starts too near to be stopped.
    pub let_in: f64,
    /// Largest depth of solids in one another at the end of a step [m].
    pub max_penetration: f64,
    /// The free motion of a load step that was driven most, and left undone.
    pub free_motion: Option<FreeMotion>,
    /// Where they were deepest in terms of what is allowed.
    pub worst_penetration: Option<Worst>,
}

/// The worst penetration of a run.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Worst {
    pub inside: Inside,
    /// How deep they might have been [m].
    pub allowed: f64,
    /// When [s].
    pub time: f64,
    /// What may be behind it, where it is more than is allowed: cells of the two that are crushed.
    pub crushed: Option<CrushedCells>,
}

impl Worst {
    /// How deep they were in terms of what is allowed.
    pub fn excess(&self) -> f64 {
        self.inside.depth / self.allowed
    }
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
            repaid: 0.0,
            least_friction: 0.0,
            min_gap: f64::INFINITY,
            let_in: 0.0,
            max_penetration: 0.0,
            free_motion: None,
            worst_penetration: None,
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
        self.repaid += report.repaid;
        self.least_friction = self.least_friction.min(report.least_friction);
        self.min_gap = self.min_gap.min(report.min_gap);
        self.max_penetration = self.max_penetration.max(report.penetration.depth);
        let driving = |motion: Option<FreeMotion>| motion.map_or(0.0, |motion| motion.driving);
        if driving(report.free_motion) > driving(self.free_motion) {
            self.free_motion = report.free_motion;
        }
    }

    /// Takes note of how deep solids were in one another in a `state`, by what the `method` allows, where it may be that a stage `sets_out`.
    pub fn note_penetration<const D: usize>(
        &mut self,
        report: &StepReport,
        state: &State<D>,
        model: &Model<D>,
        method: &Method<D>,
        sets_out: bool,
    ) {
        if sets_out {
            self.let_in = self.let_in.max(report.penetration.depth.min(report.travel));
        }
        let Some(inside) = report.penetration.worst else { return };
        let allowed = method.allowed_penetration(inside.cell, inside.arcs, self.let_in);
        let mut worst = Worst { inside, allowed, time: state.time, crushed: None };
        if self.worst_penetration.is_none_or(|known| worst.excess() > known.excess()) {
            if worst.excess() > 1.0 {
                let counts = |body| inside.between.contains(&Solid::Body(body));
                worst.crushed = CrushedCells::find(model, state, counts);
            }
            self.worst_penetration = Some(worst);
        }
    }
}
