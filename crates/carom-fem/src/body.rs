use std::sync::Arc;

use carom_mesh::compiled;
use carom_mesh::{Facet, Matrix, Mesh, Surface, Vector};

use crate::composition::{OfMaterial, for_each_piece, for_each_piece_of, laws, materials_of};
use crate::elements::{Dashpots, Elements, Past, add_mass, add_scaled_diagonal_mass, dashpots, elements};
use crate::held::{Held, HeldDof};
use crate::massless::{followers, redistributed};
use crate::material::{Mat3, PlasticState};
use crate::point_mass::with_points;
use crate::ranks::{Ranks, Summed};
use crate::shape_table::{Depth, facet_area};
use crate::sparse::{NodalMatrix, NodeGraph};
use crate::{BodySpec, FemError, Growth, Hypothesis, MassKind, PointMass, RayleighDamping};

/// A node whose radius is below this, relative to the size of the body, is on the axis.
const ON_THE_AXIS: f64 = 1e-9;

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

type Build<const D: usize> = fn(Mesh<D>, Surface, &BodySpec) -> Result<Body<D>, FemError>;

impl<const D: usize> Body<D> {
    /// Builds the body.
    ///
    /// # Errors
    /// If a material constant is out of range, or a cell is inverted or degenerate.
    pub fn new(mesh: Mesh<D>, spec: &BodySpec) -> Result<Self, FemError> {
        let surface = Surface::of(&mesh);
        Self::with_contact_surface(mesh, surface, spec)
    }

    /// Builds a body that can only be touched on a part of its boundary.
    ///
    /// # Errors
    /// As for [`Body::new`].
    pub fn with_contact_surface(mesh: Mesh<D>, surface: Surface, spec: &BodySpec) -> Result<Self, FemError> {
        compiled!(D, Body::build as Build)(mesh, surface, spec)
    }

    fn build(mesh: Mesh<D>, surface: Surface, spec: &BodySpec) -> Result<Self, FemError> {
        let laws = laws::<D>(spec)?;
        let depth = depth(&mesh, spec)?;
        // The axis is inside a body of revolution.
        let axis = if depth == Depth::Revolution { axis(&mesh) } else { Vec::new() };
        let surface = surface.part(|f| f.nodes.iter().any(|n| axis.binary_search(n).is_err()));
        let objective = laws[0].is_objective();
        // What repeats itself along a line or around an axis cannot turn.
        let turns = objective && mesh.ties().is_empty() && depth != Depth::Revolution;
        // Whatever is wrong with a cell is seen by every rank.
        let materials = materials_of(&mesh, depth, spec, &laws)?;
        let mut whole = NodeGraph::of(&mesh);
        if spec.share.is_some() && !spec.points.is_empty() {
            whole = whole.extended(spec.points.iter().flat_map(PointMass::pairs));
        }
        let whole = Arc::new(whole);
        let (mass, massless_mass) = mass_matrix(&mesh, &whole, &surface, spec, depth)?;
        let graph = Arc::clone(mass.shared_graph());
        let ranks = spec.share.as_ref().map(|share| Arc::clone(&share.ranks));
        let (mut blocks, mut viscous, mut cells_in_order) = (Vec::new(), Vec::new(), Vec::new());
        for_each_piece(&mesh, depth, spec, |cells, spec| {
            blocks.push(elements(spec, cells, &graph)?);
            cells_in_order.extend_from_slice(cells.numbers);
            if spec.viscosity.is_active() {
                viscous.push(dashpots(spec, objective, cells, &graph)?);
            }
            Ok(())
        })?;
        let mut nodal_mass = mass.row_sums();
        let mut nodal_inertia = mass.row_sizes();
        for sums in [&mut nodal_mass, &mut nodal_inertia] {
            ranks.iter().for_each(|ranks| ranks.sum(sums));
        }
        let (own_cells, cells_in_order) = match &ranks {
            None => (Vec::new(), cells_in_order),
            Some(_) => (cells_in_order, numbers_in_order(&mesh, depth, spec)?),
        };
        let remembers = laws.iter().any(|law| law.remembers());
        let memory = if remembers { blocks.iter().map(|b| b.point_count()).sum() } else { 0 };
        let mut body = Self {
            surface,
            memory,
            is_viscous: spec.by_material().iter().any(|of| of.viscosity.is_active()),
            total_mass: nodal_mass.iter().sum(),
            depth,
            materials,
            damping: spec.damping,
            damping_stiffness: None,
            cells_in_order: if spec.regions.is_empty() { Vec::new() } else { cells_in_order },
            mesh,
            graph: if ranks.is_some() { whole } else { graph },
            ranks,
            own_cells,
            elements: blocks,
            dashpots: viscous,
            mass,
            massless_stiffness: Vec::new(),
            massless_mass,
            massless_contact: spec.massless_contact,
            nodal_mass,
            nodal_inertia,
            is_objective: objective,
            turns,
            frame_arms: Vec::new(),
            held: Held::default(),
        };
        body.frame_arms = body.reference_arms();
        body.hold(body.axis_nodes().into_iter().map(|node| HeldDof { node, component: 0 }));
        if spec.massless_contact {
            let stiffness = body.unstressed_stiffness(spec)?;
            let own = |&n: &u32| stiffness.values[stiffness.graph().entry(n, n)].trace() / D as f64;
            body.massless_stiffness = body.massless().iter().map(own).collect();
            body.ranks.iter().for_each(|ranks| ranks.sum(&mut body.massless_stiffness));
        }
        body.damping_stiffness = body.stiffness_of_damping(spec)?;
        Ok(body)
    }

