//! Springs and dampers of a scenario.

use std::collections::BTreeMap;

use carom_mesh::Vector;

use super::foreign::refuse_foreign;
use super::places;
use super::values::vector;
use crate::body::fe::part::ModelBody;
use crate::error::InputError;
use crate::model::Model;
use crate::model::springs::{ForceLaw, Spring};
use crate::scenario::{PlaceEntry, Scenario, SpringEntry};

/// Places closer than this, relative to the size of the model, are the same.
const SAME: f64 = 1e-12;

/// Where a spring is attached: nodes with their shares, and the place where nothing has moved [m].
struct Place<const D: usize> {
    stencil: Vec<(u32, f64)>,
    at: Vector<D>,
}

/// The model with its springs.
pub(super) fn springs<const D: usize>(scenario: &Scenario, model: Model<D>) -> Result<Model<D>, InputError> {
    let entries = scenario.springs.iter().enumerate();
    let springs = entries.map(|(k, entry)| spring(&format!("springs.{k}"), entry, &model));
    let springs = springs.collect::<Result<Vec<_>, _>>()?;
    Ok(model.with_springs(springs))
}

fn spring<const D: usize>(key: &str, entry: &SpringEntry, model: &Model<D>) -> Result<Spring<D>, InputError> {
    let [first, second] =
        [0, 1].map(|end| place(&format!("{key}.between.{end}"), &entry.between[end], model));
    let (first, second) = (first?, second?);
    let mut shares: BTreeMap<u32, f64> = BTreeMap::new();
    for (sign, place) in [(-1.0, &first), (1.0, &second)] {
        place.stencil.iter().for_each(|&(node, share)| *shares.entry(node).or_default() += sign * share);
    }
    let stencil: Vec<(u32, f64)> = shares.into_iter().filter(|(_, share)| share.abs() > SAME).collect();
    if stencil.is_empty() {
        let message = "both places move as one, so that the spring does nothing; choose two that do not";
        return Err(InputError::new(format!("{key}.between"), message));
    }
    if !stencil.iter().any(|&(node, _)| model.assembly.body_of(node as usize).is_some()) {
        let message = "neither place is of a body; attach one of them to a body";
        return Err(InputError::new(format!("{key}.between"), message));
    }
    let reference = second.at - first.at;
    let length = reference.norm();
    let finite = |name: &str, value: f64| {
        if value.is_finite() && value >= 0.0 {
            return Ok(value);
        }
        Err(InputError::new(format!("{key}.{name}"), format!("{value}: must be a finite number, 0 at least")))
    };
    let law = match (entry.stiffness, &entry.force) {
        (Some(_), Some(_)) => {
            let message = "a spring has a stiffness or a table of forces, not both; leave one out";
            return Err(InputError::new(format!("{key}.force"), message));
        }
        (None, Some(table)) => ForceLaw::table(&table.elongation, &table.force)
            .map_err(|message| InputError::new(format!("{key}.force"), message))?,
        (stiffness, None) => ForceLaw::linear(finite("stiffness", stiffness.unwrap_or(0.0))?),
    };
    let damping = finite("damping", entry.damping)?;
    if entry.stiffness.unwrap_or(0.0) == 0.0 && entry.force.is_none() && damping == 0.0 {
        let message = "does nothing; give a stiffness, a table of forces, or a damping";
        return Err(InputError::new(key, message));
    }
    let free_length = finite("free_length", entry.free_length.unwrap_or(length))?;
    if length <= SAME * model.assembly.size && law.force(length - free_length) != 0.0 {
        let message = "its places are one and the same, so that its force has no direction; draw them apart, or let its \
                       force be none there: with free_length = 0 a stiffness pulls them together";
        return Err(InputError::new(format!("{key}.between"), message));
    }
    Ok(Spring { name: entry.name.clone(), stencil, reference, free_length, law, damping })
}

