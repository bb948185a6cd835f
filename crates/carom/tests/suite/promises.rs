//! What a case says of one pair or one body holds of that one and of no other.

use crate::common::{body, parse, plane, scenario};
use carom::Simulation;
use serde_json::{Value, json};

/// Three blocks that slide along a floor at 2 m/s, far from one another.
fn sliders(dimension: usize) -> Value {
    let names = ["a", "b", "c"];
    let bodies: Vec<Value> = (0..3)
        .map(|k| {
            let x = 5.0 * k as f64;
            let mesh = if dimension == 2 {
                json!({"kind": "rectangle", "corner": [x, 0.0], "size": [1.0, 0.5], "divisions": [2, 1]})
            } else {
                json!({"kind": "box", "corner": [x, 0.0, 0.0], "size": [1.0, 0.7, 0.5], "divisions": [2, 1, 1]})
            };
            let mut slider = body(names[k], mesh, [2.0, 0.0]);
            if dimension == 3 {
                slider["velocity"] = json!([2.0, 0.0, 0.0]);
                slider["spin"] = json!([0.0, 0.0, 0.0]);
            }
            slider
        })
        .collect();
    let up: Vec<f64> = (0..dimension).map(|i| if i == dimension - 1 { 1.0 } else { 0.0 }).collect();
    let floor = json!({"name": "floor", "kind": "plane", "point": vec![0.0; dimension], "normal": up});
    let mut case = scenario(0.2, 1e-3, &bodies, &[floor]);
    case["dimension"] = json!(dimension);
    case["analysis"]["gravity"] = json!(up.iter().map(|u| -10.0 * u).collect::<Vec<_>>());
    case["analysis"]["scheme"] = json!({"kind": "conserving"});
    case["analysis"]["newton"]["tolerance"] = json!(1e-11);
    case["materials"]["elastic"]["young"] = json!(1e6);
    case["materials"]["elastic"]["density"] = json!(1000.0);
    case["contact"]["condition"] = json!("gap");
    case
}

fn run<const D: usize>(case: &Value) -> Simulation<D> {
    let mut simulation = Simulation::<D>::new(&parse(case)).expect("a valid case");
    simulation.advance(f64::INFINITY, || false).expect("converges");
    simulation
}

/// Symptom guarded against: every contact took the friction coefficient of the first pair, and no test of the core noticed.
///
/// While a block slides, friction takes μ times the impulse of the floor, whatever the block does across it: m Δv_t = −μ (m g t + m Δv_n).
#[test]
fn every_pair_rubs_with_its_own_friction() {
    fn check<const D: usize>() {
        let coefficients = [0.1, 0.35, 0.0];
        for order in [[0, 1, 2], [2, 0, 1], [1, 2, 0]] {
            let mut case = sliders(D);
            case["contact"]["friction"] = json!(0.2);
            let pairs: Vec<Value> = order
                .iter()
                .map(|&k| {
                    let name = ["a", "b", "c"][k];
                    json!({"between": [name, "floor"], "friction": coefficients[k]})
                })
                .collect();
            case["contact"]["pairs"] = json!(pairs);
            let simulation = run::<D>(&case);
            let books = simulation.books();
            for (k, mu) in coefficients.into_iter().enumerate() {
                let b = &simulation.model().bodies[k];
                let v = b.body.mean(&simulation.state().velocity[b.nodes()]);
                let taken = mu * (10.0 * 0.2 + v[D - 1]);
                // In space a block that is compressed spreads, and slides a little sideways too.
                let off = if D == 2 { 1e-9 } else { 1e-2 * taken + 1e-9 };
                assert!(
                    (v[0] - 2.0 + taken).abs() <= off,
                    "{D}D, μ = {mu}: {} taken, {taken} due",
                    2.0 - v[0]
                );
                let names = [b.name.clone(), "floor".to_string()];
                let between = simulation.model().assembly.between(&names).expect("a pair with the floor");
                let work = books.pairs.get(between).expect("it touches").friction;
                assert!((work > 0.0) == (mu > 0.0), "{D}D, μ = {mu}: {work} J");
            }
        }
    }
    check::<2>();
    check::<3>();
}

