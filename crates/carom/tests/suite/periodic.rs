//! Bodies that repeat themselves along x: where the cut between one period and the next lies is nowhere to be seen.

use crate::common::{body, disc, parse, plane, scenario};
use carom::Simulation;
use carom_mesh::Vector;
use serde_json::{Value, json};

/// A layer of height 1 m, `cells` of 1/8 m wide, from `corner`.
fn layer(corner: [f64; 2], cells: usize, velocity: [f64; 2]) -> Value {
    let mesh = json!({
        "kind": "rectangle", "corner": corner, "size": [0.125 * cells as f64, 1.0], "divisions": [cells, 8],
        "periodic": true,
    });
    body("layer", mesh, velocity)
}

/// A layer that falls obliquely on a rough floor.
fn oblique_impact(cells: usize, corner: f64, law: &str) -> Simulation<2> {
    let floor = plane("floor", [0.0, 0.0], [0.0, 1.0]);
    let mut case = scenario(0.1, 5e-4, &[layer([corner, 0.002], cells, [1.0, -1.0])], &[floor]);
    case["materials"]["elastic"]["kind"] = json!(law);
    case["contact"]["friction"] = json!(0.2);
    Simulation::<2>::new(&parse(&case)).expect("valid")
}

fn momentum(simulation: &Simulation<2>) -> Vector<2> {
    simulation
        .model()
        .bodies
        .iter()
        .map(|b| b.body.mean(&simulation.state().velocity[b.nodes()]) * b.body.total_mass())
        .sum()
}

/// What acts on the bodies.
fn contact_force(simulation: &Simulation<2>) -> Vector<2> {
    simulation.fields().reaction.iter().sum()
}

fn assert_ties_hold(simulation: &Simulation<2>) {
    let state = simulation.state();
    for b in &simulation.model().bodies {
        for tie in b.body.mesh().ties() {
            let [image, master] = [tie.image, tie.master].map(|n| b.first_node + n as usize);
            assert_eq!(state.displacement[image], state.displacement[master]);
            assert_eq!(state.velocity[image], state.velocity[master]);
        }
    }
}

#[test]
fn a_layer_of_one_cell_stays_uniform_along_it_and_its_momentum_is_what_the_floor_gave() {
    for law in ["linear-elastic", "saint-venant-kirchhoff", "neo-hookean"] {
        let mut simulation = oblique_impact(1, 0.0, law);
        let mut expected = momentum(&simulation);
        while simulation.step() < simulation.steps() {
            simulation.advance(f64::INFINITY, || true).expect("runs");
            expected += contact_force(&simulation) * 5e-4;
            assert_ties_hold(&simulation);
            assert!((momentum(&simulation) - expected).norm() < 1e-12, "{law}");
        }
        let summary = simulation.summary();
        assert_eq!(summary.contacts.len(), 1, "{law}");
        assert!(
            summary.contacts[0].release.is_some() && momentum(&simulation)[1] > 0.1,
            "{law}: it rebounds"
        );
        assert!(summary.energy.terms.friction > 0.01 * summary.energy.initial, "{law}");
        assert_eq!(summary.dofs, 18, "the nodes of one column");
    }
}

#[test]
fn two_cells_do_per_width_what_one_does() {
    for law in ["linear-elastic", "saint-venant-kirchhoff"] {
        let [mut one, mut two] = [1, 2].map(|cells| oblique_impact(cells, 0.0, law));
        for simulation in [&mut one, &mut two] {
            simulation.advance(f64::INFINITY, || false).expect("runs");
        }
        for row in 0..9 {
            for k in 0..3 {
                let (a, b) = (one.state(), two.state());
                let (a, b) = (
                    (a.displacement[2 * row], a.velocity[2 * row]),
                    (b.displacement[3 * row + k], b.velocity[3 * row + k]),
                );
                assert!((a.0 - b.0).norm() < 1e-11, "{law}: row {row}, column {k}: {} and {}", a.0, b.0);
                assert!((a.1 - b.1).norm() < 1e-8, "{law}: row {row}, column {k}: {} and {}", a.1, b.1);
            }
        }
        let (a, b) = (one.summary().energy, two.summary().energy);
        assert!((2.0 * a.terms.friction - b.terms.friction).abs() < 1e-10 * b.initial, "{law}");
    }
}

