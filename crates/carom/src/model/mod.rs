pub(crate) mod condition;
pub(crate) mod load;
pub(crate) mod motion;
pub(crate) mod state;

use carom_contact::{ContactModel, Pair, Target};
use carom_fem::Body;
use carom_fem::sparse::Precision;
use carom_friction::{FrictionSolver, StoppingRule};
use carom_mesh::Vector;

use crate::model::motion::Drivers;
use crate::{ContactCondition, Dual, Load, Motion, ObstacleMotion, Scheme, StepMap};

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
    /// How the obstacles move.
    pub obstacle_motions: Vec<ObstacleMotion<D>>,
    /// Prescribed motion of nodes.
    pub motions: Vec<Motion<D>>,
    /// What drives the held displacements of every body.
    drivers: Vec<Drivers>,
    /// The loads of every body.
    pub loads: Vec<Vec<Load<D>>>,
    /// The body that each node belongs to.
    pub body_of_node: Vec<u32>,
    /// Diameter of the largest body [m].
    pub size: f64,
    /// Diameter of every body [m].
    diameters: Vec<f64>,
    /// The largest coordinate of a node where nothing has moved [m].
    farthest: f64,
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
        let diameters: Vec<f64> = bodies.iter().map(|b| b.body.mesh().diameter()).collect();
        let nodes = bodies.iter().flat_map(|b| b.body.mesh().nodes());
        Self {
            farthest: nodes.map(Vector::amax).fold(0.0, f64::max),
            reference: bodies
                .iter()
                .flat_map(|b| b.body.mesh().nodes().iter().copied())
                .chain(fixed)
                .collect(),
            obstacle_motions: vec![ObstacleMotion::Velocity(Vector::zeros()); contact.obstacles.len()],
            motions: Vec::new(),
            drivers: bodies.iter().map(|b| Drivers(vec![None; b.body.held().dofs().len()])).collect(),
            loads: bodies.iter().map(|_| Vec::new()).collect(),
            body_of_node: bodies
                .iter()
                .enumerate()
                .flat_map(|(i, b)| std::iter::repeat_n(i as u32, b.body.node_count()))
                .collect(),
            size: diameters.iter().copied().fold(0.0, f64::max),
            diameters,
            bodies,
            contact,
            groups,
            gravity,
        }
    }

    /// The same with obstacles that move like this.
    #[must_use]
    pub fn with_obstacle_motions(mut self, motions: Vec<ObstacleMotion<D>>) -> Self {
        assert_eq!(motions.len(), self.contact.obstacles.len(), "one motion per obstacle");
        self.obstacle_motions = motions;
        self
    }

    /// The same with these prescribed motions instead of its own. Of two that prescribe the same displacement the first has it.
    #[must_use]
    pub fn with_motions(mut self, motions: Vec<Motion<D>>) -> Self {
        let bodies = self.bodies.iter_mut().enumerate();
        self.drivers = bodies.map(|(i, b)| Drivers::of(i, b, &motions)).collect();
        self.motions = motions;
        self
    }

    /// The same with one more load on body `index`.
    #[must_use]
    pub fn with_load(mut self, index: usize, load: Load<D>) -> Self {
        self.loads[index].push(load);
        self
    }

    /// The motion that drives each held displacement of body `index`, in the order of `Body::held`; none where symmetry holds it.
    pub(crate) fn drivers(&self, index: usize) -> impl Iterator<Item = Option<usize>> + '_ {
        self.drivers[index].0.iter().map(|driver| driver.map(|k| k as usize))
    }

    /// Displacement [m] and velocity [m/s] that motion `k` prescribes to a component at time `t` [s].
    pub(crate) fn signal(&self, k: usize, component: usize, t: f64) -> Dual {
        self.motions[k].components[component].as_ref().map_or_else(Dual::default, |signal| signal.at(t))
    }

    /// The part of a vector at a node of the model that is prescribed: all of it at obstacles.
    #[inline]
    pub(crate) fn prescribed_part(&self, node: usize, v: &Vector<D>) -> Vector<D> {
        match self.body_of_node.get(node) {
            Some(&b) => {
                let b = &self.bodies[b as usize];
                b.body.held().part(node - b.first_node, v)
            }
            None => *v,
        }
    }

    /// The part of a vector at a node of the model that can answer to a force: nothing of it at obstacles.
    #[inline]
    pub(crate) fn free_part(&self, node: usize, v: &Vector<D>) -> Vector<D> {
        v - self.prescribed_part(node, v)
    }

    /// The body that a node belongs to; none if it is the position of an obstacle.
    #[inline]
    pub(crate) fn body_of(&self, node: usize) -> Option<usize> {
        self.body_of_node.get(node).map(|&b| b as usize)
    }

    /// Lengths below this are round-off of the coordinates [m], of small bodies far from the origin too.
    #[must_use]
    pub fn round_off(&self) -> f64 {
        4.0 * f64::EPSILON * self.size.max(self.farthest)
    }

    /// Diameter of the smaller body of a pair [m].
    pub(crate) fn pair_size(&self, pair: &Pair) -> f64 {
        match pair.target {
            Target::Surface(target) => self.diameters[pair.source].min(self.diameters[target]),
            Target::Obstacle(_) => self.diameters[pair.source],
        }
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
    /// Largest correction of a displacement, relative to the largest motion of a node in the step; in a static analysis to the largest
    /// displacement since the start, if that is more.
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
    /// The bi-potential gap of a step that a certified run may have, relative to the largest energy of the run or, if that is more, to the
    /// largest work of the reactions of a step over the motion that they prevent.
    pub certificate_tolerance: f64,
}

impl<const D: usize> Method<D> {
    /// How much the contact forces that the last step and this one ended with count in this one.
    #[must_use]
    pub fn contact_weights(&self, map: &StepMap) -> [f64; 2] {
        if self.condition.is_massless() { [1.0 - map.xi, map.xi] } else { [0.0, 1.0] }
    }

    /// The numbers that factors are kept in: double precision in a static analysis, where no mass keeps K̄ well-conditioned, and with
    /// massless contact, whose balance of energy sees the last correction itself and not its square.
    #[must_use]
    pub fn precision(&self) -> Precision {
        if self.scheme == Scheme::Static || self.condition.is_massless() {
            Precision::Double
        } else {
            Precision::Single
        }
    }

    /// Whether the balance of massless contact nodes is closed by a blend of start and end stresses.
    #[must_use]
    pub fn is_blended(&self) -> bool {
        self.scheme == Scheme::Conserving && self.condition.is_massless()
    }
}
