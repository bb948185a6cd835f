//! Islands: bodies that contacts of a step connect, directly or through others.
//!
//! An obstacle connects nothing, as its motion is prescribed. So islands have nothing to do with one another in the equations of a step, and each
//! iterates alone to its end: with its own contact problem, acceleration and tangents. When it has converged it costs nothing more.

use carom_contact::Target;
use carom_friction::{ContactProblem, Measure, SolverKind, measure};
use carom_mesh::Vector;

use super::active::ActiveSet;
use super::reduced::Reduced;
use super::slider::slider_of;
use crate::model::forest::Forest;
use crate::model::given::Given;

/// The contacts of a step by islands.
#[derive(Debug, Default)]
pub(crate) struct Islands<const D: usize> {
    forest: Forest,
    /// The island of the bodies in contact, by the root of their tree.
    of_root: Vec<usize>,
    /// The island of every contact, and its place there.
    places: Vec<(usize, usize)>,
    /// Those of this step come first; the others are memory.
    all: Vec<Island<D>>,
    count: usize,
    /// The contacts of all, while those of one are the present ones.
    whole: ActiveSet<D>,
}

/// An island, and what its iterations came to.
#[derive(Debug, Default)]
struct Island<const D: usize> {
    bodies: Vec<usize>,
    /// Its contacts among those of the step.
    numbers: Vec<usize>,
    active: ActiveSet<D>,
    problem: ContactProblem<D>,
    offsets: Vec<Vector<D>>,
    guess: Vec<Vector<D>>,
    solved_by: SolverKind,
}

/// Exchanges two sets of contacts of a step: which bodies contacts touch is said by the present one, always.
fn exchange<const D: usize>(present: &mut ActiveSet<D>, other: &mut ActiveSet<D>) {
    std::mem::swap(present, other);
    std::mem::swap(&mut present.touched, &mut other.touched);
}

impl<const D: usize> Island<D> {
    fn clear(&mut self) {
        self.bodies.clear();
        self.numbers.clear();
        self.active.clear();
    }

    /// Puts what is known of it in the place of what is there.
    fn exchange(&mut self, active: &mut ActiveSet<D>, reduced: &mut Reduced<D>) {
        let Self { active: own, problem, offsets, guess, solved_by, .. } = self;
        exchange(active, own);
        std::mem::swap(solved_by, &mut reduced.solved_by);
        std::mem::swap(problem, &mut reduced.problem);
        reduced.delassus.begin_anew();
        std::mem::swap(offsets, &mut reduced.offsets);
        std::mem::swap(guess, &mut reduced.guess);
    }
}

impl<const D: usize> Islands<D> {
    fn is_divided(&self) -> bool {
        self.count > 1
    }

    /// Finds the islands of the bodies in contact; returns how many there are.
    fn find(&mut self, given: &Given<'_, D>, active: &ActiveSet<D>) -> usize {
        let Self { forest, of_root, all, count, .. } = self;
        let pairs = &given.assembly.contact.pairs;
        forest.begin(active.touched.len());
        let connects = must_stay_whole(given);
        let mut first = None;
        for body in (0..active.touched.len()).filter(|&i| connects && active.touched[i]) {
            forest.join(*first.get_or_insert(body), body);
        }
        let lost = active.lost.iter().map(|&k| given.state.reactions[k].pair);
        for pair in active.candidates.iter().map(|c| c.pair).chain(lost) {
            let pair = pairs.get(pair as usize);
            if let Target::Surface(target) = pair.target {
                forest.join(pair.source, target);
            }
        }
        of_root.resize(active.touched.len(), 0);
        *count = 0;
        for body in (0..active.touched.len()).filter(|&i| active.touched[i]) {
            let root = forest.root(body);
            if root == body {
                of_root[root] = *count;
                *count += 1;
                if all.len() < *count {
                    all.push(Island::default());
                }
                all[*count - 1].clear();
            }
            all[of_root[root]].bodies.push(body);
        }
        *count
    }

