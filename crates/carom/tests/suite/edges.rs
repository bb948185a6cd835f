//! Bodies in space that meet with their edges.

use crate::common::{body, parse, scenario};
use carom::{Meshes, Simulation};
use carom_mesh::{Matrix, Mesh, Vector, generate};
use serde_json::{Value, json};

/// A bar of 3 × 1 × 1 around the origin, with one edge up, turned by `angle` about the vertical; `cells` along it.
fn bar(cells: usize, angle: f64, centre: [f64; 3]) -> Mesh<3> {
    let grid = generate::grid([-1.5, -0.5, -0.5], [3.0, 1.0, 1.0], [2 * cells, 4, 4]).expect("valid");
    let c = std::f64::consts::FRAC_1_SQRT_2;
    let (sin, cos) = angle.sin_cos();
    let tilt = Matrix::<3>::new(1.0, 0.0, 0.0, 0.0, c, -c, 0.0, c, c);
    let turn = Matrix::<3>::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0) * tilt;
    let nodes = grid.nodes().iter().map(|x| turn * x + Vector::from(centre)).collect();
    Mesh::new(nodes, grid.blocks().to_vec()).expect("turned")
}

/// Two bars, the one falling across the other, edge on edge; `offset` from its middle.
fn falling(condition: &str, friction: f64, offset: f64, velocity: [f64; 3]) -> Simulation<3> {
    let both = json!({"sources": "both"});
    falling_with(&both, condition, friction, offset, velocity)
}

/// The same with a part of `contact` that says how it is written.
fn falling_with(
    written: &Value,
    condition: &str,
    friction: f64,
    offset: f64,
    velocity: [f64; 3],
) -> Simulation<3> {
    let mut bodies =
        ["low", "high"].map(|name| body(name, json!({"kind": "file", "file": name}), [0.0, 0.0]));
    for (b, velocity) in bodies.iter_mut().zip([[0.0; 3], velocity]) {
        b["velocity"] = json!(velocity);
        b["spin"] = json!([0.0, 0.0, 0.0]);
    }
    let mut case = scenario(0.6, 2e-3, &bodies, &[]);
    case["dimension"] = json!(3);
    case["analysis"]["scheme"] = json!({"kind": "conserving"});
    case["analysis"]["newton"]["tolerance"] = json!(1e-11);
    case["contact"]["condition"] = json!(condition);
    case["contact"]["friction"] = json!(friction);
    let contact = case["contact"].as_object_mut().expect("a table");
    contact.extend(written.as_object().expect("a table").clone());
    case["contact"]["solver"] = json!({"kind": "auto", "tolerance": 1e-12, "max_iterations": 10000});
    let height = 2.0_f64.sqrt() + 0.0301;
    let meshes: Meshes<3> = [
        ("low".to_string(), bar(4, 0.0, [0.0; 3])),
        ("high".to_string(), bar(5, 1.1, [offset, 0.2, height])),
    ]
    .into();
    Simulation::<3>::with_meshes(&parse(&case), meshes).expect("a valid case")
}

/// Linear and angular momentum about the origin.
fn momenta(simulation: &Simulation<3>) -> (Vector<3>, Vector<3>) {
    let (mut linear, mut angular) = (Vector::zeros(), Vector::zeros());
    for b in &simulation.model().bodies {
        let (u, v) = (&simulation.state().displacement[b.nodes()], &simulation.state().velocity[b.nodes()]);
        let mut mv = vec![Vector::zeros(); v.len()];
        b.body.mass().multiply(v, &mut mv);
        linear += mv.iter().sum::<Vector<3>>();
        angular += Vector::from(b.body.angular_momentum(u, &mv));
    }
    (linear, angular)
}

