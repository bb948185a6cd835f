//! Bodies that rest: what has come to lie still takes no part in steps until something changes.
//!
//! A body is still in a step if none of its nodes moves by more than round-off of the model by its velocity, which is what iterations leave of any
//! motion, nor by more than noise of that size away from where it became still. It is still for long if it is so for many steps and for a share
//! of the run: what is not seen of a creep stays below so many times round-off in the whole run, however short the steps are. What nothing
//! presses on has no noise, and no velocity either. Bodies rest by islands: all that may touch one another in a step.
//!
//! What rests has d = 0 and keeps its reactions; its velocities, which are noise, are what the scheme makes of them without a motion. So the terms of its
//! books are zero but for what a dissipative scheme takes of that, and the contact forces and reactions of the state are complete. It does not rest any longer in the step in which a candidate of a contact with something else is
//! found, something that it touches moves, or what drives it changes. Then nor does anything of its island.

use carom_contact::{Candidate, Pair, Solid, Target};
use carom_mesh::{Vector, nodal};

use super::control::RESTING;
use crate::body::Body;
use crate::ledger::{BodyLedger, Energies};
use crate::model::assembly::Assembly;
use crate::model::at_rest::AtRest;
use crate::model::forest::Forest;
use crate::model::given::Given;
use crate::model::method::Method;
use crate::model::state::{Reaction, State};

/// Which bodies rest, and how long the others have been still.
#[derive(Debug)]
pub(crate) struct Resting<const D: usize> {
    /// How long a body is still before it rests [s]; infinite where none may.
    window: f64,
    pub who: AtRest,
    /// The bodies that do not rest, ascending.
    pub awake: Vec<usize>,
    pub watches: Vec<Watch>,
    /// Where nodes of bodies that are still became so [m].
    pub place: Vec<Vector<D>>,
    islands: Islands,
}

/// How long a body has been still.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Watch {
    /// Since when [s].
    pub since: f64,
    /// The steps of that time; none if it moves.
    pub steps: u64,
    /// How deep it was inside something at the end of the last step [m].
    pub depth: f64,
}

impl<const D: usize> Resting<D> {
    /// Of an assembly, of which nothing rests.
    pub fn never(assembly: &Assembly<D>) -> Self {
        let count = assembly.body_count();
        Self {
            window: f64::INFINITY,
            who: AtRest { bodies: vec![false; count], obstacles: Vec::new() },
            awake: (0..count).collect(),
            watches: vec![Watch::default(); count],
            place: nodal::zeros(assembly.node_count()),
            islands: Islands::default(),
        }
    }

    /// Lets bodies rest in a run that takes so long [s]: in steps in time. Rows of mortar pairs and friction laws belong to what
    /// moves. What blended steps have left over waits where a body rests.
    pub fn allow(&mut self, assembly: &Assembly<D>, method: &Method<D>, duration: f64) {
        let is_static = method.scheme == crate::Scheme::Static;
        let may = !is_static && !assembly.contact.pairs.have_mortar();
        self.window = if may { RESTING.share * duration } else { f64::INFINITY };
    }

    /// The bodies that rest, ascending.
    pub fn resting(&self) -> impl Iterator<Item = usize> {
        (0..self.who.bodies.len()).filter(|&i| self.who.bodies[i])
    }

    /// How deep what rests was inside something when it came to rest [m]; of all else that is forgotten.
    pub fn depth(&mut self) -> f64 {
        self.awake.iter().for_each(|&i| self.watches[i].depth = 0.0);
        self.watches.iter().map(|watch| watch.depth).fold(0.0, f64::max)
    }

    /// Lists who does not rest.
    pub fn list(&mut self) {
        self.awake.clear();
        self.awake.extend((0..self.who.bodies.len()).filter(|&i| !self.who.bodies[i]));
    }

    /// Looks at what moves and drives bodies in a step, in which obstacles move by `motion` [m], and lets those rest no longer that it changes.
    pub fn heed(&mut self, given: &Given<'_, D>, motion: &[Vector<D>], bodies: &[Box<dyn Body<D>>]) {
        let assembly = given.assembly;
        self.who.obstacles.clear();
        let of_obstacles = motion[assembly.node_count()..].iter();
        self.who.obstacles.extend(of_obstacles.map(|d| *d == Vector::<D>::zeros()));
        if self.awake.len() == bodies.len() {
            return;
        }
        let mut has_changed = false;
        for i in 0..bodies.len() {
            let since = self.watches[i].since;
            if self.who.bodies[i] && !is_driven_alike(given, &*bodies[i], since) {
                self.rouse(i);
                has_changed = true;
            }
        }
        if has_changed {
            self.rouse_islands(given);
        }
    }

