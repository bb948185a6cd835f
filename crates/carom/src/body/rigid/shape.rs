use carom_fem::Body;
use carom_mesh::{Matrix, Vector, nodal, tensor};

use super::pose::{Displaced, Pose, Twist, cross_matrix, inverse_on, lift, lower};

/// What is said of the mass of a rigid body that is not that of its cells.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct RigidSpec<const D: usize> {
    /// Its centre [m].
    pub centre: Option<Vector<D>>,
    /// Its inertia about the centre [kg m²].
    pub inertia: Option<Matrix<3>>,
}

/// A rigid body in the reference configuration: its mass, and the places of its nodes.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct RigidShape<const D: usize> {
    /// Mass [kg].
    pub mass: f64,
    /// J, the inertia about the centre [kg m²]; in the plane its zz component counts.
    pub inertia: Matrix<3>,
    /// Axes along which it can move, and about which it can turn: those of the plane, of space, or the axis of a body of revolution.
    pub moves_along: [bool; 3],
    /// See `moves_along`.
    pub turns_about: [bool; 3],
    /// C, its centre of mass [m].
    pub centre: Vector<3>,
    /// X − C [m].
    arms: Vec<Vector<D>>,
    /// G⁻¹ (X − X̄) [1/m], with G = Σ (X − X̄) ⊗ (X − X̄): what displacements are weighed with to find the rotation.
    fit: Vec<Vector<D>>,
    /// C − X̄ [m], with X̄ the mean of the nodes.
    off_mean: Vector<3>,
    /// G in space [m²].
    moments: Matrix<3>,
}

/// tr(G) I − G.
fn inertia_of(moments: &Matrix<3>) -> Matrix<3> {
    Matrix::<3>::from_diagonal_element(moments.trace()) - moments
}

impl<const D: usize> RigidShape<D> {
    /// Of a body with the mass of its cells, but for what is said of it.
    pub fn new(body: &Body<D>, spec: &RigidSpec<D>) -> Self {
        let nodes = body.mesh().nodes();
        let centre = spec.centre.unwrap_or_else(|| body.mean(nodes));
        let arms: Vec<Vector<D>> = nodes.iter().map(|x| x - centre).collect();
        let mut moved = vec![Vector::zeros(); arms.len()];
        body.mass().multiply(&arms, &mut moved);
        let second = nodal::moments(&arms, &moved);
        let in_space =
            |m: &Matrix<D>| Matrix::<3>::from_fn(|i, j| if i < D && j < D { m[(i, j)] } else { 0.0 });
        let middle = nodal::total(nodes) / nodes.len() as f64;
        let from_middle: Vec<Vector<D>> = nodes.iter().map(|x| x - middle).collect();
        let moments = nodal::moments(&from_middle, &from_middle);
        let inverse = tensor::inverse(&moments).0;
        let axial = body.is_axisymmetric();
        Self {
            mass: body.total_mass(),
            inertia: spec.inertia.unwrap_or_else(|| inertia_of(&in_space(&second))),
            moves_along: [!axial, true, D == 3],
            turns_about: [D == 3, D == 3, !axial],
            centre: lift(&centre),
            arms,
            fit: from_middle.iter().map(|y| inverse * y).collect(),
            off_mean: lift(&(centre - middle)),
            moments: in_space(&moments),
        }
    }

    /// X − C of a node [m].
    #[inline]
    pub fn arm(&self, node: usize) -> Vector<3> {
        lift(&self.arms[node])
    }

    /// That of a place in the reference configuration [m].
    pub fn arm_of(&self, place: &Vector<D>) -> Vector<3> {
        lift(place) - self.centre
    }

    /// What a nodal vector that is linear in the reference places is at the centre: of velocities that of the centre of mass.
    pub fn at_centre(&self, v: &[Vector<D>]) -> Vector<D> {
        let off: Vector<D> = lower(&self.off_mean);
        let beside = self.fit.iter().zip(v).fold(Vector::zeros(), |sum, (fit, v)| sum + v * fit.dot(&off));
        let at = nodal::total(v) / v.len() as f64 + beside;
        lower(&super::pose::on(&self.moves_along, &lift(&at)))
    }

