use carom_contact::{Contact, Pair, Positions, Site, Target};

use crate::ledger::ByPair;
use crate::model::bearing::Bearing;

/// The friction coefficient of contacts that nothing breaks: any will do, as what holds them grows with what pulls.
pub(crate) const OF_BONDS: f64 = 1.0;

/// How two surfaces hold together: their reactions obey Coulomb's law once the adhesion A [N] is added to their normal part, r_n ≥ −A and
/// |r_t| ≤ μ (r_n + A).
///
/// A contact that opens has lost its adhesion at once, in the step in which it opens. So adhesion does no work.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cohesion {
    /// How much holds a contact.
    pub strength: Strength,
    /// Whether a contact that closes holds too; else those that were closed from the start on alone.
    pub lasting: bool,
}

/// How much holds a contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Strength {
    /// As much on every area of the source [Pa].
    Stress(f64),
    /// As much in every contact [N].
    Force(f64),
    /// Whatever it takes: the contact never parts nor slides.
    Unbreakable,
}

/// The cohesion of all pairs. No body holds on to itself.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Cohesions {
    /// That of pairs of which nothing else is said.
    pub default: Option<Cohesion>,
    /// That of other pairs.
    pub own: ByPair<Option<Cohesion>>,
}

impl Cohesions {
    /// Whether no pair has any.
    #[must_use]
    pub fn are_none(&self) -> bool {
        self.all().next().is_none()
    }

    /// All that there is.
    pub fn all(&self) -> impl Iterator<Item = &Cohesion> {
        self.default.iter().chain(self.own.values().flatten())
    }

    /// That of a pair.
    #[must_use]
    pub fn of(&self, pair: &Pair) -> Option<Cohesion> {
        if pair.target == Target::Surface(pair.source) {
            return None;
        }
        *self.own.get(pair.between()).unwrap_or(&self.default)
    }

    /// Whether nothing breaks the contacts of a pair that hold.
    #[must_use]
    pub fn is_unbreakable(&self, pair: &Pair) -> bool {
        self.of(pair).is_some_and(|cohesion| cohesion.strength == Strength::Unbreakable)
    }

    /// What holds a contact of a pair together as long as it is closed [N], where nodes are at `position`; none where nothing does. What nothing
    /// breaks begins with the least there is.
    pub(crate) fn adhesion<const D: usize>(
        &self,
        (pair, site): (&Pair, Site),
        contact: &Contact<D>,
        bearing: &Bearing,
        position: &Positions<'_, D>,
    ) -> Option<f64> {
        let area = || match site {
            Site::Node(node) => {
                let pushes = contact.frame.row(0).transpose();
                bearing.area(node as usize, &pushes, position)
            }
            Site::Multiplier(..) => contact.area * bearing.depth(pair.source),
            // What no node stands for has no area of its own.
            _ => 0.0,
        };
        let adhesion = match self.of(pair)?.strength {
            Strength::Unbreakable => f64::MIN_POSITIVE,
            Strength::Force(force) => force,
            Strength::Stress(stress) => stress * area(),
        };
        (adhesion > 0.0).then_some(adhesion)
    }
}
