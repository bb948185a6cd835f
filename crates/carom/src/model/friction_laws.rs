use std::sync::Arc;

use carom_contact::Pair;
use carom_friction::FrictionLaw;

use crate::ledger::ByPair;

/// The largest friction coefficient: with more, round-off of μ|w_t| would hide the normal motion.
pub(crate) const MAX_FRICTION: f64 = 1e3;

/// The friction laws of pairs whose coefficient depends on the motion.
#[derive(Debug, Clone, Default)]
pub struct FrictionLaws {
    /// That of pairs of which nothing else is said; none where their coefficient is constant.
    pub default: Option<Arc<dyn FrictionLaw>>,
    /// Those of other pairs; none where it is constant.
    pub own: ByPair<Option<Arc<dyn FrictionLaw>>>,
}

impl FrictionLaws {
    /// Whether the coefficients of all pairs are constant.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.default.is_none() && self.own.values().all(Option::is_none)
    }

    /// Whether one of them depends on the pressure.
    pub(crate) fn depend_on_pressure(&self) -> bool {
        let all = std::iter::once(&self.default).chain(self.own.values());
        all.flatten().any(|law| law.depends_on_pressure())
    }

    /// That of a pair; none where its coefficient is constant.
    #[must_use]
    pub fn of(&self, pair: &Pair) -> Option<&dyn FrictionLaw> {
        self.own.get(pair.between()).unwrap_or(&self.default).as_deref()
    }
}