    /// J turned to a rotation [kg m²].
    pub fn inertia_at(&self, rotation: &Matrix<3>) -> Matrix<3> {
        rotation * self.inertia * rotation.transpose()
    }

    /// The place that nodes with these displacements [m] tell of: their mean, and the rotation closest to what they make of the reference places.
    pub fn pose(&self, u: &[Vector<D>]) -> Pose {
        let mean = lift(&(nodal::total(u) / u.len() as f64));
        if self.turns_about == [false; 3] {
            return Pose { shift: mean, rotation: Matrix::identity() };
        }
        let turned = Matrix::<D>::identity() + nodal::moments(u, &self.fit);
        let rotation = tensor::closest_rotation(&turned).unwrap_or_else(Matrix::identity);
        let rotation = Matrix::<3>::from_fn(|i, j| match (i < D && j < D, i == j) {
            (true, _) => rotation[(i, j)],
            (false, is_diagonal) => f64::from(u8::from(is_diagonal)),
        });
        Pose { shift: mean + rotation * self.off_mean - self.off_mean, rotation }
    }

    /// The rigid motion that nodal motions [m] tell of: their mean, and the turn about it that comes closest to the rest. With θ the vector of
    /// a rotation, a point moves by θ × the mean of its arms.
    pub fn displaced(&self, start: &Pose, motion: &[Vector<D>]) -> Displaced {
        let mean = lift(&(nodal::total(motion) / motion.len() as f64));
        if self.turns_about == [false; 3] {
            return Displaced { shift: mean, turn: Vector::zeros() };
        }
        let (mut moment, mut moments) = (Vector::<3>::zeros(), Matrix::<3>::zeros());
        for (arm, d) in self.arms.iter().zip(motion) {
            let beside = lift(d) - mean;
            let y = start.rotation * (lift(arm) + self.off_mean) + beside * 0.5;
            moment += y.cross(&beside);
            moments += y * y.transpose();
        }
        let turn = inverse_on(&self.turns_about, &inertia_of(&moments)) * moment;
        let moved = Displaced { shift: Vector::zeros(), turn };
        let off = moved.mean_rotation(start) * self.off_mean;
        Displaced { shift: mean + turn.cross(&off), turn }
    }

    /// The displacement of a node at a place [m].
    #[inline]
    pub fn displacement(&self, pose: &Pose, node: usize) -> Vector<D> {
        let arm = self.arm(node);
        lower(&(pose.shift + (pose.rotation * arm - arm)))
    }

    /// The velocity that the nodal velocities [m/s] at a place tell of.
    pub fn twist(&self, pose: &Pose, v: &[Vector<D>]) -> Twist {
        let mean = nodal::total(v) / v.len() as f64;
        let mut moment = Vector::<3>::zeros();
        for (arm, v) in self.arms.iter().zip(v) {
            let y = pose.rotation * (lift(arm) + self.off_mean);
            moment += y.cross(&lift(&(v - mean)));
        }
        let moments = inertia_of(&(pose.rotation * self.moments * pose.rotation.transpose()));
        let spin = inverse_on(&self.turns_about, &moments) * moment;
        let velocity = lift(&mean) + spin.cross(&(pose.rotation * self.off_mean));
        Twist { velocity: super::pose::on(&self.moves_along, &velocity), spin }
    }

    /// Writes the nodal velocities [m/s] at a place to `out`.
    pub fn velocities(&self, pose: &Pose, twist: &Twist, out: &mut [Vector<D>]) {
        for (arm, v) in self.arms.iter().zip(out) {
            *v = lower(&(twist.velocity + twist.spin.cross(&(pose.rotation * lift(arm)))));
        }
    }

