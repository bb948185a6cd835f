//! Reduced bodies against the whole: frequencies, and what is read from few nodes.

use carom_fem::material::LawSpec;
use carom_fem::{Body, Content, Reduction};
use carom_mesh::{CellKind, Matrix, Mesh, Surface, Vector, tensor};
use nalgebra::{DMatrix, SymmetricEigen};

use crate::common::{elastic, grid, spec};

/// A beam, or a plate in space, whose lower side may touch.
fn beam<const D: usize>(kind: CellKind, divisions: usize) -> Body<D> {
    let mesh: Mesh<D> = grid(kind, divisions, |mut x| {
        x[0] *= 4.0;
        x
    });
    let bottom = Surface::of(&mesh).part(|facet| {
        facet
            .nodes
            .iter()
            .all(|&n| mesh.nodes()[n as usize][D - 1] == 0.0 && mesh.nodes()[n as usize][0] < 1.4)
    });
    Body::with_contact_surface(mesh, bottom, &spec(LawSpec::SaintVenantKirchhoff(elastic()))).expect("valid")
}

/// ω² of all free vibrations of the mesh, ascending, rigid motions included.
fn all<const D: usize>(body: &Body<D>) -> Vec<f64> {
    let n = body.node_count();
    let still = vec![Vector::zeros(); n];
    let k = body.stiffness(&still);
    let block = |a: usize, b: usize| k.graph().find(a as u32, b as u32);
    let stiffness = DMatrix::from_fn(n * D, n * D, |r, c| {
        block(r / D, c / D).map_or(0.0, |entry| k.values[entry][(r % D, c % D)])
    });
    let mass = DMatrix::from_fn(n * D, n * D, |r, c| match (block(r / D, c / D), r % D == c % D) {
        (Some(entry), true) => body.mass().values[entry],
        _ => 0.0,
    });
    let root = mass.cholesky().expect("positive definite").l();
    let half = root.solve_lower_triangular(&stiffness).expect("regular");
    let whole = root.solve_lower_triangular(&half.transpose()).expect("regular");
    let mut values: Vec<f64> =
        SymmetricEigen::new((&whole + whole.transpose()) * 0.5).eigenvalues.iter().copied().collect();
    values.sort_by(f64::total_cmp);
    values
}

fn frequencies_of<const D: usize>(kind: CellKind, divisions: usize) {
    let body = beam::<D>(kind, divisions);
    let rigid = D * (D + 1) / 2;
    let expected = all(&body);
    let inside = D * (body.node_count() - body.surface().nodes().len());
    let whole = Reduction::new(&body, inside).expect("holds");
    assert_eq!(whole.count() + rigid, expected.len());
    for (own, exact) in whole.stiffness().iter().zip(&expected[rigid..]) {
        assert!((own / exact - 1.0).abs() < 1e-9, "{own} {exact}");
    }
    // With few modes the lowest frequencies are a little too high, and less so with more.
    let mut before = f64::INFINITY;
    for modes in [4, 8, 16, 32] {
        let few = Reduction::new(&body, modes).expect("holds");
        let error =
            (0..4).map(|k| (few.stiffness()[k] / expected[rigid + k]).sqrt() - 1.0).fold(0.0, f64::max);
        assert!((0.0..0.8 * before).contains(&error), "{modes} modes: {error:e} after {before:e}");
        before = error;
    }
    assert!(before < 1e-3, "{before:e}");
}

/// Reference: the eigenvalues of the whole matrices.
#[test]
fn with_all_modes_a_reduced_body_vibrates_as_the_whole_and_with_few_nearly() {
    frequencies_of::<2>(CellKind::Quad4, 6);
    frequencies_of::<3>(CellKind::Hex8, 3);
}

/// Identity: rigid motions and vibrations are read as what they are, and vibrations have neither momentum nor angular momentum.
#[test]
fn what_nodes_move_by_is_read_from_few_of_them() {
    let body = beam::<3>(CellKind::Tet4, 3);
    let reduction = Reduction::new(&body, 5).expect("holds");
    let nodes = body.mesh().nodes();
    let centre = body.mean(nodes);
    let turn = [0.3, -0.2, 0.5];
    let shift = Vector::<3>::new(1.0, 2.0, -0.5);
    let amplitudes: Vec<f64> = (0..reduction.count()).map(|k| ((k * 7 % 5) as f64 - 2.0) * 0.1).collect();
    let moved = |n: usize| {
        let rigid = shift + tensor::rotation_velocity(&turn, &(nodes[n] - centre));
        rigid + reduction.displacement(n, &amplitudes)
    };
    let read: Vec<Vector<3>> = reduction.read_nodes().iter().map(|&n| moved(n as usize)).collect();
    assert!(read.len() < body.node_count(), "fewer than all");
    let mut content = Content::of(reduction.count());
    reduction.read(&read, &mut content);
    assert!((content.shift - shift).norm() < 1e-12);
    assert!((0..3).all(|i| (content.turn[i] - turn[i]).abs() < 1e-12), "{:?}", content.turn);
    let largest = content.amplitudes.iter().zip(&amplitudes).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(largest < 1e-11, "{largest:e}");
    let bent: Vec<Vector<3>> = (0..nodes.len()).map(|n| reduction.displacement(n, &amplitudes)).collect();
    let mut momentum = vec![Vector::zeros(); nodes.len()];
    body.mass().multiply(&bent, &mut momentum);
    let total: Vector<3> = momentum.iter().sum();
    let moment: Matrix<3> = nodes.iter().zip(&momentum).map(|(x, p)| (x - centre) * p.transpose()).sum();
    let scale: f64 = momentum.iter().map(|p| p.norm()).sum();
    assert!(total.norm() < 1e-11 * scale && (moment - moment.transpose()).norm() < 1e-11 * scale);
}

/// A surface that does not hold the body, and one of which a part is loose, are refused.
#[test]
fn a_surface_that_does_not_hold_the_body_is_refused() {
    let mesh: Mesh<2> = grid(CellKind::Quad4, 3, |x| x);
    let none = Surface::of(&mesh).part(|_| false);
    let law = LawSpec::SaintVenantKirchhoff(elastic());
    let body = Body::with_contact_surface(mesh, none, &spec(law)).expect("valid");
    assert!(Reduction::new(&body, 3).is_err());
}
