//! The contact patch test (Taylor & Papadopoulos 1991): two blocks whose meshes do not match, pressed together, carry a uniform
//! stress. Mortar rows pass it to round-off, node to segment does not.
//!
//! The upper block is pushed down by δ, the lower rests on rollers, both may expand sideways from rollers at x = 0 (and y = 0), and
//! nothing rubs. The exact solution is uniaxial stress: −E δ/2h for blocks of height h = 1, with E/(1 − ν²) in plane strain.

use carom_contact::{ContactModel, ContactSurface, Discretisation, Pair, Path, Search, Target};
use carom_fem::material::{ElasticConstants, LawSpec, Mat3, Viscosity};
use carom_fem::{Body, BodySpec, Formulation, Hypothesis, MassKind, RayleighDamping};
use carom_friction::{BlockMatrix, ContactProblem, Criterion, SolverKind, StoppingRule};
use carom_mesh::{CellBlock, CellKind, Mesh, Vector, generate};
use nalgebra::{DMatrix, DVector};

const YOUNG: f64 = 1000.0;
const POISSON: f64 = 0.3;
/// How far the upper block is pushed down [m].
const PUSH: f64 = 0.01;

/// The stress of the exact solution [Pa] per area of the reference configuration, and how much that expands along a side.
fn exact_stress(dimension: usize) -> (f64, f64) {
    let strain = -0.5 * PUSH;
    if dimension == 2 {
        (strain * YOUNG / (1.0 - POISSON * POISSON), 1.0 - strain * POISSON / (1.0 - POISSON))
    } else {
        (strain * YOUNG, 1.0 - strain * POISSON)
    }
}

fn body<const D: usize>(mesh: Mesh<D>) -> Body<D> {
    let spec = BodySpec {
        law: LawSpec::LinearElastic(ElasticConstants { young: YOUNG, poisson: POISSON }),
        density: 1.0,
        damping: RayleighDamping::default(),
        viscosity: Viscosity::default(),
        regions: Vec::new(),
        mass: MassKind::Consistent,
        hypothesis: Hypothesis::PlaneStrain,
        formulation: Formulation::Standard,
        thickness: 1.0,
        initial_stress: Mat3::zeros(),
        grows: false,
        points: Vec::new(),
        massless_contact: false,
        share: None,
    };
    Body::new(mesh, &spec).expect("valid")
}

/// The upper and the lower block.
struct Blocks<const D: usize> {
    bodies: [Body<D>; 2],
    /// Loads on the lower block [N].
    load: Vec<Vector<D>>,
}

impl<const D: usize> Blocks<D> {
    fn new(upper: Mesh<D>, lower: Mesh<D>) -> Self {
        let load = vec![Vector::zeros(); lower.nodes().len()];
        Self { bodies: [body(upper), body(lower)], load }
    }

    fn positions(&self) -> Vec<Vector<D>> {
        self.bodies.iter().flat_map(|b| b.mesh().nodes().iter().copied()).collect()
    }

