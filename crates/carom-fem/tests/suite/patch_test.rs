//! Every cell reproduces a constant strain exactly, whatever its shape; mass, frame and damping of a body.

use carom_fem::material::LawSpec;
use carom_fem::{Body, BodySpec, Formulation, Hypothesis, MassKind, RayleighDamping};
use carom_mesh::{CellBlock, CellKind, Matrix, Mesh, Vector, generate};

use crate::common::{PLANE, SPATIAL, distortion, elastic, grid};

fn spec() -> BodySpec {
    crate::common::spec(LawSpec::SaintVenantKirchhoff(elastic()))
}

fn check<const D: usize>(mesh: Mesh<D>, spec: &BodySpec) {
    let kind = mesh.blocks()[0].kind;
    let body = Body::new(mesh, spec).expect("valid");
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
        let strain = (gradient + gradient.transpose() + gradient.transpose() * gradient) * 0.5;
        for (i, j) in (0..D).flat_map(|i| (0..D).map(move |j| (i, j))) {
            assert!((state.strain[(i, j)] - strain[(i, j)]).abs() < 1e-12, "{kind:?}: strain");
        }
    }
}

#[test]
fn every_cell_passes_the_patch_test() {
    for formulation in [Formulation::Standard, Formulation::MeanDilatation] {
        let possible = |kind: &CellKind| {
            formulation == Formulation::Standard || matches!(kind, CellKind::Quad4 | CellKind::Hex8)
        };
        for kind in PLANE.into_iter().filter(possible) {
            for hypothesis in [Hypothesis::PlaneStrain, Hypothesis::PlaneStress] {
                if formulation == Formulation::Standard || hypothesis == Hypothesis::PlaneStrain {
                    check(grid::<2>(kind, 3, distortion), &BodySpec { hypothesis, formulation, ..spec() });
                }
            }
        }
        for kind in SPATIAL.into_iter().filter(possible) {
            check(grid::<3>(kind, 3, distortion), &BodySpec { formulation, ..spec() });
        }
    }
}

/// Corners of quadratic cells have a lumped mass too, and no mass is lost.
#[test]
fn lumped_masses_are_positive_and_sum_to_that_of_the_body() {
    fn check<const D: usize>(kind: CellKind) {
        let lumped = BodySpec { mass: MassKind::Lumped, ..spec() };
        let body = Body::new(grid::<D>(kind, 2, |x| x), &lumped).expect("valid");
        assert!((body.total_mass() - 1.5).abs() < 1e-13);
        let least = body.nodal_mass().iter().copied().fold(f64::INFINITY, f64::min);
        assert!(least > 0.0, "{kind:?}: {least} kg");
        let middle = body.centre(&vec![Vector::zeros(); body.node_count()]);
        assert!((middle - Vector::from_element(0.5)).norm() < 1e-13);
    }
    PLANE.into_iter().for_each(check::<2>);
    SPATIAL.into_iter().for_each(check::<3>);
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
