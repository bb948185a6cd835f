//! What W was made of: where none of it has changed W is what it was. On flat ground that is so from one iteration to the next.

use carom_contact::Contact;
use carom_mesh::Matrix;

use super::compliance::Compliance;
use crate::model::assembly::Assembly;

/// What W was made of.
#[derive(Debug)]
pub(super) struct MadeOf<const D: usize> {
    is_known: bool,
    /// The frames of its contacts, their stencils one after the other, and where each of these ends.
    frames: Vec<Matrix<D>>,
    stencils: Vec<(usize, f64)>,
    ends: Vec<usize>,
    /// The bodies that respond, and the versions of their compliances.
    bodies: Vec<(usize, u64)>,
}

impl<const D: usize> MadeOf<D> {
    /// Nothing that is known.
    pub fn nothing() -> Self {
        let (frames, stencils, ends, bodies) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        Self { is_known: false, frames, stencils, ends, bodies }
    }

    /// Forgets it, as W is to become another.
    pub fn forget(&mut self) {
        self.is_known = false;
    }

    /// Whether it was these contacts, and these compliances as they are.
    pub fn is(&self, contacts: &[Contact<D>], compliances: &[Compliance<D>]) -> bool {
        let is_stencil = |k: usize, contact: &Contact<D>| {
            let first = if k == 0 { 0 } else { self.ends[k - 1] };
            contact.stencil().eq(self.stencils[first..self.ends[k]].iter().copied())
        };
        self.is_known
            && self.frames.len() == contacts.len()
            && self.bodies.iter().all(|&(b, version)| compliances[b].version() == version)
            && contacts.iter().zip(&self.frames).all(|(contact, frame)| contact.frame == *frame)
            && contacts.iter().enumerate().all(|(k, contact)| is_stencil(k, contact))
    }

    /// Takes note of these contacts and compliances. Where supports hold what contacts move W has something of the motion, and is not to be kept.
    pub fn take_note(
        &mut self,
        assembly: &Assembly<D>,
        contacts: &[Contact<D>],
        compliances: &[Compliance<D>],
    ) {
        let Self { is_known, frames, stencils, ends, bodies } = self;
        *is_known = true;
        frames.clear();
        frames.extend(contacts.iter().map(|contact| contact.frame));
        stencils.clear();
        ends.clear();
        bodies.clear();
        for contact in contacts {
            stencils.extend(contact.stencil());
            ends.push(stencils.len());
        }
        for &(node, _) in &*stencils {
            let Some(b) = assembly.body_of(node) else { continue };
            if *assembly.held(node) != [false; D] {
                *is_known = false;
                return;
            }
            if bodies.last().is_none_or(|&(last, _)| last != b) {
                bodies.push((b, compliances[b].version()));
            }
        }
        bodies.sort_unstable();
        bodies.dedup();
    }
}

#[cfg(test)]
mod tests {
    use carom_contact::ContactModel;
    use carom_mesh::{Surface, Vector};

    use super::*;
    use crate::model::assembly::Member;

    fn assembly(held: Vec<[bool; 2]>) -> Assembly<2> {
        let member = Member {
            name: "body".into(),
            reference: vec![Vector::zeros(); 3],
            diameter: 1.0,
            boundary: Surface::default(),
            held,
            is_massless: false,
            turns: true,
            axis: Vec::new(),
            stepped: Vec::new(),
        };
        let contact = ContactModel { surfaces: Vec::new(), obstacles: Vec::new(), pairs: Vec::new().into() };
        Assembly::new(vec![member], contact, Vec::new())
    }

    fn contact(node: u32, turn: f64, gap: f64) -> Contact<2> {
        let frame = Matrix::<2>::new(turn.cos(), turn.sin(), -turn.sin(), turn.cos());
        Contact::of_stencil(gap, frame, 0.0, std::iter::once((node, 1.0)), 1)
    }

    /// Contacts whose gaps alone differ have the same W; those with other nodes, frames or compliances, or another number of them, have not.
    #[test]
    fn w_is_what_it_was_for_the_same_frames_stencils_and_compliances_alone() {
        let (assembly, compliances) = (assembly(Vec::new()), [Compliance::new(3)]);
        let contacts = [contact(0, 0.1, 0.0), contact(2, 0.2, 0.0)];
        let mut made_of = MadeOf::nothing();
        assert!(!made_of.is(&contacts, &compliances));
        made_of.take_note(&assembly, &contacts, &compliances);
        assert!(made_of.is(&[contact(0, 0.1, 1.0), contact(2, 0.2, -1.0)], &compliances));
        assert!(!made_of.is(&[contact(0, 0.1, 0.0), contact(1, 0.2, 0.0)], &compliances));
        assert!(!made_of.is(&[contact(0, 0.1, 0.0), contact(2, 0.2 + 1e-15, 0.0)], &compliances));
        assert!(!made_of.is(&contacts[..1], &compliances));
        let mut others = Compliance::new(3);
        others.clear();
        assert!(!made_of.is(&contacts, &[others]));
        made_of.forget();
        assert!(!made_of.is(&contacts, &compliances));
    }

    /// What stands in for the compliance of supports depends on the motion.
    #[test]
    fn w_of_contacts_that_supports_hold_is_never_kept() {
        let (assembly, compliances) = (assembly(vec![[true, false]; 3]), [Compliance::new(3)]);
        let contacts = [contact(1, 0.0, 0.0)];
        let mut made_of = MadeOf::nothing();
        made_of.take_note(&assembly, &contacts, &compliances);
        assert!(!made_of.is(&contacts, &compliances));
    }
}
