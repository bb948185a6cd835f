use carom_mesh::{Vector, tensor};

use super::values::{number, vector};
use crate::body::fe::part::ModelBody;
use crate::error::InputError;
use crate::model::Model;
use crate::scenario::{Scenario, Spin};

/// How a body moves that moves as if it were rigid.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RigidMotion<const D: usize> {
    /// Velocity of the centre of mass [m/s].
    drift: Vector<D>,
    /// Angular velocity about it [rad/s].
    spin: [f64; 3],
}

impl<const D: usize> RigidMotion<D> {
    /// The velocities [m/s] of the nodes of a `body` at these `positions` [m]; of one of another code those that it came with.
    pub fn velocities(&self, body: &ModelBody<D>, positions: &[Vector<D>]) -> Vec<Vector<D>> {
        if let Some(law) = &body.foreign {
            return law.velocity.clone();
        }
        let centre = body.mean(positions);
        let velocity = |x: &Vector<D>| self.drift + tensor::rotation_velocity(&self.spin, &(x - centre));
        positions.iter().map(velocity).collect()
    }
}

/// Translation and spin about the centre of mass of every body.
pub(super) fn rigid_motions<const D: usize>(
    scenario: &Scenario,
    model: &Model<D>,
) -> Result<Vec<RigidMotion<D>>, InputError> {
    let mut motions = Vec::with_capacity(model.bodies.len());
    for (i, (entry, b)) in scenario.bodies.iter().zip(&model.bodies).enumerate() {
        let drift: Vector<D> = match &entry.velocity {
            Some(v) => vector(&format!("bodies.{i}.velocity"), v)?,
            None => Vector::zeros(),
        };
        let axial = b.body.is_axisymmetric();
        if axial && drift[0] != 0.0 {
            let message =
                format!("{:?}: a body of revolution moves along its axis; give [0, v]", drift.as_slice());
            return Err(InputError::new(format!("bodies.{i}.velocity"), message));
        }
        let key = format!("bodies.{i}.spin");
        let spin = match (entry.spin, D) {
            (Spin::None, _) => [0.0; 3],
            (Spin::InPlane(spin), 2) => [0.0, 0.0, spin],
            (Spin::InSpace(spin), 3) => spin,
            _ => {
                let message = format!("a spin in {D}D is {}", ["a number", "a list of 3 numbers"][D - 2]);
                return Err(InputError::new(key, message));
            }
        };
        for component in spin {
            number(&key, component, true, "the spin must be a finite number")?;
        }
        let still = spin == [0.0; 3];
        let free = b.body.mesh().ties().is_empty();
        number(&key, spin[2], free || still, "a periodic body cannot spin; give 0")?;
        number(&key, spin[2], !axial || still, "an axisymmetric body cannot spin; give 0")?;
        motions.push(RigidMotion { drift, spin });
    }
    Ok(motions)
}
