//! A run that goes on from a checkpoint is, to the last bit, the run that never stopped.

use carom::{Checkpoint, Simulation};
use serde_json::{Value, json};

use crate::common::{body, disc, parse, plane, scenario};
use crate::large_bodies;
use crate::rigid_bodies::meeting;

/// Two discs, one spinning, that meet above a floor and then hit it.
fn discs(scheme: &str, condition: &str) -> Value {
    let discs = [
        body("left", disc([0.0, 1.06], 1.0, 6), [1.5, -1.0]),
        body("right", disc([2.05, 1.4], 1.0, 4), [-0.5, -2.0]),
    ];
    let mut case = scenario(0.3, 2e-3, &discs, &[plane("floor", [0.0, 0.0], [0.0, 1.0])]);
    case["bodies"][0]["spin"] = json!(4.0);
    if scheme == "conserving" {
        case["analysis"]["scheme"] = json!({"kind": "conserving"});
    }
    case["contact"]["condition"] = json!(condition);
    case["contact"]["friction"] = json!(0.3);
    case["contact"]["solver"]["kind"] = json!("auto");
    case["output"]["history_every"] = json!(7e-3);
    case["output"]["track"] = json!([{"name": "tip", "body": "left", "point": [1.0, 1.06]}]);
    case
}

/// A simulation in the state of a checkpoint.
fn restored<const D: usize>(case: &Value, checkpoint: &Checkpoint) -> Simulation<D> {
    let mut simulation = Simulation::new(&parse(case)).expect("valid");
    simulation.restore(checkpoint).expect("a checkpoint of this case");
    simulation
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|x| x.to_bits()).collect()
}

/// Bit by bit: NaN, where there is nothing, is the same as NaN.
fn assert_same(a: &Checkpoint, b: &Checkpoint) {
    assert_eq!(a.integers, b.integers);
    assert!(a.numbers.keys().eq(b.numbers.keys()));
    for (name, values) in &a.numbers {
        assert!(bits(values) == bits(&b.numbers[name]), "{name}");
    }
}

/// Stops at several moments, goes on from each, and compares with the run that did not; at every stop the state made of the checkpoint
/// has the same checkpoint.
pub fn goes_on_identically<const D: usize>(case: &Value, stops: usize) -> Simulation<D> {
    let mut whole = Simulation::<D>::new(&parse(case)).expect("valid");
    let mut checkpoints = Vec::new();
    for k in 1..=stops {
        let until = whole.steps() * k as u64 / (stops + 1) as u64;
        while whole.step() < until {
            whole.advance(f64::INFINITY, || true).expect("runs");
        }
        checkpoints.push(whole.checkpoint().expect("finite"));
    }
    whole.advance(f64::INFINITY, || false).expect("runs");
    whole.finish();
    let (history, ledger) = (bits(&whole.take_history()), bits(&whole.take_ledger()));
    for checkpoint in &checkpoints {
        let mut resumed = restored::<D>(case, checkpoint);
        assert_same(&resumed.checkpoint().expect("finite"), checkpoint);
        resumed.advance(f64::INFINITY, || false).expect("runs");
        resumed.finish();
        let from = format!("from step {}", checkpoint.integers["run/step"][0]);
        assert_eq!(resumed.summary(), whole.summary(), "{from}");
        assert!(bits(&resumed.take_history()) == history, "{from}");
        assert!(bits(&resumed.take_ledger()) == ledger, "{from}");
        assert!(resumed.state() == whole.state(), "{from}");
    }
    whole
}

#[test]
fn rigid_bodies_go_on_identically() {
    for condition in ["midpoint", "endpoint"] {
        let whole = goes_on_identically::<2>(&meeting(condition), 3);
        assert!(!whole.summary().contacts.is_empty(), "they meet");
    }
}

#[test]
fn impacts_with_every_condition() {
    for (scheme, condition) in
        [("theta", "gap"), ("theta", "endpoint"), ("conserving", "midpoint"), ("conserving", "massless")]
    {
        let mut case = discs(scheme, condition);
        case["contact"]["targets"] = json!(if condition == "massless" { "smooth" } else { "faceted" });
        let whole = goes_on_identically::<2>(&case, 6);
        assert!(whole.summary().contacts.len() >= 2, "{condition}: {:?}", whole.summary().contacts);
    }
}

#[test]
fn steps_that_were_halved_a_second_solver_and_damping() {
    let mut case = discs("theta", "gap");
    case["analysis"]["newton"]["max_iterations"] = json!(8);
    case["analysis"]["time_step"] = json!(1e-2);
    case["contact"]["solver"]["cross_check"] = json!(true);
    case["materials"]["elastic"]["damping"] = json!({"mass": 0.1, "stiffness": 1e-3});
    case["materials"]["elastic"]["viscosity"] = json!({"shear": 0.5, "bulk": 0.5});
    let summary = goes_on_identically::<2>(&case, 8).summary();
    assert!(summary.retried_steps > 0, "some steps fail");
    assert!(summary.cross_check.is_some_and(|check| check.problems > 0));
}

