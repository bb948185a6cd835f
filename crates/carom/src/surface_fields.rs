//! What happened on the boundaries, facet by facet.

use crate::{Model, State};

/// Fields on the facets that may touch others, body after body.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceFields {
    /// Dissipated by friction since the start, per area of the reference configuration [J/m²]: times the areas it sums to the
    /// friction of the ledger. Two bodies share it evenly; what a rigid obstacle would receive is on the body that slides on it.
    pub friction_energy: Vec<f64>,
    /// How far it has slid along what it touched since the start [m], whichever way: the mean of its nodes.
    pub slip: Vec<f64>,
    /// Contact force against the normal, per area of the reference configuration [Pa].
    pub pressure: Vec<f64>,
    /// Area of the reference configuration [m²].
    pub area: Vec<f64>,
}

/// The fields of a state. What belongs to a node is shared by the facets around it in proportion to their size.
pub(crate) fn surface_fields<const D: usize>(model: &Model<D>, state: &State<D>) -> SurfaceFields {
    let mut fields = SurfaceFields {
        friction_energy: Vec::new(),
        slip: Vec::new(),
        pressure: Vec::new(),
        area: Vec::new(),
    };
    let mut around = vec![0.0; state.displacement.len()];
    for b in &model.bodies {
        let mesh = b.body.mesh();
        let facets = b.body.surface().facets();
        let size = |f: &carom_mesh::Facet| b.body.facet_area(f);
        for facet in facets {
            facet.nodes.iter().for_each(|&n| around[b.first_node + n as usize] += size(facet));
        }
        for facet in facets {
            let normal = facet.normal(mesh, &state.displacement[b.nodes()]);
            let (mut energy, mut slip, mut pressure) = (0.0, 0.0, 0.0);
            for node in facet.nodes.iter().map(|&n| b.first_node + n as usize) {
                slip += state.slip[node] / facet.nodes.len() as f64;
                energy += state.friction_energy[node] / around[node];
                pressure -= state.contact_force[node].dot(&normal) / around[node];
            }
            fields.friction_energy.push(energy);
            fields.slip.push(slip);
            fields.pressure.push(pressure);
            fields.area.push(size(facet));
        }
    }
    fields
}
