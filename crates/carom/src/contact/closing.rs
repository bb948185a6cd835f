//! The end of a step for its contacts: which reactions are kept, how far they are from the law, and what work they have done.

use carom_contact::{Candidate, Contact, Site};
use carom_friction::cone;
use carom_mesh::Vector;

use super::active::ActiveSet;
use super::contact_work::driven;
use crate::model::given::Given;
use crate::model::state::{Reaction, State};

/// What the contacts of a step came to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Kept {
    /// Smallest gap at the end [m]; infinite without contacts.
    pub min_gap: f64,
    /// Sum of the bi-potential gaps [J].
    pub certificate: f64,
    /// Largest distance of a friction coefficient from its law.
    pub friction_defect: f64,
}

/// Measures the contact law at the final motion, whose end is in `next`, keeps the reactions that press there, and evaluates the contacts `at_end`.
/// `offsets` are what the motions lack of the variable of the condition [m].
pub(crate) fn keep<const D: usize>(
    given: &Given<'_, D>,
    active: &mut ActiveSet<D>,
    offsets: &[Vector<D>],
    motion: &[Vector<D>],
    at_end: &mut Vec<Contact<D>>,
    next: &mut State<D>,
) -> Kept {
    next.reactions.clear();
    next.contact_force.fill(Vector::zeros());
    let mut kept = Kept { min_gap: f64::INFINITY, certificate: 0.0, friction_defect: 0.0 };
    let assembly = given.assembly;
    let end = |n: u32| assembly.reference[n as usize] + next.displacement[n as usize];
    assembly.contact.evaluate_all(&active.candidates, &end, &mut active.mortar, at_end);
    active.tie(at_end, &end);
    for ((contact, before), [_, h1]) in at_end.iter_mut().zip(&active.contacts).zip(&active.interferences) {
        contact.gap -= h1;
        contact.carry_frame(&before.frame);
        kept.min_gap = kept.min_gap.min(contact.gap);
    }
    for (i, (candidate, contact)) in active.candidates.iter().zip(&active.contacts).enumerate() {
        let r = active.reactions[i] / active.weights[i];
        let mut w = contact.relative(|n| motion[n]);
        w += offsets[i];
        if given.interval.map.is_static() && matches!(candidate.site, Site::Multiplier(..)) {
            // The last correction moved the gap by more than the row says.
            w[0] = at_end[i].gap;
        }
        kept.certificate += cone::bipotential_gap(&w, &r, active.friction[i]);
        if let Some(slider) = active.slider_of(i) {
            let off = active.off_law(given, slider, &w, &offsets[i]);
            kept.friction_defect = kept.friction_defect.max(off);
            // What a coefficient that is not that of the law does to the energy.
            kept.certificate += off * r[0].max(0.0) * cone::tangential_norm(&w);
        }
        let adhesion = active.adhesions[i];
        let presses = r[0] > 0.0 || adhesion.is_some();
        let force = active.acting(i) / active.weights[i];
        contact.add_force(&force, &mut next.contact_force);
        if presses {
            let Candidate { pair, site, facet, .. } = *candidate;
            next.reactions.push(Reaction { pair, site, facet, contact: contact.clone(), force, adhesion });
        }
    }
    kept
}

/// The work of a reaction over a step [J].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ReactionWork<const D: usize> {
    /// What of the reaction counts [N], in the frame of its contact.
    pub force: Vector<D>,
    /// Of its normal part.
    pub normal: f64,
    /// Of prescribed motion and of interference that grows.
    pub prescribed: f64,
    /// What friction takes.
    pub dissipation: f64,
}

/// Tells `book` what the reactions at both `ends` of a step do over its motion, as far as they count in its books.
pub(crate) fn for_each_work<const D: usize>(
    given: &Given<'_, D>,
    motion: &[Vector<D>],
    ends: [&[Reaction<D>]; 2],
    mut book: impl FnMut(&Reaction<D>, ReactionWork<D>),
) {
    for (end, reactions) in ends.into_iter().enumerate() {
        for reaction in reactions {
            let Reaction { contact, force, .. } = reaction;
            let condition = given.condition_of(reaction.pair);
            let force = condition.weights_of_ends(&given.interval.map).part(end, force);
            if force == Vector::<D>::zeros() {
                continue;
            }
            let [h0, h1] = given.interference(reaction.key());
            let w = contact.relative(|n| motion[n]);
            // What pushes the surfaces apart does the work of its growth; the rest is that of the reactions themselves.
            let widening = h1 - h0;
            let work = ReactionWork {
                force,
                normal: force[0] * (w[0] - widening),
                prescribed: driven(given.assembly, contact, &force, motion) + force[0] * widening,
                dissipation: -(1..D).map(|t| force[t] * w[t]).sum::<f64>(),
            };
            book(reaction, work);
        }
    }
}
