//! Loads, supports and moving obstacles of a scenario.

use carom_mesh::{Facet, Surface};

use super::foreign::refuse_foreign;
use super::guide::{Course, guided, resultant};
use super::signals::{signal, signals, starting_from_none};
use super::support_name::support_name;
use super::values::vector;
use crate::body::fe::part::ModelBody;
use crate::error::InputError;
use crate::model::Model;
use crate::scenario::{Axis, Displacement, LoadSpec, MotionSpec, ObstacleEntry, Scenario};
use crate::{Load, Motion, ObstacleMotion, Signal};

/// The model with everything that drives it.
pub(super) fn drive<const D: usize>(scenario: &Scenario, model: Model<D>) -> Result<Model<D>, InputError> {
    let span = scenario.analysis.span();
    let mut motions: Vec<Motion<D>> = Vec::new();
    for (k, entry) in scenario.motions.iter().enumerate() {
        let key = format!("motions.{k}");
        let (index, body) = find_body(&model, &key, &entry.body)?;
        if let Some(rigid) = &body.rigid {
            let course = Course { span, size: model.assembly.size };
            motions.push(guided(&key, entry, (index, &rigid.shape), &motions, &course)?);
            continue;
        }
        refuse_reduced(&format!("{key}.body"), body)?;
        refuse_foreign(&format!("{key}.body"), body)?;
        if matches!(entry.motion, MotionSpec::Guided { .. }) {
            let message =
                format!("body {:?} deforms and is guided by none; choose \"prescribed\"", entry.body);
            return Err(InputError::new(format!("{key}.kind"), message));
        }
        let nodes = body.body.mesh().nodes_of(&entry.on).ok_or_else(|| {
            let known = body.body.mesh().sets().names();
            let message =
                format!("{:?}: body {:?} has no such set; known are {known:?}", entry.on, entry.body);
            InputError::new(format!("{key}.on"), message)
        })?;
        let components = match &entry.motion {
            MotionSpec::Fixed { components } => fixed(&key, components.as_deref())?,
            MotionSpec::Guided { .. } => continue,
            MotionSpec::Prescribed(d) => displacement(&key, d, span, entry.since, model.assembly.size)?,
        };
        let name = support_name(&motions, &entry.body, &entry.on);
        let turns = [None, None, None];
        let motion = Motion { name, body: index, nodes, components, turns, since: entry.since };
        refuse_contradictions(&key, &motions, &motion, model.bodies[index].body.mesh().masters().as_slice())?;
        motions.push(motion);
    }
    let mut obstacle_motions = Vec::new();
    for (k, entry) in scenario.obstacles.iter().enumerate() {
        obstacle_motions.push(obstacle_motion(&format!("obstacles.{k}"), entry, span, model.assembly.size)?);
    }
    let mut model = model.with_motions(motions).with_obstacle_motions(obstacle_motions);
    for (k, entry) in scenario.loads.iter().enumerate() {
        let key = format!("loads.{k}");
        let (index, body) = find_body(&model, &key, &entry.body)?;
        refuse_reduced(&format!("{key}.body"), body)?;
        refuse_foreign(&format!("{key}.body"), body)?;
        let load = match &entry.load {
            LoadSpec::Resultant { force, moment, point } => {
                let resultant = resultant(
                    &key,
                    body,
                    &entry.body,
                    (force.as_deref(), moment.as_ref(), point.as_deref()),
                    span,
                )?;
                model = model.with_resultant(index, resultant);
                continue;
            }
            LoadSpec::Force { force } => {
                let nodes = body.body.mesh().nodes_of(&entry.on).ok_or_else(|| {
                    let known = body.body.mesh().sets().names();
                    let message =
                        format!("{:?}: body {:?} has no such set; known are {known:?}", entry.on, entry.body);
                    InputError::new(format!("{key}.on"), message)
                })?;
                Load::nodal_force(&nodes, signals(&format!("{key}.force"), force, span)?)
            }
            LoadSpec::Traction { traction } => {
                let traction = signals(&format!("{key}.traction"), traction, span)?;
                Load::traction(&body.body, facets(&key, body, &entry.on)?, traction)
            }
            LoadSpec::Pressure { pressure, follower } => {
                let pressure = signal(&format!("{key}.pressure"), pressure, span)?;
                let facets = facets(&key, body, &entry.on)?;
                if *follower {
                    Load::follower_pressure(&body.body, facets, pressure)
                } else {
                    Load::dead_pressure(&body.body, facets, pressure)
                }
            }
        };
        model = model.with_load(index, load);
    }
    Ok(model)
}

fn find_body<'a, const D: usize>(
    model: &'a Model<D>,
    key: &str,
    name: &str,
) -> Result<(usize, &'a ModelBody<D>), InputError> {
    let bodies = model.bodies.iter().map(|b| &**b);
    bodies.enumerate().find(|(_, b)| b.name == name).ok_or_else(|| {
        let known: Vec<&str> = model.bodies.iter().map(|b| b.name.as_str()).collect();
        InputError::new(format!("{key}.body"), format!("there is no body {name:?}; known are {known:?}"))
    })
}