    /// The largest deviation of a component of a cell's stress from the exact solution, relative to that.
    ///
    /// `sources` are the blocks whose nodes or multipliers are checked: 0 for the upper.
    fn stress_error(&self, sources: &[usize], discretisation: Discretisation) -> f64 {
        let x = self.positions();
        let upper = self.bodies[0].node_count();
        let first_node = [0, upper as u32];
        let at = |n: u32| x[n as usize];
        let surfaces = self.bodies.iter().zip(first_node);
        let surfaces = surfaces.map(|(b, n)| ContactSurface::new(b.surface(), n, &at));
        let pairs = sources.iter().map(|&source| {
            let target = Target::Surface(1 - source);
            Pair { source, target, friction: 0.0, discretisation }
        });
        let pairs = pairs.collect::<Vec<Pair>>().into();
        let model = ContactModel::<D> { surfaces: surfaces.collect(), obstacles: vec![], pairs };
        let (stiffness, load, prescribed) = self.system();
        let factor = stiffness.lu();
        let free = factor.solve(&load).expect("regular");
        let mut u = DVector::zeros(load.len());
        let (mut search, mut candidates, mut contacts) = (Search::default(), Vec::new(), Vec::new());
        // As in a step, the facets that may touch are found once.
        let start = |n: u32| x[n as usize];
        model.detect(&Path::resting(&start, 2.0 * PUSH), &mut search, &mut candidates);
        let mut change = f64::INFINITY;
        for _ in 0..50 {
            let at = |n: u32| x[n as usize] + node::<D>(&u, n as usize);
            candidates.retain(|c| !c.redundant);
            model.evaluate_all(&candidates, &at, &mut search.mortar, &mut contacts);
            assert!(!contacts.is_empty());
            // Hᵀ with D columns per contact.
            let mut rows = DMatrix::zeros(load.len(), D * contacts.len());
            for (c, contact) in contacts.iter().enumerate() {
                for (n, weight) in contact.stencil() {
                    for (i, k) in (0..D).flat_map(|i| (0..D).map(move |k| (i, k))) {
                        rows[(n * D + i, c * D + k)] += weight * contact.frame[(k, i)];
                    }
                }
            }
            prescribed.iter().for_each(|&i| rows.row_mut(i).fill(0.0));
            let compliance = factor.solve(&rows).expect("regular");
            let delassus = rows.tr_mul(&compliance);
            let (mut w, mut q) = (BlockMatrix::<D>::default(), Vec::new());
            for (c, contact) in contacts.iter().enumerate() {
                w.push_row(
                    (0..contacts.len()).map(|k| (k, delassus.fixed_view::<D, D>(c * D, k * D).into())),
                );
                let mut motion = contact.relative(|n| node::<D>(&free, n));
                motion[0] += contact.gap - contact.relative(|n| node::<D>(&u, n))[0];
                q.push(motion);
            }
            let problem = ContactProblem { w, q, mu: vec![0.0; contacts.len()] };
            let mut reactions = vec![Vector::zeros(); contacts.len()];
            let rule =
                StoppingRule { tolerance: 1e-14, criterion: Criterion::Natural, ..StoppingRule::default() };
            SolverKind::Proximal.solver().solve(&problem, &mut reactions, &rule);
            assert!(carom_friction::measure(&problem, &reactions).natural_residual < 1e-12);
            let r =
                DVector::from_iterator(D * contacts.len(), reactions.iter().flat_map(|r| r.iter().copied()));
            let next = &free + &compliance * r;
            change = (&next - &u).amax();
            u = next;
            if change < 1e-15 {
                break;
            }
        }
        assert!(change < 1e-14, "{discretisation:?}: the iterations end: {change:e}");
        let (nominal, stretch) = exact_stress(D);
        let exact = nominal / stretch.powi(D as i32 - 1);
        let mut error: f64 = 0.0;
        for (b, first) in self.bodies.iter().zip(first_node) {
            let own: Vec<_> = (0..b.node_count()).map(|n| node::<D>(&u, first as usize + n)).collect();
            for cell in b.cell_states(&own) {
                for (i, k) in (0..D).flat_map(|i| (0..D).map(move |k| (i, k))) {
                    let expected = if i == D - 1 && k == D - 1 { exact } else { 0.0 };
                    error = error.max((cell.stress[(i, k)] - expected).abs() / exact.abs());
                }
            }
        }
        error
    }

    /// K and the load, with the prescribed displacements as equations of their own, and the numbers of these.
    fn system(&self) -> (DMatrix<f64>, DVector<f64>, Vec<usize>) {
        let x = self.positions();
        let mut stiffness = DMatrix::zeros(x.len() * D, x.len() * D);
        let mut load = DVector::zeros(x.len() * D);
        let mut first = 0;
        for b in &self.bodies {
            let k = b.stiffness(&vec![Vector::zeros(); b.node_count()]);
            for a in 0..b.node_count() {
                for (entry, c) in b.graph().row(a) {
                    let block = k.values[entry];
                    let mut view = stiffness.fixed_view_mut::<D, D>((first + a) * D, (first + c) * D);
                    view.copy_from(&block);
                }
            }
            first += b.node_count();
        }
        let upper = self.bodies[0].node_count();
        for (n, f) in self.load.iter().enumerate() {
            (0..D).for_each(|i| load[(upper + n) * D + i] = f[i]);
        }
        let mut rows = Vec::new();
        for (n, x) in x.iter().enumerate() {
            for i in 0..D {
                let is_end = i == D - 1;
                let prescribed = match x[i] {
                    x if !is_end && x.abs() < 1e-12 => Some(0.0),
                    x if is_end && (x - 1.0).abs() < 1e-12 => Some(-PUSH),
                    x if is_end && (x + 1.0).abs() < 1e-12 => Some(0.0),
                    _ => None,
                };
                if let Some(value) = prescribed {
                    stiffness.row_mut(n * D + i).fill(0.0);
                    stiffness[(n * D + i, n * D + i)] = 1.0;
                    load[n * D + i] = value;
                    rows.push(n * D + i);
                }
            }
        }
        (stiffness, load, rows)
    }
}

