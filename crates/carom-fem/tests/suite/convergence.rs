//! Rates of convergence by manufactured solutions: a body force is made so that a smooth large displacement is in equilibrium, and
//! the error of the cells in it falls as h^(p+1), that of its gradient as h^p.

use std::sync::Arc;

use carom_fem::material::{LawSpec, PointLaw};
use carom_fem::{Body, BodySpec, Formulation, Hypothesis};
use carom_mesh::{CellKind, Matrix, Mesh, Vector, tensor};

use crate::common::{PLANE, SPATIAL, elastic, equilibrium, grid, spec};

/// Inner radius of bodies of revolution [m].
const RADIUS: f64 = 0.5;

/// u_i = a sin(k_i·X + i), with waves longer than the body.
fn displacement<const D: usize>(x: &Vector<D>) -> Vector<D> {
    Vector::from_fn(|i, _| 0.08 * (wave::<D>(i).dot(x) + i as f64).sin())
}

fn gradient<const D: usize>(x: &Vector<D>) -> Matrix<D> {
    Matrix::from_fn(|i, j| 0.08 * (wave::<D>(i).dot(x) + i as f64).cos() * wave::<D>(i)[j])
}

fn wave<const D: usize>(i: usize) -> Vector<D> {
    Vector::from_fn(|j, _| [[1.3, 0.9, -0.7], [-0.6, 1.1, 0.8], [0.8, -1.0, 1.2]][i][j])
}

/// P [Pa] at a point, in the S dimensions that the law sees.
fn stress<const D: usize, const S: usize>(law: &Arc<dyn PointLaw<S>>, x: &Vector<D>) -> Matrix<S> {
    let (u, h) = (displacement(x), gradient(x));
    law.stress(&Matrix::from_fn(|i, j| match (i < D && j < D, i == j) {
        (true, diagonal) => h[(i, j)] + f64::from(u8::from(diagonal)),
        (false, true) => 1.0 + u[0] / x[0],
        (false, false) => 0.0,
    }))
}

/// The body force −Div P [N/m³], by differences of fourth order.
fn body_force<const D: usize, const S: usize>(law: &Arc<dyn PointLaw<S>>, x: &Vector<D>) -> Vector<D> {
    let h = 1e-3;
    let mut divergence = Vector::<D>::zeros();
    for j in 0..D {
        let at = |s: f64| {
            let mut moved = *x;
            moved[j] += s * h;
            stress(law, &moved)
        };
        let slope = (at(-2.0) - at(-1.0) * 8.0 + at(1.0) * 8.0 - at(2.0)) / (12.0 * h);
        divergence += Vector::<D>::from_fn(|i, _| slope[(i, j)]);
    }
    if S > D {
        let p = stress(law, x);
        divergence += Vector::from_fn(|i, _| p[(i, 0)] - if i == 0 { p[(2, 2)] } else { 0.0 }) / x[0];
    }
    -divergence
}

/// Four Gauss points per direction; on simplices and wedges those of a square or cube, folded.
fn points(kind: CellKind) -> Vec<([f64; 3], f64)> {
    let line = [
        (-0.861_136_311_594_052_6, 0.347_854_845_137_453_9),
        (-0.339_981_043_584_856_3, 0.652_145_154_862_546_1),
        (0.339_981_043_584_856_3, 0.652_145_154_862_546_1),
        (0.861_136_311_594_052_6, 0.347_854_845_137_453_9),
    ];
    let d = kind.dimension();
    (0..4_usize.pow(d as u32))
        .map(|m| {
            let along: Vec<(f64, f64)> = (0..d as u32).map(|k| line[m / 4_usize.pow(k) % 4]).collect();
            let (mut xi, mut weight) = ([0.0; 3], 1.0);
            let mut rest = 1.0;
            for (k, (x, w)) in along.into_iter().enumerate() {
                if kind.is_simplex() || (kind.is_wedge() && k < 2) {
                    let s = 0.5 * (x + 1.0);
                    xi[k] = rest * s;
                    weight *= 0.5 * w * rest;
                    rest *= 1.0 - s;
                } else {
                    xi[k] = x;
                    weight *= w;
                }
            }
            (xi, weight)
        })
        .collect()
}

