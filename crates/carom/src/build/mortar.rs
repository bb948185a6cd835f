use carom_contact::Discretisation;

use crate::body::fe::part::ModelBody;
use crate::error::InputError;
use crate::scenario::{PairEntry, Scenario, Sources};

/// How contact between two bodies is written, which the exception `pair` may say with its index.
///
/// # Errors
/// If mortar rows are asked for and cannot be written.
pub(super) fn discretisation<const D: usize>(
    scenario: &Scenario,
    pair: Option<(usize, &PairEntry)>,
    sources: Option<Sources>,
    bodies: [&ModelBody<D>; 2],
) -> Result<Discretisation, InputError> {
    let own = pair.and_then(|(k, entry)| Some((k, entry.discretisation?)));
    let (key, discretisation) = match own {
        Some((k, own)) => (format!("contact.pairs.{k}.discretisation"), own),
        None => ("contact.discretisation".to_string(), scenario.contact.discretisation),
    };
    if discretisation == Discretisation::NodeToSegment {
        return Ok(discretisation);
    }
    let refuse = |reason: String| Err(InputError::new(key, format!("mortar: {reason}")));
    if scenario.contact.condition.is_massless() {
        let reason = "the condition \"massless\" is written for nodes; choose \"node-to-segment\" or another condition";
        return refuse(reason.to_string());
    }
    if sources == Some(Sources::Both) {
        let reason = "one side has the multipliers; choose \"finer\", \"first\" or \"second\" for sources";
        return refuse(reason.to_string());
    }
    match bodies.iter().find(|b| !b.body.mesh().ties().is_empty()) {
        Some(b) => refuse(format!("body {:?} is periodic; choose \"node-to-segment\"", b.name)),
        None => Ok(discretisation),
    }
}
