//! Islands of a step side by side: each of several threads iterates some of them, with contacts and scratch of its own.
//!
//! Islands, and bodies that nothing touches, know nothing of one another: what a step comes to is the same to the last bit whoever iterates which.

use carom_mesh::parallel::{BODIES, both, has_threads, share, thread_count};
use carom_mesh::{Vector, nodal};

use super::island::{Solve, iterate_touching};
use super::iterating::Iterating;
use crate::body::Body;
use crate::body::lent::Lent;
use crate::contact::Contacts;
use crate::error::StepError;
use crate::model::assembly::Assembly;
use crate::model::given::Given;

/// A contact is about as much work as so many nodes. It says who iterates what, and nothing else.
const CONTACT: usize = 8;

/// Who iterates what, and those that iterate aside.
#[derive(Default)]
pub(crate) struct SideBySide<const D: usize> {
    /// Of the thread that makes the step, and of the others.
    shares: Vec<Share>,
    asides: Vec<Aside<D>>,
    islands: usize,
    /// How much work islands are, and bodies in none, whose numbers follow.
    amounts: Vec<(usize, usize)>,
}

/// What one thread iterates: islands, and bodies that are in none, ascending.
#[derive(Debug, Clone, Default)]
struct Share {
    islands: Vec<usize>,
    alone: Vec<usize>,
    amount: usize,
}

/// Somebody else who iterates, with bodies that are lent.
struct Aside<const D: usize> {
    iterating: Iterating<D>,
    /// u₊ [m].
    reached: Vec<Vector<D>>,
    lent: Vec<usize>,
    made: Made,
}

/// How many iterations there were at most, or what failed first: an island, or a body, whose numbers follow.
type Made = Result<usize, (usize, StepError)>;

impl<const D: usize> SideBySide<D> {
    /// Deals out so many islands, and the bodies that are `alone`, to as many threads as that is worth the while of.
    pub fn deal(
        &mut self,
        islands: usize,
        alone: impl Fn(usize) -> bool,
        contacts: &Contacts<D>,
        given: &Given<'_, D>,
    ) {
        let Given { assembly, method, interval, .. } = *given;
        let nodes = |i: usize| assembly.nodes(i).len();
        let of_island = |k: usize| {
            let (bodies, contacts) = contacts.island(k);
            bodies.iter().map(|&i| nodes(i)).sum::<usize>() + CONTACT * contacts
        };
        let Self { shares, amounts, .. } = self;
        self.islands = islands;
        amounts.clear();
        amounts.extend((0..islands).map(|k| (of_island(k), k)));
        amounts.extend((0..assembly.body_count()).filter(|&i| alone(i)).map(|i| (nodes(i), islands + i)));
        // What contacts without mass do to bodies with it is summed in one place.
        let is_apart = !(assembly.is_mixed() && method.condition.is_massless());
        let takes_time = !interval.map.is_static() && !interval.is_load_step;
        // A smaller model is stepped from outside of the threads, each of which would have to be woken.
        let is_large = has_threads() && assembly.node_count() >= BODIES;
        let worth = amounts.iter().map(|(amount, _)| amount).sum::<usize>() / BODIES + 1;
        let threads = if is_apart && takes_time && is_large {
            thread_count().min(amounts.len()).min(worth).max(1)
        } else {
            1
        };
        shares.resize_with(threads, Share::default);
        shares.iter_mut().for_each(Share::clear);
        if threads > 1 {
            amounts.sort_unstable_by(|a, b| b.0.cmp(&a.0).then(a.1.cmp(&b.1)));
        }
        for &(amount, number) in &*amounts {
            // A single island is not taken out of the contacts of the step.
            let stays = islands == 1 && number == 0;
            let least = (0..threads).min_by_key(|&k| shares[k].amount).filter(|_| !stays).unwrap_or(0);
            shares[least].amount += amount;
            let Share { islands: touching, alone, .. } = &mut shares[least];
            if number < islands { touching.push(number) } else { alone.push(number - islands) }
        }
        shares.iter_mut().for_each(Share::sort);
    }

    /// Iterates what was dealt out.
    pub fn iterate(
        &mut self,
        solve: Solve<D>,
        given: &Given<'_, D>,
        reached: &mut [Vector<D>],
        iterating: &mut Iterating<D>,
    ) -> Made {
        self.lend(given, reached, iterating);
        let Self { shares, asides, islands, .. } = self;
        let others = shares.len() - 1;
        let iterate_aside = |first: usize, some: &mut [Aside<D>]| {
            for (aside, share) in some.iter_mut().zip(&shares[first + 1..]) {
                let Aside { iterating, reached, made, .. } = aside;
                *made = share.iterate(*islands, solve, given, reached, iterating);
            }
        };
        let mut own = || shares[0].iterate(*islands, solve, given, reached, iterating);
        let made =
            if others == 0 { own() } else { both(own, || share(&mut asides[..others], 1, &iterate_aside)).0 };
        self.take_back(made, given, reached, iterating)
    }

