//! Reduced bodies: momenta, energy, impacts against those of the whole mesh, and what a run of them remembers.

use carom::{Scheme, Simulation};
use serde_json::{Value, json};

use crate::checkpoint::goes_on_identically;
use crate::common::{body, disc, parse, plane, scenario};

/// A bar [4, 0.5] of `divisions` along its height, whose left end may touch, with so many modes.
fn bar(kind: &str, divisions: usize, modes: usize) -> Value {
    let mesh = json!({"kind": "rectangle", "size": [4.0, 0.5], "corner": [0.0, 0.0], "divisions": [8 * divisions, divisions]});
    let mut bar = body("bar", mesh, [-1.0, 0.0]);
    bar["contact_sets"] = json!(["left"]);
    bar["kind"] = json!(kind);
    if kind == "reduced" {
        bar["modes"] = json!(modes);
    }
    bar
}

fn flying(bodies: &[Value], obstacles: &[Value], span: [f64; 2]) -> Value {
    let mut case = scenario(span[0], span[1], bodies, obstacles);
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
        let mut bar = bar("reduced", 4, 6);
        bar["spin"] = json!(3.0);
        let mut case = flying(&[bar], &[], [2.0, 1e-2]);
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

/// Invariant: nothing acts on two bodies from outside, and friction takes what is missing; the reduced one turns, meets the other askew and rings.
#[test]
fn reduced_and_elastic_bodies_keep_momentum_and_energy() {
    let mut simulation = run(&meeting());
    assert!(!simulation.summary().contacts.is_empty(), "they meet");
    let names = ["momentum_x", "momentum_y", "angular_momentum", "total", "friction", "defect", "strain"];
    let [x, y, moment, total, friction, defect, strain] = columns(&mut simulation, names);
    assert!(drift(&x).max(drift(&y)) < 1e-12 * total[0], "{:e} {:e}", drift(&x), drift(&y));
    // Reactions act where nodes land half way, on two sides of what is still open: as of two whole bodies.
    assert!(drift(&moment) < 1e-4 * total[0], "{:e}", drift(&moment));
    assert!(drift(&defect) < 1e-10 * total[0], "{:e}", drift(&defect));
    let kept: Vec<f64> = total.iter().zip(&friction).map(|(e, f)| e + f).collect();
    assert!(drift(&kept) < 1e-10 * total[0], "{:e}", drift(&kept));
    assert!(friction.last().is_some_and(|f| *f > 1e-4 * total[0]), "it rubs: {friction:?}");
    assert!(strain.last().is_some_and(|s| *s > 1e-3 * total[0]), "it rings: {strain:?}");
}

/// A bar that turns and meets a disc askew.
fn meeting() -> Value {
    let mut bar = bar("reduced", 4, 6);
    bar["spin"] = json!(0.4);
    flying(&[bar, body("soft", disc([-1.05, 0.3], 1.0, 4), [0.5, 0.0])], &[], [0.4, 2e-3])
}

/// Reference: the same bar with its whole mesh. The error of the end that flies freely falls with the number of modes.
#[test]
fn an_impact_on_a_wall_is_that_of_the_whole_the_more_modes_there_are() {
    let end = |bar: Value| {
        let mut case = flying(&[bar], &[plane("wall", [0.0, 0.0], [1.0, 0.0])], [0.3, 1e-3]);
        case["bodies"][0]["velocity"] = json!([-0.2, 0.0]);
        case["output"]["history_every"] = json!(1e-3);
        case["materials"]["elastic"]["kind"] = json!("linear-elastic");
        case["output"]["track"] = json!([{"name": "end", "body": "bar", "point": [4.0, 0.25]}]);
        let [u, energy, friction] = columns(&mut run(&case), ["end.u_x", "total", "friction"]);
        let kept: Vec<f64> = energy.iter().zip(&friction).map(|(e, f)| e + f).collect();
        assert!(drift(&kept) < 1e-9 * kept[0], "{:e}", drift(&kept));
        u
    };
    let whole = end(bar("deformable", 4, 0));
    let largest = whole.iter().fold(0.0_f64, |most, u| most.max(u.abs()));
    let inside = 2 * (33 * 5 - 5);
    let errors = [0, 4, 8, 16, 64, inside].map(|modes| {
        let own = end(bar("reduced", 4, modes));
        own.iter().zip(&whole).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / largest
    });
    assert!(errors.windows(2).all(|pair| pair[1] < pair[0]), "{errors:?}");
    assert!(errors[3] < 0.05 && errors[5] < 1e-7, "{errors:?}");
}

#[test]
fn a_run_of_a_reduced_body_goes_on_identically() {
    goes_on_identically::<2>(&meeting(), 3);
}
