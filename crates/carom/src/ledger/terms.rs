//! The terms of the books. Written by tools/make_ledger.py from ledger/terms.toml of the core.

use std::ops::AddAssign;

use serde::Serialize;

/// Terms of all books, in the order of their columns.
pub const TERMS: [&str; 14] = [
    "kinetic",
    "strain",
    "springs",
    "external",
    "prescribed",
    "contact",
    "connections",
    "friction",
    "viscous",
    "dampers",
    "plastic",
    "scheme",
    "normal_contact",
    "settling",
];

/// What happened to the energy in a step, or since the start [J]. Every term is computed from its own definition:
///
/// ΔE_kinetic + ΔE_strain + ΔE_springs = external + prescribed − friction − viscous − dampers − plastic − scheme − normal_contact − settling + defect.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Ledger {
    /// Change of kinetic energy.
    pub kinetic: f64,
    /// Change of strain energy.
    pub strain: f64,
    /// Change of the energy of springs.
    pub springs: f64,
    /// Work of gravity and loads.
    pub external: f64,
    /// Work of what is prescribed: motion, growth of bodies, interference that grows.
    pub prescribed: f64,
    /// Dissipated by friction: −Σ r_t·Δu_t ≥ 0.
    pub friction: f64,
    /// Dissipated by damping and viscosity.
    pub viscous: f64,
    /// Dissipated by dampers: Σ c (ℓ₊ − ℓ)²/Δt ≥ 0.
    pub dampers: f64,
    /// Plastic work ∫ σ_y dα ≥ 0.
    pub plastic: f64,
    /// Dissipated by the time scheme's own algebra (θ, ξ > ½).
    pub scheme: f64,
    /// Taken by normal reactions: −Σ r_n Δu_n.
    pub normal_contact: f64,
    /// Taken by damping from the velocities that closed contacts turn round in every step (θ = ½).
    pub settling: f64,
}

impl Ledger {
    /// The names of its terms.
    pub(crate) const NAMES: [&str; 12] = [
        "kinetic",
        "strain",
        "springs",
        "external",
        "prescribed",
        "friction",
        "viscous",
        "dampers",
        "plastic",
        "scheme",
        "normal_contact",
        "settling",
    ];

    /// Its terms in the order of the columns.
    pub(crate) fn terms_mut(&mut self) -> [&mut f64; 12] {
        [
            &mut self.kinetic,
            &mut self.strain,
            &mut self.springs,
            &mut self.external,
            &mut self.prescribed,
            &mut self.friction,
            &mut self.viscous,
            &mut self.dampers,
            &mut self.plastic,
            &mut self.scheme,
            &mut self.normal_contact,
            &mut self.settling,
        ]
    }

    /// What the other terms do not explain [J].
    #[must_use]
    pub fn defect(&self) -> f64 {
        self.kinetic + self.strain + self.springs - self.external - self.prescribed
            + self.friction
            + self.viscous
            + self.dampers
            + self.plastic
            + self.scheme
            + self.normal_contact
            + self.settling
    }

    /// Adds what happened to a body, but for what it received through contact:
    /// pairs say where that comes from.
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
        self.prescribed += pair.prescribed;
        self.friction += pair.friction;
        self.normal_contact += pair.normal_contact;
        self.settling += pair.settling;
    }
}

impl AddAssign for Ledger {
    fn add_assign(&mut self, step: Self) {
        self.kinetic += step.kinetic;
        self.strain += step.strain;
        self.springs += step.springs;
        self.external += step.external;
        self.prescribed += step.prescribed;
        self.friction += step.friction;
        self.viscous += step.viscous;
        self.dampers += step.dampers;
        self.plastic += step.plastic;
        self.scheme += step.scheme;
        self.normal_contact += step.normal_contact;
        self.settling += step.settling;
    }
}