/// The place under `key`.
fn place<const D: usize>(key: &str, entry: &PlaceEntry, model: &Model<D>) -> Result<Place<D>, InputError> {
    let point = match &entry.point {
        Some(point) => Some(vector::<D>(&format!("{key}.point"), point)?),
        None => None,
    };
    match (&entry.body, &entry.obstacle, &entry.on, point) {
        (Some(name), None, Some(on), None) => of_set(key, name, on, model),
        (Some(name), None, None, Some(point)) => of_point(key, name, &point, model),
        (None, Some(name), None, Some(at)) => {
            let first = model.assembly.node_count();
            let obstacle = model.assembly.obstacle(name).ok_or_else(|| {
                InputError::new(format!("{key}.obstacle"), format!("there is no obstacle {name:?}"))
            })?;
            Ok(Place { stencil: vec![((first + obstacle) as u32, 1.0)], at })
        }
        (None, None, None, Some(at)) => Ok(Place { stencil: Vec::new(), at }),
        _ => {
            let message =
                "a place is a body with a point or a set `on` it, an obstacle with a point, or a point alone";
            Err(InputError::new(key, message))
        }
    }
}

fn body<'a, const D: usize>(
    key: &str,
    name: &str,
    model: &'a Model<D>,
) -> Result<&'a ModelBody<D>, InputError> {
    let body = model.bodies.iter().find(|b| b.name == name).ok_or_else(|| {
        let known: Vec<&str> = model.bodies.iter().map(|b| b.name.as_str()).collect();
        InputError::new(format!("{key}.body"), format!("there is no body {name:?}; known are {known:?}"))
    })?;
    if body.body.is_axisymmetric() {
        let message =
            format!("body {name:?} is one of revolution, on which a spring would be a cone; leave it out");
        return Err(InputError::new(format!("{key}.body"), message));
    }
    Ok(body)
}

/// The mean of the nodes of a set.
fn of_set<const D: usize>(key: &str, name: &str, on: &str, model: &Model<D>) -> Result<Place<D>, InputError> {
    let body = body(key, name, model)?;
    let mesh = body.body.mesh();
    let nodes = places::of_set(key, name, on, mesh)?;
    let share = 1.0 / nodes.len() as f64;
    let at = nodes.iter().map(|&n| mesh.nodes()[n as usize] * share).sum();
    takes_forces(&format!("{key}.on"), body, &nodes)?;
    let first = body.nodes().start as u32;
    Ok(Place { stencil: nodes.iter().map(|n| (first + n, share)).collect(), at })
}

/// The node nearest to a point; of a rigid body the point itself.
fn of_point<const D: usize>(
    key: &str,
    name: &str,
    point: &Vector<D>,
    model: &Model<D>,
) -> Result<Place<D>, InputError> {
    let body = body(key, name, model)?;
    let (mesh, first) = (body.body.mesh(), body.nodes().start as u32);
    if body.is_rigid() {
        let shares = places::of_rigid(point, mesh);
        let stencil = shares.into_iter().map(|(n, share)| (first + n, share)).collect();
        return Ok(Place { stencil, at: *point });
    }
    let nearest = places::nearest(key, name, point, mesh)?;
    takes_forces(&format!("{key}.point"), body, &[nearest])?;
    Ok(Place { stencil: vec![(first + nearest, 1.0)], at: mesh.nodes()[nearest as usize] })
}

/// Refuses nodes that cannot take the force of a spring.
fn takes_forces<const D: usize>(key: &str, body: &ModelBody<D>, nodes: &[u32]) -> Result<(), InputError> {
    refuse_foreign(key, body)?;
    let name = &body.name;
    let touches = body.body.surface().nodes();
    if let Some(node) = nodes.iter().find(|node| body.is_reduced() && touches.binary_search(node).is_err()) {
        let message = format!(
            "node {node} of body {name:?} is inside; the body is reduced and takes forces at nodes of its contact surface alone"
        );
        return Err(InputError::new(key, message));
    }
    Ok(())
}
