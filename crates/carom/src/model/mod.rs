//! What does not change during a run: bodies in their places, and the method that takes them through time.

pub(crate) mod assembly;
pub(crate) mod at_rest;
pub(crate) mod bearing;
pub(crate) mod cohesion;
pub(crate) mod condition;
pub(crate) mod each_body;
pub(crate) mod forest;
pub(crate) mod friction_laws;
pub(crate) mod given;
pub(crate) mod interference;
pub(crate) mod method;
pub(crate) mod obstacle_motion;
pub(crate) mod orthotropy;
pub(crate) mod restitution;
pub(crate) mod sliding;
pub(crate) mod springs;
pub(crate) mod state;

use std::sync::Arc;

use carom_contact::ContactModel;
use carom_mesh::compiled;
use carom_mesh::{Surface, Vector};

use self::assembly::{Assembly, Member};
use self::interference::Interferences;
use self::obstacle_motion::ObstacleMotion;
use self::restitution::Restitutions;
use self::springs::Spring;
use self::state::State;
use crate::body::Body;
use crate::body::fe::FeBody;
use crate::body::fe::load::Load;
use crate::body::fe::part::ModelBody;
use crate::body::fe::supports::{Motion, Supports};
use crate::body::foreign::ForeignBody;
use crate::body::reduced::ReducedBody;
use crate::body::rigid::RigidBody;
use crate::body::rigid::guide::{Guide, Resultant};

/// Bodies in their places, and what drives them. Everything that does not change during a run.
#[derive(Debug)]
pub struct Model<const D: usize> {
    /// What a step needs to know of all this.
    pub assembly: Assembly<D>,
    /// The bodies, which share themselves with those that step.
    pub bodies: Vec<Arc<ModelBody<D>>>,
    /// Prescribed motion of nodes.
    pub motions: Vec<Motion<D>>,
}

type MakeSteppingBodies<const D: usize> = fn(&Model<D>) -> Vec<Box<dyn Body<D>>>;

impl<const D: usize> Model<D> {
    /// The model of these bodies, whose nodes are numbered one body after the other, and of the contacts between their surfaces;
    /// obstacles stand still.
    #[must_use]
    pub fn new(
        bodies: Vec<ModelBody<D>>,
        contact: ContactModel<D>,
        obstacle_names: Vec<String>,
        gravity: Vector<D>,
    ) -> Self {
        let member = |b: &ModelBody<D>| Member {
            name: b.name.clone(),
            reference: b.body.mesh().nodes().to_vec(),
            diameter: b.body.mesh().diameter(),
            boundary: Surface::of(b.body.mesh()),
            held: b.held(),
            is_massless: !b.body.massless().is_empty(),
            turns: b.body.turns(),
            axis: b.body.axis_nodes(),
            stepped: b.reduced.as_ref().map_or_else(Vec::new, |reduced| reduced.moved.clone()),
        };
        let assembly = Assembly::new(bodies.iter().map(member).collect(), contact, obstacle_names);
        let surroundings = stiffness_of_deformable(&bodies);
        let bodies = bodies.into_iter().map(|mut b| {
            b.rigid.iter_mut().for_each(|rigid| rigid.surroundings = surroundings);
            Arc::new(ModelBody { gravity, ..b })
        });
        Self { assembly, bodies: bodies.collect(), motions: Vec::new() }
    }

    /// The same with obstacles that move like this.
    #[must_use]
    pub fn with_obstacle_motions(mut self, motions: Vec<ObstacleMotion<D>>) -> Self {
        assert_eq!(motions.len(), self.assembly.contact.obstacles.len(), "one motion per obstacle");
        self.assembly.obstacle_motions = motions;
        self
    }

    /// The same with this interference of its pairs.
    #[must_use]
    pub fn with_interferences(mut self, interferences: Interferences) -> Self {
        self.assembly.interferences = interferences;
        self
    }

    /// The same with these coefficients of restitution of its pairs.
    #[must_use]
    pub fn with_restitutions(mut self, restitutions: Restitutions) -> Self {
        self.assembly.restitutions = restitutions;
        self
    }

    /// The same with these springs between its bodies.
    #[must_use]
    pub fn with_springs(mut self, springs: Vec<Spring<D>>) -> Self {
        self.assembly.connect(springs);
        self
    }

    /// The same with these prescribed motions instead of its own. Of two that prescribe the same displacement the first has it.
    ///
    /// # Panics
    /// If its bodies step already.
    #[must_use]
    pub fn with_motions(mut self, motions: Vec<Motion<D>>) -> Self {
        for i in 0..self.bodies.len() {
            let b = self.own(i);
            match &mut b.rigid {
                Some(rigid) => rigid.guide = guide(i, &motions),
                None => b.supports = Supports::of(i, &mut b.body, &motions),
            }
            let held = b.held();
            self.assembly.hold(i, &held);
        }
        self.assembly.supports = motions.len();
        self.motions = motions;
        self
    }

