//! From plain arrays to surfaces, obstacles and pairs. Everything that can be wrong with them is found here.

use std::collections::BTreeMap;

use carom_contact::{ContactModel, ContactSurface, Side};
use carom_mesh::compiled;
use carom_mesh::{Facet, Surface, Vector};
use serde::Deserialize;

use super::contact::PlantedContact;
use super::numbering::Numbering;
use crate::build::Surfaces;
use crate::build::cohesion::first_cohesion;
use crate::build::contact::{check_manifold, pairs};
use crate::build::drive::obstacle_motion;
use crate::build::friction_law::{first_law, first_orthotropic, friction_laws};
use crate::build::method::{check_solver, stopping};
use crate::build::mortar::has_mortar;
use crate::build::obstacle::obstacle;
use crate::build::side::{NamedSide, facet_width};
use crate::build::values::number;
use crate::error::InputError;
use crate::model::assembly::{Assembly, Member};
use crate::model::condition::ContactCondition;
use crate::model::method::{Method, NewtonRule};
use crate::scenario::{ContactSpec, ObstacleEntry, Targets};
use crate::scheme::Scheme;

/// What is said of contact beside the surfaces, by the names of the case file.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct PlantedSpec {
    /// Rigid obstacles.
    pub obstacles: Vec<ObstacleEntry>,
    /// Contact.
    pub contact: ContactSpec,
    /// θ of the caller's time scheme, the weight of the new velocity in the motion; none in load steps without inertia.
    pub theta: Option<f64>,
}

/// The boundary of a body, or the part of it that may touch.
#[derive(Debug, Clone, PartialEq)]
pub struct Outline {
    /// Name.
    pub name: String,
    /// Facets by the caller's numbers of their nodes.
    pub facets: Vec<Vec<u32>>,
    /// Whether it may touch itself.
    pub touches_itself: bool,
}

type Build<const D: usize> = fn(
    &PlantedSpec,
    &[Vector<D>],
    &[Outline],
    &[[bool; D]],
    Surfaces<D>,
) -> Result<PlantedContact<D>, InputError>;

impl<const D: usize> PlantedContact<D> {
    /// Contact between the outlines of bodies and with obstacles. `points` are all nodes of the caller [m], and `held` says which components
    /// of their motion are prescribed; `surfaces` are those of obstacles that come from files.
    ///
    /// # Errors
    /// If facets make no surface, two outlines share a node, or a value is out of range.
    pub fn build(
        spec: &PlantedSpec,
        points: &[Vector<D>],
        outlines: &[Outline],
        held: &[[bool; D]],
        surfaces: Surfaces<D>,
    ) -> Result<Self, InputError> {
        compiled!(D, PlantedContact::of as Build)(spec, points, outlines, held, surfaces)
    }

    fn of(
        spec: &PlantedSpec,
        points: &[Vector<D>],
        outlines: &[Outline],
        held: &[[bool; D]],
        surfaces: Surfaces<D>,
    ) -> Result<Self, InputError> {
        if let Some(key) = first_law(&spec.contact) {
            let message = "friction that depends on the motion needs the steps of carom, which give it a fixed point; give a coefficient";
            return Err(InputError::new(key, message));
        }
        let mut numbering = Numbering::default();
        let mut owner: BTreeMap<u32, &str> = BTreeMap::new();
        let (mut members, mut sides, mut model) = (Vec::new(), Vec::new(), ContactModel::default());
        for outline in outlines {
            let key = format!("surfaces.{}.facets", outline.name);
            let whole = Surface::from_facets(points, &outline.facets)
                .map_err(|e| InputError::mesh(key.as_str(), e.to_string()))?;
            let nodes = whole.nodes();
            for &node in nodes {
                if let Some(other) = owner.insert(node, &outline.name) {
                    let message = format!(
                        "node {node} is one of surface {other:?} too; give each body one surface, and with self_contact if it may touch itself"
                    );
                    return Err(InputError::mesh(key, message));
                }
            }
            let first = numbering.count();
            numbering.add(nodes);
            let own = renumbered(&whole, |n| nodes.binary_search(&n).unwrap_or_default() as u32);
            let reference: Vec<Vector<D>> = nodes.iter().map(|&n| points[n as usize]).collect();
            let (surface, side) = touching(outline, &spec.contact, &own, first, &reference)?;
            model.surfaces.push(surface);
            sides.push(side);
            members.push(Member {
                name: outline.name.clone(),
                diameter: diameter(&reference),
                reference,
                // What is inside what is not measured: an outline need not be the whole boundary of a body.
                boundary: Surface::default(),
                held: nodes.iter().filter_map(|&n| held.get(n as usize).copied()).collect(),
                is_massless: false,
                turns: true,
                axis: Vec::new(),
                stepped: Vec::new(),
            });
        }
        let method = method(spec)?;
        let assembly = assembled(spec, members, &sides, model, surfaces)?;
        Ok(Self::new(assembly, method, numbering))
    }
}