/// What happened to the energy of a body in a step, or since the start [J]:
///
/// ΔE_kinetic + ΔE_strain = external + prescribed + contact + connections − viscous − plastic − scheme + defect.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct BodyLedger {
    /// Change of kinetic energy.
    pub kinetic: f64,
    /// Change of strain energy.
    pub strain: f64,
    /// Work of gravity and loads.
    pub external: f64,
    /// Work of its supports, less that of the contacts that press on them, and of its growth.
    pub prescribed: f64,
    /// Received through contact: the work of the contact forces on what of the body is free.
    pub contact: f64,
    /// Received through springs and dampers: their work on all of the body; supports do as much against it where they hold it.
    pub connections: f64,
    /// Dissipated by damping and viscosity.
    pub viscous: f64,
    /// Plastic work ∫ σ_y dα ≥ 0.
    pub plastic: f64,
    /// Dissipated by the time scheme's own algebra (θ, ξ > ½).
    pub scheme: f64,
}

impl BodyLedger {
    /// Its terms in the order of the columns.
    pub(crate) fn terms_mut(&mut self) -> [&mut f64; 9] {
        [
            &mut self.kinetic,
            &mut self.strain,
            &mut self.external,
            &mut self.prescribed,
            &mut self.contact,
            &mut self.connections,
            &mut self.viscous,
            &mut self.plastic,
            &mut self.scheme,
        ]
    }

    /// Its terms in the columns `TERMS`; NaN where it has none.
    pub(crate) fn columns(&self) -> [f64; 14] {
        [
            self.kinetic,
            self.strain,
            f64::NAN,
            self.external,
            self.prescribed,
            self.contact,
            self.connections,
            f64::NAN,
            self.viscous,
            f64::NAN,
            self.plastic,
            self.scheme,
            f64::NAN,
            f64::NAN,
        ]
    }

    /// What the other terms do not explain [J].
    #[must_use]
    pub fn defect(&self) -> f64 {
        self.kinetic + self.strain - self.external - self.prescribed - self.contact - self.connections
            + self.viscous
            + self.plastic
            + self.scheme
    }
}

impl AddAssign for BodyLedger {
    fn add_assign(&mut self, step: Self) {
        self.kinetic += step.kinetic;
        self.strain += step.strain;
        self.external += step.external;
        self.prescribed += step.prescribed;
        self.contact += step.contact;
        self.connections += step.connections;
        self.viscous += step.viscous;
        self.plastic += step.plastic;
        self.scheme += step.scheme;
    }
}

/// What a pair did to the energy in a step, or since the start [J].
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct PairLedger {
    /// Work of prescribed motion through its contacts, of its obstacle or of supports that are pressed on, and of its interference that grows.
    pub prescribed: f64,
    /// Dissipated by friction: −Σ r_t·Δu_t ≥ 0.
    pub friction: f64,
    /// Taken by normal reactions: −Σ r_n Δu_n.
    pub normal_contact: f64,
    /// Taken by damping from the velocities that closed contacts turn round in every step (θ = ½).
    pub settling: f64,
    /// Whether there was a reaction.
    pub has_touched: bool,
}

impl PairLedger {
    /// Its terms in the order of the columns.
    pub(crate) fn terms_mut(&mut self) -> [&mut f64; 4] {
        [&mut self.prescribed, &mut self.friction, &mut self.normal_contact, &mut self.settling]
    }

    /// Its terms in the columns `TERMS`; NaN where it has none.
    pub(crate) fn columns(&self) -> [f64; 14] {
        [
            f64::NAN,
            f64::NAN,
            f64::NAN,
            f64::NAN,
            self.prescribed,
            f64::NAN,
            f64::NAN,
            self.friction,
            f64::NAN,
            f64::NAN,
            f64::NAN,
            f64::NAN,
            self.normal_contact,
            self.settling,
        ]
    }
}

impl AddAssign for PairLedger {
    fn add_assign(&mut self, step: Self) {
        self.prescribed += step.prescribed;
        self.friction += step.friction;
        self.normal_contact += step.normal_contact;
        self.settling += step.settling;
        self.has_touched |= step.has_touched;
    }
}
