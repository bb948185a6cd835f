use carom_contact::{ContactModel, ContactSurface, Discretisation, Pair, Target};
use carom_fem::Hypothesis;
use carom_mesh::Vector;

use super::body::may_touch;
use super::mortar::{discretisation, has_mortar};
use super::obstacle::{Surfaces, obstacle};
use super::side::{Side, facet_width};
use super::values::{number, place, vector};
use crate::body::fe::part::ModelBody;
use crate::error::InputError;
use crate::model::assembly::NamedPair;
use crate::scenario::{BodyEntry, BodyKind, ContactSpec, MeshSpec, Scenario, Sources, Targets};

/// The largest friction coefficient.
const MAX_FRICTION: f64 = 1e3;

/// Refuses friction coefficients that are negative, or so large that round-off of μ|w_t| would hide the normal motion.
fn check_friction(key: &str, friction: f64) -> Result<(), InputError> {
    number(key, friction, (0.0..=MAX_FRICTION).contains(&friction), "friction must be between 0 and 1000")
}

/// Every pair of a body with another body or an obstacle, less the exceptions of the scenario.
pub(super) fn contact<const D: usize>(
    scenario: &Scenario,
    bodies: &[ModelBody<D>],
    mut surfaces: Surfaces<D>,
) -> Result<(ContactModel<D>, Vec<NamedPair>), InputError> {
    let mut model = ContactModel::default();
    for (i, (b, entry)) in bodies.iter().zip(&scenario.bodies).enumerate() {
        let reference = |n: u32| b.body.mesh().nodes()[n as usize - b.first_node];
        let mut surface = ContactSurface::new(b.body.surface(), b.first_node as u32, &reference);
        if entry.hypothesis == Hypothesis::Axisymmetric {
            surface = surface.revolved();
        }
        if may_touch(scenario, &b.name) {
            check_manifold(&format!("bodies.{i}.mesh"), &surface, &reference)?;
        }
        if scenario.contact.targets == Targets::Smooth {
            surface = surface.smoothed(&reference);
        }
        if has_mortar(&scenario.contact) {
            surface = surface.sided(&reference);
        }
        if entry.round {
            let (centre, radius) = roundness(&format!("bodies.{i}"), entry)?;
            surface = surface.round(&centre, radius, &reference);
        }
        let touches_itself = touches_itself(entry);
        model.surfaces.push(if touches_itself { surface.touching_itself(&reference) } else { surface });
    }
    for (i, entry) in scenario.obstacles.iter().enumerate() {
        let key = format!("obstacles.{i}");
        model.obstacles.push(obstacle(&key, &entry.shape, surfaces.remove(&entry.name))?);
    }
    let side = |(b, entry): (&ModelBody<D>, &BodyEntry)| Side {
        name: b.name.clone(),
        touches_itself: touches_itself(entry),
        is_periodic: !b.body.mesh().ties().is_empty(),
        facet_width: facet_width(b.body.surface(), |n| b.body.mesh().nodes()[n]),
        mass: b.body.total_mass(),
    };
    let sides: Vec<Side> = bodies.iter().zip(&scenario.bodies).map(side).collect();
    let obstacles: Vec<&str> = scenario.obstacles.iter().map(|o| o.name.as_str()).collect();
    let (pairs, named_pairs) = pairs(&scenario.contact, &sides, &obstacles)?;
    model.pairs = pairs;
    Ok((model, named_pairs))
}

