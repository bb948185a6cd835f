//! Reduced bodies: free flight, and what a run of them remembers. Impacts are those of `tests/unit/running/test_reduced_bodies.py`.

use carom::{Scheme, Simulation};
use serde_json::{Value, json};

use crate::checkpoint::goes_on_identically;
use crate::common::{body, disc, parse, scenario};

/// A bar [4, 0.5] of `divisions` along its height, whose left end may touch, with so many modes.
fn bar(divisions: usize, modes: usize) -> Value {
    let mesh = json!({"kind": "rectangle", "size": [4.0, 0.5], "corner": [0.0, 0.0], "divisions": [8 * divisions, divisions]});
    let mut bar = body("bar", mesh, [-1.0, 0.0]);
    bar["contact_sets"] = json!(["left"]);
    bar["kind"] = json!("reduced");
    bar["modes"] = json!(modes);
    bar
}

fn flying(bodies: &[Value], span: [f64; 2]) -> Value {
    let mut case = scenario(span[0], span[1], bodies, &[]);
    case["analysis"]["scheme"] = json!({"kind": "conserving"});
    case["contact"]["condition"] = json!("midpoint");
    case["contact"]["sources"] = Value::Null;
    case["contact"]["solver"]["kind"] = json!("auto");
    case["contact"]["friction"] = json!(0.3);
    case
}

fn run(case: &Value) -> Simulation<2> {
    let mut simulation = Simulation::<2>::new(&parse(case)).expect("valid");
    simulation.advance(f64::INFINITY, || false).expect("runs");
    simulation.finish();
    simulation
}

/// Columns of the history.
fn columns<const N: usize>(simulation: &mut Simulation<2>, names: [&str; N]) -> [Vec<f64>; N] {
    let columns = simulation.history_columns().to_vec();
    let rows = simulation.take_history();
    let place = |name: &str| columns.iter().position(|c| c == name).expect("a column");
    names.map(|name| rows.chunks(columns.len()).map(|row| row[place(name)]).collect())
}

/// How far a column moves from where it starts.
fn drift(values: &[f64]) -> f64 {
    values.iter().map(|x| (x - values[0]).abs()).fold(0.0, f64::max)
}

/// Invariant: a body that flies and spins neither deforms nor loses anything.
#[test]
fn a_free_reduced_body_spins_for_ever() {
    for scheme in [Scheme::Conserving, Scheme::Theta { theta: 0.5, xi: 0.5 }] {
        let mut bar = bar(4, 6);
        bar["spin"] = json!(3.0);
        let mut case = flying(&[bar], [2.0, 1e-2]);
        case["analysis"]["scheme"] = serde_json::to_value(scheme).expect("plain data");
        let mut simulation = run(&case);
        let [spin, total, strain, moment, x] =
            columns(&mut simulation, ["bar.spin", "total", "strain", "angular_momentum", "bar.x"]);
        assert!(drift(&spin) < 1e-11 * spin[0], "{:e}", drift(&spin));
        assert!(drift(&total) < 1e-12 * total[0], "{:e}", drift(&total));
        assert!(drift(&strain) < 1e-20 * total[0], "{:e}", drift(&strain));
        assert!(drift(&moment) < 1e-12 * moment[0].abs(), "{:e}", drift(&moment));
        assert!((x[x.len() - 1] - x[0] + 2.0).abs() < 1e-12, "{x:?}");
    }
}

/// A bar that turns and meets a disc askew.
fn meeting() -> Value {
    let mut bar = bar(4, 6);
    bar["spin"] = json!(0.4);
    flying(&[bar, body("soft", disc([-1.05, 0.3], 1.0, 4), [0.5, 0.0])], [0.4, 2e-3])
}

#[test]
fn a_run_of_a_reduced_body_goes_on_identically() {
    goes_on_identically::<2>(&meeting(), 3);
}

/// Invariant: a step that is repeated in halves begins as if there had been none, so that the books close as ever.
#[test]
fn a_reduced_body_forgets_the_step_that_failed() {
    let mut case = meeting();
    case["analysis"]["newton"]["max_iterations"] = json!(5);
    let summary = run(&case).summary();
    assert!(summary.retried_steps > 0, "no step failed");
    let defect = summary.energy.max_defect / summary.energy.initial;
    assert!(defect < 1e-11, "{defect:e} after {} repeated steps", summary.retried_steps);
}
