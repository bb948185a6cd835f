//! A deformable body: what it is made of, and what is known of it.

mod build;
mod resistance;

use std::sync::Arc;

use carom_mesh::{Facet, Matrix, Mesh, Surface, Vector};

use crate::composition::OfMaterial;
use crate::elements::{Dashpots, Elements, Past};
use crate::held::{Held, HeldDof};
use crate::material::PlasticState;
use crate::ranks::{Ranks, Summed};
use crate::shape_table::{Depth, facet_area};
use crate::sparse::{NodalMatrix, NodeGraph};
use crate::{Growth, RayleighDamping};

/// A deformable body: mesh, elements, mass and damping. It is never written after it is built.
///
/// Slices of vectors hold one entry per node of the body.
#[derive(Debug)]
pub struct Body<const D: usize> {
    mesh: Mesh<D>,
    surface: Surface,
    massless_contact: bool,
    /// The graph of the nodes, whoever has the cells between them.
    graph: Arc<NodeGraph>,
    /// The processes that share the cells, if others have some of them.
    pub(crate) ranks: Option<Arc<dyn Ranks>>,
    /// The numbers of the cells that this one has, in the order of the elements; empty if it has all.
    pub(crate) own_cells: Vec<u32>,
    elements: Vec<Box<dyn Elements<D>>>,
    dashpots: Vec<Box<dyn Dashpots<D>>>,
    /// Quadrature points that remember.
    memory: usize,
    /// Whether a material of it is viscous, whoever has its cells.
    is_viscous: bool,
    mass: NodalMatrix<f64>,
    nodal_mass: Vec<f64>,
    nodal_inertia: Vec<f64>,
    massless_stiffness: Vec<f64>,
    massless_mass: Vec<f64>,
    total_mass: f64,
    depth: Depth,
    materials: Vec<OfMaterial>,
    damping: RayleighDamping,
    /// Σ β K₀ over the materials [N s/m].
    damping_stiffness: Option<NodalMatrix<Matrix<D>>>,
    /// The numbers of the cells in the order of the elements; empty if that is theirs.
    pub(crate) cells_in_order: Vec<u32>,
    is_objective: bool,
    turns: bool,
    /// See [`Self::reference_arms`].
    pub(crate) frame_arms: Vec<Vector<D>>,
    held: Held,
}

impl<const D: usize> Body<D> {
    /// The mesh in the reference configuration.
    #[must_use]
    pub fn mesh(&self) -> &Mesh<D> {
        &self.mesh
    }

    /// The boundary, or the part of it that may touch others.
    #[must_use]
    pub fn surface(&self) -> &Surface {
        &self.surface
    }

    /// The graph of the nodes, whoever has the cells between them; matrices are over that of the cells which are here.
    #[must_use]
    pub fn graph(&self) -> &Arc<NodeGraph> {
        &self.graph
    }

    /// Number of nodes.
    #[must_use]
    pub fn node_count(&self) -> usize {
        self.mesh.nodes().len()
    }

    /// Number of unknown displacements: those of the nodes that follow no other, less what is held.
    #[must_use]
    pub fn dofs(&self) -> usize {
        let masters = self.mesh.masters();
        let held = self.held.dofs().iter().filter(|dof| masters[dof.node as usize] == dof.node).count();
        D * (self.node_count() - self.mesh.ties().len()) - held
    }

    /// Holds more displacements. Of nodes that move alike all are to be named.
    pub fn hold(&mut self, dofs: impl IntoIterator<Item = HeldDof>) {
        self.held.add(self.mesh.nodes().len(), dofs);
    }

    /// The displacements that are not free.
    #[must_use]
    pub fn held(&self) -> &Held {
        &self.held
    }

    /// The processes that share its cells, if others have some of them.
    #[must_use]
    pub fn ranks(&self) -> Option<&Arc<dyn Ranks>> {
        self.ranks.as_ref()
    }

    /// Writes M v to `out`, of all ranks together.
    pub fn multiply_mass(&self, v: &[Vector<D>], out: &mut [Vector<D>]) {
        self.mass.multiply(v, out);
        self.ranks.sum_up(out);
    }

    /// Mass matrix [kg], one number per pair of nodes (mass is isotropic); of a shared body its part of the cells that are here.
    #[must_use]
    pub fn mass(&self) -> &NodalMatrix<f64> {
        &self.mass
    }

    /// The nodes without mass, ascending.
    #[must_use]
    pub fn massless(&self) -> &[u32] {
        if self.massless_contact { self.surface.nodes() } else { &[] }
    }

    /// For every massless node, the mean stiffness [N/m] with which the others hold it in the reference configuration.
    #[must_use]
    pub fn massless_stiffness(&self) -> &[f64] {
        &self.massless_stiffness
    }

    /// For every massless node, the mass [kg] that it had before it moved inside, point masses not counted: the sum of its row without signs.
    #[must_use]
    pub fn massless_mass(&self) -> &[f64] {
        &self.massless_mass
    }

