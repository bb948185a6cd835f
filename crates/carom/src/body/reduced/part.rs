//! What makes a body of the model reduced, and where such a body is.

use carom_fem::{Body, CellState, Content, FemError, KineticParts, Momenta, Reduction};
use carom_mesh::{Matrix, Vector, nodal, tensor};

use super::outline::Outline;
use super::place::{Place, Rates};
use crate::body::rigid::pose::{Pose, Twist, cayley, lift, lower};
use crate::body::rigid::shape::{RigidShape, RigidSpec};
use crate::ledger::Energies;

/// Frames are found after some of these; every one leaves as much of an error as there is strain.
const ITERATIONS: usize = 50;

/// The reduction of a body, and the nodes that matter between pictures.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ReducedPart<const D: usize> {
    /// The body without deformation.
    pub shape: RigidShape<D>,
    /// Its vibrations.
    pub reduction: Reduction<D>,
    /// Damping in terms of the stiffness [s].
    pub damping: f64,
    /// The nodes, ascending, that the step moves: those that may touch, and those that are read.
    pub moved: Vec<u32>,
    /// The nodes, ascending, that are placed at the end of every step beside those: the ones that are tracked.
    pub tracked: Vec<u32>,
    /// All others that steps may look at.
    pub(super) outline: Outline,
    /// What displacements of the nodes that are read are weighed with to guess the rotation [1/m].
    fit: Vec<Vector<D>>,
}

/// Room for what is read.
#[derive(Debug, Clone)]
pub(crate) struct Reading<const D: usize> {
    pub(super) local: Vec<Vector<D>>,
    pub(super) content: Content<D>,
}

impl<const D: usize> Reading<D> {
    /// For a body.
    pub fn new(part: &ReducedPart<D>) -> Self {
        let zeros = vec![Vector::zeros(); part.reduction.read_nodes().len()];
        Self { local: zeros, content: Content::of(part.reduction.count()) }
    }
}

impl<const D: usize> ReducedPart<D> {
    /// Of a body, with the nodes of its contact surface and as many `modes` with these held; steps are to place its `tracked` nodes.
    ///
    /// # Errors
    /// If the nodes of the contact surface do not hold the body, or it is in pieces.
    pub fn new(body: &Body<D>, modes: usize, tracked: &[u32]) -> Result<Self, FemError> {
        let reduction = Reduction::new(body, modes)?;
        let reference = body.mesh().nodes();
        let read = reduction.read_nodes();
        let places: Vec<Vector<D>> = read.iter().map(|&n| reference[n as usize]).collect();
        let middle = nodal::total(&places) / places.len() as f64;
        let from_middle: Vec<Vector<D>> = places.iter().map(|x| x - middle).collect();
        let inverse = tensor::inverse(&nodal::moments(&from_middle, &from_middle)).0;
        let joined = |a: &[u32], b: &[u32]| {
            let mut all = [a, b].concat();
            all.sort_unstable();
            all.dedup();
            all
        };
        let moved = joined(read, body.surface().nodes());
        let placed = joined(&moved, tracked);
        let shape = RigidShape::new(body, &RigidSpec::default());
        Ok(Self {
            outline: Outline::new(body, &shape, &reduction, &placed),
            shape,
            damping: body.damping().stiffness,
            tracked: placed.into_iter().filter(|n| moved.binary_search(n).is_err()).collect(),
            moved,
            fit: from_middle.iter().map(|y| inverse * y).collect(),
            reduction,
        })
    }

    /// Numbers of unknowns.
    pub fn dofs(&self) -> usize {
        D * (D + 1) / 2 + self.reduction.count()
    }

    /// X − C + Φ η of a node [m].
    #[inline]
    pub fn bent_arm(&self, node: usize, amplitudes: &[f64]) -> Vector<3> {
        self.shape.arm(node) + lift(&self.reduction.displacement(node, amplitudes))
    }

    /// The displacement of a node [m].
    #[inline]
    pub fn displacement(&self, place: &Place, node: usize) -> Vector<D> {
        self.displaced(&place.pose, node, &self.reduction.displacement(node, &place.amplitudes))
    }

    /// Those in two places.
    #[inline]
    pub fn displacements(&self, places: [&Place; 2], node: usize) -> [Vector<D>; 2] {
        let [a, b] = self.reduction.displacements(node, places.map(|place| &place.amplitudes[..]));
        [self.displaced(&places[0].pose, node, &a), self.displaced(&places[1].pose, node, &b)]
    }

