//! Threads share the work of large bodies without a trace in the results.

use carom::Simulation;
use serde_json::json;

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
