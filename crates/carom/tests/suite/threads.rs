//! Threads share the work of large bodies, and of many, without a trace in the results.

use carom::Simulation;
use serde_json::{Value, json};

use crate::common::{body, parse, plane, scenario};

/// A disc of 38,722 unknowns lands on a floor.
#[test]
fn states_do_not_depend_on_the_number_of_threads() {
    let mesh = json!({"kind": "disc", "centre": [0.0, 1.0002], "radius": 1.0, "divisions": 80});
    let floor = plane("floor", [0.0, 0.0], [0.0, 1.0]);
    let mut case = scenario(1e-3, 2e-4, &[body("disc", mesh, [0.0, -0.6])], &[floor]);
    case["analysis"]["scheme"] = json!({"kind": "conserving"});
    case["contact"]["condition"] = json!("midpoint");
    let state = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let mut simulation = Simulation::<2>::new(&parse(&case)).expect("a valid case");
            simulation.advance(f64::INFINITY, || false).expect("converges");
            assert!(simulation.progress().contacts > 0);
            simulation.state().clone()
        })
    };
    let one = state(1);
    assert_eq!(state(2), one);
    assert_eq!(state(3), one);
}

/// Pairs of discs that meet at speeds of their own, and as many that nothing touches: with few iterations allowed the fast ones fail, and the step is halved.
fn many_islands(condition: &str, iterations: usize, halvings: usize) -> Value {
    let disc = |x: f64, y: f64, divisions: usize| json!({"kind": "disc", "centre": [x, y], "radius": 1.0, "divisions": divisions});
    let mut bodies = Vec::new();
    for k in 0..8 {
        let (x, speed) = (10.0 * k as f64, 0.2 * (k * k) as f64);
        bodies.push(body(&format!("a{k}"), disc(x, 2.0, 10 + 2 * (k % 3)), [speed, 0.1]));
        bodies.push(body(&format!("alone{k}"), disc(x, 8.0, 8 + 2 * (k % 4)), [0.3, -speed]));
        bodies.push(body(&format!("b{k}"), disc(x + 2.02, 2.1, 14 - 2 * (k % 3)), [-speed, 0.0]));
    }
    if condition != "massless" {
        // Bodies of other kinds, in islands after some that fail.
        let (rigid, reduced) = (3 * 6, 3 * 7 + 2);
        let given = bodies[rigid].as_object_mut().expect("a body");
        given
            .retain(|key, _| ["name", "mesh", "velocity", "hypothesis", "thickness"].contains(&key.as_str()));
        given.extend([("kind".into(), json!("rigid")), ("density".into(), json!(1.0))]);
        bodies[reduced]["kind"] = json!("reduced");
        bodies[reduced]["modes"] = json!(3);
    }
    let mut case = scenario(0.02, 4e-3, &bodies, &[plane("floor", [0.0, 0.0], [0.0, 1.0])]);
    case["analysis"]["scheme"] = json!({"kind": "conserving"});
    case["analysis"]["newton"]["max_iterations"] = json!(iterations);
    case["analysis"]["max_halvings"] = json!(halvings);
    case["contact"]["condition"] = json!(condition);
    case["contact"]["friction"] = json!(0.3);
    case["contact"]["sources"] = Value::Null;
    case["contact"]["solver"]["kind"] = json!("auto");
    case
}

#[test]
fn islands_side_by_side_come_to_what_one_thread_makes_of_them_also_where_some_fail() {
    for (condition, iterations) in [("gap", 6), ("midpoint", 6), ("massless", 14)] {
        let end = |threads, halvings| {
            let case = many_islands(condition, iterations, halvings);
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            pool.install(|| {
                let mut simulation = Simulation::<2>::new(&parse(&case)).expect("a valid case");
                let ended = simulation.advance(f64::INFINITY, || false).map_err(|error| error.to_string());
                let summary = simulation.summary();
                let posed =
                    simulation.posed_problem().map(|posed| (posed.problem.clone(), posed.guess.to_vec()));
                (
                    ended.err(),
                    simulation.state().clone(),
                    summary.retried_steps,
                    summary.contacts.len(),
                    posed,
                )
            })
        };
        let one = end(1, 8);
        assert!(one.0.is_none() && one.2 > 0 && one.3 > 2, "{:?}, {} retries", one.0, one.2);
        assert!(one.1.displacement.len() > 4000, "{} nodes", one.1.displacement.len());
        assert_eq!(end(3, 8), one);
        let failed = end(1, 0);
        assert!(failed.0.is_some());
        assert_eq!(end(3, 0), failed);
    }
}
