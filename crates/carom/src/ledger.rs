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
/// ΔE_kinetic + ΔE_strain = external + contact − viscous − scheme + defect.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct BodyLedger {
    /// Change of kinetic energy.
    pub kinetic: f64,
    /// Change of strain energy.
    pub strain: f64,
    /// Work of gravity and loads.
    pub external: f64,
    /// Dissipated by damping.
    pub viscous: f64,
    /// Dissipated by the time scheme's own algebra.
    pub scheme: f64,
    /// Received through contact: the work of the contact forces on the body.
    pub contact: f64,
}

impl BodyLedger {
    /// What the other terms do not explain [J].
    #[must_use]
    pub fn defect(&self) -> f64 {
        self.kinetic + self.strain - self.external - self.contact + self.viscous + self.scheme
    }
}

impl AddAssign for BodyLedger {
    fn add_assign(&mut self, step: Self) {
        self.kinetic += step.kinetic;
        self.strain += step.strain;
        self.external += step.external;
        self.viscous += step.viscous;
        self.scheme += step.scheme;
        self.contact += step.contact;
    }
}

/// What happened to the energy in a step, or since the start [J]. Every term is computed from its own definition:
///
/// ΔE_kinetic + ΔE_strain = external − friction − viscous − scheme − normal_contact + defect.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Ledger {
    /// Change of kinetic energy.
    pub kinetic: f64,
    /// Change of strain energy.
    pub strain: f64,
    /// Work of gravity and loads.
    pub external: f64,
    /// Dissipated by friction: −Σ r_t·Δu_t ≥ 0.
    pub friction: f64,
    /// Dissipated by damping: Δu·C v̄.
    pub viscous: f64,
    /// Dissipated by the time scheme's own algebra (θ, ξ > ½).
    pub scheme: f64,
    /// Taken by normal reactions: −Σ r_n Δu_n.
    pub normal_contact: f64,
}

impl Ledger {
    /// What the other terms do not explain [J].
    #[must_use]
    pub fn defect(&self) -> f64 {
        self.kinetic + self.strain - self.external
            + self.friction
            + self.viscous
            + self.scheme
            + self.normal_contact
    }
}

impl AddAssign for Ledger {
    fn add_assign(&mut self, step: Self) {
        self.kinetic += step.kinetic;
        self.strain += step.strain;
        self.external += step.external;
        self.friction += step.friction;
        self.viscous += step.viscous;
        self.scheme += step.scheme;
        self.normal_contact += step.normal_contact;
    }
}
