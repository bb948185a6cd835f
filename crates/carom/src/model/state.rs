use std::ops::Range;

use carom_contact::{Candidate, Contact, Site};
use carom_fem::material::PlasticState;
use carom_mesh::{Vector, nodal};

use crate::body::{Body, BodyState};
use crate::ledger::Energies;
use crate::model::assembly::Assembly;
use crate::model::cohesion::OF_BONDS;
use crate::model::sliding::SlidingRecord;

/// A contact that pressed in the last step.
#[derive(Debug, Clone, PartialEq)]
pub struct Reaction<const D: usize> {
    /// Index of the pair.
    pub pair: u32,
    /// Where between the two.
    pub site: Site,
    /// The facet that the node or corner faced.
    pub facet: Option<u32>,
    /// Gap, frame and stencil where the contact condition was written.
    pub contact: Contact<D>,
    /// The reaction r [N] in that frame.
    pub force: Vector<D>,
    /// The adhesion [N] that it is less by than what is in Coulomb's cone; none where nothing holds.
    pub adhesion: Option<f64>,
}

impl<const D: usize> Reaction<D> {
    /// What identifies a contact from step to step.
    #[must_use]
    pub fn key(&self) -> (u32, Site) {
        (self.pair, self.site)
    }

    /// What is in Coulomb's cone [N]: the reaction and the adhesion.
    #[must_use]
    pub fn in_cone(&self) -> Vector<D> {
        let mut r = self.force;
        r[0] += self.adhesion.unwrap_or(0.0);
        r
    }

    /// Its friction coefficient; of a law that of contacts that have never slid.
    pub(crate) fn friction(&self, assembly: &Assembly<D>) -> f64 {
        if self.adhesion.is_some() && assembly.is_unbreakable(self.pair) {
            return OF_BONDS;
        }
        assembly.contact.pairs.get(self.pair as usize).friction
    }

    /// The candidate that it was.
    #[must_use]
    pub fn candidate(&self) -> Candidate {
        Candidate::new(self.pair, self.site, self.facet)
    }

    /// The source node; of an edge or a facet the one that takes most of the reaction.
    #[must_use]
    pub fn node(&self) -> u32 {
        let nearest = || self.contact.sources().max_by(|(_, a), (_, b)| a.total_cmp(b));
        match self.site {
            Site::Node(node) | Site::Multiplier(node, _) | Site::Second(node) => node,
            _ => nearest().map_or(u32::MAX, |(node, _)| node as u32),
        }
    }
}

/// What a restart needs. Vectors hold one entry per node of the model.
#[derive(Debug, Clone, PartialEq)]
pub struct State<const D: usize> {
    /// Time [s].
    pub time: f64,
    /// Displacements u [m]; of nodes inside reduced bodies those of when somebody last looked, as their velocities are.
    pub displacement: Vec<Vector<D>>,
    /// Velocities v [m/s].
    pub velocity: Vec<Vector<D>>,
    /// Reactions of the last step by pair and site, ascending: the first guess of the next step.
    pub reactions: Vec<Reaction<D>>,
    /// What contacts of pairs with a friction law remember, by pair and site, ascending.
    pub sliding: Vec<SlidingRecord<D>>,
    /// Nodal contact forces Hᵀr [N]: mean over the last step, or at its end between massless nodes.
    pub contact_force: Vec<Vector<D>>,
    /// What friction has dissipated at every node since the start [J], half of it on either side of a contact.
    pub friction_energy: Vec<f64>,
    /// What the supports of every motion pressed on their nodes in the last step [N].
    pub support: Vec<Vector<D>>,
    /// Displacements where the motion that is prescribed now began [m]: what is prescribed adds to them.
    pub anchor: Vec<Vector<D>>,
    /// What the material of every body remembers, quadrature point by quadrature point; nothing where it is elastic.
    pub history: Vec<Vec<PlasticState>>,
    /// How far every node has slid along what it touches since the start [m], whichever way; where it touches several, their mean.
    pub slip: Vec<f64>,
    /// Internal forces ∂E/∂u [N] at `displacement`, kept because every step starts with them.
    pub internal_force: Vec<Vector<D>>,
    /// Energies [J] at `displacement` and `velocity`, those of springs included.
    pub energies: Energies,
    /// Those of every body.
    pub body_energies: Vec<Energies>,
    /// Energy of every body [J] that the blend of start and end stresses has yet to take back; round-off as a rule.
    pub energy_debt: Vec<f64>,
}

impl<const D: usize> State<D> {
    /// Whether a contact holds that nothing breaks.
    pub(crate) fn is_bond(&self, key: (u32, Site), assembly: &Assembly<D>) -> bool {
        assembly.is_unbreakable(key.0) && self.reaction(key).is_some_and(|r| r.adhesion.is_some())
    }

    /// The contacts that hold together.
    pub fn holding(&self) -> impl Iterator<Item = &Reaction<D>> {
        self.reactions.iter().filter(|reaction| reaction.adhesion.is_some())
    }

    /// The reaction of the last step with a pair and a site.
    pub(crate) fn reaction(&self, key: (u32, Site)) -> Option<&Reaction<D>> {
        self.reactions.binary_search_by_key(&key, Reaction::key).ok().map(|k| &self.reactions[k])
    }