    /// Writes the motions [m] of nodes that start at these displacements [m], from the place that these tell of, to `out`. They end where the
    /// body is rigid, however the round-off of the start.
    pub fn motions(&self, start: &Pose, moved: &Displaced, u: &[Vector<D>], out: &mut [Vector<D>]) {
        let mean = moved.mean_rotation(start);
        for (node, (d, u)) in out.iter_mut().zip(u).enumerate() {
            *d = self.motion(&mean, moved, node) + (self.displacement(start, node) - u);
        }
    }

    /// The motion of a node [m], where ½(R₀ + R₁) is this.
    #[inline]
    pub fn motion(&self, mean: &Matrix<3>, moved: &Displaced, node: usize) -> Vector<D> {
        lower(&(moved.shift + moved.turn.cross(&(mean * self.arm(node)))))
    }

    /// The resultant [N] of nodal forces and their moments by reference arms, Σ (X − C) ⊗ f [N m].
    pub fn gather(&self, forces: &[Vector<D>]) -> Wrench {
        let mut sum = Wrench::default();
        self.arms.iter().zip(forces).for_each(|(arm, f)| sum.add(&lift(arm), &lift(f)));
        sum
    }

    /// Adds nodal forces [N] with this resultant and moment about the centre to `out`, where `rotation` makes arms of those of the reference
    /// configuration: of all such forces those with the least sum of squares.
    pub fn spread(&self, rotation: &Matrix<3>, force: &Vector<3>, moment: &Vector<3>, out: &mut [Vector<D>]) {
        let moments = inertia_of(&(rotation * self.moments * rotation.transpose()));
        let about_mean = moment + (rotation * self.off_mean).cross(force);
        let turn = inverse_on(&self.turns_about, &moments) * about_mean;
        let each = force / self.arms.len() as f64;
        for (arm, f) in self.arms.iter().zip(out) {
            *f += lower::<D>(&(each + turn.cross(&(rotation * (lift(arm) + self.off_mean)))));
        }
    }

    /// How a node yields to a force on another [m/N], with a compliance of shifts [m/N] and one of turns [1/(N m)], and arms in this rotation.
    pub fn response(
        &self,
        rotation: &Matrix<3>,
        compliance: &[Matrix<3>; 2],
        a: usize,
        b: usize,
    ) -> Matrix<D> {
        let [a, b] = [a, b].map(|node| cross_matrix(&(rotation * self.arm(node))));
        let [shift, turn] = compliance;
        // d = θ × a = −â θ, and the moment of f is b̂ f.
        let block = shift - a * turn * b;
        Matrix::from_fn(|i, j| block[(i, j)])
    }

    /// Kinetic energy [J].
    pub fn kinetic(&self, pose: &Pose, twist: &Twist) -> f64 {
        let momentum = self.inertia_at(&pose.rotation) * twist.spin;
        0.5 * (self.mass * twist.velocity.norm_squared() + twist.spin.dot(&momentum))
    }
}

/// The resultant of forces on points of a rigid body, and their moments before the body has turned.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Wrench {
    /// Σ f [N].
    pub force: Vector<3>,
    /// Σ (X − C) ⊗ f [N m].
    pub dyad: Matrix<3>,
    /// Moments that do not turn with the body [N m].
    pub moment: Vector<3>,
}

impl Wrench {
    /// Adds a force [N] on the point with this reference arm [m].
    #[inline]
    pub fn add(&mut self, arm: &Vector<3>, force: &Vector<3>) {
        self.force += force;
        self.dyad += arm * force.transpose();
    }

    /// Its moment about the centre [N m], where the arms are turned like this.
    pub fn moment_at(&self, rotation: &Matrix<3>) -> Vector<3> {
        self.moment + super::pose::moment_of(&(rotation * self.dyad))
    }
}

impl std::ops::Add for Wrench {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            force: self.force + other.force,
            dyad: self.dyad + other.dyad,
            moment: self.moment + other.moment,
        }
    }
}
