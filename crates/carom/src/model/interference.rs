use std::collections::BTreeMap;

use carom_contact::{Site, Solid};

use crate::body::Interval;
use crate::ledger::ByPair;
use crate::signal::Signal;

/// By how much the surfaces of a named pair are pushed apart [m]: the contact law sees the gap less this. Where it is negative they have
/// clearance, and may be inside one another by as much.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Interference {
    /// The same for all contacts of the pair; none if nothing is said.
    pub signal: Option<Signal>,
    /// What overlaps at the start and is taken up little by little.
    pub overlap: Option<Overlap>,
}

/// The interference of all pairs.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Interferences {
    /// That of pairs of which nothing else is said.
    pub default: Interference,
    /// Those of other pairs.
    pub own: ByPair<Interference>,
}

impl Interferences {
    /// That of two solids, in ascending order.
    #[must_use]
    pub fn of(&self, between: [Solid; 2]) -> &Interference {
        self.own.get(between).unwrap_or(&self.default)
    }

    /// Whether nothing pushes surfaces apart.
    #[must_use]
    pub fn are_none(&self) -> bool {
        self.all().all(|interference| *interference == Interference::default())
    }

    /// All that there are.
    pub fn all(&self) -> impl Iterator<Item = &Interference> {
        self.own.values().chain([&self.default])
    }
}

/// Overlaps at the start: what is left of them is clearance, which falls linearly to zero.
#[derive(Debug, Clone, PartialEq)]
pub struct Overlap {
    /// How deep every contact is inside at t = 0 [m], by pair and site.
    depths: BTreeMap<(u32, Site), f64>,
    largest: f64,
    /// When they are taken up [s].
    until: f64,
}

impl Overlap {
    /// These `depths` [m] of contacts by pair and site, taken up by the time `until` [s].
    #[must_use]
    pub fn new(depths: BTreeMap<(u32, Site), f64>, until: f64) -> Self {
        let largest = depths.values().copied().fold(0.0, f64::max);
        Self { depths, largest, until }
    }

    /// The part of them that is left at time `t` [s].
    fn left(&self, t: f64) -> f64 {
        (1.0 - t / self.until).max(0.0)
    }
}

impl Interference {
    /// That of a contact of the pair at time `t` [s].
    #[must_use]
    pub fn at(&self, contact: (u32, Site), t: f64) -> f64 {
        let depth =
            |overlap: &Overlap| overlap.depths.get(&contact).copied().unwrap_or(0.0) * overlap.left(t);
        self.common(t) - self.overlap.as_ref().map_or(0.0, depth)
    }

    /// That of a contact at the start and at the end of a step.
    ///
    /// A static analysis starts from surfaces that nothing pushes apart: what is there at t = 0 is applied in its first step. Clearance is there
    /// from the beginning.
    #[must_use]
    pub fn ends(&self, contact: (u32, Site), interval: &Interval) -> [f64; 2] {
        let start = self.at(contact, interval.start);
        [if interval.starts_from_nothing() { start.min(0.0) } else { start }, self.at(contact, interval.end)]
    }

    /// The least that any contact has at time `t` [s].
    #[must_use]
    pub fn least(&self, t: f64) -> f64 {
        self.common(t) - self.overlap.as_ref().map_or(0.0, |overlap| overlap.largest * overlap.left(t))
    }

    /// Whether it is the same at two times [s].
    #[must_use]
    pub fn is_alike(&self, [a, b]: [f64; 2]) -> bool {
        self.common(a) == self.common(b)
            && self.overlap.as_ref().is_none_or(|overlap| overlap.left(a) == overlap.left(b))
    }

    /// The part that all contacts have in common.
    fn common(&self, t: f64) -> f64 {
        self.signal.as_ref().map_or(0.0, |signal| signal.at(t).value)
    }

    /// How far apart surfaces still press at time `t` [s].
    #[must_use]
    pub fn reach(&self, t: f64) -> f64 {
        self.common(t).max(0.0)
    }
}