    /// The body for analyses without inertia: its nodes all resist alike, and its weight is where it was, inside.
    #[must_use]
    pub fn without_inertia(self) -> Self {
        Self { massless_contact: false, massless_stiffness: Vec::new(), massless_mass: Vec::new(), ..self }
    }

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

    /// The nodes, ascending, that lie on the axis of a body of revolution: they have no radial displacement.
    #[must_use]
    pub fn axis_nodes(&self) -> Vec<u32> {
        if self.is_axisymmetric() { axis(&self.mesh) } else { Vec::new() }
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

    /// The stiffness [N/m] that the body, which is like `spec`, has where nothing has moved but for its initial stress: rigid motions meet no
    /// resistance of it.
    fn unstressed_stiffness(&self, spec: &BodySpec) -> Result<NodalMatrix<Matrix<D>>, FemError> {
        let rest = vec![Vector::zeros(); self.node_count()];
        if spec.initial_stress == Mat3::zeros() {
            return Ok(self.stiffness(&rest));
        }
        let spec = BodySpec { initial_stress: Mat3::zeros(), ..spec.clone() };
        let past = Past::none();
        let mut k = self.no_stiffness();
        for_each_piece(&self.mesh, self.depth, &spec, |cells, spec| {
            elements(spec, cells, self.mass.shared_graph())?.add_stiffness(&rest, past, &mut k);
            Ok(())
        })?;
        Ok(k)
    }

    /// Σ β K₀ over the materials of the body, which is like `spec` [N s/m]; none where no β is more than zero.
    fn stiffness_of_damping(&self, spec: &BodySpec) -> Result<Option<NodalMatrix<Matrix<D>>>, FemError> {
        let unstressed = BodySpec { initial_stress: Mat3::zeros(), ..spec.clone() };
        let rest = vec![Vector::zeros(); self.node_count()];
        let mut sum: Option<NodalMatrix<Matrix<D>>> = None;
        for (index, of) in spec.by_material().iter().enumerate() {
            let factor = of.damping.stiffness;
            if factor == 0.0 {
                continue;
            }
            let mut k = self.no_stiffness();
            for_each_piece_of(index, &self.mesh, self.depth, &unstressed, |cells, spec| {
                elements(spec, cells, self.mass.shared_graph())?.add_stiffness(&rest, Past::none(), &mut k);
                Ok(())
            })?;
            k.values.iter_mut().for_each(|block| *block *= factor);
            match &mut sum {
                None => sum = Some(k),
                Some(sum) => sum.values.iter_mut().zip(&k.values).for_each(|(sum, k)| *sum += k),
            }
        }
        Ok(sum)
    }

    /// Σ β K₀ over its materials [N s/m], if there is any: what resists velocities in the frame of the body.
    #[must_use]
    pub fn damping_stiffness(&self) -> Option<&NodalMatrix<Matrix<D>>> {
        self.damping_stiffness.as_ref()
    }

    /// The viscous force C v [N], written to `f`; `frame` is the rotation of the body and `scratch` as long as `v`.
    pub fn damping_force(
        &self,
        frame: &Matrix<D>,
        v: &[Vector<D>],
        f: &mut [Vector<D>],
        scratch: &mut [Vector<D>],
    ) {
        match &self.damping_stiffness {
            Some(k0) => {
                for (s, v) in scratch.iter_mut().zip(v) {
                    *s = frame.tr_mul(v);
                }
                k0.multiply(scratch, f);
                f.iter_mut().for_each(|f| *f = frame * *f);
            }
            None => f.fill(Vector::zeros()),
        }
        if self.damping.mass > 0.0 {
            self.mass.multiply(v, scratch);
            for (f, mv) in f.iter_mut().zip(scratch.iter()) {
                *f += mv * self.damping.mass;
            }
        }
        if self.damping.mass > 0.0 || self.damping_stiffness.is_some() {
            self.ranks.sum_up(f);
        }
    }

    /// Whether anything resists velocities: damping or viscosity.
    #[must_use]
    pub fn is_damped(&self) -> bool {
        self.damping.mass != 0.0 || self.damping_stiffness.is_some() || self.is_viscous
    }

    /// Adds the force [N] of the material's viscosity in a step from `u0` to `u1` in `dt` [s] to `f`: its work is what the step
    /// dissipates.
    pub fn add_viscous_force(&self, u0: &[Vector<D>], u1: &[Vector<D>], dt: f64, f: &mut [Vector<D>]) {
        if self.ranks.is_none() {
            return self.dashpots.iter().for_each(|d| d.add_force(u0, u1, dt, f));
        }
        if !self.is_viscous {
            return;
        }
        let mut own = vec![Vector::zeros(); f.len()];
        self.dashpots.iter().for_each(|d| d.add_force(u0, u1, dt, &mut own));
        self.ranks.sum_up(&mut own);
        f.iter_mut().zip(&own).for_each(|(f, own)| *f += own);
    }

    /// The derivative of the viscous force by the velocities [N s/m] at `u`, if there is any viscosity.
    #[must_use]
    pub fn viscosity(&self, u: &[Vector<D>]) -> Option<NodalMatrix<Matrix<D>>> {
        if self.dashpots.is_empty() {
            return None;
        }
        let mut c = self.no_stiffness();
        self.dashpots.iter().for_each(|d| d.add_damping(u, &mut c));
        Some(c)
    }

    /// Whether the body can turn without storing energy, so that angular momentum can be conserved.
    #[must_use]
    pub fn turns(&self) -> bool {
        self.turns
    }
}

/// The nodes on the line x = 0, ascending.
fn axis<const D: usize>(mesh: &Mesh<D>) -> Vec<u32> {
    let limit = ON_THE_AXIS * mesh.diameter();
    (0..mesh.nodes().len() as u32).filter(|&n| mesh.nodes()[n as usize][0] <= limit).collect()
}

/// What the body is in space.
fn depth<const D: usize>(mesh: &Mesh<D>, spec: &BodySpec) -> Result<Depth, FemError> {
    match spec.hypothesis {
        Hypothesis::PlaneStrain => Ok(Depth::Thickness(spec.thickness)),
        Hypothesis::PlaneStress if D == 2 => Ok(Depth::Thickness(spec.thickness)),
        Hypothesis::Axisymmetric if D == 2 => {
            let limit = -ON_THE_AXIS * mesh.diameter();
            match mesh.nodes().iter().position(|x| x[0] < limit) {
                Some(node) => {
                    let at = mesh.nodes()[node].iter().copied().collect();
                    Err(FemError::NegativeRadius { node, at })
                }
                None => Ok(Depth::Revolution),
            }
        }
        Hypothesis::PlaneStress => Err(FemError::Hypothesis { name: "plane-stress" }),
        Hypothesis::Axisymmetric => Err(FemError::Hypothesis { name: "axisymmetric" }),
    }
}

/// The mass matrix on the graph of the body.
fn mass_matrix<const D: usize>(
    mesh: &Mesh<D>,
    whole: &Arc<NodeGraph>,
    surface: &Surface,
    spec: &BodySpec,
    depth: Depth,
) -> Result<(NodalMatrix<f64>, Vec<f64>), FemError> {
    let ranks = spec.share.as_ref().map(|share| &share.ranks);
    let graph = match &spec.share {
        None => Arc::clone(whole),
        Some(share) => Arc::new(NodeGraph::of_cells(mesh, |cell| share.owns[cell])),
    };
    let points: &[PointMass] = if ranks.is_none_or(|ranks| ranks.is_first()) { &spec.points } else { &[] };
    let mut mass = NodalMatrix::filled(&graph, 0.0);
    for_each_piece(mesh, depth, spec, |cells, spec| {
        if spec.mass == MassKind::Lumped && cells.block.kind.is_quadratic() {
            add_scaled_diagonal_mass(cells, spec.density, &mut mass)
        } else {
            add_mass(cells, spec.density, &mut mass)
        }
    })?;
    if spec.mass == MassKind::Lumped {
        let sums = mass.row_sums();
        for node in 0..graph.node_count() {
            for (entry, neighbour) in graph.row(node) {
                mass.values[entry] = if neighbour == node { sums[node] } else { 0.0 };
            }
        }
    }
    if !spec.massless_contact {
        return Ok((with_points(mass, points), Vec::new()));
    }
    let sizes = mass.row_sizes();
    let mut moved: Vec<f64> = surface.nodes().iter().map(|&n| sizes[n as usize]).collect();
    ranks.iter().for_each(|ranks| ranks.sum(&mut moved));
    let followers = followers(mesh, whole, surface)?;
    Ok((redistributed(&with_points(mass, points), surface.nodes(), &followers), moved))
}

/// The numbers of the cells of all ranks in the order of the elements; none if that is their order.
fn numbers_in_order<const D: usize>(
    mesh: &Mesh<D>,
    depth: Depth,
    spec: &BodySpec,
) -> Result<Vec<u32>, FemError> {
    let mut numbers = Vec::new();
    for_each_piece(mesh, depth, &BodySpec { share: None, ..spec.clone() }, |cells, _| {
        numbers.extend_from_slice(cells.numbers);
        Ok(())
    })?;
    Ok(numbers)
}
