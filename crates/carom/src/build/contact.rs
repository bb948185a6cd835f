use std::collections::BTreeMap;

use carom_contact::{
    ContactModel, ContactSurface, Directions, Discretisation, PairRule, PairRules, Pairs, Positions, Side,
    Solid,
};
use carom_fem::Hypothesis;

use super::cohesion;
use super::friction_law::at_rest;
use super::mortar::{discretisation, has_mortar};
use super::obstacle::{Surfaces, obstacle};
use super::roundness::Roundness;
use super::side::{NamedSide, facet_width};
use super::spare_mass::may_touch;
use super::values::place;
use crate::body::fe::part::ModelBody;
use crate::error::InputError;
use crate::model::assembly::MANY_PAIRS;
use crate::scenario::{BodyEntry, BodyKind, ContactSpec, PairEntry, Scenario, Sources, Targets};

/// Every pair of a body with another body or an obstacle, less the exceptions of the scenario.
pub(super) fn contact<const D: usize>(
    scenario: &Scenario,
    bodies: &[ModelBody<D>],
    mut surfaces: Surfaces<D>,
) -> Result<ContactModel<D>, InputError> {
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
        if let Some(round) = Roundness::<D>::of(&format!("bodies.{i}"), entry)? {
            surface = surface.round(&round.centre, round.radius, &reference);
        }
        let touches_itself = touches_itself(entry);
        model.surfaces.push(if touches_itself { surface.touching_itself(&reference) } else { surface });
    }
    for (i, entry) in scenario.obstacles.iter().enumerate() {
        let key = format!("obstacles.{i}");
        model.obstacles.push(obstacle(&key, &entry.shape, surfaces.remove(&entry.name))?);
    }
    let side = |(b, entry): (&ModelBody<D>, &BodyEntry)| NamedSide {
        name: b.name.clone(),
        is_periodic: !b.body.mesh().ties().is_empty(),
        side: Side {
            touches_itself: touches_itself(entry),
            facet_width: facet_width(b.body.surface(), |n| b.body.mesh().nodes()[n]),
            mass: b.body.total_mass(),
        },
    };
    let sides: Vec<NamedSide> = bodies.iter().zip(&scenario.bodies).map(side).collect();
    let obstacles: Vec<&str> = scenario.obstacles.iter().map(|o| o.name.as_str()).collect();
    model.pairs = pairs(&scenario.contact, &sides, &obstacles)?;
    Ok(model)
}

/// Every pair of a body with another body or an obstacle, less the exceptions.
pub(crate) fn pairs(
    spec: &ContactSpec,
    bodies: &[NamedSide],
    obstacles: &[&str],
) -> Result<Pairs, InputError> {
    at_rest("contact.friction", &spec.friction)?;
    if !Pairs::have_room_for(bodies.len(), obstacles.len()) {
        let message =
            format!("{} bodies: more pairs than there are numbers for; leave bodies out", bodies.len());
        return Err(InputError::new("bodies", message));
    }
    let place = |names: &[&str], name: &str| names.iter().position(|own| *own == name);
    let names: Vec<&str> = bodies.iter().map(|body| body.name.as_str()).collect();
    let solid = |name: &str| {
        place(&names, name).map(Solid::Body).or_else(|| place(obstacles, name).map(Solid::Obstacle))
    };
    let mut exceptions = BTreeMap::new();
    for (k, entry) in spec.pairs.iter().enumerate() {
        let [Some(first), Some(second)] = [0, 1].map(|i| solid(&entry.between[i])) else { continue };
        let between = first.pair(second);
        if exceptions.contains_key(&between) {
            continue;
        }
        let rule = if entry.enabled {
            // An order is only meant where the entry says which side is the source.
            let swapped = entry.sources.is_some() && first > second;
            Some(rule(spec, Some((k, entry)), swapped, sides(between, bodies).as_deref())?)
        } else {
            None
        };
        exceptions.insert(between, rule);
    }
    let usual = rule(spec, None, false, (bodies.len() > 1).then_some(&[]))?;
    for (i, body) in bodies.iter().enumerate() {
        // What cannot be in a pair by the rule is told with the first that it would be in.
        let others = (0..bodies.len()).filter(|&j| j != i).map(|j| Solid::Body(i).pair(Solid::Body(j)));
        if body.is_periodic
            && let Some(between) = others.into_iter().find(|b| !exceptions.contains_key(b))
        {
            rule(spec, None, false, sides(between, bodies).as_deref())?;
        }
    }
    let rules = PairRules {
        sides: bodies.iter().map(|body| body.side).collect(),
        obstacles: obstacles.len(),
        rule: usual,
        exceptions,
    };
    Ok(Pairs::by(rules, MANY_PAIRS))
}

