//! Rigid bodies among others: momenta, energy, and what a run of them remembers.

use carom::{Scheme, Simulation};
use serde_json::{Value, json};

use crate::common::{body, disc, parse, plane, scenario};

/// A rigid body of density 2.
pub fn rigid(name: &str, mesh: Value, velocity: [f64; 2], spin: f64) -> Value {
    json!({
        "kind": "rigid", "name": name, "density": 2.0, "hypothesis": "plane-strain", "thickness": 1.0, "mesh": mesh,
        "velocity": velocity, "spin": spin,
    })
}

/// A rigid disc that turns, and meets an elastic one askew.
pub fn meeting(condition: &str) -> Value {
    let bodies = [
        rigid("hard", disc([0.0, 0.0], 1.0, 4), [1.0, 0.2], 3.0),
        body("soft", disc([2.05, 0.3], 1.0, 4), [-1.0, 0.0]),
    ];
    let mut case = scenario(0.2, 2e-3, &bodies, &[]);
    case["analysis"]["scheme"] = json!({"kind": "conserving"});
    case["contact"]["condition"] = json!(condition);
    case["contact"]["friction"] = json!(0.3);
    case["contact"]["sources"] = Value::Null;
    case["contact"]["solver"]["kind"] = json!("auto");
    case
}

fn run(case: &Value) -> Simulation<2> {
    let mut simulation = Simulation::<2>::new(&parse(case)).expect("valid");
    simulation.advance(f64::INFINITY, || false).expect("runs");
    simulation.finish();
    simulation
}

/// A column of the history.
fn column(simulation: &mut Simulation<2>, names: &[&str]) -> Vec<Vec<f64>> {
    let columns = simulation.history_columns().to_vec();
    let rows = simulation.take_history();
    let place = |name: &str| columns.iter().position(|c| c == name).expect("a column");
    let at = |name: &&str| rows.chunks(columns.len()).map(|row| row[place(name)]).collect();
    names.iter().map(at).collect()
}

/// How far a column moves from where it starts.
fn drift(values: &[f64]) -> f64 {
    values.iter().map(|x| (x - values[0]).abs()).fold(0.0, f64::max)
}

/// Invariant: nothing acts on the two from outside, and friction takes what is missing.
#[test]
fn a_rigid_body_and_an_elastic_one_keep_momentum_and_energy() {
    let mut simulation = run(&meeting("midpoint"));
    assert!(!simulation.summary().contacts.is_empty(), "they meet");
    let names = ["momentum_x", "momentum_y", "total", "friction", "defect"];
    let [x, y, total, friction, defect] =
        <[Vec<f64>; 5]>::try_from(column(&mut simulation, &names)).expect("five columns");
    assert!(drift(&x).max(drift(&y)) < 1e-12 * total[0], "{:e} {:e}", drift(&x), drift(&y));
    assert!(drift(&defect) < 1e-10 * total[0], "{:e}", drift(&defect));
    let kept: Vec<f64> = total.iter().zip(&friction).map(|(e, f)| e + f).collect();
    assert!(drift(&kept) < 1e-8 * total[0], "{:e}", drift(&kept));
    assert!(friction.last().is_some_and(|f| *f > 1e-3 * total[0]), "it rubs");
}

/// Closed form: a disc that turns freely has ½ J ω², J = ∫ρ r² of its polygon, for any scheme without loss.
#[test]
fn a_free_rigid_body_keeps_its_spin() {
    for scheme in [Scheme::Conserving, Scheme::Theta { theta: 0.5, xi: 0.5 }] {
        let mut case = scenario(1.0, 1e-2, &[rigid("hard", disc([1.0, 2.0], 1.0, 8), [0.3, 0.0], 3.0)], &[]);
        case["analysis"]["scheme"] = serde_json::to_value(scheme).expect("plain data");
        let mut simulation = run(&case);
        let names = ["hard.spin", "total", "angular_momentum", "hard.x"];
        let [spin, total, moment, x] =
            <[Vec<f64>; 4]>::try_from(column(&mut simulation, &names)).expect("four columns");
        assert!(drift(&spin) < 1e-12 * spin[0]);
        assert!(drift(&total) < 1e-12 * total[0]);
        assert!(drift(&moment) < 1e-12 * moment[0].abs());
        assert!((x[x.len() - 1] - x[0] - 0.3).abs() < 1e-13);
    }
}

