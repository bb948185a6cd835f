pub(crate) mod table;

use std::iter::Sum;
use std::ops::AddAssign;

use serde::Serialize;

/// Energies of a state [J].
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Energies {
    /// ½ vᵀMv.
    pub kinetic: f64,
    /// ∫ψ dV.
    pub strain: f64,
}

impl Energies {
    /// Kinetic plus strain energy [J].
    #[must_use]
    pub fn total(&self) -> f64 {
        self.kinetic + self.strain
    }
}

impl Energies {
    pub(crate) fn terms_mut(&mut self) -> [&mut f64; 2] {
        [&mut self.kinetic, &mut self.strain]
    }
}

impl Sum for Energies {
    fn sum<I: Iterator<Item = Self>>(energies: I) -> Self {
        energies.fold(Self::default(), |a, b| Self {
            kinetic: a.kinetic + b.kinetic,
            strain: a.strain + b.strain,
        })
    }
}

/// What happened to the energy of a body in a step, or since the start [J]:
///
/// ΔE_kinetic + ΔE_strain = external + prescribed + contact − viscous − plastic − scheme + defect.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct BodyLedger {
    /// Change of kinetic energy.
    pub kinetic: f64,
    /// Change of strain energy.
    pub strain: f64,
    /// Work of gravity and loads.
    pub external: f64,
    /// Work of its supports, less that of the contacts that press on them.
    pub prescribed: f64,
    /// Dissipated by damping and viscosity.
    pub viscous: f64,
    /// Plastic work ∫ σ_y dα.
    pub plastic: f64,
    /// Dissipated by the time scheme's own algebra.
    pub scheme: f64,
    /// Received through contact: the work of the contact forces on what of the body is free.
    pub contact: f64,
}

impl BodyLedger {
    /// What the other terms do not explain [J].
    #[must_use]
    pub fn defect(&self) -> f64 {
        self.kinetic + self.strain - self.external - self.prescribed - self.contact
            + self.viscous
            + self.plastic
            + self.scheme
    }
}

impl BodyLedger {
    pub(crate) fn terms_mut(&mut self) -> [&mut f64; 8] {
        let Self { kinetic, strain, external, prescribed, viscous, plastic, scheme, contact } = self;
        [kinetic, strain, external, prescribed, viscous, plastic, scheme, contact]
    }
}

impl AddAssign for BodyLedger {
    fn add_assign(&mut self, step: Self) {
        self.kinetic += step.kinetic;
        self.strain += step.strain;
        self.external += step.external;
        self.prescribed += step.prescribed;
        self.viscous += step.viscous;
        self.plastic += step.plastic;
        self.scheme += step.scheme;
        self.contact += step.contact;
    }
}

/// What happened to the energy in a step, or since the start [J]. Every term is computed from its own definition:
///
/// ΔE_kinetic + ΔE_strain = external + prescribed − friction − viscous − plastic − scheme − normal_contact + defect.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Ledger {
    /// Change of kinetic energy.
    pub kinetic: f64,
    /// Change of strain energy.
    pub strain: f64,
    /// Work of gravity and loads.
    pub external: f64,
    /// Work of prescribed motion: of supports and of obstacles that move.
    pub prescribed: f64,
    /// Dissipated by friction: −Σ r_t·Δu_t ≥ 0.
    pub friction: f64,
    /// Dissipated by damping and viscosity: Δu·C v̄.
    pub viscous: f64,
    /// Plastic work ∫ σ_y dα ≥ 0.
    pub plastic: f64,
    /// Dissipated by the time scheme's own algebra (θ, ξ > ½).
    pub scheme: f64,
    /// Taken by normal reactions: −Σ r_n Δu_n.
    pub normal_contact: f64,
}

impl Ledger {
    /// What the other terms do not explain [J].
    #[must_use]
    pub fn defect(&self) -> f64 {
        self.kinetic + self.strain - self.external - self.prescribed
            + self.friction
            + self.viscous
            + self.plastic
            + self.scheme
            + self.normal_contact
    }
}

