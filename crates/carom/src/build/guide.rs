//! What drives rigid bodies: guides and resultants.

use carom_mesh::Vector;

use super::signals::{signal, signals, starting_from_none};
use super::support_name::support_name;
use super::values::vector;
use crate::body::fe::part::ModelBody;
use crate::body::rigid::guide::Resultant;
use crate::body::rigid::shape::RigidShape;
use crate::error::InputError;
use crate::scenario::{Axis, MomentSpec, MotionEntry, MotionSpec};
use crate::{Motion, Signal, SignalSpec};

/// When a motion is asked for, and in a model of which size.
pub(super) struct Course {
    /// Start and end of the analysis [s].
    pub span: [f64; 2],
    /// Diameter of the largest body [m].
    pub size: f64,
}

/// How the rigid body `index` is guided by the motion under `key`.
pub(super) fn guided<const D: usize>(
    key: &str,
    entry: &MotionEntry,
    (index, shape): (usize, &RigidShape<D>),
    before: &[Motion<D>],
    course: &Course,
) -> Result<Motion<D>, InputError> {
    let MotionSpec::Guided { x, y, z, turn_x, turn_y, turn_z } = &entry.motion else {
        let message = format!("body {:?} is rigid: its nodes move as one; choose \"guided\"", entry.body);
        return Err(InputError::new(format!("{key}.kind"), message));
    };
    if let Some(k) = before.iter().position(|motion| motion.body == index) {
        let message = format!("body {:?} is guided by motions.{k} already; give both in one", entry.body);
        return Err(InputError::new(format!("{key}.body"), message));
    }
    let since = entry.since;
    let mut components: [Option<Signal>; D] = std::array::from_fn(|_| None);
    for (i, spec) in [x, y, z].into_iter().enumerate() {
        let Some(spec) = spec else { continue };
        let key = format!("{key}.{}", Axis::NAMES[i]);
        let place = components
            .get_mut(i)
            .ok_or_else(|| InputError::new(&key, format!("there are {D} dimensions; leave it out")))?;
        *place = Some(starting_from_none(&key, spec, course.span, since, course.size)?);
    }
    let mut turns = [None, None, None];
    for (i, spec) in [turn_x, turn_y, turn_z].into_iter().enumerate() {
        let Some(spec) = spec else { continue };
        let key = format!("{key}.turn_{}", Axis::NAMES[i]);
        if D == 2 && i < 2 {
            return Err(InputError::new(key, "a body of the plane turns about z; leave it out"));
        }
        turns[i] = Some(starting_from_none(&key, spec, course.span, since, 1.0)?);
    }
    if components.iter().chain(&turns).all(Option::is_none) {
        let message = "give one of x, y, z, turn_x, turn_y, turn_z at least; those left out are free";
        return Err(InputError::new(key, message));
    }
    let is_bound = |i: usize| {
        let [along, about] = [shape.moves_along[i], shape.turns_about[i]];
        !along && components.get(i).is_some_and(Option::is_some) || !about && turns[i].is_some()
    };
    if let Some(i) = (0..3).find(|&i| is_bound(i)) {
        let message = format!(
            "body {:?} is one of revolution and moves along y alone, not along or about {}; leave it out",
            entry.body,
            Axis::NAMES[i]
        );
        return Err(InputError::new(key, message));
    }
    let name = support_name(before, &entry.body, "");
    Ok(Motion { name, body: index, nodes: Vec::new(), components, turns, since })
}

/// The force and the moment, under `key`, on the body `name`, at a point.
pub(super) fn resultant<const D: usize>(
    key: &str,
    body: &ModelBody<D>,
    name: &str,
    (force, moment, point): (Option<&[SignalSpec]>, Option<&MomentSpec>, Option<&[f64]>),
    span: [f64; 2],
) -> Result<Resultant, InputError> {
    let Some(rigid) = &body.rigid else {
        let message = format!(
            "a resultant acts on a rigid body, and {name:?} deforms; choose force, traction or pressure"
        );
        return Err(InputError::new(format!("{key}.kind"), message));
    };
    if force.is_none() && moment.is_none() {
        return Err(InputError::new(key, "give a force or a moment"));
    }
    let mut resultant =
        Resultant { force: [None, None, None], moment: [None, None, None], arm: Vector::zeros() };
    if let Some(force) = force {
        let force: [Signal; D] = signals(&format!("{key}.force"), force, span)?;
        resultant.force.iter_mut().zip(force).for_each(|(place, signal)| *place = Some(signal));
    }
    let moment_key = format!("{key}.moment");
    match (moment, D) {
        (None, _) => {}
        (Some(MomentSpec::InPlane(spec)), 2) => resultant.moment[2] = Some(signal(&moment_key, spec, span)?),
        (Some(MomentSpec::InSpace(specs)), 3) => {
            resultant.moment = signals::<3>(&moment_key, specs, span)?.map(Some);
        }
        _ => {
            let form = ["a number or a function of time", "a list of 3"][D - 2];
            return Err(InputError::new(moment_key, format!("a moment in {D}D is {form}")));
        }
    }
    if let Some(point) = point {
        let point: Vector<D> = vector(&format!("{key}.point"), point)?;
        resultant.arm = rigid.shape.arm_of(&point);
    }
    Ok(resultant)
}