    /// Lets those rest no longer that have a part in `candidates`, and their islands. Returns whether there were any.
    pub fn rouse_found(&mut self, given: &Given<'_, D>, candidates: &[Candidate]) -> bool {
        if self.awake.len() == self.who.bodies.len() {
            return false;
        }
        let before = self.awake.len();
        for candidate in candidates {
            let pair = given.assembly.contact.pairs.get(candidate.pair as usize);
            sides(&pair).into_iter().flatten().for_each(|i| self.rouse(i));
        }
        self.rouse_islands(given);
        self.awake.len() > before
    }

    fn rouse(&mut self, body: usize) {
        if std::mem::take(&mut self.who.bodies[body]) {
            self.watches[body].steps = 0;
        }
    }

    /// Nothing rests on what does not.
    fn rouse_islands(&mut self, given: &Given<'_, D>) {
        let mut goes_on = true;
        while goes_on {
            goes_on = false;
            for reaction in &given.state.reactions {
                let pair = given.assembly.contact.pairs.get(reaction.pair as usize);
                let (source, Target::Surface(target)) = (pair.source, pair.target) else { continue };
                if self.who.bodies[source] != self.who.bodies[target] {
                    self.rouse(source);
                    self.rouse(target);
                    goes_on = true;
                }
            }
        }
        self.list();
    }

    /// Puts the reactions of what rests among those of the end of the step.
    pub fn carry(&self, given: &Given<'_, D>, next: &mut State<D>, mut note_gap: impl FnMut(f64)) {
        if self.awake.len() == self.who.bodies.len() {
            return;
        }
        let pairs = &given.assembly.contact.pairs;
        for reaction in &given.state.reactions {
            if self.who.are_still(&pairs.get(reaction.pair as usize)) {
                reaction.contact.add_force(&reaction.force, &mut next.contact_force);
                note_gap(reaction.contact.gap);
                next.reactions.push(reaction.clone());
            }
        }
        next.reactions.sort_unstable_by_key(Reaction::key);
    }

    /// Leaves what rests where it was.
    pub fn keep(
        &self,
        given: &Given<'_, D>,
        next: &mut State<D>,
        bodies: &[Box<dyn Body<D>>],
        ledgers: &mut [BodyLedger],
    ) {
        if self.awake.len() == self.who.bodies.len() {
            return;
        }
        let state = given.state;
        let map = &given.interval.map;
        for i in self.resting() {
            let nodes = given.assembly.nodes(i);
            let velocities = next.velocity[nodes.clone()].iter_mut().zip(&state.velocity[nodes.clone()]);
            velocities.for_each(|(end, v)| *end = map.end_velocity(v, &Vector::zeros()));
            next.internal_force[nodes.clone()].copy_from_slice(&state.internal_force[nodes]);
            next.history[i].clone_from(&state.history[i]);
            bodies[i].keep_support(&state.support, &mut next.support);
            let before = state.body_energies[i];
            let kinetic = before.kinetic * map.velocity_of_velocity.powi(2);
            next.body_energies[i] = Energies { kinetic, ..before };
            let lost = before.kinetic - kinetic;
            ledgers[i] = BodyLedger { kinetic: -lost, scheme: lost, ..BodyLedger::default() };
        }
    }

