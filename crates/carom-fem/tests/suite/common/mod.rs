//! Meshes of every cell and static solutions on them, for the tests of this crate.

use std::collections::BTreeMap;

use carom_fem::material::{ElasticConstants, LawSpec, Mat3, Viscosity};
use carom_fem::sparse::{Factor, Precision};
use carom_fem::{Body, BodySpec, Formulation, Hypothesis, MassKind, RayleighDamping};
use carom_mesh::{CellBlock, CellKind, Matrix, Mesh, Vector, generate};

/// The cells of 2D bodies.
pub const PLANE: [CellKind; 5] =
    [CellKind::Tri3, CellKind::Tri6, CellKind::Quad4, CellKind::Quad8, CellKind::Quad9];
/// The cells of 3D bodies.
pub const SPATIAL: [CellKind; 7] = [
    CellKind::Tet4,
    CellKind::Tet10,
    CellKind::Hex8,
    CellKind::Hex20,
    CellKind::Hex27,
    CellKind::Wedge6,
    CellKind::Wedge15,
];

/// A plain body of this law.
pub fn spec(law: LawSpec) -> BodySpec {
    BodySpec {
        law,
        density: 1.5,
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
    }
}

pub fn elastic() -> ElasticConstants {
    ElasticConstants { young: 2700.0, poisson: 0.33 }
}

/// A box from the origin of `divisions` cells in every direction, cut in simplices or wedges or given more nodes as `kind` needs.
pub fn grid<const D: usize>(
    kind: CellKind,
    divisions: usize,
    place: impl Fn(Vector<D>) -> Vector<D>,
) -> Mesh<D> {
    let mesh = generate::grid([0.0; D], [1.0; D], [divisions; D]).expect("valid");
    let nodes = mesh.nodes().iter().map(|x| place(*x)).collect();
    let cut: &[&[usize]] = match kind {
        CellKind::Tri3 | CellKind::Tri6 => &[&[0, 1, 2], &[0, 2, 3]],
        CellKind::Tet4 | CellKind::Tet10 => {
            &[&[0, 1, 2, 6], &[0, 2, 3, 6], &[0, 3, 7, 6], &[0, 7, 4, 6], &[0, 4, 5, 6], &[0, 5, 1, 6]]
        }
        CellKind::Wedge6 | CellKind::Wedge15 => &[&[0, 1, 2, 4, 5, 6], &[0, 2, 3, 4, 6, 7]],
        CellKind::Hex8 | CellKind::Hex20 | CellKind::Hex27 => &[&[0, 1, 2, 3, 4, 5, 6, 7]],
        _ => &[&[0, 1, 2, 3]],
    };
    let linear = match cut[0].len() {
        3 => CellKind::Tri3,
        6 => CellKind::Wedge6,
        8 => CellKind::Hex8,
        _ if D == 3 => CellKind::Tet4,
        _ => CellKind::Quad4,
    };
    let connectivity = mesh.blocks()[0]
        .cells()
        .flat_map(|c| cut.iter().flat_map(|part| part.iter().map(|&k| c[k])))
        .collect();
    let mesh = Mesh::new(nodes, vec![CellBlock { kind: linear, connectivity }]).expect("valid");
    if kind == linear { mesh } else { quadratic(&mesh, kind) }
}

/// The same cells with the nodes of `kind`: on the middles of edges, sides and cells as these need.
fn quadratic<const D: usize>(mesh: &Mesh<D>, kind: CellKind) -> Mesh<D> {
    let linear = mesh.blocks()[0].kind;
    let mut nodes = mesh.nodes().to_vec();
    let mut middles: BTreeMap<Vec<u32>, u32> = BTreeMap::new();
    let mut connectivity = Vec::new();
    for cell in mesh.blocks()[0].cells() {
        for xi in kind.reference().nodes {
            let mut weights = [0.0; 8];
            (linear.reference().shape)(xi, &mut weights[..cell.len()]);
            let mut corners: Vec<u32> =
                cell.iter().zip(weights).filter(|(_, w)| *w > 0.0).map(|(&n, _)| n).collect();
            corners.sort_unstable();
            let middle = || {
                nodes.push(cell.iter().zip(weights).map(|(&n, w)| nodes[n as usize] * w).sum());
                nodes.len() as u32 - 1
            };
            let node = if let [corner] = corners[..] {
                corner
            } else {
                *middles.entry(corners).or_insert_with(middle)
            };
            connectivity.push(node);
        }
    }
    Mesh::new(nodes, vec![CellBlock { kind, connectivity }]).expect("valid")
}

/// Moves what is inside the unit box, so that cells are distorted.
pub fn distortion<const D: usize>(x: Vector<D>) -> Vector<D> {
    let inside = x.iter().all(|&c| c > 1e-9 && c < 1.0 - 1e-9);
    let phase = x.iter().enumerate().map(|(i, c)| (3.0 + i as f64) * c).sum::<f64>();
    if inside { x + Vector::from_fn(|i, _| 0.05 * (7.0 * phase + 3.0 * i as f64).sin()) } else { x }
}

/// Displacements that know no pattern, of at most `size` [m].
pub fn shaken<const D: usize>(nodes: usize, size: f64, seed: f64) -> Vec<Vector<D>> {
    (0..nodes)
        .map(|n| Vector::from_fn(|i, _| size * (seed + 5.3 * n as f64 + 2.1 * i as f64).sin()))
        .collect()
}

/// Newton's iteration for K(u) du = load − f(u), where the components of the displacement that `fixed` tells of stay as they
/// are in `u`.
///
/// # Panics
/// If it does not converge.
pub fn equilibrium<const D: usize>(
    body: &Body<D>,
    load: &[Vector<D>],
    fixed: impl Fn(usize, usize) -> bool,
    u: &mut [Vector<D>],
) {
    let mut factor = Factor::<D>::new(body.graph(), &[], &[]).expect("ordered");
    let mut ends = vec![(0, 0); body.graph().entry_count()];
    for row in 0..u.len() {
        body.graph().row(row).for_each(|(entry, column)| ends[entry] = (row, column));
    }
    let mut residual = vec![Vector::zeros(); u.len()];
    let scale = body.mesh().diameter();
    for _ in 0..30 {
        body.internal_force(u, &mut residual);
        for (n, (r, load)) in residual.iter_mut().zip(load).enumerate() {
            *r = Vector::from_fn(|i, _| if fixed(n, i) { 0.0 } else { load[i] - r[i] });
        }
        let stiffness = body.stiffness(u);
        factor
            .factorize(Precision::Double, |entry| {
                let (a, b) = ends[entry];
                Matrix::from_fn(|i, k| match (fixed(a, i) || fixed(b, k), a == b && i == k) {
                    (true, diagonal) => f64::from(u8::from(diagonal)),
                    (false, _) => stiffness.values[entry][(i, k)],
                })
            })
            .expect("positive definite");
        factor.solve(&mut residual);
        u.iter_mut().zip(&residual).for_each(|(u, du)| *u += du);
        if residual.iter().all(|du| du.norm() < 1e-11 * scale) {
            return;
        }
    }
    panic!("no equilibrium after 30 iterations");
}