/// A disc falls on a layer, near the cut and far from it.
fn disc_on_layer(x: f64, friction: f64) -> Simulation<2> {
    let bodies = [layer([0.0, 0.0], 16, [0.0, 0.0]), body("disc", disc([x, 1.3], 0.25, 4), [1.0, -3.0])];
    let mut case = scenario(0.2, 5e-4, &bodies, &[]);
    case["contact"]["friction"] = json!(friction);
    case["contact"]["sources"] = json!("second");
    Simulation::<2>::new(&parse(&case)).expect("valid")
}

#[test]
fn an_impact_does_not_see_where_the_body_is_cut() {
    let [mut far, mut near] = [1.0, 1.625].map(|x| disc_on_layer(x, 0.3));
    let before = momentum(&near);
    for simulation in [&mut far, &mut near] {
        simulation.advance(f64::INFINITY, || false).expect("runs");
        assert!(simulation.summary().energy.terms.friction > 1e-4);
        assert!((momentum(simulation) - before).norm() < 1e-12, "action is reaction");
        assert_ties_hold(simulation);
    }
    // The waves had the time to run round the body.
    assert!(0.2 * far.model().bodies[0].body.wave_speed() > 2.0 * 2.0);
    let (a, b) = (far.summary(), near.summary());
    assert_eq!(a.contacts.len(), b.contacts.len());
    for (x, y) in [
        (a.energy.terms.strain, b.energy.terms.strain),
        (a.energy.terms.kinetic, b.energy.terms.kinetic),
        (a.energy.terms.friction, b.energy.terms.friction),
    ] {
        assert!((x - y).abs() < 1e-8 * a.energy.initial, "{x} J and {y} J");
    }
}

/// Symptom guarded against: a disc that pressed on the last facet moved its image alone, and the body was torn there.
#[test]
fn forces_on_images_act_on_their_masters() {
    let mut simulation = disc_on_layer(1.95, 0.3);
    let before = momentum(&simulation);
    let mut pressed = false;
    while simulation.step() < simulation.steps() {
        simulation.advance(f64::INFINITY, || true).expect("runs");
        let layer = &simulation.model().bodies[0].body;
        let images = layer.surface().ties().iter().map(|t| t.image as usize);
        pressed |= images.map(|n| simulation.state().contact_force[n].norm()).fold(0.0, f64::max) > 1.0;
        assert_ties_hold(&simulation);
    }
    assert!(pressed);
    assert!((momentum(&simulation) - before).norm() < 1e-12);
}

#[test]
fn translation_is_free_and_where_the_layer_starts_does_not_matter() {
    let mut case = scenario(1.0, 1e-2, &[layer([3.0, -1.0], 4, [2.0, -0.5])], &[]);
    case["bodies"][0]["mass"] = json!("lumped");
    let mut flying = Simulation::<2>::new(&parse(&case)).expect("valid");
    flying.advance(f64::INFINITY, || false).expect("runs");
    for u in &flying.state().displacement {
        assert!((u - Vector::<2>::new(2.0, -0.5)).norm() < 1e-12);
    }
    assert!(flying.state().energies.strain < 1e-20);

    let [mut here, mut there] = [0.0, -5.0].map(|x| oblique_impact(2, x, "saint-venant-kirchhoff"));
    for simulation in [&mut here, &mut there] {
        simulation.advance(f64::INFINITY, || false).expect("runs");
    }
    for (a, b) in here.state().displacement.iter().zip(&there.state().displacement) {
        assert!((a - b).norm() < 1e-11);
    }
}

#[test]
fn a_periodic_body_cannot_spin() {
    let mut case = scenario(0.1, 1e-3, &[layer([0.0, 0.0], 2, [0.0, 0.0])], &[]);
    case["bodies"][0]["spin"] = json!(0.1);
    let error = Simulation::<2>::new(&parse(&case)).err().expect("refused");
    assert_eq!(error.key, "bodies.0.spin");
    assert!(error.to_string().contains("periodic"), "{error}");
}

/// Whatever velocities a caller gives: tied nodes start as their masters do.
#[test]
fn tied_nodes_start_alike() {
    let mut simulation = oblique_impact(2, 0.0, "saint-venant-kirchhoff");
    let reference = &simulation.model().assembly.reference[..simulation.model().node_count()];
    let shear = reference.iter().map(|x| Vector::<2>::new(-x[1], x[0])).collect();
    simulation.set_initial_velocity(shear);
    assert_ties_hold(&simulation);
}
