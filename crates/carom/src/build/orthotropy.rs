//! Friction that depends on the direction.

use std::collections::BTreeSet;

use carom_contact::Solid;
use carom_mesh::{Matrix, Vector};
use nalgebra::DMatrix;

use super::friction_law::by_direction;
use super::values::vector;
use crate::ModelBody;
use crate::error::InputError;
use crate::ledger::ByPair;
use crate::model::Model;
use crate::model::orthotropy::{Grain, Orthotropies, Orthotropy};
use crate::scenario::{FrictionSpec, Scenario};

/// Spreads of arms below this, relative to the largest, are none: the nodes around one of a flat side lie in it.
const FLAT: f64 = 1e-10;

/// The pairs whose friction is orthotropic.
pub(super) fn orthotropies<const D: usize>(
    scenario: &Scenario,
    model: &Model<D>,
) -> Result<Orthotropies<D>, InputError> {
    let refuse = |key: String, message: String| Err(InputError::new(key, message));
    if let FrictionSpec::Orthotropic(spec) = &scenario.contact.friction {
        by_direction("contact.friction", spec)?;
        let message = "friction that depends on the direction needs a surface that carries it; give it to pairs, by [[contact.pairs]]";
        return refuse("contact.friction".into(), message.into());
    }
    let mut own = ByPair::default();
    for (k, entry) in scenario.contact.pairs.iter().enumerate() {
        let Some(FrictionSpec::Orthotropic(spec)) = &entry.friction else { continue };
        let key = format!("contact.pairs.{k}.friction");
        let both = by_direction(&key, spec)?;
        if D < 3 {
            let message =
                "the plane has one direction to slide in; give a coefficient, or build the case in space";
            return refuse(key, message.into());
        }
        let Some(between) = model.assembly.between(&entry.between) else { continue };
        let carries = |solid: &&Solid| model.assembly.solid_name(**solid) == spec.of;
        let Some(&solid) = between.iter().find(carries) else {
            let [a, b] = &entry.between;
            let message = format!("{:?} is none of the pair; give {a:?} or {b:?}", spec.of);
            return refuse(format!("{key}.of"), message);
        };
        let direction: Vector<D> = vector(&format!("{key}.direction"), &spec.direction)?;
        if direction == Vector::<D>::zeros() {
            return refuse(
                format!("{key}.direction"),
                "has no length; give the direction of \"along\"".into(),
            );
        }
        let grain = match solid {
            Solid::Obstacle(_) => Grain::Fixed(direction),
            Solid::Body(i) if scenario.bodies[i].round => {
                let message = format!(
                    "{:?} is round, and nothing is drawn on it; leave \"round\" out, or let the other one of the pair carry the direction",
                    spec.of
                );
                return refuse(format!("{key}.of"), message);
            }
            Solid::Body(i) => carried(&model.bodies[i], &direction),
        };
        let largest = both[0].max(both[1]);
        own.insert(between, Orthotropy { lengths: both.map(|mu| mu / largest), grain });
    }
    Ok(Orthotropies { own })
}

/// The grain of a body along `direction` in the reference configuration: Σ c (x_k − x) over the nodes of the facets around a node, with the c of least
/// norm that give the direction there, or its part along the surface.
fn carried<const D: usize>(b: &ModelBody<D>, direction: &Vector<D>) -> Grain<D> {
    let places = b.body.mesh().nodes();
    let mut neighbours = vec![BTreeSet::new(); places.len()];
    for facet in b.body.surface().facets() {
        for &node in &facet.nodes {
            neighbours[node as usize].extend(facet.nodes.iter().copied().filter(|&other| other != node));
        }
    }
    let around = neighbours.iter().zip(0..).map(|(neighbours, node): (&BTreeSet<u32>, u32)| {
        let arm = |n: u32| places[n as usize] - places[node as usize];
        let second: Matrix<D> = neighbours.iter().map(|&n| arm(n) * arm(n).transpose()).sum();
        let second = DMatrix::from_fn(D, D, |i, j| second[(i, j)]);
        let least = FLAT * second.norm();
        let Ok(inverse) = second.pseudo_inverse(least) else { return Vec::new() };
        let along = Matrix::<D>::from_fn(|i, j| inverse[(i, j)]) * direction;
        let number = |n: u32| b.first_node as u32 + n;
        let mut terms: Vec<(u32, f64)> =
            neighbours.iter().map(|&n| (number(n), arm(n).dot(&along))).collect();
        let own: f64 = terms.iter().map(|(_, c)| c).sum();
        terms.push((number(node), -own));
        terms
    });
    Grain::Carried { nodes: b.nodes(), around: around.collect() }
}