fn node<const D: usize>(u: &DVector<f64>, n: usize) -> Vector<D> {
    Vector::from_fn(|i, _| u[n * D + i])
}

/// The mesh of tetrahedra with the same nodes: six along a diagonal of every cube (Kuhn).
fn tetrahedra(mesh: &Mesh<3>) -> Mesh<3> {
    const CORNER: [usize; 8] = [0, 1, 3, 2, 4, 5, 7, 6];
    let mut connectivity = Vec::new();
    for cell in mesh.blocks()[0].cells() {
        for [i, j, k] in [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]] {
            let path = [0, 1 << i, (1 << i) | (1 << j), (1 << i) | (1 << j) | (1 << k)];
            let mut tet = path.map(|bits: usize| cell[CORNER[bits]]);
            let x = tet.map(|n| mesh.nodes()[n as usize]);
            if (x[1] - x[0]).cross(&(x[2] - x[0])).dot(&(x[3] - x[0])) < 0.0 {
                tet.swap(2, 3);
            }
            connectivity.extend(tet);
        }
    }
    Mesh::new(mesh.nodes().to_vec(), vec![CellBlock { kind: CellKind::Tet4, connectivity }]).expect("valid")
}

/// The mesh of quadratic cells of this kind with the corners of the cells of `mesh`.
fn quadratic<const D: usize>(mesh: &Mesh<D>, kind: CellKind) -> Mesh<D> {
    let (mut nodes, mut connectivity) = (Vec::<Vector<D>>::new(), Vec::new());
    for block in mesh.blocks() {
        let mut shape = vec![0.0; block.kind.node_count()];
        for cell in block.cells() {
            for xi in kind.reference().nodes {
                (block.kind.reference().shape)(xi, &mut shape);
                let x =
                    shape.iter().zip(cell).map(|(n, &a)| mesh.nodes()[a as usize] * *n).sum::<Vector<D>>();
                let known = nodes.iter().position(|y| (x - y).norm() < 1e-9);
                connectivity.push(known.unwrap_or(nodes.len()) as u32);
                if known.is_none() {
                    nodes.push(x);
                }
            }
        }
    }
    Mesh::new(nodes, vec![CellBlock { kind, connectivity }]).expect("valid")
}

/// Both discretisations with either block as the source: mortar is exact, node to segment is off by more than `off`.
///
/// Nodes of both sides see a uniform pressure exactly where facets are straight lines, and better than those of one side elsewhere.
fn compare<const D: usize>(name: &str, blocks: &Blocks<D>, off: f64) {
    let mut one_side: f64 = 0.0;
    for source in [0, 1] {
        let mortar = blocks.stress_error(&[source], Discretisation::Mortar);
        let nodes = blocks.stress_error(&[source], Discretisation::NodeToSegment);
        println!("{name}, source {source}: stress error {mortar:.1e} mortar, {nodes:.1e} node to segment");
        assert!(mortar < 1e-10, "{name}, source {source}: {mortar:e}");
        assert!(nodes > off, "{name}, source {source}: {nodes:e}");
        one_side = one_side.max(nodes);
    }
    let both = blocks.stress_error(&[0, 1], Discretisation::NodeToSegment);
    println!("{name}, both sides: stress error {both:.1e} node to segment");
    let is_exact = ["quad4 on quad4", "tri3 on quad4", "tri3 on tri3"].contains(&name);
    assert!(both < if is_exact { 1e-12 } else { 0.35 * one_side }, "{name}, both sides: {both:e}");
}

#[test]
fn blocks_in_the_plane_carry_a_uniform_stress() {
    let upper = || generate::grid([0.0, 0.0], [1.0, 1.0], [3, 2]).expect("valid");
    let lower = || generate::grid([0.0, -1.0], [1.0, 1.0], [5, 2]).expect("valid");
    compare("quad4 on quad4", &Blocks::new(upper(), lower()), 1e-2);
    let triangles = |mesh: Mesh<2>| generate::triangulate(&mesh).expect("valid");
    compare("tri3 on quad4", &Blocks::new(triangles(upper()), lower()), 1e-2);
    compare("tri3 on tri3", &Blocks::new(triangles(upper()), triangles(lower())), 1e-2);
}

