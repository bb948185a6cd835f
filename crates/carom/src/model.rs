use carom_contact::ContactModel;
use carom_fem::Body;
use carom_friction::{FrictionSolver, StoppingRule};
use carom_mesh::Vector;

use crate::{ContactCondition, Scheme, StepMap};

/// A body in its place in the model.
#[derive(Debug)]
pub struct ModelBody<const D: usize> {
    /// Name.
    pub name: String,
    /// The body itself.
    pub body: Body<D>,
    /// Number of its first node; nodes are numbered body after body.
    pub first_node: usize,
}

impl<const D: usize> ModelBody<D> {
    /// The numbers of its nodes.
    #[must_use]
    pub fn nodes(&self) -> std::ops::Range<usize> {
        self.first_node..self.first_node + self.body.node_count()
    }
}

/// A named pair of bodies, or of a body and an obstacle, that may touch.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    /// The two names.
    pub between: [String; 2],
    /// Friction coefficient.
    pub friction: f64,
}

/// Everything that does not change during a run.
#[derive(Debug)]
pub struct Model<const D: usize> {
    /// The bodies.
    pub bodies: Vec<ModelBody<D>>,
    /// Who may touch whom; surface i is that of body i.
    pub contact: ContactModel<D>,
    /// The named pairs that the pairs of `contact` belong to.
    pub groups: Vec<Group>,
    /// Gravity [m/s²].
    pub gravity: Vector<D>,
    /// Reference positions of all nodes [m]; after those of the bodies, zero for every obstacle, whose displacement says how far
    /// it has moved.
    pub reference: Vec<Vector<D>>,
    /// Velocities of the obstacles [m/s].
    pub obstacle_velocities: Vec<Vector<D>>,
    /// The body that each node belongs to.
    pub body_of_node: Vec<u32>,
    /// Diameter of the largest body [m].
    pub size: f64,
}

impl<const D: usize> Model<D> {
    /// The model of these bodies, whose nodes are numbered one body after the other, and of the contacts between their surfaces;
    /// obstacles stand still.
    #[must_use]
    pub fn new(
        bodies: Vec<ModelBody<D>>,
        mut contact: ContactModel<D>,
        groups: Vec<Group>,
        gravity: Vector<D>,
    ) -> Self {
        let nodes = bodies.last().map_or(0, |b| b.nodes().end);
        for (o, obstacle) in contact.obstacles.iter_mut().enumerate() {
            obstacle.node = (nodes + o) as u32;
        }
        let fixed = contact.obstacles.iter().map(|_| Vector::zeros());
        Self {
            reference: bodies
                .iter()
                .flat_map(|b| b.body.mesh().nodes().iter().copied())
                .chain(fixed)
                .collect(),
            obstacle_velocities: vec![Vector::zeros(); contact.obstacles.len()],
            body_of_node: bodies
                .iter()
                .enumerate()
                .flat_map(|(i, b)| std::iter::repeat_n(i as u32, b.body.node_count()))
                .collect(),
            size: bodies.iter().map(|b| b.body.mesh().diameter()).fold(0.0, f64::max),
            bodies,
            contact,
            groups,
            gravity,
        }
    }

    /// The same with obstacles that move at these velocities [m/s].
    #[must_use]
    pub fn with_obstacle_velocities(mut self, velocities: Vec<Vector<D>>) -> Self {
        assert_eq!(velocities.len(), self.contact.obstacles.len(), "one velocity per obstacle");
        self.obstacle_velocities = velocities;
        self
    }

    /// Lengths below this are round-off of the coordinates [m].
    #[must_use]
    pub fn round_off(&self) -> f64 {
        4.0 * f64::EPSILON * self.size
    }

    /// Number of nodes of the bodies.
    #[must_use]
    pub fn node_count(&self) -> usize {
        self.body_of_node.len()
    }

    /// Number of unknown displacements.
    #[must_use]
    pub fn dofs(&self) -> usize {
        self.bodies.iter().map(|b| b.body.dofs()).sum()
    }
}

/// When Newton's iterations stop.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NewtonRule {
    /// Largest correction of a displacement, relative to the largest motion of a node in the step.
    pub tolerance: f64,
    /// Iterations after which the step fails.
    pub max_iterations: usize,
}

/// How a model is taken through time.
pub struct Method<const D: usize> {
    /// Time scheme.
    pub scheme: Scheme,
    /// Contact condition.
    pub condition: ContactCondition,
    /// Solver of the reduced contact problem.
    pub solver: Box<dyn FrictionSolver<D>>,
    /// When that solver stops.
    pub stopping: StoppingRule,
    /// Whether a second solver solves the problem of every step again (see [`crate::CrossCheck`]).
    pub cross_check: bool,
    /// When Newton's iterations stop.
    pub newton: NewtonRule,
    /// How often a step that fails is halved.
    pub max_halvings: u32,
    /// The bi-potential gap of a step that a certified run may have, relative to the largest energy of the run.
    pub certificate_tolerance: f64,
}

impl<const D: usize> Method<D> {
    /// How much the contact forces that the last step and this one ended with count in this one.
    #[must_use]
    pub fn contact_weights(&self, map: &StepMap) -> [f64; 2] {
        if self.condition.is_massless() { [1.0 - map.xi, map.xi] } else { [0.0, 1.0] }
    }

    /// Whether the balance of massless contact nodes is closed by a blend of start and end stresses.
    #[must_use]
    pub fn is_blended(&self) -> bool {
        self.scheme == Scheme::Conserving && self.condition.is_massless()
    }
}
