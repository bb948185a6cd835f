//! A body that touches itself.

use crate::common::{body, parse, scenario};
use carom::{Meshes, Simulation};
use carom_mesh::{Mesh, Vector, generate};
use serde_json::{Value, json};

/// A ring with a slit on the right, of mean radius 1 and half the opening angle `slit`; in space it is a band of width 0.2 that rises by 0.07
/// along the ring, so that no rim of one end lies on a rim of the other.
fn slit_ring<const D: usize>(slit: f64, thickness: f64, around: usize, radial: usize) -> Mesh<D> {
    let divisions = std::array::from_fn(|i| [around, radial, 1][i]);
    let grid = generate::grid([0.0; D], [1.0; D], divisions).expect("valid");
    // The grid's x runs clockwise around the ring, so that cells keep their sense.
    let bent = |x: &Vector<D>| {
        let (sin, cos) = (-slit - (2.0 * std::f64::consts::PI - 2.0 * slit) * x[0]).sin_cos();
        let radius = 1.0 + thickness * (x[1] - 0.5);
        Vector::from_fn(|i, _| [radius * cos, radius * sin, 0.2 * x[D - 1] + 0.07 * x[0]][i])
    };
    Mesh::new(grid.nodes().iter().map(bent).collect(), grid.blocks().to_vec()).expect("a ring")
}

/// The ring in flight while its slit closes at about `speed`, and what became of it.
fn closing_ring<const D: usize>(mesh: Mesh<D>, speed: f64, friction: f64, end: f64) -> Simulation<D> {
    let mut ring = body("ring", json!({"kind": "file", "file": "ring"}), [0.0, 0.0]);
    ring["velocity"] = json!(vec![0.0; D]);
    ring["spin"] = if D == 2 { json!(0.0) } else { json!([0.0, 0.0, 0.0]) };
    // Nothing is said of contact with itself: every body may.
    ring["self_contact"] = Value::Null;
    let mut case = scenario(end, 1e-3, &[ring], &[]);
    case["dimension"] = json!(D);
    case["analysis"]["scheme"] = json!({"kind": "conserving"});
    case["analysis"]["newton"]["tolerance"] = json!(1e-11);
    case["contact"]["condition"] = json!("midpoint");
    case["contact"]["friction"] = json!(friction);
    // Upper and lower half fold about the left, the upper one a little faster and aside, so that the tips also rub.
    let fold = |x: &Vector<D>| {
        let share = 0.5 * (x[0] + 1.0);
        let side = x[1].signum();
        Vector::from_fn(|i, _| share * speed * [0.3 * (1.0 + side), -side * (1.0 + 0.1 * side), 0.0][i])
    };
    let velocity = mesh.nodes().iter().map(fold).collect();
    let meshes: Meshes<D> = [("ring".to_string(), mesh)].into();
    let mut simulation = Simulation::with_meshes(&parse(&case), meshes).expect("a valid case");
    simulation.set_initial_velocity(velocity);
    simulation.advance(f64::INFINITY, || false).expect("converges");
    simulation
}

fn momentum<const D: usize>(simulation: &Simulation<D>) -> Vector<D> {
    let (body, state) = (&simulation.model().bodies[0].body, simulation.state());
    let mut mv = vec![Vector::zeros(); body.node_count()];
    body.mass().multiply(&state.velocity, &mut mv);
    mv.iter().sum()
}

fn a_ring_closes_on_itself<const D: usize>(around: usize, radial: usize) {
    for friction in [0.0, 0.3] {
        let slit_half = 0.08;
        let mesh = slit_ring::<D>(slit_half, 0.3, around, radial);
        let simulation = closing_ring(mesh, 2.0, friction, 0.12);
        let summary = simulation.summary();
        assert_eq!(summary.contacts.len(), 1, "{:?}", summary.contacts);
        assert_eq!(summary.contacts[0].pair, ["ring", "ring"].map(String::from));
        assert!(summary.min_gap > -0.02 && summary.min_gap < 0.0, "{:e}", summary.min_gap);
        let energy = summary.energy;
        if friction == 0.0 {
            assert!(
                energy.max_drift < 1e-10 * energy.initial,
                "{:e} of {}",
                energy.max_drift,
                energy.initial
            );
        } else {
            assert!(energy.terms.friction > 1e-5 * energy.initial, "{}", energy.terms.friction);
            assert!(energy.max_defect < 1e-9 * energy.initial, "{:e}", energy.max_defect);
        }
        let start = closing_ring(slit_ring::<D>(slit_half, 0.3, around, radial), 2.0, friction, 1e-3);
        let change = momentum(&simulation) - momentum(&start);
        assert!(change.norm() < 1e-10, "{change}");
    }
}

#[test]
fn a_ring_that_closes_on_itself_conserves_energy_and_momentum() {
    a_ring_closes_on_itself::<2>(40, 3);
    a_ring_closes_on_itself::<3>(24, 2);
}

/// Symptom guarded against: in a wall one cell thick every node is within half a facet of the facets of the other side, from behind.
#[test]
fn a_thin_wall_does_not_touch_its_own_back() {
    let mesh = slit_ring::<2>(0.8, 0.03, 30, 1);
    let summary = closing_ring(mesh, 1.0, 0.0, 0.1).summary();
    assert!(summary.contacts.is_empty(), "{:?}", summary.contacts);
    assert!(summary.pairs.is_empty(), "a body that did not touch itself has no books of it");
    assert!(summary.energy.max_drift < 1e-10 * summary.energy.initial);
}
