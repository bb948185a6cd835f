//! Interference of pairs: what pushes their surfaces apart, and overlaps at the start that are taken up.

use std::collections::BTreeMap;

use carom_contact::{Candidate, ContactModel, Path, Search, Site};
use carom_mesh::Vector;

use super::overlaps::TOUCHING;
use super::signals::signal;
use super::values::number;
use crate::error::InputError;
use crate::model::Model;
use crate::model::interference::{Interference, Overlap};
use crate::scenario::{AnalysisKind, PairEntry, Scenario};

/// Clearance beyond this part of the smallest facet would hide nodes from the search, which finds them half a facet deep.
const DEEPEST: f64 = 0.25;

/// The model with the interference of its pairs.
pub(super) fn interference<const D: usize>(
    scenario: &Scenario,
    mut model: Model<D>,
) -> Result<Model<D>, InputError> {
    let until = resolved_by(scenario)?;
    let mut depths = overlaps(&model);
    let mut interferences = Vec::new();
    for (k, named) in model.assembly.named_pairs.iter().enumerate() {
        let entry = scenario.contact.entry_of(&named.between);
        let mut interference = Interference::default();
        if let Some((i, spec)) = entry.and_then(|(i, entry)| Some((i, entry.interference.as_ref()?))) {
            let key = format!("contact.pairs.{i}.interference");
            let signal = signal(&key, spec, scenario.analysis.span())?;
            interference.signal = Some(signal);
            check_clearance(&key, scenario, &model, k, &interference)?;
        }
        let own = entry.and_then(|(_, entry)| entry.resolve_overlap);
        if own.unwrap_or(scenario.contact.resolve_overlap) {
            let analysis = &scenario.analysis;
            if analysis.kind == AnalysisKind::Dynamic && analysis.starts_from_nothing() {
                let key = match (own, entry) {
                    (Some(_), Some((i, _))) => format!("contact.pairs.{i}.resolve_overlap"),
                    _ => "contact.resolve_overlap".to_string(),
                };
                let message = "overlaps are taken up in a static analysis; in a dynamic one, move the bodies apart \
                               and let `interference` grow";
                return Err(InputError::new(key, message));
            }
            let own = depths.remove(&k).unwrap_or_default();
            interference.overlap = Some(Overlap::new(own, until));
        }
        interferences.push(interference);
    }
    model = model.with_interferences(interferences);
    Ok(model)
}

/// When overlaps are taken up [s].
fn resolved_by(scenario: &Scenario) -> Result<f64, InputError> {
    let end = scenario.analysis.end_time;
    let Some(until) = scenario.contact.overlap_resolved_at else { return Ok(end) };
    let resolves = |pair: &PairEntry| pair.resolve_overlap == Some(true);
    let key = "contact.overlap_resolved_at";
    if !scenario.contact.resolve_overlap && !scenario.contact.pairs.iter().any(resolves) {
        let message = "no overlap is to be taken up; write resolve_overlap = true, or leave this out";
        return Err(InputError::new(key, message));
    }
    number(
        key,
        until,
        until > 0.0 && until <= end,
        "must be greater than 0 s and at most analysis.end_time",
    )?;
    Ok(until)
}

/// Refuses more clearance than the search for contacts sees through.
fn check_clearance<const D: usize>(
    key: &str,
    scenario: &Scenario,
    model: &Model<D>,
    named_pair: usize,
    interference: &Interference,
) -> Result<(), InputError> {
    let least = scenario.analysis.moments().map(|t| interference.least(t)).fold(0.0, f64::min);
    let deepest = DEEPEST * smallest_facet(model, named_pair);
    if -least > deepest {
        let message = format!(
            "{least}: the search for contacts sees through no more than {deepest:.3e} m, a quarter of the smallest facet; \
             give less clearance, or coarsen the mesh"
        );
        return Err(InputError::new(key, message));
    }
    Ok(())
}

/// Diameter of the smallest facet of the bodies of a named pair [m].
fn smallest_facet<const D: usize>(model: &Model<D>, named_pair: usize) -> f64 {
    let boundaries = &model.assembly.boundaries;
    let is_of = |name: &str| model.assembly.named_pairs[named_pair].between.iter().any(|other| other == name);
    let bodies = (0..model.bodies.len()).filter(|&i| is_of(&model.bodies[i].name));
    bodies.map(|i| boundaries.least_cell(i)).fold(f64::INFINITY, f64::min)
}

/// How deep every contact is inside at the start [m], by named pair.
fn overlaps<const D: usize>(model: &Model<D>) -> BTreeMap<usize, BTreeMap<(u32, Site), f64>> {
    let contact: &ContactModel<D> = &model.assembly.contact;
    let at = |n: u32| -> Vector<D> { model.assembly.reference[n as usize] };
    let mut search = Search::default();
    let (mut candidates, mut contacts): (Vec<Candidate>, _) = (Vec::new(), Vec::new());
    // A node at the corner of the other body may be beside it by round-off.
    let edges = model.bodies.iter().map(|b| b.body.mesh().smallest_edge());
    let beside = TOUCHING * edges.fold(f64::INFINITY, f64::min);
    contact.detect(&Path::resting(&at, beside), &mut search, &mut candidates);
    contact.evaluate_all(&candidates, &at, &mut search.mortar, &mut contacts);
    let mut depths: BTreeMap<usize, BTreeMap<(u32, Site), f64>> = BTreeMap::new();
    for (candidate, there) in candidates.iter().zip(&contacts) {
        if there.gap < 0.0 && !contact.is_beyond(candidate, there, beside, &at, &search) {
            let named_pair = contact.pairs[candidate.pair as usize].named_pair;
            depths.entry(named_pair).or_default().insert(candidate.key(), -there.gap);
        }
    }
    depths
}
