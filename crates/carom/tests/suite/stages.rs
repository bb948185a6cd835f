//! Analyses in sequence: a block that settles under its weight, and then is left to itself.

use carom::Simulation;
use serde_json::{Value, json};

use crate::common::{body, parse, plane, scenario};

/// A block of E = 1000 Pa that stands on the floor: a static stage until 1 s, and a dynamic one until 1.5 s.
fn case() -> Value {
    let mesh = json!({"kind": "rectangle", "corner": [0.0, 0.0], "size": [2.0, 1.0], "divisions": [6, 3]});
    let floor = plane("floor", [0.0, 0.0], [0.0, 1.0]);
    let mut case = scenario(1.0, 0.5, &[body("block", mesh, [0.0, 0.0])], &[floor]);
    case["materials"]["elastic"] =
        json!({"kind": "linear-elastic", "young": 1000.0, "poisson": 0.2, "density": 1.0});
    let newton = json!({"tolerance": 1e-11, "max_iterations": 50});
    let mut contact = case["contact"].clone();
    contact["friction"] = json!(0.4);
    contact["solver"]["kind"] = json!("auto");
    let mut midpoint = contact.clone();
    midpoint["condition"] = json!("midpoint");
    case["stages"] = json!([
        {
            "name": "settle", "history_every": 0.5, "contact": contact,
            "analysis": {
                "kind": "static", "end_time": 1.0, "time_step": 0.5, "max_halvings": 8, "gravity": [0.0, -9.81], "newton": newton,
            },
        },
        {
            "name": "stand", "history_every": 0.01, "contact": midpoint,
            "analysis": {
                "kind": "dynamic", "start_time": 1.0, "end_time": 1.5, "time_step": 0.005, "max_halvings": 8,
                "gravity": [0.0, -9.81], "newton": newton, "scheme": {"kind": "conserving"},
            },
        },
    ]);
    case
}

fn fastest(simulation: &Simulation<2>) -> f64 {
    simulation.state().velocity.iter().map(|v| v.norm()).fold(0.0, f64::max)
}

/// Symptom guarded against: reactions that a dynamic stage does not take over, so that the block bounces.
#[test]
fn what_has_settled_stands_still() {
    let mut simulation = Simulation::<2>::new(&parse(&case())).expect("a valid case");
    simulation.advance(1.0, || false).expect("converges");
    assert_eq!((simulation.stage_number(), simulation.step(), simulation.steps()), (0, 2, 102));
    let settled = simulation.state().clone();
    let deepest = settled.displacement.iter().map(|u| -u[1]).fold(0.0, f64::max);
    assert!(deepest > 1e-3, "{deepest}");
    while simulation.step() < simulation.steps() {
        simulation.advance(f64::INFINITY, || true).expect("converges");
        // A fall by as much is as fast as √(2 g u) = 0.3 m/s.
        assert!(fastest(&simulation) < 1e-9, "{}", fastest(&simulation));
    }
    assert_eq!((simulation.stage_number(), simulation.time()), (1, 1.5));
    assert_eq!(simulation.state().reactions.len(), settled.reactions.len());
    for (now, before) in simulation.state().displacement.iter().zip(&settled.displacement) {
        assert!((now - before).norm() < 1e-11, "{now} {before}");
    }
    let summary = simulation.summary();
    let [settle, stand] = &summary.stages[..] else { panic!("two stages") };
    assert_eq!((settle.steps, stand.steps), (2, 100));
    assert_eq!(stand.energy.initial, settle.energy.last);
    let stages = settle.energy.terms.external + stand.energy.terms.external;
    assert!((stages - summary.energy.terms.external).abs() < 1e-15);
    assert!(summary.energy.max_defect < 1e-13, "{}", summary.energy.max_defect);
}

/// To the last bit, wherever it stops.
#[test]
fn a_checkpoint_knows_its_stage() {
    let mut whole = Simulation::<2>::new(&parse(&case())).expect("a valid case");
    for until in [0.5, 1.0, 1.2] {
        whole.advance(until, || false).expect("converges");
        let checkpoint = whole.checkpoint().expect("finite");
        let mut other = Simulation::<2>::new(&parse(&case())).expect("a valid case");
        // One that has been elsewhere goes back.
        other.advance(1.3, || false).expect("converges");
        other.restore(&checkpoint).expect("fits");
        assert_eq!(other.stage_number(), whole.stage_number());
        other.advance(1.25, || false).expect("converges");
        let mut on = Simulation::<2>::new(&parse(&case())).expect("a valid case");
        on.advance(1.25, || false).expect("converges");
        assert_eq!(other.state(), on.state());
        assert_eq!(other.books(), on.books());
    }
}

/// What is wrong in a stage is found before the first step, and named there.
#[test]
fn a_stage_that_cannot_run_is_refused_by_its_key() {
    let mut case = case();
    case["stages"][1]["analysis"]["end_time"] = json!(1.001);
    let error = Simulation::<2>::new(&parse(&case)).err().expect("refused");
    assert_eq!(error.key, "stages.1.analysis.end_time");
    assert!(error.message.contains("at least one time step after the start"), "{error}");
    case["stages"][1]["analysis"]["end_time"] = json!(1.5);
    case["stages"][1]["velocities"] = json!([{"body": "black", "velocity": [1.0, 0.0]}]);
    let error = Simulation::<2>::new(&parse(&case)).err().expect("refused");
    assert_eq!(error.key, "stages.1.velocities.0.body");
    assert!(error.message.contains("there is no body \"black\""), "{error}");
}
