//! Which contacts there may be in a step.

use carom_contact::{
    Candidate, Contact, Mortar, Pair, Pairs, Path, Positions, Search, Site, Solid, Target, Witness,
};
use carom_mesh::Vector;

use super::active::ActiveSet;
use super::control::CONTROL;
use super::kinks;
use crate::model::at_rest::AtRest;
use crate::model::given::Given;
use crate::model::state::{Reaction, State};

/// Finds candidates, and sees afterwards whether one was missed.
#[derive(Debug, Default)]
pub(crate) struct Finder<const D: usize> {
    pub search: Search<D>,
    /// Bodies that are so far from touching themselves that they are not searched for it.
    pub asleep: Vec<bool>,
    /// All that the search found, ascending.
    pub found: Vec<Candidate>,
    /// Those of the step that say what no other does, as the measure has shown, or that arrive, where velocities are ruled; ascending.
    pub(super) needed: Vec<(u32, Site)>,
    /// How often the step has been repeated.
    repetition: usize,
    /// Whether the last step has looked at its end for what it did not find.
    has_looked: bool,
    pub(super) missed: Vec<Candidate>,
    pub(super) missed_contacts: Vec<Contact<D>>,
    pub(super) missed_mortar: Mortar<D>,
}

impl<const D: usize> Finder<D> {
    /// Of so many `bodies`, all awake.
    pub fn new(bodies: usize) -> Self {
        Self { asleep: vec![false; bodies], ..Self::default() }
    }

    /// Finds the candidates of the step between its start and the predicted end. Another time it searches between its start and where it
    /// led to, beside those already found and those missed there.
    ///
    /// Nodes are not looked for farther and farther away: in a fast step that would be all there are, and their problem dense. Only
    /// the rows of mortar pairs, which cannot be recalled, are found by a wider margin.
    pub fn find(
        &mut self,
        given: &Given<'_, D>,
        at_rest: &AtRest,
        motion: &[Vector<D>],
        (margin, repetition): (f64, usize),
        active: &mut ActiveSet<D>,
    ) {
        let start = |n: u32| given.position(n);
        let end = |n: u32| start(n) + motion[n as usize];
        let path = Path { start: &start, end: &end, margin };
        let (assembly, candidates) = (given.assembly, &mut active.candidates);
        let contact = &assembly.contact;
        self.repetition = repetition;
        let Self { search, asleep, .. } = self;
        let counts = |pair: &Pair| !is_asleep(asleep, pair) && !at_rest.are_still(pair);
        if at_rest.is_everything() {
            candidates.clear();
        } else {
            contact.detect_node_by_node(counts, &path, search, candidates);
        }
        let moves = |r: &&Reaction<D>| !at_rest.are_still(&contact.pairs.get(r.pair as usize));
        let pressed = given.state.reactions.iter().filter(moves).map(Reaction::candidate);
        let stand_off = |c: &Candidate| given.interference(c.key())[0].abs();
        self.missed.clear();
        self.missed.extend(pressed.filter(|c| contact.still_touches(c, stand_off(c), &start)));
        contact.recall(&self.missed, &path, candidates);
        if repetition == 0 {
            self.needed.clear();
        } else {
            contact.recall(&self.found, &path, candidates);
        }
        for key in &self.needed {
            if let Ok(k) = candidates.binary_search_by_key(key, Candidate::key) {
                candidates[k].redundant = false;
            }
        }
        let wide = Path { margin: margin * CONTROL.widening.powi(repetition as i32), ..path };
        contact.detect_mortar(&wide, &mut active.mortar, candidates);
        let bonds = given.state.holding().filter(|r| assembly.is_unbreakable(r.pair));
        for bond in bonds.filter(moves).map(Reaction::candidate) {
            match candidates.binary_search_by_key(&bond.key(), Candidate::key) {
                Ok(k) => candidates[k].redundant = false,
                Err(k) => candidates.insert(k, bond),
            }
        }
        if repetition > 0 {
            kinks::keep_both_facets(&self.found, candidates);
        }
        // A second facet that is the first one says nothing, and may not be the one that is missed.
        candidates.retain(|c| !(c.redundant && matches!(c.site, Site::Second(_))));
        // In load steps a node at a kink goes on to the other facet, in others it is kept out of both. What is a kink is so for the whole step.
        if !given.interval.map.is_static() {
            candidates.iter_mut().for_each(|c| c.stays = contact.concave_kinks(c, &start));
        }
        self.found.clone_from(candidates);
        self.has_looked = false;
    }

