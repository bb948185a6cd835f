//! Every cell reproduces a constant strain exactly, whatever its shape, and its stiffness is the derivative of its force.

use std::collections::BTreeMap;

use carom_fem::material::{ElasticConstants, LawSpec, Viscosity};
use carom_fem::{Body, BodySpec, MassKind, RayleighDamping};
use carom_mesh::{CellBlock, CellKind, Matrix, Mesh, Vector, generate};

fn spec() -> BodySpec {
    BodySpec {
        law: LawSpec::SaintVenantKirchhoff(ElasticConstants { young: 2700.0, poisson: 0.33 }),
        density: 1.5,
        damping: RayleighDamping::default(),
        viscosity: Viscosity::default(),
        mass: MassKind::Consistent,
        thickness: 1.0,
        massless_contact: false,
    }
}

/// Moves interior nodes so that cells are distorted.
fn distorted<const D: usize>(mesh: &Mesh<D>) -> Mesh<D> {
    let nodes = mesh
        .nodes()
        .iter()
        .enumerate()
        .map(|(n, x)| {
            let inside = x.iter().all(|&c| c > 1e-9 && c < 1.0 - 1e-9);
            if inside { x + Vector::from_fn(|i, _| 0.05 * ((n * 7 + i * 3) as f64).sin()) } else { *x }
        })
        .collect();
    Mesh::new(nodes, mesh.blocks().to_vec()).expect("valid")
}