#[test]
fn mortar_contact_between_bodies() {
    let mut case = discs("conserving", "midpoint");
    case["contact"]["discretisation"] = json!("mortar");
    goes_on_identically::<2>(&case, 4);
}

#[test]
fn contacts_with_friction_that_depends_on_their_sliding() {
    let laws = [
        json!({"static": 0.6, "kinetic": 0.2}),
        json!({"static": 0.6, "kinetic": 0.2, "distance": 0.1}),
        json!({"reference": 0.3, "direct": 0.05, "evolution": 0.1, "speed": 0.1, "distance": 0.01}),
        json!({"formula": "0.1 + 0.2*exp(-v/0.5) + 0.1*s"}),
    ];
    for (law, discretisation) in laws.iter().zip(["node-to-segment", "mortar"].into_iter().cycle()) {
        let mut case = discs("conserving", "midpoint");
        case["contact"]["friction"] = law.clone();
        case["contact"]["discretisation"] = json!(discretisation);
        let whole = goes_on_identically::<2>(&case, 4);
        assert!(!whole.state().sliding.is_empty(), "{law}: contacts remember");
        assert!(whole.summary().energy.terms.friction > 0.0, "{law}");
    }
}

#[test]
fn bodies_that_grow_and_are_pushed_apart() {
    let mut case = discs("conserving", "midpoint");
    case["bodies"][0]["growth"] = json!("0.1*t");
    case["contact"]["pairs"] = json!([{"between": ["left", "right"], "interference": "0.05*t"}]);
    let whole = goes_on_identically::<2>(&case, 4);
    assert!(whole.summary().energy.terms.prescribed.abs() > 1e-3, "what is prescribed works");
}

#[test]
fn metal_that_flows() {
    let mesh = json!({"kind": "rectangle", "corner": [0.0, 0.0], "size": [3.0, 6.0], "divisions": [4, 8]});
    let mut case =
        scenario(3.0, 0.05, &[body("bar", mesh, [0.0, -0.227])], &[plane("wall", [0.0, 0.0], [0.0, 1.0])]);
    case["materials"]["elastic"] = json!({
        "kind": "j2-plasticity", "young": 117.0, "poisson": 0.35, "density": 8.93,
        "yield_stress": 0.4, "hardening": 0.1,
    });
    case["analysis"]["scheme"] = json!({"kind": "conserving"});
    case["contact"]["condition"] = json!("midpoint");
    let whole = goes_on_identically::<2>(&case, 5);
    assert!(whole.summary().energy.terms.plastic > 0.0);
}

/// More nodes of one body in contact than have blocks of compliance with all others.
#[test]
fn a_strip_that_lies_on_the_floor_with_many_nodes() {
    let mesh =
        json!({"kind": "rectangle", "corner": [0.0, 0.005], "size": [6.0, 0.1], "divisions": [120, 2]});
    let mut case =
        scenario(0.08, 2e-3, &[body("strip", mesh, [0.3, -1.0])], &[plane("floor", [0.0, 0.0], [0.0, 1.0])]);
    case["analysis"]["scheme"] = json!({"kind": "conserving"});
    case["bodies"][0]["spin"] = json!(0.05);
    case["contact"]["condition"] = json!("midpoint");
    case["contact"]["friction"] = json!(0.3);
    case["contact"]["solver"]["kind"] = json!("auto");
    let mut simulation = Simulation::<2>::new(&parse(&case)).expect("valid");
    let mut most = 0;
    while simulation.step() < simulation.steps() {
        simulation.advance(f64::INFINITY, || true).expect("runs");
        most = most.max(simulation.progress().contacts);
    }
    assert!(most > 100, "{most} contacts");
    goes_on_identically::<2>(&case, 8);
}

/// A polynomial stands for the factor, and more nodes are in contact than have blocks of compliance with all others.
#[test]
fn a_large_block_that_lands_flat() {
    let whole = goes_on_identically::<3>(&large_bodies::block([0.0; 3]), 2);
    assert!(whole.summary().energy.terms.friction > 0.0);
}