/// The surface of an outline, whose nodes are numbered from `first` on over all bodies and from 0 in `reference` [m].
pub(super) fn touching<const D: usize>(
    outline: &Outline,
    contact: &ContactSpec,
    own: &Surface,
    first: usize,
    reference: &[Vector<D>],
) -> Result<(ContactSurface, NamedSide), InputError> {
    let at = |n: u32| reference[n as usize - first];
    let mut surface = ContactSurface::new(own, first as u32, &at);
    check_manifold(&format!("surfaces.{}.facets", outline.name), &surface, &at)?;
    if contact.targets == Targets::Smooth {
        surface = surface.smoothed(&at);
    }
    if has_mortar(contact) {
        surface = surface.sided(&at);
    }
    if outline.touches_itself {
        surface = surface.touching_itself(&at);
    }
    let side = Side {
        touches_itself: outline.touches_itself,
        facet_width: facet_width(own, |n| reference[n]),
        mass: 0.0,
    };
    Ok((surface, NamedSide { name: outline.name.clone(), is_periodic: false, side }))
}

/// The diagonal of a box around points [m].
pub(super) fn diameter<const D: usize>(points: &[Vector<D>]) -> f64 {
    let start = points.first().copied().unwrap_or_else(Vector::zeros);
    let (low, high) = points.iter().fold((start, start), |(low, high), x| (low.inf(x), high.sup(x)));
    (high - low).norm()
}

/// The bodies with the obstacles, and the pairs of both.
pub(super) fn assembled<const D: usize>(
    spec: &PlantedSpec,
    members: Vec<Member<D>>,
    sides: &[NamedSide],
    mut model: ContactModel<D>,
    mut surfaces: Surfaces<D>,
) -> Result<Assembly<D>, InputError> {
    if let Some(key) = first_cohesion(&spec.contact) {
        let message = "surfaces of bodies of other codes do not hold together; leave it out";
        return Err(InputError::new(key, message));
    }
    let mut motions = Vec::new();
    let size = members.iter().map(|m| m.diameter).fold(0.0, f64::max);
    for (i, entry) in spec.obstacles.iter().enumerate() {
        let key = format!("obstacles.{i}");
        model.obstacles.push(obstacle(&key, &entry.shape, surfaces.remove(&entry.name))?);
        motions.push(obstacle_motion(&key, entry, [0.0, f64::INFINITY], size)?);
    }
    let names: Vec<&str> = spec.obstacles.iter().map(|o| o.name.as_str()).collect();
    model.pairs = pairs(&spec.contact, sides, &names)?;
    let names = names.into_iter().map(String::from).collect();
    let mut assembly = Assembly::new(members, model, names);
    assembly.obstacle_motions = motions;
    assembly.friction_laws = friction_laws(&spec.contact, spec.theta.is_none(), &assembly)?;
    if assembly.friction_laws.depend_on_pressure() {
        let message = "the areas of bodies of other codes are not known, and so no pressure; leave p out";
        return Err(InputError::new(first_law(&spec.contact).unwrap_or_default(), message));
    }
    if let Some(key) = first_orthotropic(&spec.contact) {
        let message = "friction that depends on the direction is not there for bodies of other codes; give a coefficient or another law";
        return Err(InputError::new(key, message));
    }
    Ok(assembly)
}

/// The surface with its nodes numbered anew.
fn renumbered(surface: &Surface, number: impl Fn(u32) -> u32) -> Surface {
    let facet = |f: &Facet| Facet { kind: f.kind, nodes: f.nodes.iter().map(|&n| number(n)).collect() };
    Surface::of_facets(surface.facets().iter().map(facet).collect(), &[])
}

pub(super) fn method<const D: usize>(spec: &PlantedSpec) -> Result<Method<D>, InputError> {
    let ContactSpec { condition, solver, .. } = &spec.contact;
    let refuse = |key: &str, message: &str| Err(InputError::new(key, message));
    let scheme = match spec.theta {
        Some(theta) => {
            number(
                "theta",
                theta,
                theta > 0.0 && theta <= 1.0,
                "theta must be greater than 0 and at most 1",
            )?;
            Scheme::Theta { theta, xi: 0.5 }
        }
        None if *condition != ContactCondition::Gap => {
            return refuse(
                "contact.condition",
                "load steps without inertia rule the gap at their end; write condition = \"gap\"",
            );
        }
        None => Scheme::Static,
    };
    if condition.is_massless() {
        return refuse(
            "contact.condition",
            "\"massless\" changes the mass of the bodies, which are not carom's; choose \"gap\", \"midpoint\" or \"endpoint\"",
        );
    }
    check_solver(solver)?;
    Ok(Method {
        scheme,
        condition: *condition,
        solver: solver.kind.solver(),
        stopping: stopping(solver),
        cross_check: false,
        // These are the caller's.
        newton: NewtonRule { tolerance: 0.0, max_iterations: 0 },
        max_halvings: 0,
        bridges: false,
        certificate_tolerance: spec.contact.certificate_tolerance,
        penetration_tolerance: spec.contact.penetration_tolerance,
    })
}
