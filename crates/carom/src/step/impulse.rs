//! Impulses in contacts at the end of a step.

use carom_contact::{Contact, Target};
use carom_mesh::{Vector, nodal};

use super::control::IMPULSIVE;
use crate::body::{Jolt, Masses};
use crate::contact::contact_work::driven;
use crate::ledger::BodyLedger;
use crate::model::assembly::Assembly;
use crate::model::forest::Forest;
use crate::model::given::Given;
use crate::model::state::{Reaction, State};

/// An impulse that a contact may take.
#[derive(Debug, Clone)]
pub(crate) struct Impulse<const D: usize> {
    /// Which of the reactions of the new state.
    pub reaction: usize,
    /// Which of the contacts at the end of the step.
    pub contact: usize,
    /// λ [N s] in its frame.
    pub impulse: Vector<D>,
    /// The energy that it is to give [J].
    pub energy: f64,
}

/// What an impulse did.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Done<const D: usize> {
    /// Which of the reactions of the new state has it as a part.
    pub reaction: usize,
    /// Which of the contacts at the end of the step.
    pub contact: usize,
    /// Its force over the step [N] in the frame of the contact.
    pub force: Vector<D>,
    /// Energy that it took along the normal and across it [J].
    pub taken: [f64; 2],
    /// Work of prescribed motion [J].
    pub prescribed: f64,
}

/// What impulses mean for bodies that are connected by them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Group {
    /// Σ λ·H v, along the normals and across them [J].
    pub work: [f64; 2],
    /// Σ λ·H Δv [J] likewise, twice the energy of what the impulses make of bodies at rest.
    pub square: [f64; 2],
    /// What damping would take of that [W].
    pub power: f64,
    /// Σ of the energies that they are to give [J].
    pub energy: f64,
    /// How many times they could be taken from the normal reactions of the step before one of these pulls.
    pub pressed: f64,
}

/// Impulses in contacts change the velocities at the end of a step, Δv = M⁻¹ Hᵀλ, and neither positions nor the momentum of the whole. They are
/// part of the reactions. Those that bodies connect are all scaled by one number.
#[derive(Debug)]
pub(crate) struct Impulses<const D: usize> {
    pub(super) wanted: Vec<Impulse<D>>,
    pub(crate) done: Vec<Done<D>>,
    /// How many of these restore what landing took; the others settle.
    pub(super) landings: usize,
    /// Those of the reactions, ascending, whose contacts come to their target with the end of the step and are to land in the next.
    pub(crate) arriving: Vec<usize>,
    /// Hᵀλ [N s] and what it makes of the velocities [m/s].
    force: Vec<Vector<D>>,
    change: Vec<Vector<D>>,
    /// Whether bodies have a part.
    takes_part: Vec<bool>,
    /// What guides would do against the impulses on every body [J].
    borne: Vec<f64>,
    /// The impulses [N s] that supports would give, each with the body and the support.
    supports: Vec<(usize, usize, Vector<D>)>,
    /// What impulses connect.
    forest: Forest,
    groups: Vec<Group>,
    /// By how much of what they answered last the velocities of bodies were changed last.
    pub(crate) scales: Vec<f64>,
}

impl Group {
    /// Of no impulse.
    const NONE: Self =
        Self { work: [0.0; 2], square: [0.0; 2], power: 0.0, energy: 0.0, pressed: f64::INFINITY };
}

impl<const D: usize> Impulses<D> {
    /// Of so many nodes, obstacles among them, and bodies.
    pub fn new(nodes: usize, bodies: usize) -> Self {
        Self {
            wanted: Vec::new(),
            done: Vec::new(),
            landings: 0,
            arriving: Vec::new(),
            force: nodal::zeros(nodes),
            change: nodal::zeros(nodes),
            takes_part: vec![false; bodies],
            borne: vec![0.0; bodies],
            supports: Vec::new(),
            forest: Forest::new(bodies),
            groups: vec![Group::NONE; bodies],
            scales: vec![0.0; bodies],
        }
    }

    /// The forces [N] of the impulses of the last step in its `reactions`: of landing, and of what settled. Its contacts at the end are
    /// `contacts`.
    pub(super) fn forces(&self, reactions: usize, contacts: &[Contact<D>]) -> [Vec<Vector<D>>; 2] {
        let mut forces = [(); 2].map(|()| vec![Vector::zeros(); reactions]);
        for (k, done) in self.done.iter().enumerate() {
            let force = contacts[done.contact].frame.tr_mul(&done.force);
            forces[usize::from(k >= self.landings)][done.reaction] += force;
        }
        forces
    }

