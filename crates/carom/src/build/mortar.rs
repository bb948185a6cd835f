use carom_contact::Discretisation;

use super::side::NamedSide;
use crate::error::InputError;
use crate::scenario::{ContactSpec, PairEntry, Sources};

/// Whether a pair may be one of mortar contact.
pub(crate) fn has_mortar(spec: &ContactSpec) -> bool {
    let of_pairs = spec.pairs.iter().filter_map(|pair| pair.discretisation);
    of_pairs.chain([spec.discretisation]).any(|d| d == Discretisation::Mortar)
}

/// How contact between two bodies is written, which the exception `pair` may say with its index.
///
/// # Errors
/// If mortar rows are asked for and cannot be written.
pub(super) fn discretisation(
    spec: &ContactSpec,
    pair: Option<(usize, &PairEntry)>,
    sources: Option<Sources>,
    sides: &[&NamedSide],
) -> Result<Discretisation, InputError> {
    let own = pair.and_then(|(k, entry)| Some((k, entry.discretisation?)));
    let (key, discretisation) = match own {
        Some((k, own)) => (format!("contact.pairs.{k}.discretisation"), own),
        None => ("contact.discretisation".to_string(), spec.discretisation),
    };
    if discretisation == Discretisation::NodeToSegment {
        return Ok(discretisation);
    }
    let refuse = |reason: String| Err(InputError::new(key, format!("mortar: {reason}")));
    if sources == Some(Sources::Both) {
        let reason = "one side has the multipliers; choose \"finer\", \"first\" or \"second\" for sources";
        return refuse(reason.to_string());
    }
    match sides.iter().find(|side| side.is_periodic) {
        Some(side) => refuse(format!("body {:?} is periodic; choose \"node-to-segment\"", side.name)),
        None => Ok(discretisation),
    }
}
