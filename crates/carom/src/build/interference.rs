//! Interference of pairs: what pushes their surfaces apart, and overlaps at the start that are taken up.

use std::collections::BTreeMap;

use carom_contact::{Candidate, ContactModel, Path, Search, Site, Solid};
use carom_mesh::Vector;

use super::overlaps::TOUCHING;
use super::signals::signal;
use super::values::number;
use crate::error::InputError;
use crate::model::Model;
use crate::model::interference::{Interference, Interferences, Overlap};
use crate::scenario::{AnalysisKind, PairEntry, Scenario};

/// Clearance beyond this part of the smallest facet would hide nodes from the search, which finds them half a facet deep.
const DEEPEST: f64 = 0.25;

/// The model with the interference of its pairs.
pub(super) fn interference<const D: usize>(
    scenario: &Scenario,
    model: Model<D>,
) -> Result<Model<D>, InputError> {
    let until = resolved_by(scenario)?;
    let mut depths = overlaps(&model);
    let mut all = Interferences::default();
    for (i, entry) in scenario.contact.pairs.iter().enumerate() {
        let Some(between) = model.assembly.between(&entry.between) else { continue };
        if scenario.contact.entry_of(&entry.between).is_none_or(|(first, _)| first != i) {
            continue;
        }
        let mut interference = Interference::default();
        if let Some(spec) = &entry.interference {
            let key = format!("contact.pairs.{i}.interference");
            let signal = signal(&key, spec, scenario.analysis.span())?;
            interference.signal = Some(signal);
            check_clearance(&key, scenario, &model, between, &interference)?;
        }
        if entry.resolve_overlap.unwrap_or(scenario.contact.resolve_overlap) {
            if entry.resolve_overlap.is_some() {
                check_resolves(scenario, format!("contact.pairs.{i}.resolve_overlap"))?;
            }
            let own = depths.remove(&between).unwrap_or_default();
            interference.overlap = Some(Overlap::new(own, until));
        }
        depths.remove(&between);
        all.own.insert(between, interference);
    }
    if scenario.contact.resolve_overlap {
        check_resolves(scenario, "contact.resolve_overlap".to_string())?;
        all.default.overlap = Some(Overlap::new(BTreeMap::new(), until));
        for (between, own) in depths {
            let overlap = Some(Overlap::new(own, until));
            all.own.insert(between, Interference { overlap, ..Interference::default() });
        }
    }
    Ok(model.with_interferences(all))
}

/// Refuses overlaps that nobody can take up.
fn check_resolves(scenario: &Scenario, key: String) -> Result<(), InputError> {
    let analysis = &scenario.analysis;
    if analysis.kind == AnalysisKind::Dynamic && analysis.starts_from_nothing() {
        let message = "overlaps are taken up in a static analysis; in a dynamic one, move the bodies apart \
                       and let `interference` grow";
        return Err(InputError::new(key, message));
    }
    Ok(())
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
    between: [Solid; 2],
    interference: &Interference,
) -> Result<(), InputError> {
    let least = scenario.analysis.moments().map(|t| interference.least(t)).fold(0.0, f64::min);
    let deepest = DEEPEST * smallest_facet(model, between);
    if -least > deepest {
        let message = format!(
            "{least}: the search for contacts sees through no more than {deepest:.3e} m, a quarter of the smallest facet; \
             give less clearance, or coarsen the mesh"
        );
        return Err(InputError::new(key, message));
    }
    Ok(())
}

/// Diameter of the smallest facet of the bodies of a pair [m].
fn smallest_facet<const D: usize>(model: &Model<D>, between: [Solid; 2]) -> f64 {
    let least = between.map(|solid| match solid {
        Solid::Body(i) => model.assembly.boundaries.least_cell(i),
        Solid::Obstacle(_) => f64::INFINITY,
    });
    least[0].min(least[1])
}

/// How deep every contact is inside at the start [m], by pair of solids.
fn overlaps<const D: usize>(model: &Model<D>) -> BTreeMap<[Solid; 2], BTreeMap<(u32, Site), f64>> {
    let contact: &ContactModel<D> = &model.assembly.contact;
    let at = |n: u32| -> Vector<D> { model.assembly.reference[n as usize] };
    let mut search = Search::default();
    let (mut candidates, mut contacts): (Vec<Candidate>, _) = (Vec::new(), Vec::new());
    // A node at the corner of the other body may be beside it by round-off.
    let edges = model.bodies.iter().map(|b| b.body.mesh().smallest_edge());
    let beside = TOUCHING * edges.fold(f64::INFINITY, f64::min);
    contact.detect(&Path::resting(&at, beside), &mut search, &mut candidates);
    contact.evaluate_all(&candidates, &at, &mut search.mortar, &mut contacts);
    let mut depths: BTreeMap<[Solid; 2], BTreeMap<(u32, Site), f64>> = BTreeMap::new();
    for (candidate, there) in candidates.iter().zip(&contacts) {
        if there.gap < 0.0 && !contact.is_beyond(candidate, there, beside, &at, &search) {
            let between = contact.pairs.get(candidate.pair as usize).between();
            depths.entry(between).or_default().insert(candidate.key(), -there.gap);
        }
    }
    depths
}
