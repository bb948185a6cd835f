//! The pressure at contacts whose friction depends on it.

use carom_contact::{Candidate, Contact, shares};
use carom_mesh::Vector;

use super::slider::Slider;
use crate::model::given::Given;

/// What makes pressures of normal reactions.
///
/// The pressure of a contact is that at its source nodes: what all contacts between the same two solids press on a node with, from either side, over
/// the [area](crate::Bearing::area) around it.
#[derive(Debug, Default)]
pub(super) struct Pressing {
    /// Nodes with the contacts that press on them and their share [node, contact, share], by node.
    shares: Vec<(usize, usize, f64)>,
    /// For every slider its contact, and where its terms end.
    ends: Vec<(usize, usize)>,
    /// Contacts and what their normal reactions count for [1/m²].
    terms: Vec<(usize, f64)>,
}

impl Pressing {
    /// Of the contacts as they were last evaluated.
    pub fn prepare<const D: usize>(
        &mut self,
        given: &Given<'_, D>,
        candidates: &[Candidate],
        contacts: &[Contact<D>],
        sliders: &[Slider<D>],
    ) {
        let Self { shares: all, ends, terms } = self;
        ends.clear();
        terms.clear();
        let assembly = given.assembly;
        if !assembly.friction_laws.depend_on_pressure() {
            return;
        }
        all.clear();
        for (j, contact) in contacts.iter().enumerate() {
            for (node, share) in shares(contact.sources()).chain(shares(contact.targets())) {
                all.push((node, j, share));
            }
        }
        all.sort_unstable_by_key(|&(node, j, _)| (node, j));
        let pair_of = |i: usize| assembly.contact.pairs.get(candidates[i].pair as usize);
        let position = |n: u32| given.position(n);
        for &Slider { contact: i, .. } in sliders {
            let pair = pair_of(i);
            let depends = assembly.friction_laws.of(&pair).is_some_and(|law| law.depends_on_pressure());
            if depends {
                let contact = &contacts[i];
                let pushes: Vector<D> = contact.frame.row(0).transpose();
                for (node, share) in shares(contact.sources()) {
                    let area = assembly.bearing.area(node, &pushes, &position);
                    if area > 0.0 {
                        let from = all.partition_point(|&(n, ..)| n < node);
                        let on_it = all[from..].iter().take_while(|&&(n, ..)| n == node);
                        let of_pair = on_it.filter(|&&(_, j, _)| pair_of(j).between() == pair.between());
                        terms.extend(of_pair.map(|&(_, j, part)| (j, share * part / area)));
                    }
                }
            }
            ends.push((i, terms.len()));
        }
    }

    /// The pressure [Pa] at contact `i`, a slider, with these `normal` reactions of contacts [N]; 0 where no law asks for it.
    pub fn at(&self, i: usize, normal: impl Fn(usize) -> f64) -> f64 {
        let Ok(k) = self.ends.binary_search_by_key(&i, |&(contact, _)| contact) else { return 0.0 };
        let from = if k == 0 { 0 } else { self.ends[k - 1].1 };
        self.terms[from..self.ends[k].1].iter().map(|&(j, part)| normal(j).max(0.0) * part).sum()
    }
}
