use std::ops::Range;

use carom_contact::{Contact, ContactModel, Positions};
use carom_mesh::Vector;

use crate::ledger::ByPair;

/// The pairs whose friction is orthotropic.
#[derive(Debug, Clone, Default)]
pub struct Orthotropies<const D: usize> {
    /// What is known of them.
    pub own: ByPair<Orthotropy<D>>,
}

impl<const D: usize> Orthotropies<D> {
    /// That of a pair of the `contact` model by its number; none where friction is the same in all directions.
    #[inline]
    #[must_use]
    pub fn of(&self, pair: u32, contact: &ContactModel<D>) -> Option<&Orthotropy<D>> {
        // Most models have none.
        if self.own.is_empty() { None } else { self.own.get(contact.pairs.get(pair as usize).between()) }
    }
}

/// Friction that depends on the direction: (r₁/μ₁)² + (r₂/μ₂)² ≤ rₙ², with a sliding rule that is associated in the tangent plane, so that the
/// velocity of what slides is along (r₁/μ₁², r₂/μ₂²) and the most is dissipated that the cone allows.
///
/// With μ the larger of both and tangents of the lengths μ₁/μ and μ₂/μ the cone is circular, and the sliding rule Coulomb's: r·w is what it was.
/// [Hjiaj, Feng, de Saxcé & Mróz 2004]
#[derive(Debug, Clone)]
pub struct Orthotropy<const D: usize> {
    /// μ₁/μ and μ₂/μ; of laws where contacts have never slid.
    pub lengths: [f64; 2],
    /// The direction of μ₁.
    pub grain: Grain<D>,
}

impl<const D: usize> Orthotropy<D> {
    /// Lays the frame of a contact along the grain, where nodes are at `position`, with tangents of these `lengths` where they are not constant.
    pub(crate) fn orient(
        &self,
        contact: &mut Contact<D>,
        lengths: Option<[f64; 2]>,
        position: &Positions<'_, D>,
    ) {
        let direction = self.grain.at(contact, position);
        contact.stretch_frame(&direction, lengths.unwrap_or(self.lengths));
    }
}

/// A direction that a surface carries.
#[derive(Debug, Clone)]
pub enum Grain<const D: usize> {
    /// Of an obstacle, which does not turn.
    Fixed(Vector<D>),
    /// Of a body: at every node a sum of places of nodes around, Σ c x with Σ c = 0, so that it follows the surface as a line drawn on it.
    Carried {
        /// The nodes of the body.
        nodes: Range<usize>,
        /// Nodes and c, in the numbers of all nodes; none inside.
        around: Vec<Vec<(u32, f64)>>,
    },
}

impl<const D: usize> Grain<D> {
    /// At a contact, where nodes are at `position`; of any length.
    fn at(&self, contact: &Contact<D>, position: &Positions<'_, D>) -> Vector<D> {
        match self {
            Self::Fixed(direction) => *direction,
            Self::Carried { nodes, around } => {
                let own = contact.stencil().filter(|(node, _)| nodes.contains(node));
                own.fold(Vector::zeros(), |sum, (node, weight)| {
                    let terms = around[node - nodes.start].iter();
                    let along = terms.fold(Vector::<D>::zeros(), |x, &(n, c)| x + position(n) * c);
                    sum + along * weight.abs()
                })
            }
        }
    }
}