    /// Row sums of the mass matrix [kg].
    #[must_use]
    pub fn nodal_mass(&self) -> &[f64] {
        &self.nodal_mass
    }

    /// The mass [kg] by which every node resists what moves it alone: the sum of its row without signs. That of a corner of second order is
    /// negative with them.
    #[must_use]
    pub fn nodal_inertia(&self) -> &[f64] {
        &self.nodal_inertia
    }

    /// Mass [kg].
    #[must_use]
    pub fn total_mass(&self) -> f64 {
        self.total_mass
    }

    /// Area of a facet of the reference configuration [m²]: its size times the depth of the body.
    #[must_use]
    pub fn facet_area(&self, facet: &Facet) -> f64 {
        facet_area(&self.mesh, facet, self.depth)
    }

    /// How far the body goes on beyond its D dimensions at a point [m]: the thickness in 2D, 2πR of a body of revolution, 1 in 3D.
    #[must_use]
    pub fn depth(&self, x: &Vector<D>) -> f64 {
        self.depth.at(x)
    }

    /// Whether the body is one of revolution around x = 0.
    #[must_use]
    pub fn is_axisymmetric(&self) -> bool {
        self.depth == Depth::Revolution
    }

    /// What it has of each of its materials: of that of the rest, then of those of its regions.
    #[must_use]
    pub fn materials(&self) -> &[OfMaterial] {
        &self.materials
    }

    /// Volume of the reference configuration [m³].
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.materials.iter().map(|of| of.volume).sum()
    }

    /// For every cell the number of its material: 0 is that of the rest.
    #[must_use]
    pub fn material_of_cells(&self) -> Vec<usize> {
        let mut numbers = vec![0; self.mesh.cell_count()];
        let in_order = self.materials.iter().enumerate().flat_map(|(k, of)| std::iter::repeat_n(k, of.cells));
        self.cells_in_order.iter().zip(in_order).for_each(|(&cell, number)| numbers[cell as usize] = number);
        numbers
    }

    /// Speed of pressure waves in the reference configuration [m/s], where it is lowest: none needs longer to cross the body.
    #[must_use]
    pub fn wave_speed(&self) -> f64 {
        self.materials.iter().map(|of| of.wave_speed).fold(f64::INFINITY, f64::min)
    }

    /// Speed of shear waves in the reference configuration [m/s], where it is lowest.
    #[must_use]
    pub fn shear_wave_speed(&self) -> f64 {
        self.materials.iter().map(|of| of.shear_wave_speed).fold(f64::INFINITY, f64::min)
    }

    /// Damping coefficients, but of regions, whose α is the same.
    #[must_use]
    pub fn damping(&self) -> RayleighDamping {
        self.damping
    }

    /// What growth by this linear strain is to its material.
    #[must_use]
    pub fn growth(&self, strain: f64) -> Growth {
        Growth::new(strain, self.is_objective)
    }

    /// The blocks of elements.
    pub(crate) fn elements(&self) -> &[Box<dyn Elements<D>>] {
        &self.elements
    }

    /// The blocks of elements, each with its part of the `history`.
    pub(crate) fn blocks<'a>(
        &'a self,
        history: &'a [PlasticState],
    ) -> impl Iterator<Item = (&'a dyn Elements<D>, &'a [PlasticState])> {
        let mut rest = history;
        self.elements.iter().map(move |e| {
            let (own, others) = rest.split_at(e.point_count().min(rest.len()));
            rest = others;
            (&**e, own)
        })
    }

    /// What the material of a virgin body remembers: nothing in an elastic one, otherwise an entry per quadrature point.
    #[must_use]
    pub fn virgin(&self) -> Vec<PlasticState> {
        vec![PlasticState::default(); self.memory]
    }

    /// A matrix of zeros over the graph of the cells that are here.
    fn no_stiffness(&self) -> NodalMatrix<Matrix<D>> {
        NodalMatrix::filled(self.mass.shared_graph(), Matrix::zeros())
    }

    /// The stiffness ∂²E/∂u² [N/m] of the virgin body at `u`; of a shared body its part of the cells that are here.
    #[must_use]
    pub fn stiffness(&self, u: &[Vector<D>]) -> NodalMatrix<Matrix<D>> {
        self.stiffness_after(&[], Growth::default(), u)
    }

    /// The stiffness [N/m] at `u` where the material remembers this `history` and has grown.
    pub(crate) fn stiffness_after(
        &self,
        history: &[PlasticState],
        growth: Growth,
        u: &[Vector<D>],
    ) -> NodalMatrix<Matrix<D>> {
        let mut k = self.no_stiffness();
        self.blocks(history).for_each(|(e, history)| e.add_stiffness(u, Past { history, growth }, &mut k));
        if growth.tangent() != 1.0 {
            k.values.iter_mut().for_each(|block| *block *= growth.tangent());
        }
        k
    }

    /// Whether the body can turn without storing energy, so that angular momentum can be conserved.
    #[must_use]
    pub fn turns(&self) -> bool {
        self.turns
    }
}