    /// Gives every island its contacts.
    fn share(&mut self, given: &Given<'_, D>) {
        let Self { forest, of_root, places, all, whole, .. } = self;
        let pairs = &given.assembly.contact.pairs;
        let mut island_of = |pair: u32| of_root[forest.root(pairs.get(pair as usize).source)];
        places.clear();
        for (i, candidate) in whole.candidates.iter().enumerate() {
            let number = island_of(candidate.pair);
            let island = &mut all[number];
            places.push((number, island.numbers.len()));
            island.numbers.push(i);
            island.active.take(whole, i);
        }
        for slider in &whole.sliders {
            let (number, place) = places[slider.contact];
            let mut own = *slider;
            own.contact = place;
            all[number].active.sliders.push(own);
        }
        for (i, bond) in &whole.bonds {
            let (number, place) = places[*i];
            all[number].active.bonds.push((place, bond.clone()));
        }
        for &k in &whole.lost {
            all[island_of(given.state.reactions[k].pair)].active.lost.push(k);
        }
    }

    /// Takes what the iterations of every island have made of its contacts.
    fn gather(&mut self, given: &Given<'_, D>) {
        let Self { places, all, whole, count, .. } = self;
        whole.contacts.clear();
        for (i, &(number, place)) in places.iter().enumerate() {
            let own = &all[number].active;
            whole.contacts.push(own.contacts[place].clone());
            whole.frames[i] = own.frames[place];
            whole.friction[i] = own.friction[place];
            whole.adhesions[i] = own.adhesions[place];
            whole.reactions[i] = own.reactions[place];
        }
        for slider in &mut whole.sliders {
            let (number, place) = places[slider.contact];
            if let Some(own) = slider_of(&all[number].active.sliders, place) {
                let contact = slider.contact;
                *slider = *own;
                slider.contact = contact;
            }
        }
        whole.unsettled = all[..*count].iter().map(|island| island.active.unsettled).fold(0.0, f64::max);
        let sliders = std::mem::take(&mut whole.sliders);
        whole.prepare_pressing(given, &sliders);
        whole.sliders = sliders;
    }

    /// Makes the contact problem of all of those of the islands.
    fn gather_problems(&self, whole: &mut Reduced<D>) {
        let Reduced { delassus, problem, offsets, guess, .. } = whole;
        delassus.begin_anew();
        problem.w.clear();
        problem.q.clear();
        problem.mu.clear();
        offsets.clear();
        guess.clear();
        for &(number, place) in &self.places {
            let own = &self.all[number];
            let row = own.problem.w.row(place);
            problem.w.push_row(row.map(|(column, block)| (own.numbers[column], *block)));
            problem.q.push(own.problem.q[place]);
            problem.mu.push(own.problem.mu[place]);
            offsets.push(own.offsets[place]);
            guess.push(own.guess[place]);
        }
    }
}

/// Whether all that is in contact is taken for one island: load steps look at bodies together that hold one another, springs connect bodies too, and rows of
/// mortar pairs are made together.
fn must_stay_whole<const D: usize>(given: &Given<'_, D>) -> bool {
    let Given { assembly, interval, .. } = *given;
    interval.map.is_static()
        || interval.is_load_step
        || !assembly.springs.is_empty()
        || assembly.contact.pairs.have_mortar()
}

impl<const D: usize> Islands<D> {
    /// Divides the `active` contacts of a step by islands; returns how many there are.
    pub fn divide(&mut self, given: &Given<'_, D>, active: &mut ActiveSet<D>) -> usize {
        let count = self.find(given, active);
        if self.is_divided() {
            exchange(active, &mut self.whole);
            self.share(given);
        }
        count
    }

    /// The bodies of an island, ascending, and how many contacts it has.
    pub fn island(&self, island: usize) -> (&[usize], usize) {
        let Island { bodies, numbers, .. } = &self.all[island];
        (bodies, numbers.len())
    }

