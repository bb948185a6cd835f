//! How a body moves as a whole.

use carom_mesh::{Matrix, Vector, nodal, tensor};

use crate::Body;

impl<const D: usize> Body<D> {
    /// Centre of mass of the deformed body [m].
    #[must_use]
    pub fn centre(&self, u: &[Vector<D>]) -> Vector<D> {
        self.mean(u) + self.mean(self.mesh().nodes())
    }

    /// Mean of a nodal vector, weighted by mass: the velocity of the centre of mass for `v`. In a body of revolution what is
    /// radial cancels around the axis.
    #[must_use]
    pub fn mean(&self, v: &[Vector<D>]) -> Vector<D> {
        self.resultant(nodal::weighted_total(self.nodal_mass(), v)) / self.total_mass()
    }

    /// The resultant of a `sum` over the nodes: without its radial component in a body of revolution, where that cancels.
    #[must_use]
    pub fn resultant(&self, mut sum: Vector<D>) -> Vector<D> {
        if self.is_axisymmetric() {
            sum[0] = 0.0;
        }
        sum
    }

    /// The mean rotation R of the body: the polar factor of Σ m (x − c) ⊗ (X − C).
    ///
    /// It is the identity for a law of small displacements, whose forces do not turn with the body, and for a body that
    /// repeats itself. It is also the identity where the body is so deformed that there is no rotation to find.
    #[must_use]
    pub fn frame(&self, u: &[Vector<D>]) -> Matrix<D> {
        if !self.turns() {
            return Matrix::identity();
        }
        let turned = Matrix::identity() + nodal::moments(u, &self.frame_arms);
        tensor::closest_rotation(&turned).unwrap_or_else(Matrix::identity)
    }

    /// [Σ m (X − C) ⊗ (X − C)]⁻¹ m (X − C) [1/m] of every node, what [`Self::frame`] weighs displacements with; nothing of a body that
    /// does not turn. The mean of the displacements need not be taken off, as these arms sum to zero.
    pub(crate) fn reference_arms(&self) -> Vec<Vector<D>> {
        if !self.turns() {
            return Vec::new();
        }
        let nodes = self.mesh().nodes();
        let centre = self.mean(nodes);
        let mut inertia = Matrix::zeros();
        for (x, &m) in nodes.iter().zip(self.nodal_mass()) {
            inertia += (x - centre) * (x - centre).transpose() * m;
        }
        let inverse = tensor::inverse(&inertia).0;
        nodes.iter().zip(self.nodal_mass()).map(|(x, &m)| inverse * (x - centre) * m).collect()
    }

    /// The moments of the mass at the positions X + `u`, from which forces are made that move the body rigidly. Writes the positions y from the
    /// centre [m] to `from_centre`, and M y [kg m] to `arms`.
    #[must_use]
    pub fn rigid_mass(
        &self,
        u: &[Vector<D>],
        from_centre: &mut [Vector<D>],
        arms: &mut [Vector<D>],
    ) -> RigidMass<D> {
        RigidMass::new(self, u, from_centre, arms)
    }

    /// Mean spin [rad/s] about the centre of mass, as (z) in 2D and (x, y, z) in 3D: the inertia tensor's inverse times the
    /// angular momentum about the centre. A body of revolution has none.
    #[must_use]
    pub fn spin(&self, u: &[Vector<D>], v: &[Vector<D>]) -> [f64; 3] {
        if self.is_axisymmetric() {
            return [0.0; 3];
        }
        let (centre, drift) = (self.centre(u), self.mean(v));
        let mut momentum = [0.0; 3];
        let mut inertia = Matrix::<3>::zeros();
        let mut polar = 0.0;
        for (((u, v), x), &m) in u.iter().zip(v).zip(self.mesh().nodes()).zip(self.nodal_mass()) {
            let arm = x + u - centre;
            let moment = tensor::cross(&arm, &(v - drift));
            let arm3 = Vector::<3>::from_fn(|i, _| if i < D { arm[i] } else { 0.0 });
            (0..3).for_each(|i| momentum[i] += m * moment[i]);
            polar += m * arm3.norm_squared();
            inertia -= arm3 * arm3.transpose() * m;
        }
        inertia += Matrix::<3>::identity() * polar;
        let spin = tensor::inverse(&inertia).0 * Vector::<3>::from(momentum);
        [spin[0], spin[1], spin[2]]
    }

    /// Angular momentum [kg m²/s] about the origin of a body with momentum density `mv` = M v [kg m/s] per node. A body of
    /// revolution has none, as it cancels.
    #[must_use]
    pub fn angular_momentum(&self, u: &[Vector<D>], mv: &[Vector<D>]) -> [f64; 3] {
        if self.is_axisymmetric() {
            return [0.0; 3];
        }
        total_moment(self.mesh().nodes().iter().zip(u).map(|(x, u)| x + u), mv)
    }
}

/// The kinetic energy of a body by what moves [J].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct KineticParts {
    /// Of the centre of mass, ½ m v².
    pub translation: f64,
    /// Of the turn about it as a rigid body of the present shape, ½ ω·J ω.
    pub rotation: f64,
    /// The rest, with which the body moves in itself.
    pub vibration: f64,
}