/// A block that is pressed on a floor and pulled aside in load steps, some of which must be halved.
#[test]
fn load_steps_that_were_halved() {
    let mesh = json!({"kind": "rectangle", "corner": [0.0, 0.0], "size": [2.0, 1.0], "divisions": [6, 3]});
    let floor = plane("floor", [0.0, 0.0], [0.0, 1.0]);
    let mut case = scenario(1.0, 0.125, &[body("block", mesh, [0.0, 0.0])], &[floor]);
    case["analysis"] = json!({
        "kind": "static", "end_time": 1.0, "time_step": 0.125, "max_halvings": 8, "gravity": null,
        "newton": {"tolerance": 1e-11, "max_iterations": 3},
    });
    case["contact"]["friction"] = json!(0.4);
    case["contact"]["solver"]["kind"] = json!("auto");
    case["output"]["history_every"] = json!(0.125);
    case["motions"] =
        json!([{"kind": "prescribed", "body": "block", "on": "top", "x": "0.3*t*t", "y": "-0.1*t"}]);
    let whole = goes_on_identically::<2>(&case, 7);
    assert!(whole.summary().retried_steps > 0, "{:?}", whole.summary());
    assert!(whole.summary().energy.terms.friction > 0.0);
}

#[test]
fn a_ball_in_space_on_an_obstacle_that_moves() {
    let mesh = json!({"kind": "ball", "centre": [0.0, 0.0, 1.02], "radius": 1.0, "divisions": 2});
    let mut case = scenario(0.2, 4e-3, &[], &[]);
    case["dimension"] = json!(3);
    case["bodies"] = json!([{
        "name": "ball", "material": "elastic", "hypothesis": "plane-strain", "thickness": 1.0,
        "mass": "consistent", "mesh": mesh, "velocity": [0.4, 0.0, -1.0], "spin": [0.0, 3.0, 1.0],
    }]);
    case["obstacles"] = json!([{
        "name": "table", "kind": "plane", "point": [0.0, 0.0, 0.0], "normal": [0.0, 0.0, 1.0], "velocity": [0.2, 0.1, 0.3],
    }]);
    case["analysis"]["scheme"] = json!({"kind": "conserving"});
    case["contact"]["condition"] = json!("midpoint");
    case["contact"]["friction"] = json!(0.3);
    let whole = goes_on_identically::<3>(&case, 4);
    assert!(whole.summary().energy.terms.prescribed != 0.0);
}

/// Whatever is wrong with an array is found, and named.
#[test]
fn arrays_that_do_not_fit_are_refused_by_name() {
    let case = discs("conserving", "midpoint");
    let mut simulation = Simulation::<2>::new(&parse(&case)).expect("valid");
    simulation.advance(0.1, || false).expect("runs");
    let good = simulation.checkpoint().expect("finite");
    assert!(!simulation.state().reactions.is_empty(), "the checkpoint has contacts");
    let mut target = Simulation::<2>::new(&parse(&case)).expect("valid");
    let mut refused = |name: &str, bad: &Checkpoint| {
        let error = target.restore(bad).expect_err(name);
        assert!(!error.what.is_empty() && error.to_string().contains('/') || name == "schema", "{error}");
    };
    for name in good.numbers.keys() {
        let mut bad = good.clone();
        bad.numbers.remove(name);
        refused(name, &bad);
        let mut bad = good.clone();
        let values = bad.numbers.entry(name.clone()).or_default();
        if let Some(first) = values.first_mut() {
            *first = f64::NEG_INFINITY;
            if !matches!(name.as_str(), "totals/min_gap" | "history/min_gap" | "cross_checks/sizes") {
                refused(name, &bad);
            }
        }
    }
    for name in good.integers.keys() {
        let mut bad = good.clone();
        bad.integers.remove(name);
        refused(name, &bad);
        let mut bad = good.clone();
        bad.integers.entry(name.clone()).or_default().extend([u64::MAX; 3]);
        refused(name, &bad);
        let mut bad = good.clone();
        let indices =
            ["pair", "site", "stencil_node", "source_count", "stencil_length", "nodes", "schema", "group"];
        if indices.iter().any(|end| name.ends_with(end)) && !good.integers[name].is_empty() {
            bad.integers.entry(name.clone()).or_default()[0] = u64::from(u32::MAX);
            refused(name, &bad);
        }
    }
    // Symptom guarded against: a warning of answers that differ, at a time that is not there.
    for counts in [[3, 0, 1], [0, 0, 1], [2, 2, 1]] {
        let mut bad = good.clone();
        bad.integers.insert("cross_checks/counts".into(), counts.into());
        refused("cross_checks", &bad);
    }
    target.restore(&good).expect("a failed attempt does not spoil the next");
    assert_same(&target.checkpoint().expect("finite"), &good);
}

#[test]
fn a_checkpoint_of_another_mesh_is_refused() {
    let mut other = discs("conserving", "midpoint");
    other["bodies"][0]["mesh"]["divisions"] = json!(8);
    let checkpoint = Simulation::<2>::new(&parse(&other)).expect("valid").checkpoint().expect("finite");
    let mut simulation = Simulation::<2>::new(&parse(&discs("conserving", "midpoint"))).expect("valid");
    let error = simulation.restore(&checkpoint).expect_err("another mesh");
    assert_eq!(error.array, "state/displacement");
    assert!(error.what.contains("entries"), "{error}");
}
