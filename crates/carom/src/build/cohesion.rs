//! Cohesion out of a scenario, and what holds together at the start.

use carom_contact::{Mortar, Pair, Path, Search};
use carom_mesh::Vector;

use super::values::number;
use crate::State;
use crate::error::InputError;
use crate::ledger::ByPair;
use crate::model::assembly::Assembly;
use crate::model::cohesion::{Cohesion, Cohesions, Strength};
use crate::model::state::Reaction;
use crate::scenario::{CohesionSpec, ContactSpec, PairEntry, Scenario};

/// Contacts with gaps up to this at the start, in sizes of the smaller body, are closed and hold.
pub(crate) const CLOSED: f64 = 1e-9;

/// What a pair has by its entry or, without one, all: none if it does not hold, with its key.
pub(super) fn of_pair<'a>(
    spec: &'a ContactSpec,
    found: Option<(usize, &'a PairEntry)>,
) -> Option<(String, &'a CohesionSpec)> {
    let own =
        found.and_then(|(k, entry)| Some((format!("contact.pairs.{k}.cohesion"), entry.cohesion.as_ref()?)));
    let usual = || spec.cohesion.as_ref().map(|cohesion| ("contact.cohesion".to_string(), cohesion));
    own.or_else(usual).filter(|(_, cohesion)| {
        let full = cohesion.full();
        full.unbreakable || full.stress.or(full.force) != Some(0.0)
    })
}

/// Whether some pair of the body holds.
pub(super) fn holds(scenario: &Scenario, name: &str) -> bool {
    let spec = &scenario.contact;
    let of_pairs = spec.pairs.iter().enumerate().filter(|(_, pair)| pair.between.iter().any(|n| n == name));
    let mut own = of_pairs.map(|found| of_pair(spec, Some(found)));
    of_pair(spec, None).is_some() || own.any(|cohesion| cohesion.is_some())
}

/// The first cohesion of a contact, by its key.
pub(crate) fn first_cohesion(spec: &ContactSpec) -> Option<String> {
    let pairs = spec.pairs.iter().enumerate().map(Some);
    std::iter::once(None).chain(pairs).find_map(|found| of_pair(spec, found)).map(|(key, _)| key)
}

fn cohesion(key: &str, spec: &CohesionSpec) -> Result<Option<Cohesion>, InputError> {
    let full = spec.full();
    let given = [("stress", full.stress), ("force", full.force)];
    for (name, value) in given {
        let Some(value) = value else { continue };
        let key =
            if matches!(spec, CohesionSpec::Stress(_)) { key.to_string() } else { format!("{key}.{name}") };
        number(&key, value, value >= 0.0, "must not be negative")?;
    }
    let strength = match (full.stress, full.force, full.unbreakable) {
        (Some(stress), None, false) => Strength::Stress(stress),
        (None, Some(force), false) => Strength::Force(force),
        (None, None, true) if !full.lasting => Strength::Unbreakable,
        (None, None, true) => {
            let message = "what nothing breaks holds from the start on; leave one of \"lasting\" and \"unbreakable\" out";
            return Err(InputError::new(format!("{key}.lasting"), message));
        }
        _ => {
            let message = "surfaces hold by a stress, by a force of every contact, or unbreakably; give one of \"stress\", \"force\" and \"unbreakable\"";
            return Err(InputError::new(key, message));
        }
    };
    Ok(Some(Cohesion { strength, lasting: full.lasting })
        .filter(|c| !matches!(c.strength, Strength::Stress(0.0) | Strength::Force(0.0))))
}

/// The cohesion of all pairs.
///
/// # Errors
/// If a value is out of range.
pub(super) fn cohesions<const D: usize>(
    spec: &ContactSpec,
    assembly: &Assembly<D>,
) -> Result<Cohesions, InputError> {
    let given = |key: &str, spec: Option<&CohesionSpec>| spec.map_or(Ok(None), |spec| cohesion(key, spec));
    let default = given("contact.cohesion", spec.cohesion.as_ref())?;
    let mut own = ByPair::default();
    for (k, entry) in spec.pairs.iter().enumerate() {
        let key = format!("contact.pairs.{k}.cohesion");
        let own_cohesion = given(&key, entry.cohesion.as_ref())?;
        let [a, b] = &entry.between;
        if a == b && own_cohesion.is_some() {
            return Err(InputError::new(key, format!("{a:?} does not hold on to itself; leave it out")));
        }
        if let (Some(_), Some(between)) = (&entry.cohesion, assembly.between(&entry.between)) {
            own.insert(between, own_cohesion);
        }
    }
    Ok(Cohesions { default, own })
}

/// Lets the contacts hold that are closed at the start, as reactions of the state that are zero.
pub(crate) fn bond<const D: usize>(assembly: &Assembly<D>, state: &mut State<D>) {
    state.reactions.clear();
    if assembly.cohesions.are_none() {
        return;
    }
    let at = |n: u32| assembly.reference[n as usize] + state.displacement[n as usize];
    let path = Path::resting(&at, CLOSED * assembly.size);
    let (mut search, mut mortar, mut found) = (Search::default(), Mortar::default(), Vec::new());
    let holds = |pair: &Pair| assembly.cohesions.of(pair).is_some();
    assembly.contact.detect_node_by_node(holds, &path, &mut search, &mut found);
    assembly.contact.detect_mortar(&path, &mut mortar, &mut found);
    let mut contacts = Vec::new();
    assembly.contact.evaluate_all(&found, &at, &mut mortar, &mut contacts);
    let closed = found.into_iter().zip(contacts).filter(|(candidate, contact)| {
        let pair = assembly.contact.pairs.get(candidate.pair as usize);
        !candidate.redundant && contact.gap <= CLOSED * assembly.pair_size(&pair)
    });
    state.reactions.extend(closed.filter_map(|(candidate, contact)| {
        let adhesion = assembly.adhesion(candidate.key(), &contact, &at)?;
        Some(Reaction {
            pair: candidate.pair,
            site: candidate.site,
            facet: candidate.facet,
            contact,
            force: Vector::zeros(),
            adhesion: Some(adhesion),
        })
    }));
}
