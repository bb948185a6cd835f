//! What of the velocities of a body is no rigid motion.

use carom_mesh::{Vector, nodal};

use crate::Body;
use crate::rigid::{RigidMass, total_moment};

/// A field of velocities that has neither momentum nor angular momentum.
#[derive(Debug, Default)]
pub struct Vibration<const D: usize> {
    /// w [m/s], zero at nodes without mass.
    pub field: Vec<Vector<D>>,
    /// M w [kg m/s].
    pub momentum: Vec<Vector<D>>,
    arms: Vec<Vector<D>>,
}

impl<const D: usize> Vibration<D> {
    /// Takes the `velocity` [m/s] of a body with displacements `u` [m] apart, and returns the energy of what vibrates, ½ w·M w [J].
    ///
    /// w is the velocity less that of a rigid body of the same momenta, at right angles to it in the mass matrix. Where supports hold the body they take
    /// the momenta of what they hold, and only translations that they leave free are no vibration. A body of revolution, or one that repeats itself, does not
    /// turn. Where supports move there is no answer: the energy is zero, and so is w.
    pub fn measure(&mut self, body: &Body<D>, u: &[Vector<D>], velocity: &[Vector<D>]) -> f64 {
        let Self { field, momentum, arms } = self;
        for own in [&mut *field, momentum, arms] {
            own.resize(velocity.len(), Vector::zeros());
        }
        let held = body.held().dofs();
        if held.iter().any(|dof| velocity[dof.node as usize][dof.component as usize] != 0.0) {
            field.fill(Vector::zeros());
            momentum.fill(Vector::zeros());
            return 0.0;
        }
        body.multiply_mass(velocity, momentum);
        let resultant = body.resultant(nodal::total(momentum));
        if held.is_empty() {
            // The field holds the positions from the centre first.
            let rigid = body.rigid_mass(u, field, arms);
            let turns = body.mesh().ties().is_empty();
            let moment = if turns { total_moment(field.iter().copied(), momentum) } else { [0.0; 3] };
            let motion = rigid.acceleration(&resultant, &moment);
            for (w, v) in field.iter_mut().zip(velocity) {
                *w = v - RigidMass::force(&motion, 1.0, w);
            }
        } else {
            field.copy_from_slice(velocity);
            let mut drift = resultant / body.total_mass();
            held.iter().for_each(|dof| drift[dof.component as usize] = 0.0);
            field.iter_mut().for_each(|w| *w -= drift);
        }
        body.massless().iter().for_each(|&n| field[n as usize] = Vector::zeros());
        body.multiply_mass(field, momentum);
        0.5 * nodal::dot(field, momentum)
    }
}
