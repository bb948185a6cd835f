use carom_contact::{Candidate, Pair, Path, Penetration, RigidShape, Search, Solid, Target};
use carom_mesh::Vector;

use super::values::place;
use crate::body::fe::part::ModelBody;
use crate::error::InputError;
use crate::model::Model;
use crate::model::assembly::Assembly;
use crate::model::interference::Interference;
use crate::model::method::Method;
use crate::scenario::{AnalysisKind, Scenario};

/// Overlaps at the start deeper than this, relative to the smallest edge, are an error.
pub(super) const TOUCHING: f64 = 1e-9;

/// Refuses bodies that overlap one another or an obstacle before anything has moved by more than the interference of their pair lets them, and
/// themselves by more than a run by this `method` may have them.
pub(super) fn check_overlaps<const D: usize>(
    scenario: &Scenario,
    model: &Model<D>,
    method: &Method<D>,
) -> Result<(), InputError> {
    let at = |n: u32| model.assembly.reference[n as usize];
    let is_other = |pair: &Pair| pair.target != Target::Surface(pair.source);
    let mut extents = model.assembly.contact.extents(&at);
    for (i, body) in model.bodies.iter().enumerate() {
        extents.include(i, body.body.mesh().nodes().iter().copied());
    }
    let Assembly { contact, interferences, .. } = &model.assembly;
    let pushed_apart = interferences.all().map(|interference| interference.least(0.0)).fold(0.0, f64::max);
    let mut near = Vec::new();
    contact.within(pushed_apart, &extents, &mut near);
    for pair in near.into_iter().map(|p| contact.pairs.get(p)).filter(is_other) {
        let least = least_gap(scenario, model, &pair);
        if contact.at_least(&pair, &extents, &at) > least {
            continue;
        }
        let cure = cure(scenario, interferences.of(pair.between()));
        // Both directions are checked, whichever the contact condition uses.
        let mut directions = vec![pair];
        if let Target::Surface(b) = pair.target {
            directions.push(Pair { source: b, target: Target::Surface(pair.source), ..pair });
        }
        for direction in directions {
            let of_mesh = || contact.closest(sample(&model.bodies[direction.source]), direction.target, &at);
            let Some(closest) = contact.round_proximity(&direction, &at).or_else(of_mesh) else { continue };
            let source = &model.bodies[direction.source];
            let touching = TOUCHING * source.body.mesh().smallest_edge();
            if closest.gap >= least - touching {
                continue;
            }
            if closest.gap >= -touching {
                return Err(is_pushed(scenario, model, pair.between(), closest.gap, least));
            }
            let [a, b] = model.assembly.names(pair.between());
            let place = place(&closest.at);
            let index = direction.source;
            return Err(match direction.target {
                Target::Surface(_) => InputError::new(
                    format!("bodies.{index}.mesh"),
                    format!(
                        "bodies {a:?} and {b:?} overlap at the start: {:?} at {place} is {:.6} m inside; \
                         move one of them{cure}",
                        source.name, -closest.gap
                    ),
                ),
                Target::Obstacle(o) => {
                    let obstacle = &model.assembly.contact.obstacles[o];
                    let outside =
                        source.nodes().all(|n| obstacle.gap(&model.assembly.reference[n], &at).0 < 0.0);
                    let cure = if outside { "" } else { cure };
                    let fact = if outside { "lies outside, behind" } else { "overlaps" };
                    let free = match obstacle.shape {
                        RigidShape::Plane { .. } => "turn the normal of",
                        RigidShape::Sphere { .. } | RigidShape::Cylinder { .. } => {
                            "set or leave out `cavity` of"
                        }
                        RigidShape::Box { .. } | RigidShape::Surface(_) => "move",
                    };
                    InputError::new(
                        format!("bodies.{index}.mesh"),
                        format!(
                            "body {a:?} {fact} obstacle {b:?} at the start: near {place} it is {:.6} m behind that; \
                             move the body or {free} obstacles.{} ({:?}){cure}",
                            -closest.gap, o, scenario.obstacles[o].name
                        ),
                    )
                }
            });
        }
    }
    check_corners(scenario, model)?;
    check_crossings(scenario, model)?;
    check_selves(model, method)
}