    /// Lends bodies and islands to the others, and tells them where bodies are guessed to be.
    fn lend(&mut self, given: &Given<'_, D>, reached: &[Vector<D>], iterating: &mut Iterating<D>) {
        let Self { shares, asides, .. } = self;
        while asides.len() + 1 < shares.len() {
            asides.push(Aside::new(given.assembly));
        }
        for (aside, share) in asides.iter_mut().zip(&shares[1..]) {
            let Aside { iterating: theirs, reached: reached_there, lent, .. } = aside;
            lent.clear();
            lent.extend(share.islands.iter().flat_map(|&k| iterating.contacts.island(k).0));
            lent.extend(&share.alone);
            let obstacles = given.assembly.node_count()..given.assembly.reference.len();
            let all = lent.iter().map(|&i| given.assembly.nodes(i)).chain(std::iter::once(obstacles));
            for nodes in all {
                theirs.motion[nodes.clone()].copy_from_slice(&iterating.motion[nodes.clone()]);
                reached_there[nodes.clone()].copy_from_slice(&reached[nodes]);
            }
            theirs.newton.begin(lent, given.assembly, &theirs.motion);
            theirs.contacts.on_masses.begin(given);
            theirs.contacts.active.touched.clone_from(&iterating.contacts.active.touched);
            hand_over(&share.islands, lent, iterating, theirs);
        }
    }

    /// Takes back what was lent and what has become of it; returns what came of it all, of which `made` is the own share.
    fn take_back(
        &mut self,
        mut made: Made,
        given: &Given<'_, D>,
        reached: &mut [Vector<D>],
        iterating: &mut Iterating<D>,
    ) -> Made {
        let Self { shares, asides, .. } = self;
        for (aside, share) in asides.iter_mut().zip(&shares[1..]) {
            let Aside { iterating: theirs, reached: reached_there, lent, made: made_there } = aside;
            hand_over(&share.islands, lent, theirs, iterating);
            for &i in &*lent {
                let nodes = given.assembly.nodes(i);
                iterating.motion[nodes.clone()].copy_from_slice(&theirs.motion[nodes.clone()]);
                reached[nodes.clone()].copy_from_slice(&reached_there[nodes]);
                if given.interval.is_blended {
                    iterating.blend.take(i, &theirs.blend);
                }
            }
            iterating.factorisations += std::mem::take(&mut theirs.factorisations);
            iterating.contacts.reduced.friction_time +=
                std::mem::take(&mut theirs.contacts.reduced.friction_time);
            made = match (made, std::mem::replace(made_there, Ok(0))) {
                (Ok(a), Ok(b)) => Ok(a.max(b)),
                // That of one thread alone would have been the first.
                (Err(a), Err(b)) => Err(if a.0 < b.0 { a } else { b }),
                (Err(a), Ok(_)) | (Ok(_), Err(a)) => Err(a),
            };
        }
        made
    }
}

/// Hands islands and bodies from one that iterates to another.
fn hand_over<const D: usize>(
    islands: &[usize],
    bodies: &[usize],
    from: &mut Iterating<D>,
    to: &mut Iterating<D>,
) {
    from.contacts.hand_over(islands, bodies, &mut to.contacts);
    bodies.iter().for_each(|&i| std::mem::swap(&mut from.bodies[i], &mut to.bodies[i]));
}

impl Share {
    fn clear(&mut self) {
        self.islands.clear();
        self.alone.clear();
        self.amount = 0;
    }

    fn sort(&mut self) {
        self.islands.sort_unstable();
        self.alone.sort_unstable();
    }

    /// Iterates each to its end, or until one fails. There are so many `islands` in all.
    fn iterate<const D: usize>(
        &self,
        islands: usize,
        solve: Solve<D>,
        given: &Given<'_, D>,
        reached: &mut [Vector<D>],
        iterating: &mut Iterating<D>,
    ) -> Made {
        let mut iterations = 0;
        for &island in &self.islands {
            let bodies = iterating.contacts.enter(island);
            let made = iterate_touching(&bodies, solve, given, reached, iterating);
            if !given.interval.map.is_static() {
                // The next island begins without.
                iterating.contacts.soften(&bodies);
            }
            iterating.contacts.leave(island, bodies);
            iterations = iterations.max(made.map_err(|error| (island, error))?);
        }
        for &i in &self.alone {
            let made = solve(&[i], given, reached, iterating);
            iterations = iterations.max(made.map_err(|error| (islands + i, error))?);
        }
        Ok(iterations)
    }
}

impl<const D: usize> Aside<D> {
    /// Without bodies.
    fn new(assembly: &Assembly<D>) -> Self {
        let bodies = (0..assembly.body_count()).map(|_| Box::new(Lent) as Box<dyn Body<D>>);
        Self {
            iterating: Iterating::new(assembly, bodies.collect()),
            reached: nodal::zeros(assembly.reference.len()),
            lent: Vec::new(),
            made: Ok(0),
        }
    }
}