    /// Takes note of a step that has been made, in which these candidates were `found`: who was still in it, and who rests from now on.
    pub fn note(
        &mut self,
        given: &Given<'_, D>,
        next: &State<D>,
        bodies: &[Box<dyn Body<D>>],
        found: &[Candidate],
    ) {
        if self.window.is_infinite() {
            return;
        }
        for k in 0..self.awake.len() {
            let i = self.awake[k];
            self.watch(given, next, i, &*bodies[i]);
        }
        let Self { watches, awake, who, islands, window, .. } = self;
        let Given { assembly, interval, .. } = *given;
        let is_for_long = |i: usize| {
            let Watch { since, steps, .. } = watches[i];
            steps >= RESTING.steps && interval.end - since >= *window && !assembly.is_connected[i]
        };
        if !awake.iter().any(|&i| is_for_long(i)) {
            return;
        }
        islands.begin(watches.len());
        awake.iter().filter(|&&i| !is_for_long(i)).for_each(|&i| islands.disturb(i));
        // What nothing presses on has no noise: any velocity is a drift.
        let is_still = |i: usize| next.velocity[assembly.nodes(i)].iter().all(|v| *v == Vector::<D>::zeros());
        for pair in next.reactions.iter().map(|r| assembly.contact.pairs.get(r.pair as usize)) {
            sides(&pair).into_iter().flatten().for_each(|i| islands.is_pressed[i] = true);
        }
        for &i in awake.iter().filter(|i| !is_still(**i)) {
            if !islands.is_pressed[i] {
                islands.disturb(i);
            }
        }
        let pressing = next.reactions.iter().map(|r| r.pair);
        for pair in found.iter().map(|c| c.pair).chain(pressing) {
            let pair = assembly.contact.pairs.get(pair as usize);
            match pair.target {
                Target::Surface(target) => islands.join(pair.source, target),
                Target::Obstacle(o) if who.is_still(Solid::Obstacle(o)) => {}
                Target::Obstacle(_) => islands.disturb(pair.source),
            }
        }
        // What contacts remember of their sliding goes on while they lie still.
        for record in &next.sliding {
            let pair = assembly.contact.pairs.get(record.pair as usize);
            sides(&pair).into_iter().flatten().for_each(|i| islands.disturb(i));
        }
        for &i in &*awake {
            who.bodies[i] = !islands.is_disturbed(i);
        }
        self.list();
    }

    /// Takes note of whether a body was still in a step.
    fn watch(&mut self, given: &Given<'_, D>, next: &State<D>, i: usize, body: &dyn Body<D>) {
        let Given { assembly, interval, .. } = *given;
        let (round_off, dt) = (assembly.round_off(), interval.end - interval.start);
        let Self { watches, place, .. } = self;
        let (watch, nodes) = (&mut watches[i], assembly.nodes(i));
        let is_slow = |v: &Vector<D>| v.norm() * dt <= round_off;
        let since = if watch.steps > 0 { watch.since } else { interval.start };
        if !next.velocity[nodes.clone()].iter().all(is_slow) || !is_driven_alike(given, body, since) {
            watch.steps = 0;
            return;
        }
        let (now, place) = (&next.displacement[nodes.clone()], &mut place[nodes]);
        let is_there = || now.iter().zip(&*place).all(|(u, at)| (u - at).norm() <= RESTING.way * round_off);
        if watch.steps > 0 && is_there() {
            watch.steps += 1;
        } else {
            place.copy_from_slice(now);
            (watch.since, watch.steps) = (interval.end, 1);
        }
    }
}

/// Whether what drives a body, and what pushes pairs apart, is the same all through a step as it was at the time `since` [s].
fn is_driven_alike<const D: usize>(given: &Given<'_, D>, body: &dyn Body<D>, since: f64) -> bool {
    let Given { assembly, interval, .. } = *given;
    [interval.start, interval.end].into_iter().all(|t| {
        body.is_driven_alike([since, t])
            && assembly.interferences.all().all(|interference| interference.is_alike([since, t]))
    })
}

/// The bodies of a pair.
fn sides(pair: &Pair) -> [Option<usize>; 2] {
    let target = match pair.target {
        Target::Surface(target) => Some(target),
        Target::Obstacle(_) => None,
    };
    [Some(pair.source), target]
}

/// Bodies that touch one another, directly or through others: a forest in which every tree is an island.
#[derive(Debug, Default)]
struct Islands {
    forest: Forest,
    /// Whether something of the island of a root moves.
    is_disturbed: Vec<bool>,
    /// Whether a reaction acts on a body.
    is_pressed: Vec<bool>,
}

impl Islands {
    /// So many bodies, each on its own.
    fn begin(&mut self, bodies: usize) {
        self.forest.begin(bodies);
        self.is_disturbed.clear();
        self.is_disturbed.resize(bodies, false);
        self.is_pressed.clear();
        self.is_pressed.resize(bodies, false);
    }

    fn join(&mut self, a: usize, b: usize) {
        let [stays, other] = self.forest.join(a, b);
        self.is_disturbed[stays] |= self.is_disturbed[other];
    }

    fn disturb(&mut self, body: usize) {
        let root = self.forest.root(body);
        self.is_disturbed[root] = true;
    }

    fn is_disturbed(&mut self, body: usize) -> bool {
        let root = self.forest.root(body);
        self.is_disturbed[root]
    }
}
