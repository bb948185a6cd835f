mod by_pair;
pub(crate) mod table;
mod terms;

use std::iter::Sum;

use carom_contact::Solid;
use serde::Serialize;

pub use by_pair::ByPair;
pub use terms::{BodyLedger, Ledger, PairLedger, TERMS};

/// Energies of a state [J].
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Energies {
    /// ½ vᵀMv.
    pub kinetic: f64,
    /// ∫ψ dV.
    pub strain: f64,
    /// Σψ of springs, which are of no body.
    pub springs: f64,
}

impl Energies {
    /// All of them [J].
    #[must_use]
    pub fn total(&self) -> f64 {
        self.kinetic + self.strain + self.springs
    }
}

impl Energies {
    pub(crate) fn terms_mut(&mut self) -> [&mut f64; 3] {
        [&mut self.kinetic, &mut self.strain, &mut self.springs]
    }
}

impl Sum for Energies {
    fn sum<I: Iterator<Item = Self>>(energies: I) -> Self {
        energies.fold(Self::default(), |a, b| Self {
            kinetic: a.kinetic + b.kinetic,
            strain: a.strain + b.strain,
            springs: a.springs + b.springs,
        })
    }
}

impl Ledger {
    /// The same with energies in place of their changes: what there is, and what became of the rest.
    pub(crate) fn with_energies(&self, now: &Energies) -> Self {
        Self { kinetic: now.kinetic, strain: now.strain, springs: now.springs, ..*self }
    }
}

/// The books of a run: the same energy as a whole, by bodies, and by pairs.
#[derive(Debug, Clone, PartialEq)]
pub struct Books {
    /// Of everything.
    pub total: Ledger,
    /// Of every body.
    pub bodies: Vec<BodyLedger>,
    /// Of every pair that anything happened to.
    pub pairs: ByPair<PairLedger>,
}

impl Books {
    /// Empty books of as many `bodies`.
    #[must_use]
    pub fn new(bodies: usize) -> Self {
        Self {
            total: Ledger::default(),
            bodies: vec![BodyLedger::default(); bodies],
            pairs: ByPair::default(),
        }
    }

    /// Adds a step.
    pub fn add(
        &mut self,
        total: Ledger,
        bodies: &[BodyLedger],
        pairs: impl Iterator<Item = ([Solid; 2], PairLedger)>,
    ) {
        self.total += total;
        self.bodies.iter_mut().zip(bodies).for_each(|(sum, step)| *sum += *step);
        pairs.for_each(|(between, step)| *self.pairs.or_default(between) += step);
    }

    /// Replaces the changes of energy, which are sums of many steps, by the differences of `now` and `initial`: of every body, and of springs.
    pub fn set_changes(&mut self, initial: &[Energies], now: impl Iterator<Item = Energies> + Clone) {
        for ((body, a), b) in self.bodies.iter_mut().zip(initial).zip(now.clone()) {
            (body.kinetic, body.strain) = (b.kinetic - a.kinetic, b.strain - a.strain);
        }
        let (a, b): (Energies, Energies) = (initial.iter().copied().sum(), now.sum());
        (self.total.kinetic, self.total.strain) = (b.kinetic - a.kinetic, b.strain - a.strain);
        self.total.springs = b.springs - a.springs;
    }
}
