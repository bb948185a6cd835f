//! Steps that fail are halved; those that cannot succeed stop the run and leave the last good state.

use crate::common::{body, disc, parse, plane, scenario};
use carom::{Outcome, Simulation, StepError};
use serde_json::{Value, json};

/// A disc that hits a floor in steps of 10 ms.
fn drop_on_floor() -> Value {
    let disc = body("disc", disc([0.0, 1.05], 1.0, 4), [0.5, -3.0]);
    let mut case = scenario(0.2, 1e-2, &[disc], &[plane("floor", [0.0, 0.0], [0.0, 1.0])]);
    case["contact"]["friction"] = json!(0.3);
    case
}

#[test]
fn failed_steps_are_halved_and_the_time_grid_stays() {
    let mut case = drop_on_floor();
    case["analysis"]["newton"]["max_iterations"] = json!(5);
    let mut simulation = Simulation::<2>::new(&parse(&case)).expect("valid");
    assert_eq!(simulation.advance(f64::INFINITY, || false), Ok(Outcome::Reached));
    let summary = simulation.summary();
    assert!(summary.retried_steps > 0, "five iterations are too few for the first impact of these steps");
    assert_eq!((summary.steps, summary.end_time), (20, 0.2));
    assert!(summary.min_gap > -1e-12);
    let rows = simulation.take_history();
    let width = simulation.history_columns().len();
    let column = |name: &str| simulation.history_columns().iter().position(|c| c == name).expect("there");
    let (retried, shortest) = (column("retried_steps"), column("shortest_step"));
    let mut sum = 0.0;
    for (k, row) in rows.chunks_exact(width).enumerate().skip(1) {
        assert!((row[0] - k as f64 * 1e-2).abs() < 1e-15, "row {k} at t = {}", row[0]);
        let halvings = (1e-2 / row[shortest]).log2();
        assert!((halvings - halvings.round()).abs() < 1e-9, "row {k}: {} s", row[shortest]);
        assert_eq!(row[retried] > 0.0, halvings > 0.5, "row {k}");
        sum += row[retried];
    }
    assert_eq!(sum, summary.retried_steps as f64);
}

#[test]
fn a_run_that_cannot_go_on_says_why_and_keeps_the_last_good_state() {
    let mut case = drop_on_floor();
    case["analysis"]["newton"]["max_iterations"] = json!(1);
    case["analysis"]["max_halvings"] = json!(3);
    let mut simulation = Simulation::<2>::new(&parse(&case)).expect("valid");
    let error =
        simulation.advance(f64::INFINITY, || false).expect_err("one iteration cannot solve an impact");
    assert!(matches!(error.reason, StepError::Newton { iterations: 1, .. }), "{error}");
    assert_eq!((error.halvings, error.time_step), (3, 1e-2 / 8.0));
    assert_eq!(error.time, simulation.time());
    assert!(simulation.state().is_finite(&simulation.model().assembly));
    let before = simulation.take_history().len();
    simulation.finish();
    assert!(simulation.take_history().len() <= before + simulation.history_columns().len());
    let energy = simulation.summary().energy;
    assert!(energy.max_drift < 1e-13 * energy.initial, "free flight up to the impact changes no energy");
}

/// Symptom guarded against: runs with massless nodes that completed without a fifth of their energy.
#[test]
fn violent_impacts_of_massless_nodes_keep_their_energy() {
    let ball = body("ball", disc([1.25, 1.25], 0.8009, 4), [0.076, 2.312]);
    let walls = [plane("floor", [0.0, 0.0], [0.0, 1.0]), plane("west", [0.0, 0.0], [1.0, 0.0])];
    let mut case = scenario(0.649, 8.11e-3, &[ball], &walls);
    case["bodies"][0]["spin"] = json!(20.07);
    case["materials"]["elastic"] =
        json!({"kind": "linear-elastic", "young": 10360.0, "poisson": 0.3, "density": 1.0});
    case["analysis"]["scheme"] = json!({"kind": "conserving"});
    case["analysis"]["gravity"] = json!([0.0, -9.81]);
    case["contact"]["condition"] = json!("massless");
    case["contact"]["targets"] = json!("smooth");
    case["contact"]["friction"] = json!(0.2765);
    let mut simulation = Simulation::<2>::new(&parse(&case)).expect("valid");
    assert_eq!(simulation.advance(f64::INFINITY, || false), Ok(Outcome::Reached));
    let summary = simulation.summary();
    assert!(summary.energy.max_defect < 1e-12 * summary.energy.initial, "{:?}", summary.energy);
}