/// The two bodies of a pair; none of a body with itself or with an obstacle.
fn sides(between: [Solid; 2], bodies: &[NamedSide]) -> Option<Vec<&NamedSide>> {
    match between {
        [Solid::Body(a), Solid::Body(b)] if a != b => Some(vec![&bodies[a], &bodies[b]]),
        _ => None,
    }
}

/// What holds for a pair by its entry or, without one, for all. Two bodies may have multipliers; those that are known are asked.
fn rule(
    spec: &ContactSpec,
    found: Option<(usize, &PairEntry)>,
    swapped: bool,
    sides: Option<&[&NamedSide]>,
) -> Result<PairRule, InputError> {
    let entry = found.map(|(_, entry)| entry);
    let own =
        found.and_then(|(k, entry)| Some((format!("contact.pairs.{k}.friction"), entry.friction.as_ref()?)));
    let friction = match own {
        Some((key, friction)) => at_rest(&key, friction)?,
        None => at_rest("contact.friction", &spec.friction)?,
    };
    let sources = entry.and_then(|entry| entry.sources).or(spec.sources);
    let holding = cohesion::of_pair(spec, found);
    if let (Some((key, _)), Some(Sources::Both), Some(_)) = (&holding, sources, sides) {
        let message =
            "what holds is on one side of a pair; choose \"finer\", \"first\" or \"second\" for sources";
        return Err(InputError::new(key.as_str(), message));
    }
    let discretisation = match sides {
        Some(sides) => discretisation(spec, found, sources, sides)?,
        None => Discretisation::NodeToSegment,
    };
    // Neither side sees all that the other does. But multipliers are on one.
    let directions = match (sources, swapped) {
        (None, _) if discretisation == Discretisation::Mortar || holding.is_some() => Directions::Finer,
        (Some(Sources::Finer), _) => Directions::Finer,
        (None | Some(Sources::Both), _) => Directions::Both,
        (Some(Sources::First), false) | (Some(Sources::Second), true) => Directions::Forward,
        (Some(Sources::First), true) | (Some(Sources::Second), false) => Directions::Backward,
    };
    Ok(PairRule { friction, discretisation, directions })
}

/// Whether a body may touch itself. What is rigid or deforms little cannot.
fn touches_itself(entry: &BodyEntry) -> bool {
    match entry.kind {
        BodyKind::Deformable => entry.self_contact != Some(false),
        BodyKind::Foreign => entry.self_contact == Some(true),
        BodyKind::Rigid | BodyKind::Reduced => false,
    }
}

/// Refuses a surface that has no two sides everywhere.
pub(crate) fn check_manifold<const D: usize>(
    key: &str,
    surface: &ContactSurface,
    position: &Positions<'_, D>,
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

#[cfg(test)]
mod tests {
    use carom_friction::SolverKind;

    use super::*;
    use crate::ContactCondition;
    use crate::scenario::{FrictionSpec, SolverSpec};

    #[test]
    fn bodies_whose_pairs_have_no_numbers_are_refused() {
        let spec = ContactSpec {
            condition: ContactCondition::Gap,
            friction: FrictionSpec::Coefficient(0.3),
            solver: SolverSpec {
                kind: SolverKind::Auto,
                tolerance: 1e-12,
                max_iterations: 10,
                cross_check: false,
            },
            sources: None,
            targets: Targets::Smooth,
            discretisation: Discretisation::NodeToSegment,
            certificate_tolerance: 1e-9,
            penetration_tolerance: 1e-2,
            resolve_overlap: false,
            overlap_resolved_at: None,
            restitution: None,
            cohesion: None,
            pairs: Vec::new(),
        };
        let side = Side { touches_itself: false, facet_width: 1.0, mass: 1.0 };
        let body = NamedSide { name: "grain".to_string(), is_periodic: false, side };
        let many = |count: usize| pairs(&spec, &vec![body.clone(); count], &["floor"]);
        assert!(many(40_000).expect("there is room").are_many());
        let refused = many(50_000).expect_err("there is none");
        assert_eq!(refused.key, "bodies");
        assert_eq!(refused.message, "50000 bodies: more pairs than there are numbers for; leave bodies out");
    }
}