/// No node comes near a facet: the bars touch with their edges alone, which keep all that contact is to keep. Deformed edges are bent at their
/// nodes, and the contact rests in such a dent, where two edges of one bar touch the other, or slides over several.
#[test]
fn crossed_edges_keep_momenta_and_energy_and_let_nothing_through() {
    let (slow, fast) = ([0.2, 0.1, -1.0], [2.0, 0.1, -1.0]);
    let cases = [
        ("midpoint", 0.0, 0.0, slow),
        ("midpoint", 0.0, 0.31, slow),
        ("midpoint", 0.3, 1.1, slow),
        ("midpoint", 0.3, -0.4, fast),
        ("gap", 0.0, 0.31, slow),
        ("gap", 0.0, -0.4, fast),
        ("gap", 0.3, -0.4, fast),
        ("massless", 0.0, 0.31, slow),
        ("massless", 0.3, -0.4, fast),
    ];
    for (condition, friction, offset, velocity) in cases {
        let name = format!("{condition}, friction {friction}, {offset} off at {velocity:?}");
        let mut simulation = falling(condition, friction, offset, velocity);
        let (linear, angular) = momenta(&simulation);
        simulation
            .advance(0.6, || false)
            .unwrap_or_else(|e| panic!("{name}: {:?} at {} s", e.reason, e.time));
        let (linear_after, angular_after) = momenta(&simulation);
        let summary = simulation.summary();
        let energy = summary.energy;
        println!(
            "{name}: drift {:.1e}, defect {:.1e}, friction {:.3} of the energy; angular momentum {:.0e}; smallest gap {:.1e} m",
            energy.max_drift / energy.initial,
            energy.max_defect / energy.initial,
            energy.terms.friction / energy.initial,
            (angular_after - angular).norm() / angular.norm(),
            summary.min_gap
        );
        assert_eq!((summary.contacts.len(), summary.retried_steps), (1, 0), "{name}");
        assert!((linear_after - linear).norm() < 1e-12 * linear.norm(), "{name}");
        assert!(energy.max_defect < 1e-11 * energy.initial, "{name}: {:e}", energy.max_defect);
        assert_eq!(
            energy.terms.friction > 1e-3 * energy.initial,
            friction > 0.0,
            "{name}: {:e}",
            energy.terms.friction
        );
        if condition == "midpoint" {
            // It chooses its contacts at the start of a step.
            assert!(summary.min_gap > -6e-3, "{name}: {:e}", summary.min_gap);
        } else {
            assert!(summary.min_gap > -1e-11, "{name}: {:e}", summary.min_gap);
        }
        if condition != "gap" && friction == 0.0 {
            assert!(energy.max_drift < 1e-11 * energy.initial, "{name}: {:e}", energy.max_drift);
            assert!((angular_after - angular).norm() < 1e-11 * angular.norm(), "{name}");
        }
    }
}

/// Symptom guarded against: multipliers have the mean of gaps over facets, and bars whose facets slope away from where they cross went a fifth
/// of a cell into one another before it was closed.
#[test]
fn crossed_edges_of_a_mortar_pair_touch() {
    let mortar = json!({"sources": "finer", "discretisation": "mortar"});
    for (condition, friction, offset) in [("gap", 0.0, 0.31), ("midpoint", 0.3, -0.4)] {
        let mut simulation = falling_with(&mortar, condition, friction, offset, [0.2, 0.1, -1.0]);
        let (linear, _) = momenta(&simulation);
        simulation
            .advance(0.6, || false)
            .unwrap_or_else(|e| panic!("{condition}: {:?} at {} s", e.reason, e.time));
        let summary = simulation.summary();
        println!("{condition}: {:?}", summary.penetration);
        let (linear_after, _) = momenta(&simulation);
        assert_eq!(summary.contacts.len(), 1, "{condition}");
        assert!((linear_after - linear).norm() < 1e-12 * linear.norm(), "{condition}");
        assert!(summary.energy.max_defect < 1e-11 * summary.energy.initial, "{condition}");
        assert!(summary.penetration.max_depth < 1e-12, "{condition}: {:?}", summary.penetration);
    }
}

/// Their nodes are all outside of one another, and so are the middles of facets and cells.
#[test]
fn edges_that_have_passed_at_the_start_are_refused() {
    let bodies = ["low", "high"].map(|name| body(name, json!({"kind": "file", "file": name}), [0.0, 0.0]));
    let mut case = scenario(0.1, 1e-3, &bodies, &[]);
    case["dimension"] = json!(3);
    for b in case["bodies"].as_array_mut().expect("a list") {
        b["velocity"] = json!([0.0, 0.0, 0.0]);
        b["spin"] = json!([0.0, 0.0, 0.0]);
    }
    let built = |overlap: f64| {
        let height = 2.0_f64.sqrt() - overlap;
        let meshes: Meshes<3> = [
            ("low".to_string(), bar(4, 0.0, [0.0; 3])),
            ("high".to_string(), bar(5, 1.1, [0.0, 0.2, height])),
        ]
        .into();
        Simulation::<3>::with_meshes(&parse(&case), meshes)
    };
    for apart in [0.0, -1e-3] {
        assert!(built(apart).is_ok());
    }
    for overlap in [1e-6, 1e-2] {
        let error = built(overlap).err().expect("refused");
        assert_eq!(error.key, "bodies.0.mesh");
        let depth =
            format!("edges of \"low\" and \"high\" are {overlap:.6} m through one another at the start");
        assert!(error.message.starts_with(&depth), "{}", error.message);
    }
}
