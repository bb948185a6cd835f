use carom_mesh::{Facet, Vector};

use crate::path::Positions;
use crate::{Candidate, ContactSurface, Obstacle, Pairs, Site, Target};

/// All surfaces, obstacles and pairs.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ContactModel<const D: usize> {
    /// Surfaces, one per body.
    pub surfaces: Vec<ContactSurface>,
    /// Rigid obstacles.
    pub obstacles: Vec<Obstacle<D>>,
    /// Who is checked against whom.
    pub pairs: Pairs,
}

impl<const D: usize> ContactModel<D> {
    /// Whether the bodies of a pair are checked from both sides, as a body with itself always is.
    #[must_use]
    pub fn is_two_sided(&self, pair: usize) -> bool {
        self.is_self_contact(pair) || self.pairs.directions(pair).len() > 1
    }

    /// Whether the facet of a candidate is one of the surface that it faces.
    #[must_use]
    pub fn has_facet(&self, candidate: &Candidate) -> bool {
        let count = self.faced_surface(candidate).map_or(0, |surface| surface.facets.len());
        candidate.facet.is_none_or(|f| (f as usize) < count)
    }

    /// The facet of a candidate, if it has one.
    #[must_use]
    pub fn facet_of(&self, candidate: &Candidate) -> Option<&Facet> {
        self.faced_surface(candidate)?.facets.get(candidate.facet? as usize)
    }

    /// The surface that a candidate faces a facet of.
    pub(crate) fn faced_surface(&self, candidate: &Candidate) -> Option<&ContactSurface> {
        let pair = self.pairs.get(candidate.pair as usize);
        match (candidate.site, pair.target) {
            (Site::Corner(_) | Site::Facet(_), _) => Some(&self.surfaces[pair.source]),
            (_, Target::Surface(t)) => Some(&self.surfaces[t]),
            (_, Target::Obstacle(o)) => self.obstacles[o].faceted.as_ref().map(|f| &f.surface),
        }
    }

    /// Where nodes, and the corners of the obstacle of a pair, are.
    pub(crate) fn placed(&self, pair: u32, position: &Positions<'_, D>) -> impl Fn(u32) -> Vector<D> {
        let obstacle = match self.pairs.get(pair as usize).target {
            Target::Obstacle(o) => Some(&self.obstacles[o]),
            Target::Surface(_) => None,
        };
        move |n| obstacle.map_or_else(|| position(n), |obstacle| obstacle.placed(position)(n))
    }
}
