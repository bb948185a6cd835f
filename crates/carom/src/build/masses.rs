//! Masses at points of the bodies of a scenario.

use carom_fem::PointMass;
use carom_mesh::{Mesh, Vector};

use super::places;
use super::values::{number, vector};
use crate::error::InputError;
use crate::scenario::{BodyEntry, BodyKind, Scenario};

/// The masses that a body with this `mesh` carries.
///
/// # Errors
/// If a mass is none, or its place is not of the body.
pub(super) fn masses<const D: usize>(
    scenario: &Scenario,
    entry: &BodyEntry,
    mesh: &Mesh<D>,
) -> Result<Vec<PointMass>, InputError> {
    let mut all = Vec::new();
    for (k, given) in scenario.masses.iter().enumerate().filter(|(_, given)| given.body == entry.name) {
        let (key, name) = (format!("masses.{k}"), &entry.name);
        let mass = given.mass;
        number(&format!("{key}.mass"), mass, mass > 0.0, "the mass must be greater than 0 kg")?;
        let is_rigid = entry.kind == BodyKind::Rigid;
        if is_rigid && entry.inertia.is_some() {
            let message = format!(
                "body {name:?} has an inertia of its own, which tells of all its mass; leave one out"
            );
            return Err(InputError::new(format!("{key}.body"), message));
        }
        if is_rigid && entry.round {
            let message =
                format!("body {name:?} is round, with its centre of mass in the middle; leave round out");
            return Err(InputError::new(format!("{key}.body"), message));
        }
        let stencils: Vec<Vec<(u32, f64)>> = match (&given.on, &given.point) {
            (Some(on), None) => {
                places::of_set(&key, name, on, mesh)?.into_iter().map(|node| vec![(node, 1.0)]).collect()
            }
            (None, Some(point)) => {
                let point: Vector<D> = vector(&format!("{key}.point"), point)?;
                vec![if is_rigid {
                    places::of_rigid(&point, mesh)
                } else {
                    vec![(places::nearest(&key, name, &point, mesh)?, 1.0)]
                }]
            }
            _ => return Err(InputError::new(key, "a mass is at a point, or on a set; give one of them")),
        };
        let mass = mass / stencils.len() as f64;
        all.extend(stencils.into_iter().map(|stencil| PointMass { mass, stencil }));
    }
    Ok(all)
}

/// Refuses masses of bodies that are not there.
///
/// # Errors
/// With those that are.
pub(super) fn refuse_unknown(scenario: &Scenario) -> Result<(), InputError> {
    for (k, given) in scenario.masses.iter().enumerate() {
        let known: Vec<&str> = scenario.bodies.iter().map(|body| body.name.as_str()).collect();
        if !known.contains(&given.body.as_str()) {
            let message = format!("there is no body {:?}; known are {known:?}", given.body);
            return Err(InputError::new(format!("masses.{k}.body"), message));
        }
    }
    Ok(())
}