    /// Hands these islands over `to` others.
    pub fn hand_over(&mut self, islands: &[usize], to: &mut Self) {
        to.count = self.count;
        to.all.resize_with(to.all.len().max(self.count), Island::default);
        islands.iter().for_each(|&island| std::mem::swap(&mut self.all[island], &mut to.all[island]));
    }

    /// Makes the contacts of an island the `active` ones; returns its bodies, ascending.
    pub fn enter(
        &mut self,
        island: usize,
        active: &mut ActiveSet<D>,
        reduced: &mut Reduced<D>,
    ) -> Vec<usize> {
        if self.is_divided() {
            self.all[island].exchange(active, reduced);
        }
        std::mem::take(&mut self.all[island].bodies)
    }

    /// Keeps what the iterations of an island have come to, of these `bodies`.
    pub fn leave(
        &mut self,
        island: usize,
        bodies: Vec<usize>,
        active: &mut ActiveSet<D>,
        reduced: &mut Reduced<D>,
    ) {
        self.all[island].bodies = bodies;
        if self.is_divided() {
            self.all[island].exchange(active, reduced);
        }
    }

    /// Puts the islands of a step together again.
    pub fn join(&mut self, given: &Given<'_, D>, active: &mut ActiveSet<D>, reduced: &mut Reduced<D>) {
        if !self.is_divided() {
            return;
        }
        self.gather(given);
        self.gather_problems(reduced);
        let largest = self.all[..self.count].iter().max_by_key(|island| island.numbers.len());
        reduced.solved_by = largest.map_or(reduced.solved_by, |island| island.solved_by);
        exchange(active, &mut self.whole);
    }

    /// Gives up a step in which the iterations of an island have failed: its problem is the last one posed.
    pub fn give_up(&mut self, island: usize, active: &mut ActiveSet<D>, reduced: &mut Reduced<D>) {
        if self.is_divided() {
            std::mem::swap(&mut self.all[island].problem, &mut reduced.problem);
            reduced.delassus.begin_anew();
            std::mem::swap(&mut self.all[island].guess, &mut reduced.guess);
            exchange(active, &mut self.whole);
        }
    }

    /// How far the reactions of the step are from the laws, where every island is measured on its own.
    pub fn measure(&self, active: &ActiveSet<D>, reduced: &Reduced<D>) -> Measure {
        if !self.is_divided() {
            return measure(&reduced.problem, &active.reactions);
        }
        let in_contact = self.all[..self.count].iter().filter(|island| !island.numbers.is_empty());
        in_contact.map(|island| measure(&island.problem, &island.active.reactions)).fold(
            Measure::default(),
            |sum, own| Measure {
                residual: larger(sum.residual, own.residual),
                natural_residual: larger(sum.natural_residual, own.natural_residual),
                certificate: sum.certificate + own.certificate,
            },
        )
    }
}

impl<const D: usize> ActiveSet<D> {
    /// Forgets all contacts.
    fn clear(&mut self) {
        self.candidates.clear();
        self.contacts.clear();
        self.conditions.clear();
        self.weights.clear();
        self.frames.clear();
        self.friction.clear();
        self.sliders.clear();
        self.unsettled = 0.0;
        self.start_gaps.clear();
        self.interferences.clear();
        self.adhesions.clear();
        self.bonds.clear();
        self.start_forces.clear();
        self.at_kink.clear();
        self.reactions.clear();
        self.lost.clear();
    }

    /// Takes contact `i` of a `whole`, as it was selected.
    fn take(&mut self, whole: &Self, i: usize) {
        self.candidates.push(whole.candidates[i]);
        self.conditions.push(whole.conditions[i]);
        self.weights.push(whole.weights[i]);
        self.frames.push(whole.frames[i]);
        self.friction.push(whole.friction[i]);
        self.start_gaps.push(whole.start_gaps[i]);
        self.interferences.push(whole.interferences[i]);
        self.adhesions.push(whole.adhesions[i]);
        self.start_forces.push(whole.start_forces[i]);
        self.reactions.push(whole.reactions[i]);
    }
}

/// The larger of two numbers, and none where one is not a number.
fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}