    /// Makes what was done part of the reactions, and before tells `book` of each what it was, the force more along its normal [N], and whether it
    /// landed.
    pub(crate) fn join(
        &self,
        contacts: &[Contact<D>],
        reactions: &mut [Reaction<D>],
        mut book: impl FnMut(&Reaction<D>, &Done<D>, f64, bool),
    ) {
        for (k, done) in self.done.iter().enumerate() {
            let reaction = &mut reactions[done.reaction];
            let force = reaction.contact.components(&contacts[done.contact].frame.tr_mul(&done.force));
            book(reaction, done, force[0], k < self.landings);
            reaction.force += force;
        }
    }

    /// What the wanted impulses mean for the groups of bodies that they connect, in `contacts` at the end of the step.
    pub(super) fn weigh(
        &mut self,
        given: &Given<'_, D>,
        contacts: &[Contact<D>],
        bodies: &mut (impl Masses<D> + ?Sized),
        new: &State<D>,
    ) {
        let wanted = std::mem::take(&mut self.wanted);
        self.connect(given, contacts, new, &wanted);
        self.respond(given, bodies, new);
        self.measure(given, contacts, new, &wanted);
        self.wanted = wanted;
    }

    /// What `scale` says of the group of a wanted impulse that was weighed.
    pub(super) fn scale(
        &self,
        given: &Given<'_, D>,
        new: &State<D>,
        impulse: &Impulse<D>,
        scale: impl Fn(&Group) -> f64,
    ) -> f64 {
        scale(&self.groups[self.group_of(given, new, impulse.reaction)])
    }

    /// What a wanted impulse that was weighed would take along the normal and across it [J], times what `scale` says of its group.
    pub(super) fn taken(
        &self,
        given: &Given<'_, D>,
        contacts: &[Contact<D>],
        new: &State<D>,
        impulse: &Impulse<D>,
        scale: impl Fn(&Group) -> f64,
    ) -> [f64; 2] {
        let scale = self.scale(given, new, impulse, scale);
        let velocity = |n: usize| new.velocity[n] + self.change[n] * (0.5 * scale);
        by_direction(&(impulse.impulse * -scale), &contacts[impulse.contact].relative(velocity))
    }

    /// Gives the impulses that were weighed times what `scale` says of their group, and adds what they did to `done`.
    pub(super) fn give(
        &mut self,
        given: &Given<'_, D>,
        contacts: &[Contact<D>],
        new: &mut State<D>,
        ledgers: &mut [BodyLedger],
        scale: impl Fn(&Group) -> f64,
    ) {
        for wanted in &self.wanted {
            let contact = &contacts[wanted.contact];
            let impulse = wanted.impulse * self.scale(given, new, wanted, &scale);
            let force = impulse / given.interval.map.dt;
            self.done.push(Done {
                reaction: wanted.reaction,
                contact: wanted.contact,
                force,
                taken: self.taken(given, contacts, new, wanted, &scale),
                prescribed: driven(given.assembly, contact, &impulse, &new.velocity),
            });
            contact.add_force(&force, &mut new.contact_force);
        }
        self.move_bodies(given, new, ledgers, scale);
    }

    /// Gathers the impulses of bodies that they connect.
    fn connect(
        &mut self,
        given: &Given<'_, D>,
        contacts: &[Contact<D>],
        new: &State<D>,
        wanted: &[Impulse<D>],
    ) {
        self.takes_part.fill(false);
        self.force.fill(Vector::zeros());
        self.change.fill(Vector::zeros());
        self.forest.begin(self.takes_part.len());
        self.groups.fill(Group::NONE);
        for Impulse { reaction, contact, impulse, .. } in wanted {
            let Reaction { pair, .. } = new.reactions[*reaction];
            let pair = given.assembly.contact.pairs.get(pair as usize);
            let target = if let Target::Surface(target) = pair.target { target } else { pair.source };
            (self.takes_part[pair.source], self.takes_part[target]) = (true, true);
            self.forest.join(pair.source, target);
            contacts[*contact].add_force(impulse, &mut self.force);
        }
    }