#[test]
fn blocks_in_space_carry_a_uniform_stress() {
    let upper = generate::grid([0.0; 3], [1.0; 3], [2, 3, 1]).expect("valid");
    let lower = generate::grid([0.0, 0.0, -1.0], [1.0; 3], [3, 2, 1]).expect("valid");
    compare("hex8 on hex8", &Blocks::new(upper.clone(), lower.clone()), 1e-2);
    compare("hex8 on tet4", &Blocks::new(upper.clone(), tetrahedra(&lower)), 1e-2);
    compare("tet4 on tet4", &Blocks::new(tetrahedra(&upper), tetrahedra(&lower)), 1e-2);
}

#[test]
fn blocks_of_quadratic_cells_carry_a_uniform_stress() {
    let upper = generate::grid([0.0, 0.0], [1.0, 1.0], [2, 1]).expect("valid");
    let lower = generate::grid([0.0, -1.0], [1.0, 1.0], [5, 1]).expect("valid");
    let triangles = |mesh: &Mesh<2>| generate::triangulate(mesh).expect("valid");
    let [quad8, quad9, tri6] = [CellKind::Quad8, CellKind::Quad9, CellKind::Tri6];
    compare("quad8 on quad4", &Blocks::new(quadratic(&upper, quad8), lower.clone()), 1e-3);
    compare("quad9 on quad8", &Blocks::new(quadratic(&upper, quad9), quadratic(&lower, quad8)), 1e-3);
    let lower = quadratic(&triangles(&lower), tri6);
    compare("tri6 on tri6", &Blocks::new(quadratic(&triangles(&upper), tri6), lower), 1e-3);
    let upper = generate::grid([0.0; 3], [1.0; 3], [1, 2, 1]).expect("valid");
    let lower = generate::grid([0.0, 0.0, -1.0], [1.0; 3], [2, 1, 1]).expect("valid");
    let [hex20, hex27, tet10] = [CellKind::Hex20, CellKind::Hex27, CellKind::Tet10];
    compare("hex20 on hex8", &Blocks::new(quadratic(&upper, hex20), lower.clone()), 1e-3);
    compare("hex27 on hex20", &Blocks::new(quadratic(&upper, hex27), quadratic(&lower, hex20)), 1e-3);
    let (upper, lower) = (quadratic(&tetrahedra(&upper), tet10), quadratic(&tetrahedra(&lower), tet10));
    compare("tet10 on tet10", &Blocks::new(upper, lower), 1e-3);
}

/// The lower block reaches beyond the upper, to x = 1.7, and bears the same pressure there as a load.
#[test]
fn a_wider_block_carries_a_uniform_stress() {
    const END: f64 = 1.7;
    /// ∫ of the hat function of the node k on the grid of `n` cells from 0 to `to`, from `from` on.
    fn hat(k: usize, n: usize, from: f64, to: f64) -> f64 {
        let h = to / n as f64;
        let at = k as f64 * h;
        // The hat is the difference of ramps; their integral from `from` to `to` is a half of squares.
        let ramp = |start: f64| {
            let square = |x: f64| 0.5 * (x - start).max(0.0).powi(2) / h;
            square(to) - square(from)
        };
        ramp(at - h) - 2.0 * ramp(at) + ramp(at + h)
    }
    let plane = generate::grid([0.0, -1.0], [END, 1.0], [5, 2]).expect("valid");
    let upper = generate::grid([0.0, 0.0], [1.0, 1.0], [3, 2]).expect("valid");
    let mut blocks = Blocks::new(upper, plane);
    for (f, x) in blocks.load.iter_mut().zip(blocks.bodies[1].mesh().nodes()) {
        if x[1].abs() < 1e-12 {
            f[1] = exact_stress(2).0 * hat((x[0] * 5.0 / END).round() as usize, 5, 1.0, END);
        }
    }
    compare("quad4 on wider quad4", &blocks, 1e-3);
    let space = generate::grid([0.0, 0.0, -1.0], [END, 1.0, 1.0], [4, 3, 1]).expect("valid");
    let upper = generate::grid([0.0; 3], [1.0; 3], [3, 2, 1]).expect("valid");
    let mut blocks = Blocks::new(upper, space);
    for (f, x) in blocks.load.iter_mut().zip(blocks.bodies[1].mesh().nodes()) {
        if x[2].abs() < 1e-12 {
            let along = hat((x[0] * 4.0 / END).round() as usize, 4, 1.0, END);
            f[2] = exact_stress(3).0 * along * hat((x[1] * 3.0).round() as usize, 3, 0.0, 1.0);
        }
    }
    compare("hex8 on wider hex8", &blocks, 1e-3);
}
