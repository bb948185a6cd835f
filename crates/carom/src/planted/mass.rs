//! The mass of bodies that carom does not know.

use carom_mesh::Vector;

use super::numbering::Numbering;
use crate::body::{BodyState, Jolt, Masses};
use crate::model::assembly::Assembly;

/// The mass of the caller's bodies, by the caller's numbers of nodes. It couples no two surfaces.
pub trait ForeignMass<const D: usize> {
    /// The mass by which a node resists what moves it alone [kg], greater than 0: the sum of its row without signs.
    fn of_node(&self, node: u32) -> f64;

    /// Writes Δv = M⁻¹ p [m/s] of these `nodes` of a surface for the impulses p [N s] on them; nothing changes where motion is prescribed.
    fn jolt(&mut self, surface: usize, nodes: &[u32], impulse: &[Vector<D>], change: &mut [Vector<D>]);
}

/// The same by the nodes of surfaces.
pub(super) struct OnSurfaces<'a, const D: usize> {
    pub mass: &'a mut dyn ForeignMass<D>,
    pub assembly: &'a Assembly<D>,
    pub numbering: &'a Numbering,
}

impl<const D: usize> Masses<D> for OnSurfaces<'_, D> {
    fn mass_of(&self, body: usize, node: u32) -> f64 {
        let nodes = self.numbering.range(self.assembly.nodes(body));
        self.mass.of_node(nodes[node as usize])
    }

    fn jolt(
        &mut self,
        body: usize,
        impulse: &mut [Vector<D>],
        _state: &BodyState<'_, D>,
        [change, _support]: [&mut [Vector<D>]; 2],
    ) -> Jolt {
        self.mass.jolt(body, self.numbering.range(self.assembly.nodes(body)), impulse, change);
        Jolt::default()
    }
}
