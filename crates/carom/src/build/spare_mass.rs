//! Which bodies have no mass where they touch: with massless contact those that can spare it. A pair in which one has none is ruled by it, the
//! others by the motion: see [`crate::ContactCondition::Massless`].

use carom_mesh::{Mesh, Surface, Vector};

use super::cohesion::holds;
use super::places;
use super::values::vector;
use crate::scenario::{AnalysisKind, BodyEntry, BodyKind, PairEntry, Scenario};

/// Whether a body with this `mesh`, whose `surface` may touch, can do without the mass of that.
///
/// It cannot if it is no body of finite elements, if it grows, if springs or masses are attached there, if its friction depends on the motion,
/// which nodes in static balance do not have, or if it holds on to another. A static stage before or after one with massless contact has the weight
/// where that has it.
pub(super) fn spares_mass<const D: usize>(
    scenario: &Scenario,
    entry: &BodyEntry,
    mesh: &Mesh<D>,
    surface: &Surface,
) -> bool {
    let is_static = scenario.analysis.kind == AnalysisKind::Static;
    (scenario.contact.condition.is_massless() || is_static && scenario.has_massless_stage)
        && entry.kind == BodyKind::Deformable
        && entry.growth.is_none()
        && may_touch(scenario, &entry.name)
        && !has_friction_law(scenario, &entry.name)
        && !holds(scenario, &entry.name)
        && !is_attached_to(scenario, entry, mesh, surface)
}

/// Whether anything is there that a body may touch.
pub(super) fn may_touch(scenario: &Scenario, name: &str) -> bool {
    let enabled = |other: &str| {
        let between = |p: &&PairEntry| {
            let [a, b] = &p.between;
            (a == name && b == other) || (a == other && b == name)
        };
        scenario.contact.pairs.iter().find(between).is_none_or(|p| p.enabled)
    };
    let others = scenario
        .bodies
        .iter()
        .filter(|b| b.name != name || b.self_contact == Some(true) && b.kind == BodyKind::Deformable)
        .map(|b| b.name.as_str());
    others.chain(scenario.obstacles.iter().map(|o| o.name.as_str())).any(enabled)
}

/// Whether a friction law belongs to a pair of the body.
fn has_friction_law(scenario: &Scenario, name: &str) -> bool {
    let is_own = |pair: &&PairEntry| pair.between.iter().any(|other| other == name);
    let of_pairs = scenario.contact.pairs.iter().filter(is_own).filter_map(|pair| pair.friction.as_ref());
    scenario.contact.friction.is_law() || of_pairs.into_iter().any(|friction| friction.is_law())
}

/// Whether springs or masses are attached to nodes of the `surface`.
fn is_attached_to<const D: usize>(
    scenario: &Scenario,
    entry: &BodyEntry,
    mesh: &Mesh<D>,
    surface: &Surface,
) -> bool {
    let is_there = |on: &Option<String>, point: &Option<Vec<f64>>| {
        let of_set = on.as_ref().and_then(|on| mesh.nodes_of(on)).unwrap_or_default();
        let at = point.as_ref().and_then(|point| vector::<D>("", point).ok());
        let nearest = at.and_then(|at: Vector<D>| places::nearest("", &entry.name, &at, mesh).ok());
        of_set.iter().chain(&nearest).any(|node| surface.nodes().binary_search(node).is_ok())
    };
    let masses = scenario.masses.iter().filter(|mass| mass.body == entry.name);
    let ends = scenario.springs.iter().flat_map(|spring| &spring.between);
    let ends = ends.filter(|end| end.body.as_deref() == Some(entry.name.as_str()));
    masses.into_iter().any(|mass| is_there(&mass.on, &mass.point))
        || ends.into_iter().any(|end| is_there(&end.on, &end.point))
}
