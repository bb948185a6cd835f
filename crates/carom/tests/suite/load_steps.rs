//! Static analyses: balance of forces step by step, held by supports or by contact and friction alone.

use carom::{Simulation, StepError};
use serde_json::{Value, json};

use crate::common::{body, parse, plane, scenario};

/// A static case of one block of E = 1000 Pa, 2 m wide and 1 m high, on the floor y = 0.
fn block(steps: usize) -> Value {
    let mesh = json!({"kind": "rectangle", "corner": [0.0, 0.0], "size": [2.0, 1.0], "divisions": [6, 3]});
    let floor = plane("floor", [0.0, 0.0], [0.0, 1.0]);
    let mut case = scenario(1.0, 1.0 / steps as f64, &[body("block", mesh, [0.0, 0.0])], &[floor]);
    case["analysis"] = json!({
        "kind": "static", "end_time": 1.0, "time_step": 1.0 / steps as f64, "max_halvings": 8, "gravity": null,
        "newton": {"tolerance": 1e-11, "max_iterations": 50},
    });
    case["materials"]["elastic"] =
        json!({"kind": "linear-elastic", "young": 1000.0, "poisson": 0.0, "density": 1.0});
    // Loose bodies make W ill-conditioned; the default solver bears it.
    case["contact"]["solver"]["kind"] = json!("auto");
    case["output"] = json!({"fields_every": 0.5, "history_every": 1.0 / steps as f64, "merge_contacts": 0.0});
    case
}

fn run(case: &Value) -> Simulation<2> {
    let mut simulation = Simulation::new(&parse(case)).expect("a valid case");
    simulation.advance(f64::INFINITY, || false).expect("converges");
    simulation
}

/// Last value of a column of the history.
fn last(simulation: &mut Simulation<2>, column: &str) -> f64 {
    simulation.finish();
    let columns = simulation.history_columns().to_vec();
    let index = columns.iter().position(|c| c == column).expect("a column");
    let rows = simulation.take_history();
    rows[rows.len() - columns.len() + index]
}

/// σ = 10 Pa on 1 m² stretches a bar of 2 m by σL/E = 0.02 m and pulls 10 N at its support. The load does ½Fu.
#[test]
fn pulled_bar_stretches_as_hooke_says() {
    let mut case = block(4);
    case["obstacles"] = json!([]);
    case["motions"] = json!([
        {"kind": "fixed", "body": "block", "on": "left", "components": ["x"]},
        {"kind": "fixed", "body": "block", "on": "bottom", "components": ["y"]},
    ]);
    case["loads"] = json!([{"kind": "traction", "body": "block", "on": "right", "traction": ["10*t", 0.0]}]);
    let mut simulation = run(&case);
    let stretch = simulation.state().displacement.iter().map(|u| u[0]).fold(0.0, f64::max);
    assert!((stretch - 0.02).abs() < 1e-12, "{stretch}");
    let ledger = simulation.books().total;
    assert!((ledger.strain - 0.1).abs() < 1e-12 && ledger.kinetic == 0.0, "{ledger:?}");
    assert!((ledger.external - 0.1).abs() < 1e-12, "{}", ledger.external);
    assert!(ledger.scheme.abs() < 1e-14 && ledger.defect().abs() < 1e-14, "{ledger:?}");
    assert!((last(&mut simulation, "block.left.force_x") + 10.0).abs() < 1e-10);
}

/// Nothing but the floor holds the block against its weight, and nothing but friction along it, however long the step is said to take.
#[test]
fn block_rests_on_its_weight() {
    for (slope, duration) in [(0.0, 1.0), (0.2, 1.0), (0.2, 1e4)] {
        let mut case = block(1);
        case["analysis"]["end_time"] = json!(duration);
        case["analysis"]["time_step"] = json!(duration);
        case["output"] = json!({"fields_every": duration, "history_every": duration, "merge_contacts": 0.0});
        case["contact"]["friction"] = json!(0.3);
        case["analysis"]["gravity"] = json!([10.0 * slope, -10.0]);
        let mut simulation = run(&case);
        let force = last(&mut simulation, "normal_force");
        assert!((force - 20.0).abs() < 1e-7, "{slope}: {force} N");
        let nodes = simulation.model().node_count();
        let along: f64 = simulation.state().contact_force[..nodes].iter().map(|f| f[0]).sum();
        assert!((along + 20.0 * slope).abs() < 1e-7, "{slope}: {along} N");
        let top = simulation.state().displacement.iter().map(|u| u[1]).fold(0.0, f64::min);
        // ρ g H²/2E without lateral strain, where friction lets go of the sides.
        assert!(slope > 0.0 || (top + 0.005).abs() < 0.05 * 0.005, "{slope}: {top} m");
    }
}