/// Closed form: without friction a flat stop at the floor leaves −e of the velocity that gravity gave.
#[test]
fn a_box_bounces_as_its_restitution_says() {
    let square = json!({"kind": "rectangle", "corner": [0.0, 0.0], "size": [1.0, 1.0], "divisions": [1, 1]});
    let mut case = scenario(
        1e-2,
        1e-2,
        &[rigid("box", square, [0.0, -2.0], 0.0)],
        &[plane("floor", [0.0, 0.0], [0.0, 1.0])],
    );
    case["contact"]["condition"] = json!("endpoint");
    case["contact"]["pairs"] = json!([{"between": ["floor", "box"], "friction": null, "sources": null, "discretisation": null, "restitution": 0.7}]);
    let mut simulation = run(&case);
    let velocity = column(&mut simulation, &["box.v_y"]).remove(0);
    assert!((velocity[velocity.len() - 1] - 1.4).abs() < 1e-12, "{velocity:?}");
}

/// What the Python layer does not let through, and the core must not believe.
#[test]
fn what_no_rigid_body_can_be_is_refused() {
    let square = json!({"kind": "rectangle", "corner": [0.0, 0.0], "size": [1.0, 1.0], "divisions": [1, 1]});
    let refused = |change: &dyn Fn(&mut Value)| {
        let bodies = [
            rigid("hard", square.clone(), [0.0, 0.0], 0.0),
            body("soft", disc([5.0, 0.0], 1.0, 4), [0.0, 0.0]),
        ];
        let mut case = scenario(1e-2, 1e-2, &bodies, &[]);
        change(&mut case);
        Simulation::<2>::new(&parse(&case)).map(|_| ()).expect_err("refused").to_string()
    };
    let set = |place: &'static str, value: Value| {
        refused(&|case: &mut Value| *case.pointer_mut(place).expect("it is there") = value.clone())
    };
    let add = |body: usize, key: &'static str, value: Value| {
        refused(&|case: &mut Value| case["bodies"][body][key] = value.clone())
    };
    let messages = [
        (set("/bodies/0/density", Value::Null), "is rigid and has no density; give it, or its mass"),
        (add(0, "mass", json!(1.0)), "a rigid body has a density or a mass, not both"),
        (add(0, "inertia", json!(-1.0)), "the inertia must be greater than 0 kg m²"),
        (add(0, "inertia", json!([1.0, 1.0, 1.0])), "an inertia in 2D is a number"),
        (add(0, "round", json!(true)), "is round with a disc or a ball as its mesh"),
        (add(1, "round", json!(true)), "deforms and is what its mesh makes it"),
        (add(1, "mass", json!(1.0)), "a mass is given of a rigid body"),
        (
            refused(&|case| {
                case["bodies"][0]["density"] = Value::Null;
                case["bodies"][0]["mass"] = json!(-1.0);
            }),
            "the mass must be greater than 0 kg",
        ),
        (
            refused(&|case| case["bodies"][0]["mesh"]["periodic"] = json!(true)),
            "is rigid and cannot be periodic; leave periodic out",
        ),
        (
            refused(&|case| {
                case["contact"]["condition"] = json!("endpoint");
                case["contact"]["restitution"] = json!(2.0);
            }),
            "a restitution is between 0 and 1",
        ),
    ];
    for (said, expected) in messages {
        assert!(said.contains(expected), "{said}");
    }
}