    /// The state at t = 0 with these velocities of the nodes of all bodies, and the bodies in their reference configuration. Tied nodes start as their
    /// masters do, and what is prescribed as prescribed.
    #[must_use]
    pub fn initial(
        assembly: &Assembly<D>,
        bodies: &[Box<dyn Body<D>>],
        mut velocity: Vec<Vector<D>>,
    ) -> Self {
        assert_eq!(velocity.len(), assembly.node_count(), "one velocity per node");
        let still = nodal::zeros(velocity.len());
        for (i, body) in bodies.iter().enumerate() {
            body.constrain(&still[assembly.nodes(i)], &mut velocity[assembly.nodes(i)], 0.0);
        }
        velocity.extend(assembly.obstacle_motions.iter().map(|m| m.velocity(0.0)));
        let count = velocity.len();
        let mut state = Self {
            time: 0.0,
            displacement: nodal::zeros(count),
            velocity,
            reactions: Vec::new(),
            sliding: Vec::new(),
            contact_force: nodal::zeros(count),
            friction_energy: vec![0.0; count],
            support: vec![Vector::zeros(); assembly.supports],
            anchor: nodal::zeros(count),
            history: bodies.iter().map(|body| body.initial_history()).collect(),
            slip: vec![0.0; count],
            internal_force: nodal::zeros(count),
            energies: Energies::default(),
            body_energies: vec![Energies::default(); bodies.len()],
            energy_debt: vec![0.0; bodies.len()],
        };
        state.refresh(assembly, bodies);
        state
    }

    /// The state that a static analysis starts from: there are no velocities, whatever the rate at which supports set out.
    #[must_use]
    pub fn at_rest(assembly: &Assembly<D>, bodies: &[Box<dyn Body<D>>]) -> Self {
        let mut state = Self::initial(assembly, bodies, nodal::zeros(assembly.node_count()));
        state.velocity.fill(Vector::zeros());
        state.refresh(assembly, bodies);
        state
    }

    /// Gives body `index` a velocity [m/s], an entry per node, within what binds and drives it; returns its kinetic energy more [J].
    pub(crate) fn give_velocity(
        &mut self,
        assembly: &Assembly<D>,
        bodies: &[Box<dyn Body<D>>],
        index: usize,
        velocity: &[Vector<D>],
    ) -> f64 {
        let before = self.body_energies[index].kinetic;
        let nodes = assembly.nodes(index);
        self.velocity[nodes.clone()].copy_from_slice(velocity);
        let displacement = &self.displacement[nodes.clone()];
        bodies[index].constrain(displacement, &mut self.velocity[nodes.clone()], self.time);
        let mut forces = nodal::zeros(nodes.len());
        let energies = bodies[index].measure(&self.body(index, nodes), &mut forces);
        self.body_energies[index].kinetic = energies.kinetic;
        self.sum_energies(assembly);
        energies.kinetic - before
    }

    /// Recomputes forces and energies from displacements and velocities.
    pub(crate) fn refresh(&mut self, assembly: &Assembly<D>, bodies: &[Box<dyn Body<D>>]) {
        let mut forces = nodal::zeros(self.internal_force.len());
        for (i, body) in bodies.iter().enumerate() {
            let nodes = assembly.nodes(i);
            let energies = body.measure(&self.body(i, nodes.clone()), &mut forces[nodes]);
            self.body_energies[i] = energies;
        }
        self.internal_force = forces;
        self.sum_energies(assembly);
    }

    /// Sums the energies of bodies and springs.
    pub(crate) fn sum_energies(&mut self, assembly: &Assembly<D>) {
        let springs = assembly.spring_energy(&self.displacement);
        self.energies = self.body_energies.iter().copied().sum();
        self.energies.springs = springs;
    }

    /// The energies of every body and, after them, of the springs.
    pub(crate) fn all_energies(&self) -> impl Iterator<Item = Energies> + Clone {
        let springs = Energies { springs: self.energies.springs, ..Energies::default() };
        self.body_energies.iter().copied().chain([springs])
    }

    /// The part of body `index`, which has these `nodes`.
    pub(crate) fn body(&self, index: usize, nodes: Range<usize>) -> BodyState<'_, D> {
        BodyState {
            displacement: &self.displacement[nodes.clone()],
            velocity: &self.velocity[nodes.clone()],
            internal_force: &self.internal_force[nodes.clone()],
            contact_force: &self.contact_force[nodes.clone()],
            anchor: &self.anchor[nodes],
            history: &self.history[index],
            energies: self.body_energies[index],
        }
    }

    /// Whether every number is finite that steps of the `assembly` depend on.
    #[must_use]
    pub fn is_finite(&self, assembly: &Assembly<D>) -> bool {
        let of_nodes =
            [&self.displacement, &self.velocity, &self.internal_force, &self.contact_force, &self.anchor];
        let numbers = [&self.friction_energy, &self.slip];
        let are_finite = |nodes: Range<usize>| {
            of_nodes.into_iter().all(|vectors| nodal::is_finite(&vectors[nodes.clone()]))
                && numbers.into_iter().all(|numbers| numbers[nodes.clone()].iter().all(|x| x.is_finite()))
        };
        let bodies = 0..assembly.body_count();
        let runs = bodies.flat_map(|i| assembly.stepped(i).iter().map(move |run| assembly.numbered(i, run)));
        let obstacles = assembly.node_count()..assembly.reference.len();
        runs.chain([obstacles]).all(are_finite)
            && nodal::is_finite(&self.support)
            && self.energy_debt.iter().all(|x| x.is_finite())
            && self.sliding.iter().all(|record| record.distance.is_finite() && record.state.is_finite())
            && self.energies.kinetic.is_finite()
            && self.energies.strain.is_finite()
            && self.energies.springs.is_finite()
    }
}
