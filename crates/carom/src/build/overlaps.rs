use carom_contact::{Candidate, Pair, Penetration, RigidShape, Search, Solid, Target};
use carom_mesh::Vector;

use super::values::place;
use crate::body::fe::part::ModelBody;
use crate::error::InputError;
use crate::model::Model;
use crate::scenario::Scenario;

/// Overlaps at the start deeper than this, relative to the smallest edge, are an error.
const TOUCHING: f64 = 1e-9;

/// Refuses bodies that overlap one another or an obstacle before anything has moved.
pub(super) fn check_overlaps<const D: usize>(
    scenario: &Scenario,
    model: &Model<D>,
) -> Result<(), InputError> {
    let at = |n: u32| model.assembly.reference[n as usize];
    let is_other = |pair: &&Pair| pair.target != Target::Surface(pair.source);
    for pair in model.assembly.contact.pairs.iter().filter(is_other) {
        // Both directions are checked, whichever the contact condition uses.
        let mut directions = vec![*pair];
        if let Target::Surface(b) = pair.target {
            directions.push(Pair { source: b, target: Target::Surface(pair.source), ..*pair });
        }
        for direction in directions {
            let points = sample(&model.bodies[direction.source]);
            let Some(closest) = model.assembly.contact.closest(points, direction.target, &at) else {
                continue;
            };
            let source = &model.bodies[direction.source];
            if closest.gap >= -TOUCHING * source.body.mesh().smallest_edge() {
                continue;
            }
            let [a, b] = &model.assembly.named_pairs[pair.named_pair].between;
            let place = place(&closest.at);
            let index = direction.source;
            return Err(match direction.target {
                Target::Surface(_) => InputError::new(
                    format!("bodies.{index}.mesh"),
                    format!(
                        "bodies {a:?} and {b:?} overlap at the start: {:?} at {place} is {:.6} m inside; \
                         move one of them",
                        source.name, -closest.gap
                    ),
                ),
                Target::Obstacle(o) => {
                    let obstacle = &model.assembly.contact.obstacles[o];
                    let outside =
                        source.nodes().all(|n| obstacle.gap(&model.assembly.reference[n], &at).0 < 0.0);
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
                            "body {a:?} {fact} obstacle {b:?} at the start: its node at {place} is {:.6} m behind it; \
                             move the body or {free} obstacles.{} ({:?})",
                            -closest.gap, o, scenario.obstacles[o].name
                        ),
                    )
                }
            });
        }
    }
    check_corners(scenario, model)?;
    check_crossings(model)
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
        if depth > arcs + TOUCHING * body.body.mesh().smallest_edge() {
            refused.get_or_insert_with(|| {
                InputError::new(
                    format!("bodies.{i}.mesh"),
                    format!(
                        "obstacle {:?} overlaps body {:?} at the start: near {} it is {depth:.6} m inside; move one of them",
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
fn check_crossings<const D: usize>(model: &Model<D>) -> Result<(), InputError> {
    let at = |n: u32| model.assembly.reference[n as usize];
    let (mut search, mut candidates) = (Search::default(), Vec::new());
    model.assembly.contact.detect(&at, &at, 0.0, &mut search, &mut candidates);
    for candidate in candidates.iter().filter(|c| has_straight_edges(model, c)) {
        let pair = &model.assembly.contact.pairs[candidate.pair as usize];
        let smallest_edge = model.bodies[pair.source].body.mesh().smallest_edge();
        let contact = model.assembly.contact.evaluate(candidate, &at);
        let touching = TOUCHING * smallest_edge;
        if contact.gap >= -touching
            || model.assembly.contact.is_beyond(candidate, &contact, touching, &at, &search)
        {
            continue;
        }
        let [a, b] = &model.assembly.named_pairs[pair.named_pair].between;
        return Err(InputError::new(
            format!("bodies.{}.mesh", pair.source),
            format!(
                "edges of {a:?} and {b:?} are {:.6} m through one another at the start, near {}; move one of them",
                -contact.gap,
                place(&contact.source_point(&at))
            ),
        ));
    }
    Ok(())
}

/// Whether a candidate is of the edges of two bodies, and these are where they seem to be: those of quadratic cells are curved.
fn has_straight_edges<const D: usize>(model: &Model<D>, candidate: &Candidate) -> bool {
    let contact = &model.assembly.contact;
    let is_straight = |s: usize| !contact.surfaces[s].facets.iter().any(|f| f.kind.is_quadratic());
    let pair = &contact.pairs[candidate.pair as usize];
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