    /// The same with a force and a moment more on the rigid body `index`.
    ///
    /// # Panics
    /// If its bodies step already or this one is not rigid.
    #[must_use]
    pub(crate) fn with_resultant(mut self, index: usize, resultant: Resultant) -> Self {
        let rigid = self.own(index).rigid.as_mut().expect("resultants act on rigid bodies");
        rigid.resultants.push(resultant);
        self
    }

    /// The same with one more load on body `index`.
    ///
    /// # Panics
    /// If its bodies step already.
    #[must_use]
    pub fn with_load(mut self, index: usize, load: Load<D>) -> Self {
        self.own(index).loads.push(load);
        self
    }

    /// Body `index`, before it is shared.
    fn own(&mut self, index: usize) -> &mut ModelBody<D> {
        Arc::get_mut(&mut self.bodies[index]).expect("a model is complete before its bodies step")
    }

    /// The bodies as they step, each with scratch of its own.
    #[must_use]
    pub fn stepping_bodies(&self) -> Vec<Box<dyn Body<D>>> {
        compiled!(D, Model::make_stepping_bodies as MakeSteppingBodies)(self)
    }

    fn make_stepping_bodies(&self) -> Vec<Box<dyn Body<D>>> {
        let stepping = |(b, &connected): (&Arc<ModelBody<D>>, &bool)| -> Box<dyn Body<D>> {
            if b.is_rigid() {
                Box::new(RigidBody::new(Arc::clone(b)))
            } else if b.is_reduced() {
                Box::new(ReducedBody::new(Arc::clone(b)))
            } else if let Some(law) = &b.foreign {
                let nodes = b.body.mesh().nodes().to_vec();
                let body = ForeignBody::new(nodes, law, b.gravity);
                Box::new(body.expect("the mass was positive definite when the model was built"))
            } else {
                Box::new(FeBody::new(Arc::clone(b), connected))
            }
        };
        self.bodies.iter().zip(&self.assembly.is_connected).map(stepping).collect()
    }

    /// The state at t = 0 with these velocities of the nodes of all bodies: see [`State::initial`].
    #[must_use]
    pub fn initial_state(&self, velocity: Vec<Vector<D>>) -> State<D> {
        State::initial(&self.assembly, &self.stepping_bodies(), velocity)
    }

    /// The state that a static analysis starts from: see [`State::at_rest`].
    #[must_use]
    pub fn state_at_rest(&self) -> State<D> {
        State::at_rest(&self.assembly, &self.stepping_bodies())
    }

    /// Takes over a `state` from another model of the same bodies, obstacles and pairs. Nothing moves: what is prescribed from now on counts from
    /// where the bodies are.
    pub(crate) fn take_over(&self, state: &mut State<D>) {
        state.support = vec![Vector::zeros(); self.assembly.supports];
        for b in &self.bodies {
            let driven = b.supports.driven(&b.body);
            for (dof, _) in driven.filter(|&(_, motion)| self.motions[motion].since >= state.time) {
                let (n, i) = (b.first_node + dof.node as usize, dof.component as usize);
                state.anchor[n][i] = state.displacement[n][i];
            }
            let guide = b.rigid.as_ref().and_then(|rigid| rigid.guide.as_ref());
            if guide.is_some_and(|guide| self.motions[guide.number].since >= state.time) {
                state.anchor[b.nodes()].copy_from_slice(&state.displacement[b.nodes()]);
            }
        }
    }

    /// Number of nodes of the bodies.
    #[must_use]
    pub fn node_count(&self) -> usize {
        self.assembly.node_count()
    }

    /// Number of unknown displacements.
    #[must_use]
    pub fn dofs(&self) -> usize {
        self.bodies.iter().map(|b| b.dofs()).sum()
    }
}

/// What guides the rigid body `index`: the first of the motions that does.
fn guide<const D: usize>(index: usize, motions: &[Motion<D>]) -> Option<Guide> {
    let (number, motion) = motions.iter().enumerate().find(|(_, m)| m.body == index)?;
    let along = std::array::from_fn(|i| motion.components.get(i).cloned().flatten());
    Some(Guide { number, along, about: motion.turns.clone() })
}

/// How stiff the softest of the deformable bodies is [N/m], by the time that waves take through it; zero if all are rigid.
fn stiffness_of_deformable<const D: usize>(bodies: &[ModelBody<D>]) -> f64 {
    let stiffness = bodies.iter().filter_map(|b| {
        let frequency = b.wave_speed()? / b.body.mesh().diameter();
        Some(b.body.total_mass() * frequency * frequency)
    });
    stiffness.reduce(f64::min).unwrap_or(0.0)
}