/// A pair that is not enabled does not touch, and the others do.
#[test]
fn a_pair_that_is_disabled_is_the_only_one_that_does_not_touch() {
    let mut case = sliders(2);
    case["contact"]["pairs"] = json!([{"between": ["floor", "b"], "enabled": false}]);
    let simulation = run::<2>(&case);
    let height = |k: usize| {
        let b = &simulation.model().bodies[k];
        b.body.mean(&simulation.state().displacement[b.nodes()])[1]
    };
    assert!((height(1) + 0.5 * 10.0 * 0.2 * 0.2).abs() < 1e-10, "it falls: {}", height(1));
    assert!(height(0).abs() < 1e-2 && height(2).abs() < 1e-2, "they rest: {} {}", height(0), height(2));
}

/// Density, thickness, damping and velocity are those of the body that has them: the others move as if it were not there.
#[test]
fn what_a_body_is_made_of_is_its_own_affair() {
    let plain = run::<2>(&sliders(2));
    let mut case = sliders(2);
    case["materials"]["other"] = json!({
        "kind": "neo-hookean", "young": 3e6, "poisson": 0.2, "density": 500.0,
        "damping": {"mass": 1.0, "stiffness": 1e-4},
    });
    case["bodies"][1]["material"] = json!("other");
    case["bodies"][1]["thickness"] = json!(0.1);
    case["bodies"][1]["mass"] = json!("lumped");
    let mixed = run::<2>(&case);
    let nodes = |s: &Simulation<2>, k: usize| {
        let b = &s.model().bodies[k];
        s.state().displacement[b.nodes()].to_vec()
    };
    let apart = |k: usize| {
        let (a, b) = (nodes(&plain, k), nodes(&mixed, k));
        a.iter().zip(&b).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max)
    };
    assert!(apart(0) < 1e-12 && apart(2) < 1e-12 && apart(1) > 1e-6, "{:?}", [0, 1, 2].map(apart));
    let mass = |k: usize| mixed.model().bodies[k].body.total_mass();
    assert!((mass(0) - 500.0).abs() < 1e-9 && (mass(1) - 25.0).abs() < 1e-9, "{} {}", mass(0), mass(1));
    let viscous = |k: usize| mixed.books().bodies[k].viscous;
    assert!(viscous(0) == 0.0 && viscous(1) > 0.0 && viscous(2) == 0.0);
}

/// A stack in which every floor has its own friction: a block drawn from below moves those above by what their own interface bears.
#[test]
fn the_interface_between_two_bodies_has_the_friction_of_that_pair() {
    let bodies: Vec<Value> = ["low", "high"]
        .iter()
        .enumerate()
        .map(|(k, name)| {
            let size = [if k == 0 { 3.0 } else { 1.0 }, 0.5];
            let mesh =
                json!({"kind": "rectangle", "corner": [0.0, 0.5 * k as f64], "size": size, "divisions": [3 - k, 1]});
            body(name, mesh, [if k == 0 { 0.0 } else { 3.0 }, 0.0])
        })
        .collect();
    let mut case = scenario(0.1, 1e-3, &bodies, &[plane("floor", [0.0, 0.0], [0.0, 1.0])]);
    case["analysis"]["gravity"] = json!([0.0, -10.0]);
    case["analysis"]["newton"]["tolerance"] = json!(1e-11);
    case["materials"]["elastic"]["young"] = json!(1e6);
    case["materials"]["elastic"]["density"] = json!(1000.0);
    case["contact"]["condition"] = json!("gap");
    case["contact"]["friction"] = json!(0.9);
    case["contact"]["pairs"] = json!([
        {"between": ["low", "floor"], "friction": 0.8}, {"between": ["high", "low"], "friction": 0.05},
    ]);
    let simulation = run::<2>(&case);
    let velocity = |k: usize| {
        let b = &simulation.model().bodies[k];
        b.body.mean(&simulation.state().velocity[b.nodes()])
    };
    let (low, high) = (velocity(0), velocity(1));
    // The upper block slides all the time, on what it has dented; the lower one is held by the floor.
    let pairs = &simulation.books().pairs;
    let of = |names: [&str; 2]| {
        let between = simulation.model().assembly.between(&names.map(String::from)).expect("a pair");
        pairs.get(between).expect("they touch").friction
    };
    let due = 0.05 * 500.0 * 10.0 * 3.0 * 0.1;
    assert!((of(["high", "low"]) / due - 1.0).abs() < 0.2, "{} J of {due} J", of(["high", "low"]));
    assert!(low[0].abs() < 0.1 && high[0] > 2.9, "{low} {high}");
}
