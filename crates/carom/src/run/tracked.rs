//! Points whose motion is in the history.

use carom_mesh::Vector;

use crate::Model;
use crate::error::InputError;
use crate::run::history::Track;
use crate::scenario::TrackEntry;

/// The tracked nodes of a scenario.
///
/// # Errors
/// If a point belongs to no body, or is far from its own.
pub(crate) fn tracks<const D: usize>(
    model: &Model<D>,
    entries: &[TrackEntry],
) -> Result<Vec<Track>, InputError> {
    entries.iter().enumerate().map(|(i, entry)| track(model, i, entry)).collect()
}

/// The node of a body nearest to a tracked point.
fn track<const D: usize>(model: &Model<D>, index: usize, entry: &TrackEntry) -> Result<Track, InputError> {
    let key = format!("output.track.{index}");
    let body = model.bodies.iter().find(|b| b.name == entry.body).ok_or_else(|| {
        let known: Vec<&str> = model.bodies.iter().map(|b| b.name.as_str()).collect();
        InputError::new(
            format!("{key}.body"),
            format!("there is no body {:?}; known are {known:?}", entry.body),
        )
    })?;
    if entry.point.len() != D || !entry.point.iter().all(|x| x.is_finite()) {
        return Err(InputError::new(
            format!("{key}.point"),
            format!("{:?} must be {D} finite numbers", entry.point),
        ));
    }
    let point = Vector::from_column_slice(&entry.point);
    let distance = |n: &usize| (model.assembly.reference[*n] - point).norm();
    let nearest = body.nodes().min_by(|a, b| distance(a).total_cmp(&distance(b)));
    match nearest {
        Some(node) if distance(&node) <= 0.25 * body.body.mesh().diameter() => {
            Ok(Track { name: entry.name.clone(), node })
        }
        _ => Err(InputError::new(
            format!("{key}.point"),
            format!(
                "{:?} is far from body {:?}; give a point of it in the reference configuration",
                entry.point, entry.body
            ),
        )),
    }
}