/// Symptom guarded against: corners that fold snapped, and what that set free stayed out of the books.
#[test]
fn what_folding_corners_set_free_goes_into_vibration() {
    let mesh = json!({"kind": "rectangle", "corner": [0.5, 0.5], "size": [1.0, 1.0], "divisions": [3, 3]});
    let block = body("block", mesh, [-20.0, -20.0]);
    let walls = [plane("floor", [0.0, 0.0], [0.0, 1.0]), plane("west", [0.0, 0.0], [1.0, 0.0])];
    let mut case = scenario(0.3, 2e-3, &[block], &walls);
    case["bodies"][0]["spin"] = json!(5.0);
    case["materials"]["elastic"] =
        json!({"kind": "saint-venant-kirchhoff", "young": 1e4, "poisson": 0.3, "density": 1.0});
    case["analysis"]["scheme"] = json!({"kind": "conserving"});
    case["analysis"]["gravity"] = json!([0.0, -9.81]);
    case["contact"]["condition"] = json!("massless");
    case["contact"]["targets"] = json!("smooth");
    case["contact"]["friction"] = json!(0.2765);
    let mut simulation = Simulation::<2>::new(&parse(&case)).expect("valid");
    assert_eq!(simulation.advance(f64::INFINITY, || false), Ok(Outcome::Reached));
    let summary = simulation.summary();
    assert!(summary.energy.max_defect < 1e-12 * summary.energy.initial, "{:?}", summary.energy);
    assert!(
        summary.repaid > 1e-3 * summary.energy.initial,
        "the blend alone would do: {:e} J",
        summary.repaid
    );
}

/// Symptom guarded against: what damping leaves over at the onset of each contact ended runs whose bodies had lost most of their energy.
#[test]
fn damped_bodies_may_come_to_rest_on_massless_nodes() {
    let ball = body("ball", disc([0.0, 0.51], 0.5, 4), [0.0, -1.0]);
    let mut case = scenario(1.0, 2e-3, &[ball], &[plane("floor", [0.0, 0.0], [0.0, 1.0])]);
    case["materials"]["elastic"]["young"] = json!(1e4);
    case["materials"]["elastic"]["damping"] = json!({"mass": 0.0, "stiffness": 2e-3});
    case["analysis"]["scheme"] = json!({"kind": "conserving"});
    case["analysis"]["gravity"] = json!([0.0, -9.81]);
    case["contact"]["condition"] = json!("massless");
    let mut simulation = Simulation::<2>::new(&parse(&case)).expect("valid");
    assert_eq!(simulation.advance(f64::INFINITY, || false), Ok(Outcome::Reached));
    let energy = simulation.summary().energy;
    assert!(energy.terms.viscous > 0.5 * energy.initial, "{energy:?}");
    // At rest next to nothing vibrates that could pay.
    assert!(energy.max_defect < 2e-5 * energy.initial, "{energy:?}");
}

/// Symptom guarded against: the smallest gap of a body that may touch itself was zero all the time, as its nodes are on its own surface.
#[test]
fn the_smallest_gap_in_flight_is_the_way_to_the_floor() {
    let mut case = drop_on_floor();
    case["output"]["history_every"] = json!(1e-2);
    let mut simulation = Simulation::<2>::new(&parse(&case)).expect("valid");
    let nodes = simulation.model().node_count();
    let mut lowest = Vec::new();
    let mut note = |simulation: &Simulation<2>| {
        let places = simulation.model().assembly.reference.iter().zip(&simulation.state().displacement);
        lowest.push(places.take(nodes).map(|(x, u)| x[1] + u[1]).fold(f64::INFINITY, f64::min));
    };
    note(&simulation);
    while simulation.step() < simulation.steps() {
        simulation.advance(f64::INFINITY, || true).expect("runs");
        note(&simulation);
    }
    let rows = simulation.take_history();
    let width = simulation.history_columns().len();
    let gap = simulation.history_columns().iter().position(|c| c == "min_gap").expect("there");
    let gaps: Vec<f64> = rows.chunks_exact(width).map(|row| row[gap]).collect();
    assert_eq!(gaps.len(), lowest.len());
    assert!(gaps[0] > 1e-3, "{} m", gaps[0]);
    for (gap, lowest) in gaps.iter().zip(&lowest) {
        assert!((gap - lowest).abs() < 1e-12, "{gap} m, and the lowest node is {lowest} m above the floor");
    }
}