    /// Whether a node that the search did not find, or that another stood for, has gone through its target by the end of the step. If so, what was
    /// missed is searched from now on.
    ///
    /// Where the condition is not written there, it is what [arrives](Self::lets_arrive) beside the `active` ones after this `motion`, as long as the step
    /// `may_be_repeated`, and it is looked for on the way that the next step would go.
    pub fn missed_one(
        &mut self,
        given: &Given<'_, D>,
        at_rest: &AtRest,
        (motion, next): (&[Vector<D>], &State<D>),
        active: &ActiveSet<D>,
        may_be_repeated: bool,
    ) -> bool {
        let rules_the_end = given.method.condition.rules_the_end();
        if !rules_the_end && !may_be_repeated {
            return false;
        }
        // What velocities rule may be inside and stay there for a while.
        self.has_looked = rules_the_end;
        if at_rest.is_everything() {
            return false;
        }
        let Given { assembly, state, interval, .. } = *given;
        let end = |n: u32| assembly.reference[n as usize] + next.displacement[n as usize];
        let goes_on = |n: u32| {
            let velocity = interval.map.end_velocity(&state.velocity[n as usize], &motion[n as usize]);
            end(n) + velocity * interval.whole
        };
        // What is closed counts whatever the sign of round-off: an edge that goes on keeps others from being found at its end.
        let closed = CONTROL.closed * assembly.size;
        let margin = assembly.reach(interval.end) + closed;
        let at_end = if rules_the_end {
            Path::resting(&end, margin)
        } else {
            Path { start: &end, end: &goes_on, margin }
        };
        let Self { search, asleep, found, needed, missed, missed_mortar, missed_contacts, .. } = self;
        let contact = &assembly.contact;
        let counts = |pair: &Pair| !is_asleep(asleep, pair) && !at_rest.are_still(pair);
        contact.detect_node_by_node(counts, &at_end, search, missed);
        assembly.contact.detect_mortar(&at_end, missed_mortar, missed);
        // Two facets may change places from one attempt at a step to the next. In space rows of faces that lie flush on one another would say
        // the same many times.
        let may_have_second = D == 2 && !interval.map.is_static() && self.repetition < CONTROL.second_facets;
        if may_have_second {
            kinks::find_seconds(contact, found, &end, missed);
        }
        missed.retain(|m| kinks::known(found, m.key()).is_none());
        missed.sort_unstable();
        assembly.contact.evaluate_all(missed, &end, missed_mortar, missed_contacts);
        let mut missed_one = false;
        let mut gaps = missed_contacts.iter().map(|c| c.gap);
        missed.retain(|m| {
            let Some(gap) = gaps.next() else { return true };
            // On a smooth target a facet that is not the one it was is no second one.
            let first = kinks::first_of(m, found);
            let other = first.map(|first| assembly.contact.evaluate(first, &end).gap);
            let least = given.interference(m.key())[1] + other.unwrap_or(0.0).min(0.0);
            // Where motions are ruled, gaps are as good as the way of a step is straight.
            let is_ruled = first.is_none() || given.condition_of(m.pair).rules_gaps();
            let round_off = if is_ruled { assembly.round_off() } else { closed };
            let is_inside = gap < least - round_off;
            missed_one |= is_inside;
            // What nodes are not behind is a facet of a convex corner, which either of both keeps out of.
            is_inside || first.is_none()
        });
        let known = needed.len();
        // In load steps both would rule a turn that nothing resists: coarse fits of round parts did not converge.
        let is_static = interval.map.is_static();
        let parted = found.iter().filter(|c| {
            let touching = given.interference(c.key())[1] - closed;
            !is_static && c.redundant && contact.has_parted(c, touching, &end, found)
        });
        needed.extend(parted.map(Candidate::key));
        needed.sort_unstable();
        if missed_one || !rules_the_end {
            found.extend_from_slice(missed);
            found.sort_unstable();
        }
        let rouses = missed_one || needed.len() > known;
        if rules_the_end { rouses } else { self.lets_arrive(given, motion, active, next) }
    }

