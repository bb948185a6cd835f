use carom_mesh::{Vector, tensor};

use super::values::{number, vector};
use crate::error::InputError;
use crate::model::Model;
use crate::scenario::{Scenario, Spin};

/// Translation and spin about the centre of mass of every body.
pub(super) fn initial_velocity<const D: usize>(
    scenario: &Scenario,
    model: &Model<D>,
) -> Result<Vec<Vector<D>>, InputError> {
    let mut velocity = Vec::with_capacity(model.node_count());
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
        let nodes = b.body.mesh().nodes();
        let centre = b.body.mean(nodes);
        velocity.extend(nodes.iter().map(|x| drift + tensor::rotation_velocity(&spin, &(x - centre))));
    }
    Ok(velocity)
}
