//! How a body is made: of its cells pieces of one material, its mass, and what it is held by.

use std::sync::Arc;

use carom_mesh::compiled;
use carom_mesh::{Matrix, Mesh, Surface, Vector};

use super::Body;
use crate::composition::{for_each_piece, laws, materials_of};
use crate::elements::{Past, add_mass, add_scaled_diagonal_mass, dashpots, elements};
use crate::held::{Held, HeldDof};
use crate::massless::{followers, redistributed};
use crate::material::Mat3;
use crate::point_mass::with_points;
use crate::shape_table::Depth;
use crate::sparse::{NodalMatrix, NodeGraph};
use crate::{BodySpec, FemError, Hypothesis, MassKind, PointMass};

/// A node whose radius is below this, relative to the size of the body, is on the axis.
const ON_THE_AXIS: f64 = 1e-9;

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

    /// The nodes, ascending, that lie on the axis of a body of revolution: they have no radial displacement.
    #[must_use]
    pub fn axis_nodes(&self) -> Vec<u32> {
        if self.is_axisymmetric() { axis(&self.mesh) } else { Vec::new() }
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
