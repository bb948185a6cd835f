//! Nothing goes through anything unseen: what contact does not stop is told.

use carom::{Simulation, Summary};
use serde_json::{Value, json};

use crate::common::{body, parse, scenario};

fn block(name: &str, corner: [f64; 2], size: [f64; 2], divisions: [usize; 2], velocity: [f64; 2]) -> Value {
    let mesh = json!({"kind": "rectangle", "corner": corner, "size": size, "divisions": divisions});
    body(name, mesh, velocity)
}

fn wall(name: &str, corner: [f64; 2], size: [f64; 2]) -> Value {
    json!({"name": name, "kind": "box", "corner": corner, "size": size})
}

fn run(case: &Value) -> Summary {
    let mut simulation = Simulation::<2>::new(&parse(case)).expect("valid");
    simulation.advance(f64::INFINITY, || false).expect("runs");
    simulation.finish();
    simulation.summary()
}

/// Symptom guarded against: a block went through a wall that is thinner than its way in a step, without a contact.
#[test]
fn a_block_meets_a_wall_that_is_thinner_than_its_way_in_a_step() {
    let thrown = block("block", [-0.1, 0.25], [0.2, 0.2], [4, 4], [0.0, -10.0]);
    let thin = block("wall", [-0.4, -0.02], [0.8, 0.04], [16, 1], [0.0, 0.0]);
    let rigid =
        scenario(0.08, 0.02, std::slice::from_ref(&thrown), &[wall("wall", [-1.0, -0.02], [2.0, 0.04])]);
    let loose = scenario(0.08, 0.02, &[thrown, thin], &[]);
    for mut case in [rigid, loose] {
        case["analysis"]["scheme"] = json!({"kind": "conserving"});
        for condition in ["gap", "midpoint"] {
            case["contact"]["condition"] = json!(condition);
            let summary = run(&case);
            assert!(!summary.contacts.is_empty(), "{condition}: they meet");
            if condition == "gap" {
                let excess =
                    summary.penetration.worst.as_ref().map_or(0.0, |worst| worst.depth / worst.allowed);
                // Nodes of one side alone are checked: an edge of the other comes a little deeper.
                assert!(excess < 2.0, "{:?}", summary.penetration);
            }
        }
    }
}

#[test]
fn what_is_not_to_touch_may_overlap() {
    let mut case = scenario(
        0.05,
        1e-3,
        &[
            block("a", [0.0, 0.0], [1.0, 1.0], [2, 2], [0.0, 0.0]),
            block("b", [0.0, 1.2], [1.0, 1.0], [3, 3], [0.0, -10.0]),
        ],
        &[],
    );
    case["contact"]["pairs"] = json!([{"between": ["a", "b"], "enabled": false}]);
    let summary = run(&case);
    assert!(summary.penetration.worst.is_none() && summary.contacts.is_empty());
}