/// What else may be done about an overlap.
fn cure(scenario: &Scenario, interference: &Interference) -> &'static str {
    match scenario.analysis.kind {
        AnalysisKind::Static if interference.overlap.is_none() => {
            ", or let the analysis take the overlap up by contact.resolve_overlap = true"
        }
        // A contact sees half a facet deep.
        AnalysisKind::Static => "; contact takes up no more than half a facet",
        AnalysisKind::Dynamic => "",
    }
}

/// The least gap that a pair may start with [m].
///
/// A static analysis pushes apart in its first step what overlaps only by the arcs that facets stand for: surfaces that are modelled line to line
/// because interference or growth is to press them on one another need not have matching meshes. A dynamic one has to start from surfaces that
/// do not press yet.
fn least_gap<const D: usize>(scenario: &Scenario, model: &Model<D>, pair: &Pair) -> f64 {
    let interference = model.assembly.interferences.of(pair.between());
    let least = interference.least(0.0);
    if scenario.analysis.kind == AnalysisKind::Dynamic {
        return least;
    }
    let boundaries = &model.assembly.boundaries;
    let target = match pair.target {
        Target::Surface(target) => boundaries.largest_arc(target),
        Target::Obstacle(_) => 0.0,
    };
    let arcs = boundaries.largest_arc(pair.source) + target;
    let grows = |body: usize| model.bodies[body].growth.is_some();
    let is_meant = *interference != Interference::default()
        || grows(pair.source)
        || matches!(pair.target, Target::Surface(target) if grows(target));
    least.min(0.0) - if is_meant { arcs } else { 0.0 }
}

/// Why a dynamic analysis cannot start from surfaces that are nearer than their interference.
fn is_pushed<const D: usize>(
    scenario: &Scenario,
    model: &Model<D>,
    between: [Solid; 2],
    gap: f64,
    least: f64,
) -> InputError {
    let between = model.assembly.names(between);
    let key = match scenario.contact.entry_of(&between) {
        Some((k, _)) => format!("contact.pairs.{k}.interference"),
        None => "contact.pairs".to_string(),
    };
    let [a, b] = between;
    let message = format!(
        "{a:?} and {b:?} are {:.3e} m apart at the start, where it pushes them {least:.3e} m apart at once; \
         let it grow with time, as \"{least:e}*min(t/1e-3, 1)\" does",
        gap.abs()
    );
    InputError::new(key, message)
}

/// Refuses bodies that corners and edges of obstacles are inside of, or round obstacles between nodes, where no node need be inside.
fn check_corners<const D: usize>(scenario: &Scenario, model: &Model<D>) -> Result<(), InputError> {
    let assembly = &model.assembly;
    let obstacles = &assembly.contact.obstacles;
    let at = |n: u32| assembly.reference[n as usize];
    let counts = |between: [Solid; 2]| match between {
        [Solid::Body(_), Solid::Obstacle(o)] | [Solid::Obstacle(o), Solid::Body(_)] => {
            obstacles[o].touches_between_nodes() && assembly.must_not_overlap(between)
        }
        _ => false,
    };
    let mut refused = None;
    assembly.boundaries.clone().measure(obstacles, counts, &at, |Penetration { depth, at, between, arcs, .. }| {
        let [Solid::Body(i), Solid::Obstacle(o)] = between else { return };
        let body = &model.bodies[i];
        // What is round bulges into small facets, and facets are in front of the round sides that they stand for.
        let arcs = if obstacles[o].has_corners() { 0.0 } else { arcs };
        let depth_beyond = depth - assembly.clearance(between, 0.0) - arcs;
        if depth_beyond > TOUCHING * body.body.mesh().smallest_edge() {
            let cure = cure(scenario, assembly.interferences.of(between));
            refused.get_or_insert_with(|| {
                InputError::new(
                    format!("bodies.{i}.mesh"),
                    format!(
                        "obstacle {:?} overlaps body {:?} at the start: near {} it is {depth:.6} m inside; move one of them{cure}",
                        scenario.obstacles[o].name,
                        body.name,
                        place(&at),
                    ),
                )
            });
        }
    });
    refused.map_or(Ok(()), Err)
}