    /// What the impulses mean for the energy of every group.
    fn measure(
        &mut self,
        given: &Given<'_, D>,
        contacts: &[Contact<D>],
        new: &State<D>,
        wanted: &[Impulse<D>],
    ) {
        for &Impulse { reaction, contact, ref impulse, energy } in wanted {
            let contact = &contacts[contact];
            let work = by_direction(impulse, &contact.relative(|n| new.velocity[n]));
            let square = by_direction(impulse, &contact.relative(|n| self.change[n]));
            let group = self.group_of(given, new, reaction);
            let group = &mut self.groups[group];
            group.energy += energy;
            group.pressed = group
                .pressed
                .min(new.reactions[reaction].force[0] * given.interval.map.dt / impulse[0].abs());
            for i in 0..2 {
                group.work[i] += work[i];
                group.square[i] += square[i];
            }
        }
    }

    /// Asks the bodies what the impulses make of their velocities.
    fn respond(&mut self, given: &Given<'_, D>, bodies: &mut (impl Masses<D> + ?Sized), new: &State<D>) {
        self.supports.clear();
        let mut support = vec![Vector::zeros(); new.support.len()];
        for i in 0..self.takes_part.len() {
            if self.takes_part[i] {
                let (nodes, group) = (given.assembly.nodes(i), self.group(i));
                let (force, change) = (&mut self.force[nodes.clone()], &mut self.change[nodes.clone()]);
                let written = [&mut change[..], &mut support[..]];
                let Jolt { power, borne } = bodies.jolt(i, force, &new.body(i, nodes), written);
                self.groups[group].power += power;
                self.borne[i] = borne;
                for (k, impulse) in support.iter_mut().enumerate() {
                    if impulse.norm_squared() > 0.0 {
                        self.supports.push((i, k, std::mem::replace(impulse, Vector::zeros())));
                    }
                }
            }
        }
    }

    /// Changes the velocities of the bodies, their energies and the forces of supports.
    fn move_bodies(
        &mut self,
        given: &Given<'_, D>,
        new: &mut State<D>,
        ledgers: &mut [BodyLedger],
        scale: impl Fn(&Group) -> f64,
    ) {
        for &(body, k, impulse) in &self.supports {
            new.support[k] += impulse * (scale(&self.groups[self.group(body)]) / given.interval.map.dt);
        }
        self.scales.fill(0.0);
        for i in 0..self.takes_part.len() {
            if !self.takes_part[i] {
                continue;
            }
            let group = self.group(i);
            let scale = scale(&self.groups[group]);
            self.scales[i] = scale;
            let (mut contact, mut supports) = (0.0, self.borne[i] * scale);
            for n in given.assembly.nodes(i) {
                let (momentum, change) = (self.force[n] * scale, self.change[n] * scale);
                let mean = new.velocity[n] + change * 0.5;
                contact += given.assembly.free_part(n, &momentum).dot(&mean);
                supports += given.assembly.prescribed_part(n, &momentum).dot(&mean);
                new.velocity[n] += change;
            }
            new.body_energies[i].kinetic += contact + supports;
            ledgers[i].kinetic += contact + supports;
            ledgers[i].contact += contact;
            ledgers[i].prescribed += supports;
        }
    }

    /// The body that stands for the group of one.
    fn group(&self, body: usize) -> usize {
        self.forest.root_of(body)
    }

    /// The body that stands for the group of a reaction of the state `new`.
    fn group_of(&self, given: &Given<'_, D>, new: &State<D>, reaction: usize) -> usize {
        self.group(given.assembly.contact.pairs.get(new.reactions[reaction].pair as usize).source)
    }
}

/// Whether a contact with the reaction `r` sticks: its friction is below the limit by more than round-off.
pub(super) fn sticks<const D: usize>(r: &Vector<D>, friction: f64) -> bool {
    tangential(r) < friction * r[0] * (1.0 - IMPULSIVE.sticking)
}

/// The mass that a contact puts in the way of an impulse [kg], if every node moves for itself.
pub(super) fn mass<const D: usize>(
    contact: &Contact<D>,
    assembly: &Assembly<D>,
    bodies: &(impl Masses<D> + ?Sized),
) -> f64 {
    let yields = contact.stencil().filter_map(|(node, weight)| {
        let (body, own) = assembly.place_of(node)?;
        Some(weight * weight / bodies.mass_of(body, own as u32))
    });
    yields.sum::<f64>().recip()
}

/// |r_t|.
pub(super) fn tangential<const D: usize>(r: &Vector<D>) -> f64 {
    (1..D).map(|t| r[t] * r[t]).sum::<f64>().sqrt()
}

/// The parts of a·b along the normal and across it.
fn by_direction<const D: usize>(a: &Vector<D>, b: &Vector<D>) -> [f64; 2] {
    let along = a[0] * b[0];
    [along, a.dot(b) - along]
}