    /// The displacement of a node [m] that vibrations have `bent` in the frame of the body [m].
    #[inline]
    pub fn displaced(&self, pose: &Pose, node: usize, bent: &Vector<D>) -> Vector<D> {
        let Pose { shift, rotation } = pose;
        lower(&(shift + (rotation - Matrix::identity()) * self.shape.arm(node) + rotation * lift(bent)))
    }

    /// The velocity of a node [m/s].
    #[inline]
    pub fn velocity(&self, place: &Place, rates: &Rates, node: usize) -> Vector<D> {
        let Pose { rotation, .. } = place.pose;
        let [bent, bending] = self.reduction.displacements(node, [&place.amplitudes, &rates.amplitudes]);
        let arm = rotation * (self.shape.arm(node) + lift(&bent));
        lower(&(rates.twist.velocity + rates.twist.spin.cross(&arm) + rotation * lift(&bending)))
    }

    /// Finds the place where the nodes that are read have these displacements [m], which are of all nodes: the frame in which shift and turn are zero.
    pub fn place(&self, u: &[Vector<D>], reading: &mut Reading<D>, place: &mut Place) {
        let nodes = self.reduction.read_nodes();
        let mut turned = Matrix::<D>::identity();
        for (&node, fit) in nodes.iter().zip(&self.fit) {
            turned += u[node as usize] * fit.transpose();
        }
        let rotation = tensor::closest_rotation(&turned).unwrap_or_else(Matrix::identity);
        let mut rotation = in_space(&rotation);
        let Reading { local, content, .. } = reading;
        let mut last = f64::INFINITY;
        for _ in 0..ITERATIONS {
            for (local, &node) in local.iter_mut().zip(nodes) {
                // Not as a difference of places, whose round-off is that of the size of the body.
                let turned = (rotation - Matrix::identity()).tr_mul(&self.shape.arm(node as usize));
                *local = lower(&(turned + rotation.tr_mul(&lift(&u[node as usize]))));
            }
            let turn = Vector::<3>::from(self.reduction.read_turn(local));
            let size = turn.norm();
            if size.is_nan() || size >= last || size == 0.0 {
                break;
            }
            rotation *= cayley(&turn);
            last = size;
        }
        self.reduction.read(local, content);
        place.pose = Pose { shift: rotation * lift(&content.shift), rotation };
        place.amplitudes.copy_from_slice(&content.amplitudes);
    }

    /// Finds how the body moves where the nodes that are read have these velocities [m/s], which are of all nodes; by how much vibrations have `bent`
    /// those that are read [m] is given one by one, in the frame of the body, which has this `rotation`.
    pub fn rates(
        &self,
        rotation: &Matrix<3>,
        bent: impl Iterator<Item = Vector<D>> + Clone,
        v: &[Vector<D>],
        reading: &mut Reading<D>,
        rates: &mut Rates,
    ) {
        let nodes = self.reduction.read_nodes();
        let Reading { local, content } = reading;
        let (mut spin, mut last) = (Vector::<3>::zeros(), f64::INFINITY);
        for _ in 0..ITERATIONS {
            for ((local, &node), bent) in local.iter_mut().zip(nodes).zip(bent.clone()) {
                let own = rotation.tr_mul(&lift(&v[node as usize]));
                *local = lower(&(own - spin.cross(&lift(&bent))));
            }
            let turn = Vector::<3>::from(self.reduction.read_turn(local));
            let change = (turn - spin).norm();
            spin = turn;
            if change.is_nan() || change >= last || change == 0.0 {
                break;
            }
            last = change;
        }
        self.reduction.read(local, content);
        rates.twist = Twist { velocity: rotation * lift(&content.shift), spin: rotation * spin };
        rates.amplitudes.copy_from_slice(&content.amplitudes);
    }

    /// Its energies [J].
    pub fn energies(&self, place: &Place, rates: &Rates) -> Energies {
        let vibration: f64 = rates.amplitudes.iter().map(|v| v * v).sum();
        let stored = place.amplitudes.iter().zip(self.reduction.stiffness());
        Energies {
            kinetic: self.shape.kinetic(&place.pose, &rates.twist) + 0.5 * vibration,
            strain: 0.5 * stored.map(|(a, k)| k * a * a).sum::<f64>(),
            springs: 0.0,
        }
    }