/// Every pair of a body with another body or an obstacle, less the exceptions, and the named pairs they belong to.
pub(crate) fn pairs(
    spec: &ContactSpec,
    sides: &[Side],
    obstacles: &[&str],
) -> Result<(Vec<Pair>, Vec<NamedPair>), InputError> {
    let default = spec.friction;
    check_friction("contact.friction", default)?;
    let (mut pairs, mut named_pairs) = (Vec::new(), Vec::new());
    for (a, side) in sides.iter().enumerate() {
        let first = side.name.as_str();
        let others =
            sides.iter().enumerate().skip(a).map(|(b, side)| (Target::Surface(b), side.name.as_str()));
        let others = others.filter(|&(t, _)| t != Target::Surface(a) || side.touches_itself);
        let obstacles = obstacles.iter().enumerate().map(|(o, &name)| (Target::Obstacle(o), name));
        for (target, second) in others.chain(obstacles) {
            let found = spec.pairs.iter().enumerate().find(|(_, p)| {
                let [x, y] = &p.between;
                (x == first && y == second) || (x == second && y == first)
            });
            let (mut friction, mut sources, mut swapped) = (default, spec.sources, false);
            if let Some((k, entry)) = found {
                if !entry.enabled {
                    continue;
                }
                friction = entry.friction.unwrap_or(friction);
                sources = entry.sources.or(sources);
                // An order is only meant where the entry says which side is the source.
                swapped = entry.sources.is_some() && entry.between[0] == second;
                check_friction(&format!("contact.pairs.{k}.friction"), friction)?;
            }
            let discretisation = match target {
                // Nodes of a body against its own facets: neither side is the source.
                Target::Surface(b) if b == a => Discretisation::NodeToSegment,
                Target::Surface(b) => discretisation(spec, found, sources, [side, &sides[b]])?,
                Target::Obstacle(_) => Discretisation::NodeToSegment,
            };
            // Neither side sees all that the other does. But multipliers are on one, and nodes without mass that are in static balance on
            // both sides at once take energy.
            let one_side = discretisation == Discretisation::Mortar || spec.condition.is_massless();
            let sources = sources.unwrap_or(if one_side { Sources::Finer } else { Sources::Both });
            let named_pair = named_pairs.len();
            named_pairs.push(NamedPair { between: [first.to_string(), second.to_string()], friction });
            let forward = Pair { source: a, target, friction, named_pair, discretisation };
            match target {
                Target::Obstacle(_) => pairs.push(forward),
                Target::Surface(b) if b == a => pairs.push(forward),
                Target::Surface(b) => {
                    let backward = Pair { source: b, target: Target::Surface(a), ..forward };
                    match (sources, swapped) {
                        (Sources::Finer, _) if sides[b].is_finer_than(side) => pairs.push(backward),
                        (Sources::Finer, _) => pairs.push(forward),
                        (Sources::Both, _) => pairs.extend([forward, backward]),
                        (Sources::First, false) | (Sources::Second, true) => pairs.push(forward),
                        (Sources::First, true) | (Sources::Second, false) => pairs.push(backward),
                    }
                }
            }
        }
    }
    Ok((pairs, named_pairs))
}

/// The centre and the radius [m] of a body that is round.
fn roundness<const D: usize>(key: &str, entry: &BodyEntry) -> Result<(Vector<D>, f64), InputError> {
    let key = format!("{key}.round");
    let (centre, radius): (&[f64], f64) = match &entry.mesh {
        MeshSpec::Disc { centre, radius, .. } => (centre, *radius),
        MeshSpec::Ball { centre, radius, .. } => (centre, *radius),
        _ => {
            let message =
                format!("body {:?} is round with a disc or a ball as its mesh; leave it out", entry.name);
            return Err(InputError::new(key, message));
        }
    };
    if entry.kind != BodyKind::Rigid {
        let message = format!("body {:?} deforms and is what its mesh makes it; leave it out", entry.name);
        return Err(InputError::new(key, message));
    }
    Ok((vector(&key, centre)?, radius))
}

/// Whether a body may touch itself. What is rigid cannot.
fn touches_itself(entry: &BodyEntry) -> bool {
    entry.self_contact != Some(false) && entry.kind != BodyKind::Rigid
}

/// Refuses a surface that has no two sides everywhere.
pub(crate) fn check_manifold<const D: usize>(
    key: &str,
    surface: &ContactSurface,
    position: &impl Fn(u32) -> Vector<D>,
) -> Result<(), InputError> {
    let edges = surface.non_manifold_edges();
    let Some(ends) = edges.first() else { return Ok(()) };
    let [from, to] = ends.map(|n| place(&position(n)));
    let count = edges.len();
    let message = format!(
        "the contact surface is not manifold: more than two facets meet at {count} of its edges, the first from {from} to {to}; \
         join the parts that touch there by a face, or separate them"
    );
    Err(InputError::mesh(key, message))
}
