//! What happened on the boundaries, facet by facet.

use carom_contact::shares;
use carom_mesh::{Facet, Vector};

use crate::model::bearing::BEARS;
use crate::{Model, ModelBody, State};

/// Fields on the facets that may touch others, body after body.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceFields {
    /// Dissipated by friction since the start, per area of the reference configuration [J/m²]: times the areas it sums to the
    /// friction of the ledger. Two bodies share it evenly; what a rigid obstacle would receive is on the body that slides on it.
    pub friction_energy: Vec<f64>,
    /// How far it has slid along what it touched since the start [m], whichever way: the mean of its nodes.
    pub slip: Vec<f64>,
    /// Normal reactions per area of the reference configuration [Pa], never negative: times the areas it sums to the normal reactions on the body.
    pub pressure: Vec<f64>,
    /// Area of the reference configuration [m²].
    pub area: Vec<f64>,
}

/// The fields of a state. What belongs to a node is shared by the facets around it in proportion to their size, and of a normal reaction to
/// how well they face it too.
pub(crate) fn surface_fields<const D: usize>(model: &Model<D>, state: &State<D>) -> SurfaceFields {
    let mut fields = SurfaceFields {
        friction_energy: Vec::new(),
        slip: Vec::new(),
        pressure: Vec::new(),
        area: Vec::new(),
    };
    let loads = normal_loads(model, state);
    let mut loads = &loads[..];
    let mut around = vec![0.0; state.displacement.len()];
    for b in &model.bodies {
        let facets = b.body.surface().facets();
        let size = |f: &Facet| b.body.facet_area(f);
        for facet in facets {
            facet.nodes.iter().for_each(|&n| around[b.first_node + n as usize] += size(facet));
        }
        let first = fields.pressure.len();
        for facet in facets {
            let (mut energy, mut slip) = (0.0, 0.0);
            for node in facet.nodes.iter().map(|&n| b.first_node + n as usize) {
                slip += state.slip[node] / facet.nodes.len() as f64;
                energy += state.friction_energy[node] / around[node];
            }
            fields.friction_energy.push(energy);
            fields.slip.push(slip);
            fields.pressure.push(0.0);
            fields.area.push(size(facet));
        }
        let own = loads.partition_point(|load| load.node < b.nodes().end);
        let (of_body, rest) = loads.split_at(own);
        loads = rest;
        if !of_body.is_empty() {
            bear(
                b,
                &state.displacement[b.nodes()],
                facets,
                of_body,
                &fields.area[first..],
                &mut fields.pressure[first..],
            );
        }
    }
    fields
}

/// A normal reaction at a node.
struct NormalLoad<const D: usize> {
    node: usize,
    /// Its size [N], not negative.
    force: f64,
    /// Where it pushes.
    direction: Vector<D>,
}

/// The normal reactions at the nodes of all bodies, by node.
fn normal_loads<const D: usize>(model: &Model<D>, state: &State<D>) -> Vec<NormalLoad<D>> {
    let mut loads = Vec::new();
    for reaction in &state.reactions {
        let normal = reaction.contact.frame.row(0).transpose();
        let force = reaction.force[0].max(0.0);
        let mut push = |(node, share), direction| {
            loads.push(NormalLoad { node, force: force * share, direction });
        };
        shares(reaction.contact.sources()).for_each(|share| push(share, normal));
        // Obstacles have no facets.
        let target = reaction.contact.targets().filter(|&(node, _)| node < model.node_count());
        shares(target).for_each(|share| push(share, -normal));
    }
    loads.sort_by_key(|load: &NormalLoad<D>| load.node);
    loads
}

/// Lays the normal reactions `loads` at nodes of a body, which has moved by `displacement` [m], on its `facets` as pressures [Pa].
fn bear<const D: usize>(
    b: &ModelBody<D>,
    displacement: &[Vector<D>],
    facets: &[Facet],
    loads: &[NormalLoad<D>],
    areas: &[f64],
    pressures: &mut [f64],
) {
    let number = |n: u32| b.first_node + n as usize;
    let is_loaded = |n: u32| loads.binary_search_by_key(&number(n), |load| load.node).is_ok();
    // Facets by the loaded nodes that they have.
    let mut incident: Vec<(usize, usize)> = Vec::new();
    for (f, facet) in facets.iter().enumerate() {
        incident.extend(facet.nodes.iter().filter(|&&n| is_loaded(n)).map(|&n| (number(n), f)));
    }
    incident.sort_unstable();
    let mut weights: Vec<(usize, f64)> = Vec::new();
    for load in loads {
        let from = incident.partition_point(|&(node, _)| node < load.node);
        let around = incident[from..].iter().take_while(|&&(node, _)| node == load.node);
        weights.clear();
        weights.extend(around.map(|&(_, f)| {
            let normal = facets[f].normal(b.body.mesh(), displacement);
            (f, -normal.dot(&load.direction))
        }));
        let best = weights.iter().map(|&(_, facing)| facing).fold(f64::NEG_INFINITY, f64::max);
        for (f, facing) in &mut weights {
            // Where no facet faces the contact, as at the tip of a needle, all bear it alike.
            *facing = if best <= 0.0 {
                areas[*f]
            } else if *facing >= BEARS * best {
                areas[*f] * *facing
            } else {
                0.0
            };
        }
        let whole: f64 = weights.iter().map(|&(_, weight)| weight).sum();
        if whole > 0.0 {
            weights.iter().for_each(|&(f, weight)| pressures[f] += load.force * weight / whole / areas[f]);
        }
    }
}