    /// Where the nodes say it is, and how it moves.
    pub fn seen(&self, u: &[Vector<D>], v: &[Vector<D>]) -> (Place, Rates) {
        let count = self.reduction.count();
        let mut reading = Reading::new(self);
        let (mut place, mut rates) = (Place::of(count), Rates::of(count));
        self.place(u, &mut reading, &mut place);
        let nodes = self.reduction.read_nodes().iter();
        let bent: Vec<_> =
            nodes.map(|&n| self.reduction.displacement(n as usize, &place.amplitudes)).collect();
        self.rates(&place.pose.rotation, bent.iter().copied(), v, &mut reading, &mut rates);
        (place, rates)
    }

    /// What it has of motion at these displacements [m] and velocities [m/s], where its kinetic energy is `kinetic` [J]: mean axes move with the
    /// mass, and what is left of it is in the amplitudes.
    pub fn momenta(&self, u: &[Vector<D>], v: &[Vector<D>], kinetic: f64) -> Momenta<D> {
        let (Place { pose, .. }, Rates { twist, .. }) = self.seen(u, v);
        let momentum = twist.velocity * self.shape.mass;
        let own = self.shape.inertia_at(&pose.rotation) * twist.spin;
        let about_origin = own + (self.shape.centre + pose.shift).cross(&momentum);
        let (translation, rotation) = (0.5 * momentum.dot(&twist.velocity), 0.5 * own.dot(&twist.spin));
        Momenta {
            momentum: lower(&momentum),
            angular_momentum: about_origin.into(),
            kinetic: KineticParts { translation, rotation, vibration: kinetic - translation - rotation },
        }
    }

    /// Its centre of mass [m], the velocity of that [m/s] and its spin [rad/s], as the nodes say that are placed in every step.
    pub fn drift(&self, u: &[Vector<D>], v: &[Vector<D>]) -> [[f64; 3]; 3] {
        let (Place { pose, .. }, Rates { twist, .. }) = self.seen(u, v);
        [(self.shape.centre + pose.shift).into(), twist.velocity.into(), twist.spin.into()]
    }

    /// Lets all nodes that no step moves be where those that are read say [m], and move so [m/s].
    pub fn complete(&self, u: &mut [Vector<D>], v: &mut [Vector<D>]) {
        let (place, rates) = self.seen(u, v);
        let mut moved = self.moved.iter().copied().peekable();
        for (node, (u, v)) in u.iter_mut().zip(v).enumerate() {
            if moved.next_if_eq(&(node as u32)).is_none() {
                *u = self.displacement(&place, node);
                *v = self.velocity(&place, &rates, node);
            }
        }
    }

    /// The same of the nodes that are tracked alone.
    pub fn complete_tracked(&self, u: &mut [Vector<D>], v: &mut [Vector<D>]) {
        if self.tracked.is_empty() {
            return;
        }
        let (place, rates) = self.seen(u, v);
        for node in self.tracked.iter().map(|&n| n as usize) {
            u[node] = self.displacement(&place, node);
            v[node] = self.velocity(&place, &rates, node);
        }
    }

    /// The mean state of every cell: that of the deformation in the frame of the body, turned with it.
    pub fn cell_states(&self, body: &Body<D>, u: &[Vector<D>]) -> Vec<CellState> {
        let (own, rotation) = self.in_own_frame(u);
        let mut cells = body.after(&[]).cell_states(&own);
        cells.iter_mut().for_each(|cell| cell.stress = rotation * cell.stress * rotation.transpose());
        cells
    }

    /// The displacements [m] of all nodes in the frame of the body, and its rotation.
    fn in_own_frame(&self, u: &[Vector<D>]) -> (Vec<Vector<D>>, Matrix<3>) {
        let mut place = Place::of(self.reduction.count());
        self.place(u, &mut Reading::new(self), &mut place);
        let own = (0..u.len()).map(|node| self.reduction.displacement(node, &place.amplitudes));
        (own.collect(), place.pose.rotation)
    }
}

/// A rotation of the model in space.
fn in_space<const D: usize>(rotation: &Matrix<D>) -> Matrix<3> {
    Matrix::<3>::from_fn(|i, j| match (i < D && j < D, i == j) {
        (true, _) => rotation[(i, j)],
        (false, is_diagonal) => f64::from(u8::from(is_diagonal)),
    })
}
