//! What impulses make of velocities: M Δv = p for every cell and both mass matrices, where displacements are held and where nodes are tied.

use carom_fem::material::LawSpec;
use carom_fem::{Body, BodySpec, HeldDof, MassKind, MassSolver};
use carom_mesh::{CellKind, Mesh, Vector, nodal, parallel};

use crate::common::{PLANE, SPATIAL, distortion, elastic, grid, shaken, spec};

fn body<const D: usize>(mesh: Mesh<D>, mass: MassKind) -> Body<D> {
    let spec = BodySpec { mass, ..spec(LawSpec::SaintVenantKirchhoff(elastic())) };
    Body::new(mesh, &spec).expect("valid")
}

/// Largest component of M Δv − p where a node is free, relative to the largest impulse.
fn lack<const D: usize>(body: &Body<D>) -> f64 {
    lack_of(body, shaken::<D>(body.node_count(), 1.0, 0.3))
}

fn lack_of<const D: usize>(body: &Body<D>, impulse: Vec<Vector<D>>) -> f64 {
    let (mut change, mut momentum) = (vec![Vector::zeros(); body.node_count()], impulse.clone());
    MassSolver::default().solve(body, &impulse, &mut change);
    assert!(body.held().dofs().iter().all(|d| change[d.node as usize][d.component as usize] == 0.0));
    body.mass().multiply(&change, &mut momentum);
    let mut lack: Vec<Vector<D>> = momentum.iter().zip(&impulse).map(|(m, p)| m - p).collect();
    for tie in body.mesh().ties() {
        assert_eq!(change[tie.image as usize], change[tie.master as usize]);
        let at_image = std::mem::replace(&mut lack[tie.image as usize], Vector::zeros());
        lack[tie.master as usize] += at_image;
    }
    body.held().clear(&mut lack);
    nodal::largest(&lack)
}

fn every_cell<const D: usize>(kinds: &[CellKind]) {
    for kind in kinds {
        for mass in [MassKind::Consistent, MassKind::Lumped] {
            let mut body = body(grid::<D>(*kind, 3, distortion), mass);
            let free = lack(&body);
            body.hold((0..D as u8).map(|component| HeldDof { node: u32::from(component), component }));
            let held = lack(&body);
            assert!(free.max(held) < 1e-11, "{kind:?}, {mass:?}: {free:e} free, {held:e} held");
        }
    }
}

#[test]
fn impulses_are_the_momenta_that_they_make() {
    every_cell::<2>(&PLANE);
    every_cell::<3>(&SPATIAL);
}

/// A blow is looked at as far as it is felt, beside supports that are farther away too, and nothing is left of the blow before.
#[test]
fn a_blow_goes_no_farther_than_it_is_felt() {
    let cells = 120;
    let mut body = body(grid::<2>(CellKind::Quad4, cells, |x| x), MassKind::Consistent);
    let nodes = body.node_count();
    body.hold([nodes as u32 - 1, nodes as u32 / 2 + 3].map(|node| HeldDof { node, component: 1 }));
    let blow = |node: usize| {
        let mut impulse = vec![Vector::zeros(); nodes];
        impulse[node] = Vector::<2>::new(0.3, -1.0);
        impulse
    };
    let solved = |solver: &mut MassSolver<2>, impulse: &[Vector<2>]| {
        let mut change = vec![Vector::zeros(); nodes];
        solver.solve(&body, impulse, &mut change);
        change
    };
    let mut solver = MassSolver::default();
    for node in [0, nodes / 2] {
        assert!(lack_of(&body, blow(node)) < 1e-12, "node {node}");
        let change = solved(&mut solver, &blow(node));
        assert_eq!(change, solved(&mut MassSolver::default(), &blow(node)), "node {node}");
        let felt = change.iter().filter(|v| v.amax() > 0.0).count();
        assert!(felt > 500 && felt < nodes / 2, "node {node}: {felt} of {nodes}");
    }
}

/// Threads share what is felt by many nodes.
#[test]
fn any_number_of_threads_comes_to_the_same_bits() {
    let mut body = body(grid::<2>(CellKind::Quad4, 140, |x| x), MassKind::Consistent);
    body.hold([HeldDof { node: 5, component: 0 }]);
    assert!(body.node_count() > parallel::MANY);
    let impulse = shaken::<2>(body.node_count(), 1.0, 0.3);
    let solved = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let mut change = impulse.clone();
        pool.install(|| MassSolver::default().solve(&body, &impulse, &mut change));
        change
    };
    assert!(lack_of(&body, impulse.clone()) < 1e-11);
    assert_eq!(solved(1), solved(3));
}

/// A blow that all of a small body feels has the momentum of all.
#[test]
fn a_blow_on_a_node_is_felt_around_it() {
    for kind in [CellKind::Hex8, CellKind::Tet4] {
        let mesh = grid::<3>(kind, 14, |x| x + (distortion(x) - x) * 0.2);
        let body = body(mesh, MassKind::Consistent);
        for node in [0, body.node_count() / 2] {
            let mut impulse = vec![Vector::zeros(); body.node_count()];
            impulse[node] = Vector::<3>::new(0.3, -1.0, 0.7);
            let lack = lack_of(&body, impulse);
            assert!(lack < 1e-12, "{kind:?}, node {node}: {lack:e}");
        }
    }
}