/// Refuses to drive a reduced body: gravity and contacts are all that acts on it.
fn refuse_reduced<const D: usize>(key: &str, body: &ModelBody<D>) -> Result<(), InputError> {
    if !body.is_reduced() {
        return Ok(());
    }
    let message = format!(
        "body {:?} is reduced and free: only gravity and contacts act on it; leave it deformable to hold or load it",
        body.name
    );
    Err(InputError::new(key, message))
}

/// The facets of a set on the boundary of a body.
fn facets<const D: usize>(key: &str, body: &ModelBody<D>, on: &str) -> Result<Vec<Facet>, InputError> {
    let mesh = body.body.mesh();
    let key = format!("{key}.on");
    let part = mesh.surface_of(on, &Surface::of(mesh)).ok_or_else(|| {
        let known = mesh.sets().facet_names();
        let message = format!("{on:?}: body {:?} has no such set of facets; known are {known:?}", body.name);
        InputError::new(&key, message)
    })?;
    if part.facets().is_empty() {
        return Err(InputError::new(&key, format!("{on:?}: no facet of this set is on the boundary")));
    }
    Ok(part.facets().to_vec())
}

/// Zero for the components that are named, or for all.
fn fixed<const D: usize>(key: &str, components: Option<&[Axis]>) -> Result<[Option<Signal>; D], InputError> {
    let zero = || Some(Signal::Constant(0.0));
    let Some(named) = components else { return Ok(std::array::from_fn(|_| zero())) };
    let mut signals = std::array::from_fn(|_| None);
    for axis in named.iter().map(|&a| a as usize) {
        let signal = signals.get_mut(axis).ok_or_else(|| {
            let message = format!("{:?}: there are {D} dimensions", Axis::NAMES[axis]);
            InputError::new(format!("{key}.components"), message)
        })?;
        *signal = zero();
    }
    Ok(signals)
}

/// The displacement under `key`, which starts from zero at the time `since` [s] in a model of this `size` [m].
fn displacement<const D: usize>(
    key: &str,
    spec: &Displacement,
    span: [f64; 2],
    since: f64,
    size: f64,
) -> Result<[Option<Signal>; D], InputError> {
    let mut signals = std::array::from_fn(|_| None);
    for (i, spec) in [&spec.x, &spec.y, &spec.z].into_iter().enumerate() {
        let Some(spec) = spec else { continue };
        let key = format!("{key}.{}", Axis::NAMES[i]);
        let place = signals
            .get_mut(i)
            .ok_or_else(|| InputError::new(&key, format!("there are {D} dimensions; leave it out")))?;
        *place = Some(starting_from_none(&key, spec, span, since, size)?);
    }
    if signals.iter().all(Option::is_none) {
        return Err(InputError::new(key, "give one of x, y, z at least; those left out are free"));
    }
    Ok(signals)
}

/// Refuses a motion that prescribes something else for what another one prescribes already.
fn refuse_contradictions<const D: usize>(
    key: &str,
    before: &[Motion<D>],
    motion: &Motion<D>,
    masters: &[u32],
) -> Result<(), InputError> {
    for (k, other) in before.iter().enumerate().filter(|(_, m)| m.body == motion.body) {
        let clash = (0..D).find(|&i| match (&motion.components[i], &other.components[i]) {
            (Some(a), Some(b)) => a != b || (motion.since != other.since && !a.is_zero()),
            _ => false,
        });
        let Some(component) = clash else { continue };
        let shared = |n: &&u32| other.nodes.iter().any(|m| masters[*m as usize] == masters[**n as usize]);
        if let Some(node) = motion.nodes.iter().find(shared) {
            let message = format!(
                "node {node} is in {:?} of motions.{k} too, which moves it along {} differently; \
                 leave that component out of one of them",
                other.name,
                Axis::NAMES[component]
            );
            return Err(InputError::new(format!("{key}.on"), message));
        }
    }
    Ok(())
}

/// How the obstacle under `key` moves.
pub(crate) fn obstacle_motion<const D: usize>(
    key: &str,
    entry: &ObstacleEntry,
    span: [f64; 2],
    size: f64,
) -> Result<ObstacleMotion<D>, InputError> {
    match (&entry.velocity, &entry.motion) {
        (Some(_), Some(_)) => {
            let message = "an obstacle has a velocity or a motion, not both; leave one out";
            Err(InputError::new(format!("{key}.motion"), message))
        }
        (Some(v), None) => vector(&format!("{key}.velocity"), v).map(ObstacleMotion::Velocity),
        (None, Some(motion)) => {
            let signals = displacement::<D>(&format!("{key}.motion"), motion, span, 0.0, size)?;
            let still = || Signal::Constant(0.0);
            Ok(ObstacleMotion::Displacement(Box::new(signals.map(|s| s.unwrap_or_else(still)))))
        }
        (None, None) => Ok(ObstacleMotion::Velocity(carom_mesh::Vector::zeros())),
    }
}