/// Norms of the error of `u` and of its gradient.
fn errors<const D: usize>(mesh: &Mesh<D>, u: &[Vector<D>]) -> [f64; 2] {
    let mut sums = [0.0; 2];
    let block = &mesh.blocks()[0];
    let count = block.kind.node_count();
    for (xi, weight) in points(block.kind) {
        let (mut n, mut g) = (vec![0.0; count], vec![[0.0; 3]; count]);
        (block.kind.reference().shape)(&xi, &mut n);
        (block.kind.reference().gradient)(&xi, &mut g);
        for nodes in block.cells() {
            let (mut x, mut value) = (Vector::<D>::zeros(), Vector::<D>::zeros());
            let (mut jacobian, mut slope) = (Matrix::<D>::zeros(), Matrix::<D>::zeros());
            for (a, &node) in nodes.iter().enumerate() {
                let (at, u) = (mesh.nodes()[node as usize], u[node as usize]);
                let local = Vector::<D>::from_fn(|j, _| g[a][j]).transpose();
                x += at * n[a];
                value += u * n[a];
                jacobian += at * local;
                slope += u * local;
            }
            let (inverse, det) = tensor::inverse(&jacobian);
            sums[0] += weight * det * (value - displacement(&x)).norm_squared();
            sums[1] += weight * det * (slope * inverse - gradient(&x)).norm_squared();
        }
    }
    sums.map(f64::sqrt)
}

fn solve<const D: usize>(spec: &BodySpec, kind: CellKind, divisions: usize) -> [f64; 2] {
    let skewed = |x: Vector<D>| {
        let mut y = x;
        y[0] += RADIUS + 0.2 * x[1];
        y
    };
    let body = Body::new(grid::<D>(kind, divisions, skewed), spec).expect("valid");
    let nodes = body.mesh().nodes();
    let forces: Vec<Vector<D>> = match spec.hypothesis {
        Hypothesis::Axisymmetric => {
            let law = spec.law.point_law::<3>(spec.hypothesis).expect("valid");
            nodes.iter().map(|x| body_force(&law, x) / spec.density).collect()
        }
        _ => {
            let law = spec.law.point_law::<D>(spec.hypothesis).expect("valid");
            nodes.iter().map(|x| body_force(&law, x) / spec.density).collect()
        }
    };
    let mut load = vec![Vector::zeros(); nodes.len()];
    body.mass().multiply(&forces, &mut load);
    let on_boundary = |n: usize| body.surface().nodes().binary_search(&(n as u32)).is_ok();
    let mut u: Vec<Vector<D>> = nodes.iter().map(displacement).collect();
    equilibrium(&body, &load, |n, _| on_boundary(n), &mut u);
    errors(body.mesh(), &u)
}

fn check<const D: usize>(spec: &BodySpec, kind: CellKind) {
    let divisions = if D == 2 { 6 } else { 3 };
    let (coarse, fine) = (solve::<D>(spec, kind, divisions), solve::<D>(spec, kind, 2 * divisions));
    let rates: [f64; 2] = std::array::from_fn(|k| (coarse[k] / fine[k]).log2());
    let degree = kind.reference().degree as f64;
    println!(
        "{:>6} {:?} {:?}: rates {:.3} of u, {:.3} of its gradient; errors {:.2e} m, {:.2e}",
        kind.reference().name,
        spec.hypothesis,
        spec.formulation,
        rates[0],
        rates[1],
        fine[0],
        fine[1]
    );
    assert!((rates[0] - degree - 1.0).abs() < 0.2, "{kind:?} {spec:?}: {rates:?}");
    assert!((rates[1] - degree).abs() < 0.15, "{kind:?} {spec:?}: {rates:?}");
}

fn rubber() -> BodySpec {
    spec(LawSpec::NeoHookean(elastic()))
}

#[test]
fn plane_cells_converge_at_their_rates() {
    for kind in PLANE {
        for hypothesis in [Hypothesis::PlaneStrain, Hypothesis::PlaneStress, Hypothesis::Axisymmetric] {
            check::<2>(&BodySpec { hypothesis, ..rubber() }, kind);
        }
    }
}

#[test]
fn spatial_cells_converge_at_their_rates() {
    for kind in SPATIAL {
        check::<3>(&rubber(), kind);
    }
}

#[test]
fn cells_of_mean_dilatation_converge_at_their_rates() {
    let formulation = Formulation::MeanDilatation;
    for hypothesis in [Hypothesis::PlaneStrain, Hypothesis::Axisymmetric] {
        check::<2>(&BodySpec { hypothesis, formulation, ..rubber() }, CellKind::Quad4);
    }
    check::<3>(&BodySpec { formulation, ..rubber() }, CellKind::Hex8);
}