impl Ledger {
    /// Adds what happened to the energy of a body, but for what it received through contact: pairs say where that comes from.
    pub(crate) fn add_body(&mut self, body: &BodyLedger) {
        self.kinetic += body.kinetic;
        self.strain += body.strain;
        self.external += body.external;
        self.prescribed += body.prescribed;
        self.viscous += body.viscous;
        self.plastic += body.plastic;
        self.scheme += body.scheme;
    }

    /// Adds what a pair did.
    pub(crate) fn add_pair(&mut self, pair: &PairLedger) {
        self.friction += pair.friction;
        self.normal_contact += pair.normal_contact;
        self.prescribed += pair.prescribed;
    }

    pub(crate) fn terms_mut(&mut self) -> [&mut f64; 9] {
        let Self {
            kinetic,
            strain,
            external,
            prescribed,
            friction,
            viscous,
            plastic,
            scheme,
            normal_contact,
        } = self;
        [kinetic, strain, external, prescribed, friction, viscous, plastic, scheme, normal_contact]
    }
}

impl AddAssign for Ledger {
    fn add_assign(&mut self, step: Self) {
        self.kinetic += step.kinetic;
        self.strain += step.strain;
        self.external += step.external;
        self.prescribed += step.prescribed;
        self.friction += step.friction;
        self.viscous += step.viscous;
        self.plastic += step.plastic;
        self.scheme += step.scheme;
        self.normal_contact += step.normal_contact;
    }
}

/// What a pair did to the energy in a step, or since the start [J].
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct PairLedger {
    /// Dissipated by friction.
    pub friction: f64,
    /// Taken by normal reactions.
    pub normal_contact: f64,
    /// Work of prescribed motion through its contacts: of its obstacle, or of supports that are pressed on.
    pub prescribed: f64,
    /// Whether there was a reaction.
    pub has_touched: bool,
}

impl PairLedger {
    pub(crate) fn terms_mut(&mut self) -> [&mut f64; 3] {
        [&mut self.friction, &mut self.normal_contact, &mut self.prescribed]
    }
}

impl AddAssign for PairLedger {
    fn add_assign(&mut self, step: Self) {
        self.has_touched |= step.has_touched;
        self.prescribed += step.prescribed;
        self.friction += step.friction;
        self.normal_contact += step.normal_contact;
    }
}

/// The books of a run: the same energy as a whole, by bodies, and by pairs.
#[derive(Debug, Clone, PartialEq)]
pub struct Books {
    /// Of everything.
    pub total: Ledger,
    /// Of every body.
    pub bodies: Vec<BodyLedger>,
    /// Of every named pair.
    pub pairs: Vec<PairLedger>,
}

impl Books {
    /// Empty books of as many `bodies` and `pairs`.
    #[must_use]
    pub fn new(bodies: usize, pairs: usize) -> Self {
        Self {
            total: Ledger::default(),
            bodies: vec![BodyLedger::default(); bodies],
            pairs: vec![PairLedger::default(); pairs],
        }
    }

    /// Adds a step.
    pub fn add(&mut self, total: Ledger, bodies: &[BodyLedger], pairs: impl Iterator<Item = PairLedger>) {
        self.total += total;
        self.bodies.iter_mut().zip(bodies).for_each(|(sum, step)| *sum += *step);
        self.pairs.iter_mut().zip(pairs).for_each(|(sum, step)| *sum += step);
    }

    /// Replaces the changes of energy, which are sums of many steps, by the differences of `now` and `initial`.
    pub fn set_changes(&mut self, initial: &[Energies], now: &[Energies]) {
        for ((body, a), b) in self.bodies.iter_mut().zip(initial).zip(now) {
            (body.kinetic, body.strain) = (b.kinetic - a.kinetic, b.strain - a.strain);
        }
        let (a, b): (Energies, Energies) = (initial.iter().copied().sum(), now.iter().copied().sum());
        (self.total.kinetic, self.total.strain) = (b.kinetic - a.kinetic, b.strain - a.strain);
    }
}
