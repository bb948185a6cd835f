use carom_contact::{Contact, Site, Solid, Target};
use carom_mesh::Vector;

use super::active::ActiveSet;
use crate::model::assembly::Assembly;
use crate::model::given::Given;

/// A contact in the eyes of the balance: its bodies, μ, normal reactions at the start and the end of the step, and |w_t|.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ContactWork {
    /// Which of the contacts of the step it is; those that are lost come after the others.
    pub number: usize,
    pub between: [Solid; 2],
    pub source: usize,
    pub target: Target,
    pub friction: f64,
    pub start: f64,
    pub end: f64,
    pub slip: f64,
    /// Work [J] that prescribed motion, as of an obstacle, and growing interference would do with the reactions of the start and of the end.
    pub driven: [f64; 2],
}

impl ContactWork {
    /// Work [J] that prescribed motion does through the contact.
    pub fn prescribed(&self, weight: f64) -> f64 {
        (0.5 - weight) * self.driven[0] + (0.5 + weight) * self.driven[1]
    }

    /// μ r̄_n |w_t|: what friction takes in the step [J].
    pub fn dissipation(&self, weight: f64) -> f64 {
        self.friction * ((0.5 - weight) * self.start + (0.5 + weight) * self.end) * self.slip
    }
}

/// Work [J] that prescribed motion does through a contact with the reaction `r`: of an obstacle that moves, and of what supports
/// hold of the nodes around.
pub(crate) fn driven<const D: usize>(
    assembly: &Assembly<D>,
    contact: &Contact<D>,
    r: &Vector<D>,
    motion: &[Vector<D>],
) -> f64 {
    let travel = contact.stencil().fold(Vector::zeros(), |sum: Vector<D>, (node, weight)| {
        sum - assembly.prescribed_part(node, &motion[node]) * weight
    });
    r.dot(&(contact.frame * travel))
}

/// Writes what massless contacts mean for the balance of their bodies to `out`: those of the step, and those that it starts with and loses.
pub(crate) fn measure<const D: usize>(
    given: &Given<'_, D>,
    active: &ActiveSet<D>,
    motion: &[Vector<D>],
    out: &mut Vec<ContactWork>,
) {
    let work = |number: usize, key: (u32, Site), contact: &Contact<D>, start: Vector<D>, end: Vector<D>| {
        let [h0, h1] = given.interference(key);
        let pair = given.assembly.contact.pairs.get(key.0 as usize);
        let w = contact.relative(|n| motion[n]);
        let driven = [start, end].map(|r| driven(given.assembly, contact, &r, motion) + r[0] * (h1 - h0));
        ContactWork {
            number,
            between: pair.between(),
            source: pair.source,
            target: pair.target,
            friction: pair.friction,
            start: start[0],
            end: end[0],
            slip: (1..D).map(|t| w[t] * w[t]).sum::<f64>().sqrt(),
            driven,
        }
    };
    out.clear();
    for (k, contact) in
        active.contacts.iter().enumerate().filter(|(k, _)| active.conditions[*k].is_massless())
    {
        let (start, end) = (active.start_forces[k], active.reactions[k] / active.weights[k]);
        out.push(work(k, active.candidates[k].key(), contact, start, end));
    }
    for (k, reaction) in active.lost.iter().map(|&k| &given.state.reactions[k]).enumerate() {
        let number = active.contacts.len() + k;
        out.push(work(number, reaction.key(), &reaction.contact, reaction.force, Vector::zeros()));
    }
}
