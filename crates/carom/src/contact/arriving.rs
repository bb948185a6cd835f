//! What comes so near to its target that it has to be stopped now, where velocities are ruled.

use carom_contact::{Candidate, Site};
use carom_mesh::Vector;

use super::active::ActiveSet;
use super::candidates::Finder;
use crate::model::given::Given;
use crate::model::state::State;

impl<const D: usize> Finder<D> {
    /// Whether the step, which ended at `next` after this `motion`, let a contact come so near that the next one could not keep it out. If so, it takes
    /// part from now on.
    ///
    /// What is stopped goes on in that step: with v₊ = a v + b d by (a + e) v/b, at θ = ½ and without restitution by half of its way. So it
    /// stops before it arrives, and never goes in. The next step may be a whole one, where this was a part. Rows of mortar pairs, which
    /// cannot be recalled, do that once they have arrived, and so do contacts of pairs that hold together where they touch.
    pub(super) fn lets_arrive(
        &mut self,
        given: &Given<'_, D>,
        motion: &[Vector<D>],
        active: &ActiveSet<D>,
        next: &State<D>,
    ) -> bool {
        let Given { assembly, state, interval, .. } = *given;
        let map = &interval.map;
        let Self { found, needed, missed, missed_contacts, missed_mortar, .. } = self;
        let is_open = |c: &&Candidate| {
            !c.redundant
                && !matches!(c.site, Site::Multiplier(..))
                && active.candidates.binary_search_by_key(&c.key(), Candidate::key).is_err()
        };
        missed.clear();
        missed.extend(found.iter().filter(is_open).filter(|c| needed.binary_search(&c.key()).is_err()));
        let end = |n: u32| assembly.reference[n as usize] + next.displacement[n as usize];
        assembly.contact.evaluate_all(missed, &end, missed_mortar, missed_contacts);
        let velocity = |n: usize| map.end_velocity(&state.velocity[n], &motion[n]);
        let known = needed.len();
        let per_velocity = interval.whole / (map.dt * map.velocity_of_motion);
        for (candidate, contact) in missed.iter().zip(&*missed_contacts) {
            let [before, after] = given.interference(candidate.key());
            let closing = contact.relative(velocity)[0] - (after - before) / map.dt;
            let pair = assembly.contact.pairs.get(candidate.pair as usize);
            if assembly.cohesions.of(&pair).is_some() {
                continue;
            }
            let restitution = assembly.restitutions.of(&pair).unwrap_or(0.0);
            let goes_on = (map.velocity_of_velocity + restitution) * closing.min(0.0) * per_velocity;
            if contact.gap - after < goes_on.max(0.0) - assembly.round_off() {
                needed.push(candidate.key());
            }
        }
        needed.sort_unstable();
        needed.len() > known
    }
}