    /// Those that have to take part, as the last attempt at the step has shown.
    pub fn needed(&self) -> &[(u32, Site)] {
        &self.needed
    }

    /// Takes note that the step has come to nothing.
    pub fn forget_end(&mut self) {
        self.has_looked = false;
    }

    /// The nodes that may be inside of surfaces where the last step ended, each with its pair, ascending: those that were found. Of all others it has seen that they
    /// are not. Contacts are among them: a node in front of the facet that it faces may be behind the next one. None if it has not looked, and of rows of mortar
    /// pairs, which are about means.
    pub fn suspects(&self, pairs: &Pairs) -> Option<Vec<(u32, u32)>> {
        if !self.has_looked || pairs.have_mortar() {
            return None;
        }
        let mut suspects: Vec<_> = self.found.iter().filter_map(|c| Some((c.pair, c.node()?))).collect();
        suspects.sort_unstable();
        suspects.dedup();
        Some(suspects)
    }

    /// Whether candidates that nobody had found would have kept out what the measure of the step has found inside. If so, they are searched
    /// from now on.
    pub fn missed_by(&mut self, given: &Given<'_, D>, next: &State<D>, witnesses: &[Witness]) -> bool {
        if witnesses.is_empty() {
            return false;
        }
        let assembly = given.assembly;
        let is_too_deep = |w: &&Witness| {
            let between = [Solid::Body(w.of), Solid::Body(w.inside)];
            w.depth > assembly.clearance(between, given.interval.end)
        };
        let witnesses: Vec<Witness> = witnesses.iter().filter(is_too_deep).copied().collect();
        let start = |n: u32| given.position(n);
        let end = |n: u32| assembly.reference[n as usize] + next.displacement[n as usize];
        let Self { search, found, needed, missed, .. } = self;
        assembly.contact.witnessed(
            &witnesses,
            &Path { start: &start, end: &end, margin: 0.0 },
            search,
            missed,
        );
        missed.retain(|m| match found.binary_search_by_key(&m.key(), Candidate::key) {
            Ok(k) => std::mem::take(&mut found[k].redundant),
            Err(_) => true,
        });
        if missed.is_empty() {
            return false;
        }
        needed.extend(missed.iter().map(Candidate::key));
        needed.sort_unstable();
        missed.retain(|m| found.binary_search_by_key(&m.key(), Candidate::key).is_err());
        found.extend_from_slice(missed);
        found.sort_unstable();
        true
    }

    /// Whether a `body` is somewhere within `reach` [m] of itself where the nodes are at `position`.
    pub fn comes_near_itself(
        &mut self,
        given: &Given<'_, D>,
        body: usize,
        reach: f64,
        position: &Positions<'_, D>,
    ) -> bool {
        let Self { search, missed, .. } = self;
        given.assembly.contact.detect_itself(body, &Path::resting(position, reach), search, missed);
        !self.missed.is_empty()
    }
}

/// Whether a pair is that of a body with itself which is not looked at.
fn is_asleep(asleep: &[bool], pair: &Pair) -> bool {
    pair.target == Target::Surface(pair.source) && asleep.get(pair.source).is_some_and(|asleep| *asleep)
}