#[test]
fn body_that_nothing_holds_is_named() {
    for (gravity, friction, motion) in [
        ([0.0, 10.0], 0.0, "move along y"),
        ([4.0, -10.0], 0.3, "slide along x"),
        ([1.0, -10.0], 0.0, "slide along x"),
        // What is left undone is less than a hundredth of this.
        ([1e-2, -10.0], 0.0, "slide along x"),
    ] {
        let mut case = block(1);
        case["analysis"]["gravity"] = json!(gravity);
        case["analysis"]["max_halvings"] = json!(1);
        case["contact"]["friction"] = json!(friction);
        let mut simulation = Simulation::<2>::new(&parse(&case)).expect("a valid case");
        let error = simulation.advance(f64::INFINITY, || false).expect_err("nothing holds it");
        let not_held = StepError::NotHeld { body: "block".into(), motion: motion.into() };
        assert_eq!(error.reason, not_held, "{gravity:?}");
    }
}

/// A block pressed down and then dragged: once all of its foot slips the drag is μN, and friction takes what the drag does.
#[test]
fn dragged_block_slides_at_coulombs_force() {
    let mut case = block(20);
    case["contact"]["friction"] = json!(0.3);
    case["motions"] = json!([{
        "kind": "prescribed", "body": "block", "on": "top",
        "x": {"time": [0.2, 1.0], "value": [0.0, 0.4]}, "y": {"time": [0.0, 0.2], "value": [0.0, -0.02]},
    }]);
    let mut simulation = run(&case);
    let ledger = simulation.books().total;
    simulation.finish();
    let columns = simulation.history_columns().to_vec();
    let rows = simulation.take_history();
    let at = |row: usize, column: &str| {
        rows[row * columns.len() + columns.iter().position(|c| c == column).expect("a column")]
    };
    let (row, before) = (rows.len() / columns.len() - 1, rows.len() / columns.len() - 5);
    let (drag, press) = (at(row, "block.top.force_x"), -at(row, "block.top.force_y"));
    assert!((press - at(row, "normal_force")).abs() < 1e-7 * press, "{press} N");
    assert!((drag - 0.3 * press).abs() < 1e-7 * press, "{drag} N of {press} N");
    // While it slides as a whole nothing is stored: friction takes μ N times the way.
    let taken = at(row, "friction") - at(before, "friction");
    assert!((taken - 0.3 * press * 0.1).abs() < 1e-4 * taken, "{taken} J");
    assert!((at(row, "prescribed") - at(before, "prescribed") - taken).abs() < 1e-4 * taken);
    assert!(ledger.defect().abs() < 1e-10 * ledger.prescribed && ledger.kinetic == 0.0, "{ledger:?}");
}

#[test]
fn what_a_static_analysis_has_no_use_for_is_refused() {
    for (path, value, key) in [
        ("/contact/condition", json!("midpoint"), "contact.condition"),
        ("/bodies/0/velocity", json!([1.0, 0.0]), "bodies.0.velocity"),
        ("/bodies/0/spin", json!(1.0), "bodies.0.spin"),
    ] {
        let mut case = block(1);
        *case.pointer_mut(path).expect("there") = value;
        assert_eq!(Simulation::<2>::new(&parse(&case)).err().expect("refused").key, key);
    }
    let mut case = block(1);
    case["analysis"]["kind"] = json!("dynamic");
    assert_eq!(Simulation::<2>::new(&parse(&case)).err().expect("refused").key, "analysis.scheme");
}

/// What drives a case is refused with its place where it means nothing.
#[test]
fn loads_and_motions_that_mean_nothing_are_refused() {
    let load = |on: &str, force: Value| json!([{"kind": "force", "body": "block", "on": on, "force": force}]);
    let moved = |x: Value| json!([{"kind": "prescribed", "body": "block", "on": "top", "x": x}]);
    for (table, value, key, fact) in [
        ("loads", load("lid", json!([0.0, 0.0])), "loads.0.on", "\"top\""),
        ("loads", load("top", json!([0.0])), "loads.0.force", "2 components"),
        ("loads", load("top", json!([0.0, "sin(t"])), "loads.0.force.1", "column 6"),
        ("loads", load("top", json!([0.0, "log(t)"])), "loads.0.force.1", "t = 0 s is -inf"),
        (
            "loads",
            json!([{"kind": "pressure", "body": "lid", "on": "top", "pressure": 1.0}]),
            "loads.0.body",
            "block",
        ),
        ("motions", moved(json!(0.1)), "motions.0.x", "let it grow from 0"),
        ("motions", moved(json!({"time": [0.0, 0.0], "value": [0.0, 1.0]})), "motions.0.x", "must ascend"),
        (
            "motions",
            json!([{"kind": "prescribed", "body": "block", "on": "top"}]),
            "motions.0",
            "one of x, y, z",
        ),
        (
            "motions",
            json!([{"kind": "prescribed", "body": "block", "on": "top", "z": 0.0}]),
            "motions.0.z",
            "2 dimensions",
        ),
        (
            "motions",
            json!([{"kind": "fixed", "body": "block", "on": "left"},
                {"kind": "prescribed", "body": "block", "on": "top", "x": "t"}]),
            "motions.1.on",
            "motions.0",
        ),
    ] {
        let mut case = block(1);
        case[table] = value;
        let error = Simulation::<2>::new(&parse(&case)).err().expect("refused");
        assert_eq!(error.key, key, "{error}");
        assert!(error.message.contains(fact), "{error}");
    }
}