/// Refuses bodies of which edges have passed one another, though no node of one may be inside the other.
fn check_crossings<const D: usize>(scenario: &Scenario, model: &Model<D>) -> Result<(), InputError> {
    let at = |n: u32| model.assembly.reference[n as usize];
    let (mut search, mut candidates) = (Search::default(), Vec::new());
    model.assembly.contact.detect(&Path::resting(&at, 0.0), &mut search, &mut candidates);
    for candidate in candidates.iter().filter(|c| has_straight_edges(model, c)) {
        let pair = model.assembly.contact.pairs.get(candidate.pair as usize);
        let smallest_edge = model.bodies[pair.source].body.mesh().smallest_edge();
        let contact = model.assembly.contact.evaluate(candidate, &at);
        let touching = TOUCHING * smallest_edge;
        let least = least_gap(scenario, model, &pair).min(0.0);
        if contact.gap >= least - touching
            || model.assembly.contact.is_beyond(candidate, &contact, touching, &at, &search)
        {
            continue;
        }
        let [a, b] = model.assembly.names(pair.between());
        return Err(InputError::new(
            format!("bodies.{}.mesh", pair.source),
            format!(
                "edges of {a:?} and {b:?} are {:.6} m through one another at the start, near {}; move one of them{}",
                -contact.gap,
                place(&contact.source_point(&at)),
                cure(scenario, model.assembly.interferences.of(pair.between()))
            ),
        ));
    }
    Ok(())
}

/// Refuses meshes that lie over themselves.
fn check_selves<const D: usize>(model: &Model<D>, method: &Method<D>) -> Result<(), InputError> {
    let Assembly { boundaries, contact, reference, .. } = &model.assembly;
    let at = |n: u32| reference[n as usize];
    let mut refused = None;
    boundaries.clone().measure(&contact.obstacles, |[a, b]| a == b, &at, |found| {
        let Penetration { depth, cell, arcs, between: [Solid::Body(i), _], at } = found else { return };
        if depth > method.allowed_penetration(cell, arcs, 0.0) {
            refused.get_or_insert_with(|| {
                let (name, place) = (&model.bodies[i].name, place(&at));
                let message = format!(
                    "the mesh of {name:?} lies over itself: near {place} it is {depth:.3e} m inside itself; join what is \
                     one there by common nodes, or make bodies of its parts"
                );
                InputError::new(format!("bodies.{i}.mesh"), message)
            });
        }
    });
    refused.map_or(Ok(()), Err)
}

/// Whether a candidate is of the edges of two bodies, and these are where they seem to be: those of quadratic cells are curved.
fn has_straight_edges<const D: usize>(model: &Model<D>, candidate: &Candidate) -> bool {
    let contact = &model.assembly.contact;
    let is_straight = |s: usize| !contact.surfaces[s].facets.iter().any(|f| f.kind.is_quadratic());
    let pair = contact.pairs.get(candidate.pair as usize);
    match pair.target {
        Target::Surface(t) => {
            candidate.node().is_none() && t != pair.source && is_straight(pair.source) && is_straight(t)
        }
        // The measure has seen them.
        Target::Obstacle(_) => false,
    }
}

/// Nodes, centres of facets and centres of cells of a body. Bars of equal height pushed into one another have all their
/// nodes on sides of the other; identical bodies in the same place have their facets there too.
fn sample<const D: usize>(body: &ModelBody<D>) -> impl Iterator<Item = Vector<D>> {
    let mesh = body.body.mesh();
    let centre = |nodes: &[u32]| {
        nodes.iter().map(|&n| mesh.nodes()[n as usize]).sum::<Vector<D>>() / nodes.len() as f64
    };
    let surface = body.body.surface();
    let nodes = surface.nodes().iter().map(|&n| mesh.nodes()[n as usize]);
    let facets = surface.facets().iter().map(move |f| centre(&f.nodes));
    let cells = mesh.blocks().iter().flat_map(move |b| b.cells().map(centre));
    nodes.chain(facets).chain(cells)
}
