//! Impacts of bodies under every hypothesis and formulation: the ledger closes, and the momenta are kept.

use crate::common::{body, parse, plane, scenario};
use carom::Simulation;
use carom_mesh::Vector;
use serde_json::{Value, json};

/// Two blocks, or cylinders on one axis, of which the upper one falls on the lower.
fn impact(hypothesis: &str, formulation: &str, condition: &str, friction: f64) -> Simulation<2> {
    let rectangle = |corner: [f64; 2], size: [f64; 2], divisions: [usize; 2]| json!({"kind": "rectangle", "corner": corner, "size": size, "divisions": divisions});
    let blocks = [
        body("lower", rectangle([0.0, 0.0], [1.0, 0.6], [5, 4]), [0.0, 0.0]),
        body("upper", rectangle([0.0, 0.61], [0.7, 0.5], [4, 4]), [0.0, -2.0]),
    ];
    let mut case = scenario(0.06, 5e-4, &blocks, &[]);
    for entry in case["bodies"].as_array_mut().expect("a list") {
        entry["hypothesis"] = json!(hypothesis);
        entry["formulation"] = json!(formulation);
    }
    case["materials"]["elastic"]["kind"] = json!("neo-hookean");
    case["analysis"]["scheme"] = json!({"kind": "conserving"});
    case["analysis"]["newton"]["tolerance"] = json!(1e-11);
    case["contact"]["condition"] = json!(condition);
    case["contact"]["friction"] = json!(friction);
    Simulation::<2>::new(&parse(&case)).expect("valid")
}

fn momentum(simulation: &Simulation<2>) -> Vector<2> {
    let state = simulation.state();
    simulation
        .model()
        .bodies
        .iter()
        .map(|b| b.body.mean(&state.velocity[b.nodes()]) * b.body.total_mass())
        .sum()
}

fn variants() -> impl Iterator<Item = (&'static str, &'static str, &'static str)> {
    let bodies = [
        ("plane-strain", "mean-dilatation"),
        ("plane-stress", "standard"),
        ("axisymmetric", "standard"),
        ("axisymmetric", "mean-dilatation"),
    ];
    bodies.into_iter().flat_map(|(h, f)| ["midpoint", "massless"].map(|condition| (h, f, condition)))
}

#[test]
fn energy_and_momentum_of_an_impact_are_kept_under_every_hypothesis() {
    for (hypothesis, formulation, condition) in variants() {
        let mut simulation = impact(hypothesis, formulation, condition, 0.3);
        let before = momentum(&simulation);
        simulation.advance(f64::INFINITY, || false).expect("runs");
        let summary = simulation.summary();
        let (name, energy) = (format!("{hypothesis}, {formulation}, {condition}"), summary.energy);
        assert!(summary.contacts[0].peak_force > 1.0, "{name}: {:?}", summary.contacts);
        assert!(energy.terms.friction > 0.0, "{name}: the blocks rub as they widen");
        assert!(energy.max_defect < 1e-10 * energy.initial, "{name}: {:e}", energy.max_defect);
        let change = (momentum(&simulation) - before).norm();
        assert!(change < 1e-11 * before.norm(), "{name}: {change}");
    }
}

/// A cylinder in free fall: gravity does the work m g h, and the axis is no boundary.
#[test]
fn a_cylinder_falls_as_one_and_its_axis_touches_nothing() {
    let mesh = json!({"kind": "rectangle", "corner": [0.0, 1.0], "size": [0.5, 1.0], "divisions": [3, 4]});
    let floor = plane("floor", [0.0, 0.0], [0.0, 1.0]);
    let mut case = scenario(0.2, 1e-2, &[body("cylinder", mesh, [0.0, 0.0])], &[floor]);
    case["bodies"][0]["hypothesis"] = json!("axisymmetric");
    case["analysis"]["gravity"] = json!([0.0, -9.81]);
    let mut simulation = Simulation::<2>::new(&parse(&case)).expect("valid");
    let body = &simulation.model().bodies[0].body;
    let inner: Vec<u32> = body.axis_nodes().into_iter().filter(|n| ![0, 16].contains(n)).collect();
    assert_eq!(inner, [4, 8, 12]);
    assert!(inner.iter().all(|n| body.surface().nodes().binary_search(n).is_err()), "the axis is inside");
    let mass = body.total_mass();
    assert!((mass - 0.25 * std::f64::consts::PI).abs() < 1e-14);
    simulation.advance(f64::INFINITY, || false).expect("runs");
    let (summary, fall) = (simulation.summary(), 0.5 * 9.81 * 0.2_f64.powi(2));
    assert!(summary.contacts.is_empty(), "{:?}", summary.contacts);
    assert!((summary.energy.terms.external - mass * 9.81 * fall).abs() < 1e-12, "{:?}", summary.energy);
    assert!((summary.energy.last - summary.energy.terms.external).abs() < 1e-12);
}

/// What makes a case one that is refused.
type Change<'a> = &'a dyn Fn(&mut Value);

/// What a body of revolution cannot do is refused by its key.
#[test]
fn motion_across_the_axis_is_refused() {
    let mesh = json!({"kind": "rectangle", "corner": [0.0, 0.0], "size": [1.0, 1.0], "divisions": [2, 2]});
    let refused = |change: Change<'_>| {
        let mut case = scenario(0.1, 1e-2, &[body("cylinder", mesh.clone(), [0.0, 0.0])], &[]);
        case["bodies"][0]["hypothesis"] = json!("axisymmetric");
        change(&mut case);
        Simulation::<2>::new(&parse(&case)).err().expect("refused")
    };
    let refusals: [(&str, Change<'_>); 5] = [
        ("analysis.gravity", &|case| case["analysis"]["gravity"] = json!([1.0, 0.0])),
        ("bodies.0.velocity", &|case| case["bodies"][0]["velocity"] = json!([1.0, 0.0])),
        ("bodies.0.spin", &|case| case["bodies"][0]["spin"] = json!(1.0)),
        ("bodies.0.mesh", &|case| case["bodies"][0]["mesh"]["corner"] = json!([-0.5, 0.0])),
        ("bodies.0.formulation", &|case| {
            case["bodies"][0]["formulation"] = json!("mean-dilatation");
            case["bodies"][0]["mesh"]["cell"] = json!("tri3");
        }),
    ];
    for (key, change) in refusals {
        let error = refused(change);
        assert_eq!(error.key, key, "{error}");
    }
}