/// What a body has of motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Momenta<const D: usize> {
    /// Σ M v [kg m/s].
    pub momentum: Vector<D>,
    /// About the origin [kg m²/s], as [`Body::angular_momentum`].
    pub angular_momentum: [f64; 3],
    /// ½ vᵀM v by what moves [J].
    pub kinetic: KineticParts,
}

impl<const D: usize> Body<D> {
    /// Momenta and kinetic energy at displacements `u` [m] and velocities `v` [m/s], at which the kinetic energy is `kinetic` [J].
    ///
    /// For the parts of the energy the velocities are taken apart into those of a rigid body of the same momentum and angular momentum, and the rest, which is at right
    /// angles to them in the mass matrix: the parts add up to the whole, and none is negative but for round-off. A body of revolution, or one
    /// that repeats itself, does not turn.
    #[must_use]
    pub fn momenta(&self, u: &[Vector<D>], v: &[Vector<D>], kinetic: f64) -> Momenta<D> {
        let momentum = self.resultant(nodal::weighted_total(self.nodal_mass(), v));
        let translation = 0.5 * momentum.norm_squared() / self.total_mass();
        let (mut rotation, mut angular_momentum) = (0.0, [0.0; 3]);
        if !self.is_axisymmetric() {
            let (mut from_centre, mut arms) =
                (vec![Vector::zeros(); v.len()], vec![Vector::zeros(); v.len()]);
            let rigid = self.rigid_mass(u, &mut from_centre, &mut arms);
            let orbit = tensor::cross(&rigid.centre, &momentum);
            // The mass matrix is symmetric: Σ y × M v is Σ M y × v.
            let spin = total_moment(arms.iter().copied(), v);
            angular_momentum = std::array::from_fn(|i| orbit[i] + spin[i]);
            if self.mesh().ties().is_empty() {
                let (_, turn) = rigid.acceleration(&Vector::zeros(), &spin);
                rotation = 0.5 * (0..3).map(|i| turn[i] * spin[i]).sum::<f64>();
            }
        }
        let vibration = kinetic - translation - rotation;
        let kinetic = KineticParts { translation, rotation, vibration };
        Momenta { momentum, angular_momentum, kinetic }
    }
}

/// Σ a × b, with three components.
pub(crate) fn total_moment<const D: usize>(a: impl Iterator<Item = Vector<D>>, b: &[Vector<D>]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (a, b) in a.zip(b) {
        let moment = tensor::cross(&a, b);
        (0..3).for_each(|i| sum[i] += moment[i]);
    }
    sum
}

/// Mass, centre and inertia of a body in some configuration.
///
/// With them a force of given resultant and moment is spread over the body as M(a + ω × y), y from the centre. This force
/// accelerates it rigidly and does the least to its deformation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigidMass<const D: usize> {
    /// The centre of mass [m].
    pub centre: Vector<D>,
    mass: f64,
    /// Whether the body is one of revolution, which moves rigidly only along its axis.
    axial: bool,
    inertia: Matrix<3>,
}

impl<const D: usize> RigidMass<D> {
    /// [`Body::rigid_mass`].
    fn new(body: &Body<D>, u: &[Vector<D>], from_centre: &mut [Vector<D>], arms: &mut [Vector<D>]) -> Self {
        let centre = body.centre(u);
        for ((y, x), u) in from_centre.iter_mut().zip(body.mesh().nodes()).zip(u) {
            *y = x + u - centre;
        }
        body.multiply_mass(from_centre, arms);
        let mut inertia = Matrix::<3>::zeros();
        let mut polar = 0.0;
        for (y, arm) in from_centre.iter().zip(arms.iter()) {
            for i in 0..D {
                for j in 0..D {
                    inertia[(i, j)] -= y[i] * arm[j];
                }
            }
            polar += y.dot(arm);
        }
        inertia += Matrix::<3>::identity() * polar;
        Self { centre, mass: body.total_mass(), axial: body.is_axisymmetric(), inertia }
    }

    /// The rigid acceleration [m/s²], [1/s²] under a force of this `resultant` [N] and `moment` [N m] about the centre.
    #[must_use]
    pub fn acceleration(&self, resultant: &Vector<D>, moment: &[f64; 3]) -> (Vector<D>, [f64; 3]) {
        if self.axial {
            let mut acceleration = resultant / self.mass;
            acceleration[0] = 0.0;
            return (acceleration, [0.0; 3]);
        }
        let spin = if D == 2 {
            [0.0, 0.0, moment[2] / self.inertia[(2, 2)]]
        } else {
            (tensor::inverse(&self.inertia).0 * Vector::<3>::from(*moment)).into()
        };
        // A body without extent cannot turn.
        let spin = if spin.iter().all(|s| s.is_finite()) { spin } else { [0.0; 3] };
        (resultant / self.mass, spin)
    }

    /// The force [N] on a node of mass `nodal_mass` [kg] with `arm` M y that belongs to a rigid acceleration.
    #[inline]
    #[must_use]
    pub fn force(acceleration: &(Vector<D>, [f64; 3]), nodal_mass: f64, arm: &Vector<D>) -> Vector<D> {
        acceleration.0 * nodal_mass + tensor::rotation_velocity(&acceleration.1, arm)
    }
}
