//! How far nodes have slid.

use carom_contact::Contact;
use carom_mesh::Vector;

use crate::model::state::Reaction;

/// Gathers sliding distances at the nodes.
#[derive(Debug)]
pub(crate) struct Slip {
    /// For every node of the bodies the sum of weights and of weighted sliding distances [m] of its contacts; zero between steps.
    slid: Vec<[f64; 2]>,
}

impl Slip {
    /// Of so many nodes of bodies.
    pub fn new(nodes: usize) -> Self {
        Self { slid: vec![[0.0; 2]; nodes] }
    }

    /// Adds to the `slip` [m] of every node how far it has slid in a step of this `motion` [m] along what presses on it at the end.
    pub fn add<const D: usize>(&mut self, reactions: &[Reaction<D>], motion: &[Vector<D>], slip: &mut [f64]) {
        let pressing = || reactions.iter().filter(|r| r.in_cone()[0] > 0.0).map(|r| &r.contact);
        for contact in pressing() {
            let distance = contact.distance(&contact.relative(|n| motion[n]));
            for (node, weight) in nodes(contact) {
                if let Some(slid) = self.slid.get_mut(node) {
                    slid[0] += weight;
                    slid[1] += weight * distance;
                }
            }
        }
        for (node, _) in pressing().flat_map(nodes) {
            let [weight, distance] = self.slid.get_mut(node).map(std::mem::take).unwrap_or_default();
            if weight > 0.0 {
                slip[node] += distance / weight;
            }
        }
    }
}

/// The nodes of both sides of a contact with their weights, none of them negative.
fn nodes<const D: usize>(contact: &Contact<D>) -> impl Iterator<Item = (usize, f64)> {
    contact.sources().chain(contact.targets()).map(|(node, weight)| (node, weight.abs()))
}
