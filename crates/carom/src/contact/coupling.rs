//! Which contacts respond to one another.

use carom_contact::Contact;

use super::compliance::Compliance;
use crate::model::assembly::Assembly;

/// No more contacts.
const END: u32 = u32::MAX;

/// The contacts at every node and of every body, so that the partners of one are found without asking all.
#[derive(Debug)]
pub(crate) struct Coupling {
    /// The last contact listed at every node: a place in `links`, or `END`.
    last: Vec<u32>,
    /// Contacts, each with the place of the one listed before at the same node.
    links: Vec<(u32, u32)>,
    of_body: Vec<Vec<u32>>,
}

impl Coupling {
    /// For a model with so many nodes and bodies.
    pub fn new(nodes: usize, bodies: usize) -> Self {
        Self { last: vec![END; nodes], links: Vec::new(), of_body: vec![Vec::new(); bodies] }
    }

    /// Lists `contacts` by node and body.
    pub fn list<const D: usize>(&mut self, assembly: &Assembly<D>, contacts: &[Contact<D>]) {
        self.links.clear();
        for (i, contact) in (0_u32..).zip(contacts) {
            for (node, _) in contact.stencil() {
                let Some(b) = assembly.body_of(node) else { continue };
                self.links.push((i, self.last[node]));
                self.last[node] = self.links.len() as u32 - 1;
                if self.of_body[b].last() != Some(&i) {
                    self.of_body[b].push(i);
                }
            }
        }
    }

    /// Undoes [`Self::list`].
    pub fn forget<const D: usize>(&mut self, assembly: &Assembly<D>, contacts: &[Contact<D>]) {
        for (node, _) in contacts.iter().flat_map(Contact::stencil) {
            let Some(b) = assembly.body_of(node) else { continue };
            self.last[node] = END;
            self.of_body[b].clear();
        }
    }

    /// Writes the contacts that may respond to `contact`, number `i`, and itself, ascending, to `partners`.
    pub fn partners<const D: usize>(
        &self,
        assembly: &Assembly<D>,
        compliances: &[Compliance<D>],
        (i, contact): (usize, &Contact<D>),
        partners: &mut Vec<u32>,
    ) {
        let Self { last, links, of_body } = self;
        partners.clear();
        partners.push(i as u32);
        let mut whole = None;
        for (node, _) in contact.stencil() {
            let Some((b, own)) = assembly.place_of(node) else { continue };
            let first = node - own;
            match compliances[b].near(own) {
                Some(near) => {
                    for &other in near {
                        let mut place = last[first + other as usize];
                        while let Some(&(j, before)) = links.get(place as usize) {
                            partners.push(j);
                            place = before;
                        }
                    }
                }
                None if whole != Some(b) => {
                    partners.extend_from_slice(&of_body[b]);
                    whole = Some(b);
                }
                None => {}
            }
        }
        partners.sort_unstable();
        partners.dedup();
    }
}
