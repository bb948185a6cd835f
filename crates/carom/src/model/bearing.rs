use carom_contact::Positions;
use carom_mesh::{Facet, Vector};

use crate::ModelBody;

/// Facets around a node bear its contact if they face it at least this well, relative to the one that does best. The sides of a sole stand across
/// it and bear nothing, whatever friction pulls at their nodes.
pub(crate) const BEARS: f64 = 0.5;

/// The areas that bear the contact of the nodes of bodies, where friction depends on the pressure or surfaces cohere.
#[derive(Debug, Clone, Default)]
pub struct Bearing {
    /// Facets by the numbers of all nodes, with the part of their area [m²] of the reference configuration that every node has.
    facets: Vec<(Facet, f64)>,
    /// The facets of every node.
    around: Vec<Vec<u32>>,
    /// What makes an area [m²] of what the multipliers of every body cover [m]: its thickness in the plane, else 1.
    depths: Vec<f64>,
}

impl Bearing {
    /// Of these bodies.
    pub(crate) fn of<'a, const D: usize>(bodies: impl Iterator<Item = &'a ModelBody<D>>) -> Self {
        let mut bearing = Self::default();
        for b in bodies {
            bearing.depths.push(if b.body.is_axisymmetric() { 1.0 } else { b.body.depth(&Vector::zeros()) });
            bearing.around.resize(b.nodes().end, Vec::new());
            for facet in b.body.surface().facets() {
                let number = bearing.facets.len() as u32;
                let area = b.body.facet_area(facet) / facet.nodes.len() as f64;
                let facet = facet.numbered_from(b.first_node as u32);
                facet.nodes.iter().for_each(|&n| bearing.around[n as usize].push(number));
                bearing.facets.push((facet, area));
            }
        }
        bearing
    }

    /// What makes an area [m²] of what a multiplier of a body covers.
    pub(crate) fn depth(&self, body: usize) -> f64 {
        self.depths.get(body).copied().unwrap_or(1.0)
    }

    /// The area [m²] around a node that bears what `pushes` it along this direction, where nodes are at `position`; 0 where none is known.
    pub(crate) fn area<const D: usize>(
        &self,
        node: usize,
        pushes: &Vector<D>,
        position: &Positions<'_, D>,
    ) -> f64 {
        let facing = |number: &u32| {
            let normal = self.facets[*number as usize].0.area_vector_at(|n| position(n as u32));
            -normal.try_normalize(0.0).unwrap_or(normal).dot(pushes)
        };
        let around = self.around.get(node).map_or(&[][..], Vec::as_slice);
        let best = around.iter().map(facing).fold(f64::NEG_INFINITY, f64::max);
        // Where no facet faces the contact, as at the tip of a needle, all bear it alike.
        let bears = |number: &&u32| best <= 0.0 || facing(number) >= BEARS * best;
        around.iter().filter(bears).map(|&number| self.facets[number as usize].1).sum()
    }
}
