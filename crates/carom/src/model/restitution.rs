use carom_contact::{Pair, Target};

use crate::ledger::ByPair;

/// The coefficients of restitution of pairs of which both sides are rigid, where velocities are ruled: see
/// [`ContactCondition::Endpoint`](super::condition::ContactCondition::Endpoint).
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Restitutions {
    /// That of pairs of which nothing else is said; none where velocities are not ruled.
    pub default: Option<f64>,
    /// Those of other pairs.
    pub own: ByPair<f64>,
    /// Which bodies deform. Their impacts follow from that.
    pub deforms: Vec<bool>,
}

impl Restitutions {
    /// That of a pair; none where nothing rules the velocity.
    #[inline]
    #[must_use]
    pub fn of(&self, pair: &Pair) -> Option<f64> {
        let default = self.default?;
        let deforms = |body: usize| self.deforms.get(body).is_some_and(|deforms| *deforms);
        if deforms(pair.source) || matches!(pair.target, Target::Surface(target) if deforms(target)) {
            return None;
        }
        Some(self.own.get(pair.between()).copied().unwrap_or(default))
    }
}
