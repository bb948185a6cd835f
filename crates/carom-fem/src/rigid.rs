use carom_mesh::{Matrix, Vector, tensor};

use crate::Body;

/// Mass, centre and inertia of a body in some configuration.
///
/// With them a force of given resultant and moment is spread over the body as M(a + ω × y), y from the centre: the force that
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
    /// At the positions X + `u`; writes M y [kg m] to `arms`.
    pub(crate) fn new(body: &Body<D>, u: &[Vector<D>], arms: &mut [Vector<D>]) -> Self {
        let centre = body.centre(u);
        let reference = body.mesh().nodes();
        let mut inertia = Matrix::<3>::zeros();
        let mut polar = 0.0;
        // M y = M(X + u) − m c, as M is a number for every pair of nodes.
        for (node, arm) in arms.iter_mut().enumerate() {
            let mut sum = Vector::zeros();
            for (entry, neighbour) in body.mass().graph().row(node) {
                sum += (reference[neighbour] + u[neighbour] - centre) * body.mass().values[entry];
            }
            *arm = sum;
            let y = reference[node] + u[node] - centre;
            for i in 0..D {
                for j in 0..D {
                    inertia[(i, j)] -= y[i] * sum[j];
                }
            }
            polar += y.dot(&sum);
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