/// Each hexahedron cut in six tetrahedra around its diagonal.
fn tetrahedra(mesh: &Mesh<3>) -> Mesh<3> {
    let connectivity = mesh.blocks()[0]
        .cells()
        .flat_map(|c| {
            [[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]]
                .into_iter()
                .flat_map(|t: [usize; 4]| t.map(|k| c[k]))
                .collect::<Vec<u32>>()
        })
        .collect();
    Mesh::new(mesh.nodes().to_vec(), vec![CellBlock { kind: CellKind::Tet4, connectivity }]).expect("valid")
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

fn check<const D: usize>(mesh: Mesh<D>) {
    let kind = mesh.blocks()[0].kind;
    let body = Body::new(mesh, &spec()).expect("valid");
    assert!((body.volume() - 1.0).abs() < 1e-14);
    assert!((body.total_mass() - 1.5).abs() < 1e-14);
    let gradient = Matrix::<D>::from_fn(|i, j| 0.1 * ((3 * i + 2 * j + 1) as f64).sin());
    let u: Vec<Vector<D>> = body.mesh().nodes().iter().map(|x| gradient * x).collect();
    let mut f = vec![Vector::zeros(); u.len()];
    body.internal_force(&u, &mut f);
    for (force, x) in f.iter().zip(body.mesh().nodes()) {
        if x.iter().all(|&c| c > 1e-9 && c < 1.0 - 1e-9) {
            assert!(force.norm() < 1e-11, "{kind:?}: inner node out of balance by {} N", force.norm());
        }
    }
    let states = body.cell_states(&u);
    for state in &states {
        assert!((state.stress - states[0].stress).norm() < 1e-10, "{kind:?}: stress is not constant");
    }

    // K is the derivative of the force, at a state that is not homogeneous.
    let u: Vec<Vector<D>> = u
        .iter()
        .enumerate()
        .map(|(n, u)| u + Vector::from_fn(|i, _| 0.01 * ((n + i) as f64).cos()))
        .collect();
    let direction: Vec<Vector<D>> =
        (0..u.len()).map(|n| Vector::from_fn(|i, _| ((5 * n + i) as f64).sin())).collect();
    let mut product = vec![Vector::zeros(); u.len()];
    body.stiffness(&u).multiply(&direction, &mut product);
    let h = 1e-6;
    let at = |s: f64| {
        let moved: Vec<Vector<D>> = u.iter().zip(&direction).map(|(u, d)| u + d * s).collect();
        let mut f = vec![Vector::zeros(); u.len()];
        body.internal_force(&moved, &mut f);
        (f, body.strain_energy(&moved))
    };
    let ((fp, ep), (fm, em)) = (at(h), at(-h));
    let (f, _) = at(0.0);
    let power: f64 = f.iter().zip(&direction).map(|(f, d)| f.dot(d)).sum();
    assert!(((ep - em) / (2.0 * h) - power).abs() < 1e-5 * power.abs().max(1.0), "{kind:?}");
    for n in 0..u.len() {
        assert!(((fp[n] - fm[n]) / (2.0 * h) - product[n]).norm() < 1e-4, "{kind:?} node {n}");
    }
}

#[test]
fn every_cell_passes_the_patch_test() {
    let square = distorted(&generate::grid([0.0; 2], [1.0; 2], [3, 3]).expect("valid"));
    let triangles = generate::triangulate(&square).expect("valid");
    check(quadratic(&triangles, CellKind::Tri6));
    check(quadratic(&square, CellKind::Quad8));
    check(quadratic(&square, CellKind::Quad9));
    check(triangles);
    check(square);
    let cube = distorted(&generate::grid([0.0; 3], [1.0; 3], [3, 3, 3]).expect("valid"));
    let cut = tetrahedra(&cube);
    check(quadratic(&cut, CellKind::Tet10));
    check(quadratic(&cube, CellKind::Hex20));
    check(quadratic(&cube, CellKind::Hex27));
    check(cut);
    check(cube);
}

/// Corners of quadratic cells have a lumped mass too, and no mass is lost.
#[test]
fn lumped_masses_are_positive_and_sum_to_that_of_the_body() {
    let lumped = BodySpec { mass: MassKind::Lumped, ..spec() };
    fn check<const D: usize>(mesh: Mesh<D>, spec: &BodySpec) {
        let body = Body::new(mesh, spec).expect("valid");
        assert!((body.total_mass() - 1.5).abs() < 1e-13);
        let least = body.nodal_mass().iter().copied().fold(f64::INFINITY, f64::min);
        assert!(least > 0.0, "{:?}: {least} kg", body.mesh().blocks()[0].kind);
        let middle = body.centre(&vec![Vector::zeros(); body.node_count()]);
        assert!((middle - Vector::from_element(0.5)).norm() < 1e-13);
    }
    let square = generate::grid([0.0; 2], [1.0; 2], [2, 2]).expect("valid");
    check(quadratic(&generate::triangulate(&square).expect("valid"), CellKind::Tri6), &lumped);
    check(quadratic(&square, CellKind::Quad8), &lumped);
    check(quadratic(&square, CellKind::Quad9), &lumped);
    check(square, &lumped);
    let cube = generate::grid([0.0; 3], [1.0; 3], [2, 2, 2]).expect("valid");
    check(quadratic(&tetrahedra(&cube), CellKind::Tet10), &lumped);
    check(quadratic(&cube, CellKind::Hex20), &lumped);
    check(quadratic(&cube, CellKind::Hex27), &lumped);
}

#[test]
fn the_frame_follows_a_rigid_rotation_and_spin_is_its_rate() {
    let disc = generate::Disc { centre: [2.0, 4.0], radius: 1.0, divisions: 4, rings: None };
    let body = Body::new(disc.quadrilaterals().expect("valid"), &spec()).expect("valid");
    let (c, s) = (2.1_f64.cos(), 2.1_f64.sin());
    let q = Matrix::<2>::new(c, -s, s, c);
    let u: Vec<Vector<2>> = body.mesh().nodes().iter().map(|x| q * x - x).collect();
    assert!((body.frame(&u) - q).norm() < 1e-13);
    let centre = body.centre(&u);
    let v: Vec<Vector<2>> = body
        .mesh()
        .nodes()
        .iter()
        .zip(&u)
        .map(|(x, u)| {
            Vector::<2>::new(3.0, 1.0) + Vector::<2>::new(-(x + u - centre)[1], (x + u - centre)[0]) * 0.7
        })
        .collect();
    assert!((body.spin(&u, &v)[2] - 0.7).abs() < 1e-13);
    let mut f = vec![Vector::zeros(); u.len()];
    body.internal_force(&u, &mut f);
    assert!(f.iter().all(|f| f.norm() < 1e-10), "a rigid rotation is free of force");
}

#[test]
fn damping_does_not_see_rigid_motion_of_a_turned_body_and_dissipates_any_other() {
    let damped = BodySpec { damping: RayleighDamping { mass: 0.0, stiffness: 1e-3 }, ..spec() };
    let body =
        Body::new(generate::grid([0.0; 2], [2.0, 1.0], [4, 2]).expect("valid"), &damped).expect("valid");
    let (c, s) = (0.8_f64.cos(), 0.8_f64.sin());
    let q = Matrix::<2>::new(c, -s, s, c);
    let u: Vec<Vector<2>> = body.mesh().nodes().iter().map(|x| q * x - x).collect();
    let rigid: Vec<Vector<2>> =
        body.mesh().nodes().iter().map(|x| Vector::<2>::new(-(q * x)[1], (q * x)[0])).collect();
    let (mut f, mut scratch) = (vec![Vector::zeros(); u.len()], vec![Vector::zeros(); u.len()]);
    body.damping_force(&body.frame(&u), &rigid, &mut f, &mut scratch);
    assert!(f.iter().all(|f| f.norm() < 1e-12));
    let shaking: Vec<Vector<2>> = (0..u.len()).map(|n| Vector::<2>::new((n as f64).sin(), 0.3)).collect();
    body.damping_force(&body.frame(&u), &shaking, &mut f, &mut scratch);
    assert!(f.iter().zip(&shaking).map(|(f, v)| f.dot(v)).sum::<f64>() > 0.0);
}

#[test]
fn an_inverted_or_flat_cell_is_named() {
    let nodes =
        [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [2.0, 0.0], [2.0, 1.0]].map(Vector::<2>::from);
    for (second, word) in [([1, 2, 5, 4], "inverted"), ([1, 4, 1, 4], "degenerate")] {
        let mut connectivity = vec![0, 1, 2, 3];
        connectivity.extend(second);
        let mut nodes = nodes.to_vec();
        if word == "degenerate" {
            nodes.pop();
        }
        let mesh =
            Mesh::new(nodes, vec![CellBlock { kind: CellKind::Quad4, connectivity }]).expect("consistent");
        let message = Body::new(mesh, &spec()).expect_err("bad cell").to_string();
        assert!(message.contains("cell 1") && message.contains(word), "{message}");
    }
}
