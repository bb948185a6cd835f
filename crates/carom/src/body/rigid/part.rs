use carom_fem::Body;
use carom_mesh::Vector;

use super::guide::{Guide, Resultant};
use super::shape::{RigidShape, RigidSpec};

/// What makes a body of the model rigid.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RigidPart<const D: usize> {
    pub shape: RigidShape<D>,
    pub guide: Option<Guide>,
    pub resultants: Vec<Resultant>,
    /// How stiff the deformable bodies around it are [N/m]: what holds its corrections back in load steps, where it has no stiffness itself. Zero
    /// where all bodies are rigid.
    pub surroundings: f64,
}

impl<const D: usize> RigidPart<D> {
    /// Of a body that nothing drives, with the mass of its cells, but for what is said of it.
    pub fn new(body: &Body<D>, spec: &RigidSpec<D>) -> Self {
        let shape = RigidShape::new(body, spec);
        Self { shape, guide: None, resultants: Vec::new(), surroundings: 0.0 }
    }

    /// Its mass [kg].
    pub fn mass(&self) -> f64 {
        self.shape.mass
    }

    /// The numbers of unknowns.
    pub fn dofs(&self) -> usize {
        let [along, about] = self.free();
        along.into_iter().chain(about).filter(|&free| free).count()
    }

    /// The axes along and about which nothing prescribes how it moves.
    pub fn free(&self) -> [[bool; 3]; 2] {
        let guide = self.guide.as_ref();
        let is_guided = |part: fn(&Guide) -> &[Option<crate::Signal>; 3], i: usize| {
            guide.is_some_and(|guide| part(guide)[i].is_some())
        };
        [
            std::array::from_fn(|i| self.shape.moves_along[i] && !is_guided(|g| &g.along, i)),
            std::array::from_fn(|i| self.shape.turns_about[i] && !is_guided(|g| &g.about, i)),
        ]
    }

    /// Which displacements of all its nodes are prescribed.
    pub fn held(&self) -> [bool; D] {
        self.guide.as_ref().map_or([false; D], |guide| guide.holds(self.shape.turns_about))
    }

    /// Its centre of mass [m], the velocity of that [m/s] and its spin [rad/s].
    pub fn drift(&self, u: &[Vector<D>], v: &[Vector<D>]) -> [[f64; 3]; 3] {
        let pose = self.shape.pose(u);
        let twist = self.shape.twist(&pose, v);
        [(self.shape.centre + pose.shift).into(), twist.velocity.into(), twist.spin.into()]
    }

    /// Momentum [kg m/s] and angular momentum about the origin [kg m²/s] at these displacements [m] and velocities [m/s].
    pub fn momenta(&self, u: &[Vector<D>], v: &[Vector<D>]) -> (Vector<D>, [f64; 3]) {
        let pose = self.shape.pose(u);
        let twist = self.shape.twist(&pose, v);
        let momentum = twist.velocity * self.shape.mass;
        let own = self.shape.inertia_at(&pose.rotation) * twist.spin;
        let about_origin = own + (self.shape.centre + pose.shift).cross(&momentum);
        let turns = self.shape.turns_about != [false; 3];
        (super::pose::lower(&momentum), if turns { about_origin.into() } else { [0.0; 3] })
    }
}
