//! A state and its contacts as NumPy arrays.

use carom::{Model, Reaction, State};
use carom_contact::{ContactModel, Site, Target};
use carom_mesh::Vector;
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::vectors;

/// A state with the energy that each body has yet to give back [J] and its contacts.
pub fn arrays<'py, const D: usize>(
    py: Python<'py>,
    model: &Model<D>,
    state: &State<D>,
) -> PyResult<Bound<'py, PyDict>> {
    let out = PyDict::new(py);
    out.set_item("time", state.time)?;
    let nodes = model.node_count();
    out.set_item("displacement", vectors(py, &state.displacement[..nodes])?)?;
    out.set_item("velocity", vectors(py, &state.velocity[..nodes])?)?;
    out.set_item("energy_debt", PyArray1::from_slice(py, &state.energy_debt))?;
    out.set_item("contact_force", vectors(py, &state.contact_force[..nodes])?)?;
    set_contacts(&out, model, &state.reactions)?;
    Ok(out)
}

/// Sets the entries of a state's contacts, one row of each.
///
/// `contact_node` is the source node, of edges and facets the one that takes most. `contact_target` is the index of a body, or −1 − that of an
/// obstacle. [`contact_site`](numbers_of) says where between the two the contact is, and `contact_facet` has the nodes of the facet that it is on,
/// or the corners of one of an obstacle, and then −1. Then follow the gap [m] where the condition was written, the normal, the force on the
/// source [N], and the adhesion [N] that this is less by than what is in Coulomb's cone: 0 where nothing holds.
fn set_contacts<const D: usize>(
    out: &Bound<'_, PyDict>,
    model: &Model<D>,
    reactions: &[Reaction<D>],
) -> PyResult<()> {
    let py = out.py();
    let contact = &model.assembly.contact;
    let target = |pair: u32| match contact.pairs.get(pair as usize).target {
        Target::Surface(body) => body as i64,
        Target::Obstacle(obstacle) => -1 - obstacle as i64,
    };
    let sites = reactions.iter().flat_map(|r| numbers_of(contact, r));
    // No facet has more nodes than one of nine.
    let width = if D == 2 { 3 } else { 9 };
    let facets = reactions.iter().flat_map(|r| {
        let nodes = facet_of(contact, r);
        let missing = width - nodes.len();
        nodes.into_iter().chain(std::iter::repeat_n(-1, missing))
    });
    out.set_item("contact_node", PyArray1::from_iter(py, reactions.iter().map(|r| i64::from(r.node()))))?;
    out.set_item("contact_target", PyArray1::from_iter(py, reactions.iter().map(|r| target(r.pair))))?;
    out.set_item("contact_site", PyArray1::from_iter(py, sites).reshape([reactions.len(), 5])?)?;
    out.set_item("contact_facet", PyArray1::from_iter(py, facets).reshape([reactions.len(), width])?)?;
    out.set_item("contact_gap", PyArray1::from_iter(py, reactions.iter().map(|r| r.contact.gap)))?;
    let normals: Vec<Vector<D>> = reactions.iter().map(|r| r.contact.frame.row(0).transpose()).collect();
    out.set_item("contact_normal", vectors(py, &normals)?)?;
    let forces: Vec<Vector<D>> = reactions.iter().map(|r| r.contact.frame.tr_mul(&r.force)).collect();
    out.set_item("contact_reaction", vectors(py, &forces)?)?;
    let adhesions = reactions.iter().map(|r| r.adhesion.unwrap_or(0.0));
    out.set_item("contact_adhesion", PyArray1::from_iter(py, adhesions))
}

/// Where a contact is: what it is, and up to four numbers, the rest −1. At a node (0) that; where edges cross (1) the nodes of that of the source
/// and those of the other, or its corners; before something round on an edge (2) its nodes, on a facet (2) none; at a corner of an obstacle (3) that; of
/// a multiplier of a mortar pair (4) its node and its side; at a point of an edge between nodes (5) these, and how many sixteenths from the first.
fn numbers_of<const D: usize>(contact: &ContactModel<D>, reaction: &Reaction<D>) -> [i64; 5] {
    let number = |n: u32| number_of(contact, reaction.pair, n);
    match reaction.site {
        Site::Node(n) | Site::Second(n) => [0, number(n), -1, -1, -1],
        Site::Crossing([a, b], [c, d]) => [1, number(a), number(b), number(c), number(d)],
        Site::Facet(_) => [2, -1, -1, -1, -1],
        Site::Edge([a, b]) => [2, number(a), number(b), -1, -1],
        Site::Corner(n) => [3, number(n), -1, -1, -1],
        Site::Multiplier(n, side) => [4, number(n), i64::from(side), -1, -1],
        Site::Between([a, b], point) => [5, number(a), number(b), i64::from(point), -1],
    }
}

/// The nodes of the facet that a contact is on, or the corners of that of an obstacle.
fn facet_of<const D: usize>(contact: &ContactModel<D>, reaction: &Reaction<D>) -> Vec<i64> {
    let facet = contact.facet_of(&reaction.candidate());
    facet.map_or_else(Vec::new, |f| f.nodes.iter().map(|&n| number_of(contact, reaction.pair, n)).collect())
}

/// The number of a node of the model; of a corner of the obstacle of a pair which of its corners it is.
fn number_of<const D: usize>(contact: &ContactModel<D>, pair: u32, n: u32) -> i64 {
    let corner = match contact.pairs.get(pair as usize).target {
        Target::Obstacle(o) => contact.obstacles[o].corner_index(n),
        Target::Surface(_) => None,
    };
    i64::from(corner.unwrap_or(n))
}
