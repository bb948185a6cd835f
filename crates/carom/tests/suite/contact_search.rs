//! Scenes in which the search for contacts once went wrong. Each test states the symptom.

use crate::common::{body, disc, parse, plane, scenario};
use carom::{InputError, Simulation};
use serde_json::{Value, json};

fn bar(corner: [f64; 2], size: [f64; 2], divisions: [usize; 2]) -> Value {
    json!({"kind": "rectangle", "corner": corner, "size": size, "divisions": divisions})
}

fn refused(bodies: &[Value]) -> InputError {
    let case = scenario(0.1, 1e-3, bodies, &[]);
    Simulation::<2>::new(&parse(&case)).err().expect("bodies overlap")
}

/// Symptom: bars of equal height pushed into one another, bars that cross and identical bodies passed for bodies that touch,
/// because their nodes are all on sides of the other or outside of it.
#[test]
fn overlaps_without_a_node_inside_are_refused() {
    let still = |name: &str, mesh: Value| body(name, mesh, [0.0, 0.0]);
    let long = bar([0.0, 0.0], [4.0, 1.0], [4, 1]);
    for other in [bar([2.5, 0.0], [4.0, 1.0], [4, 1]), bar([1.5, -2.0], [1.0, 5.0], [1, 5]), long.clone()] {
        let error = refused(&[still("a", long.clone()), still("b", other)]);
        assert!(error.message.contains("overlap"), "{error}");
    }
}

/// Symptom: with both sides as sources, aligned nodes made every contact twice and the solver did not converge.
#[test]
fn aligned_meshes_collide_with_both_sides_as_sources() {
    for condition in ["gap", "midpoint", "endpoint"] {
        let discs = [
            body("a", disc([0.0, 0.0], 1.0, 8), [2.0, 0.0]),
            body("b", disc([2.505, 0.0], 1.0, 8), [-2.0, 0.0]),
        ];
        let mut case = scenario(0.4, 1e-3, &discs, &[]);
        case["contact"]["sources"] = json!("both");
        case["contact"]["condition"] = json!(condition);
        case["contact"]["friction"] = json!(0.2);
        // Nodes nearly opposite make rows of W that are nearly the same, which Gauss-Seidel is slow to share reactions between.
        case["contact"]["solver"]["kind"] = json!("auto");
        let mut simulation = Simulation::<2>::new(&parse(&case)).expect("valid");
        simulation.advance(f64::INFINITY, || false).expect("converges");
        let v = simulation.model().bodies[0]
            .body
            .mean(&simulation.state().velocity[simulation.model().bodies[0].nodes()]);
        assert!(v[0] < -1.5, "{condition}: they bounce, v = {v}");
        let energy = simulation.summary().energy;
        assert!(
            energy.last < energy.initial + energy.max_defect,
            "{condition}: no contact adds energy, {energy:?}"
        );
    }
}

/// Symptom: a ball fell through a coarse floor whose nodes alone were checked.
#[test]
fn a_ball_does_not_fall_through_a_coarse_body() {
    let bodies = [
        body("floor", bar([-4.0, -2.0], [8.0, 2.0], [2, 1]), [0.0, 0.0]),
        body("ball", disc([1.0, 0.55], 0.5, 4), [0.0, -2.0]),
    ];
    let mut case = scenario(0.3, 1e-3, &bodies, &[]);
    case["contact"]["sources"] = json!("finer");
    let mut simulation = Simulation::<2>::new(&parse(&case)).expect("valid");
    simulation.advance(f64::INFINITY, || false).expect("runs");
    let summary = simulation.summary();
    assert_eq!(summary.contacts.len(), 1);
    assert!(summary.min_gap > -1e-12);
}

/// Symptom: a node passing beside a corner, closer than the search margin that a fast body elsewhere set, was caught by the plane
/// of the facet it passed, and gained energy.
#[test]
fn a_corner_passing_beside_another_is_not_caught() {
    let bodies = [
        body("low", bar([0.0, 0.0], [1.0, 1.0], [2, 2]), [0.0, 0.0]),
        body("passing", bar([1.01, 1.02], [1.0, 1.0], [2, 2]), [0.0, -2.0]),
        body("fast", disc([50.0, 0.0], 1.0, 4), [40.0, 0.0]),
    ];
    let mut simulation = Simulation::<2>::new(&parse(&scenario(0.1, 1e-3, &bodies, &[]))).expect("valid");
    simulation.advance(f64::INFINITY, || false).expect("runs");
    let summary = simulation.summary();
    assert!(summary.contacts.is_empty(), "{:?}", summary.contacts);
    assert!(summary.energy.max_drift < 1e-12 * summary.energy.initial);
}

/// Symptom: with merge_contacts = 0 a bounce was reported as an event per step.
#[test]
fn a_bounce_is_one_event_however_little_is_merged() {
    let discs =
        [body("a", disc([0.0, 0.0], 1.0, 8), [2.0, 0.3]), body("b", disc([2.1, 0.0], 1.0, 8), [0.0, 0.0])];
    let mut case = scenario(0.25, 1e-3, &discs, &[]);
    case["output"]["merge_contacts"] = json!(0.0);
    case["contact"]["condition"] = json!("endpoint");
    let mut simulation = Simulation::<2>::new(&parse(&case)).expect("valid");
    simulation.advance(f64::INFINITY, || false).expect("runs");
    let events = simulation.summary().contacts;
    assert!(!events.is_empty() && events.len() < 10, "{} events", events.len());
}

/// Symptom: contacts less than 0.03 s apart were one, whatever the run, so that a run of 0.04 s had one contact where a small stiff body hit the
/// floor again and again.
#[test]
fn what_is_one_contact_is_for_the_bodies_to_say() {
    // The same bounces, 10⁴ times as fast and as small.
    let bounces = |scale: f64| {
        let mesh = json!({"kind": "rectangle", "corner": [0.0, 0.02 * scale], "size": [scale, scale], "divisions": [2, 2]});
        let mut case = scenario(
            4.0 * scale,
            1e-3 * scale,
            &[body("block", mesh, [0.0, -2.0])],
            &[plane("floor", [0.0, 0.0], [0.0, 1.0]), plane("ceiling", [0.0, 1.4 * scale], [0.0, -1.0])],
        );
        case["output"]["merge_contacts"] = Value::Null;
        let mut simulation = Simulation::<2>::new(&parse(&case)).expect("valid");
        simulation.advance(f64::INFINITY, || false).expect("runs");
        simulation.summary()
    };
    let (large, small) = (bounces(1.0), bounces(1e-4));
    assert!(large.contacts.len() > 6, "{:?}", large.contacts);
    assert_eq!(large.contacts.len(), small.contacts.len());
    // Later on round-off has grown to steps.
    for (a, b) in large.contacts.iter().zip(&small.contacts).take(3) {
        assert!((a.onset - 1e4 * b.onset).abs() < 1e-9, "{} {}", a.onset, b.onset);
    }
    // The time of a wave across the block: √(0.33-plane-strain stiffness 4000.4 Pa / 1 kg/m³) = 63.2 m/s.
    let crossing = 1.0 / (2700.0_f64 * 0.67 / (1.33 * 0.34)).sqrt();
    assert!(large.pairs.iter().all(|p| (p.merge_contacts - crossing).abs() < 1e-12), "{:?}", large.pairs);
    // A case may say otherwise.
    let mut case = scenario(
        0.01,
        1e-3,
        &[body("disc", disc([0.0, 1.1], 1.0, 4), [0.0, 0.0])],
        &[plane("floor", [0.0, 0.0], [0.0, 1.0])],
    );
    case["output"]["merge_contacts"] = json!(0.7);
    let simulation = Simulation::<2>::new(&parse(&case)).expect("valid");
    assert!(simulation.summary().pairs.iter().all(|p| p.merge_contacts == 0.7));
}

/// Symptom: a body that turns fast widened the search until every node faced every wall, and contact problems took minutes.
#[test]
fn a_fast_step_does_not_make_a_contact_of_every_node() {
    let walls = [
        plane("floor", [0.0, -1.05], [0.0, 1.0]),
        plane("ceiling", [0.0, 2.6], [0.0, -1.0]),
        plane("west", [-2.6, 0.0], [1.0, 0.0]),
        plane("east", [2.6, 0.0], [-1.0, 0.0]),
    ];
    let mut wheel = body("wheel", disc([0.0, 0.0], 1.0, 8), [0.0, -10.0]);
    wheel["spin"] = json!(40.0);
    let mut simulation =
        Simulation::<2>::new(&parse(&scenario(0.02, 0.02, &[wheel], &walls))).expect("valid");
    simulation.advance(f64::INFINITY, || false).expect("runs");
    let rim = simulation.model().assembly.contact.surfaces[0].sources.len();
    let posed = simulation.posed_problem().expect("it meets the floor").problem.len();
    assert!(0 < posed && posed < rim, "{posed} contacts of {rim} nodes");
}

/// Symptom guarded against: a bar that another drives, within one step, across more than the search sees sinks into a third one.
#[test]
fn a_blow_is_passed_on_within_a_step() {
    let bodies = [
        body("first", bar([0.0, 0.0], [1.0, 1.0], [1, 1]), [10.0, 0.0]),
        body("second", bar([1.001, 0.0], [1.0, 1.0], [1, 1]), [0.0, 0.0]),
        body("third", bar([2.16, -0.5], [1.0, 2.0], [1, 2]), [0.0, 0.0]),
    ];
    let mut case = scenario(0.05, 0.05, &bodies, &[]);
    case["analysis"]["max_halvings"] = json!(0);
    let mut simulation = Simulation::<2>::new(&parse(&case)).expect("valid");
    simulation.advance(f64::INFINITY, || false).expect("runs");
    let (model, state) = (simulation.model(), simulation.state());
    let [second, third] =
        [1, 2].map(|b: usize| model.bodies[b].body.mean(&state.displacement[model.bodies[b].nodes()])[0]);
    assert!(second > 0.159 && third > 0.0, "{second} m and {third} m");
    assert!(simulation.summary().min_gap > -1e-9, "{:?}", simulation.summary().min_gap);
}

/// Symptom: a node that came past an edge was found deep inside, pushed out within a step, and gave the bodies many times their energy.
///
/// The plate sinks onto the block, whose corners nobody checks, and then draws its own corner in through the side.
#[test]
fn a_node_that_is_found_deep_inside_is_not_shot_out() {
    let bodies = [
        body("plate", bar([-1.0, 1.01], [3.0, 1.0], [1, 1]), [-10.0, -3.0]),
        body("block", bar([0.0, 0.0], [1.0, 1.0], [1, 1]), [0.0, 0.0]),
    ];
    let mut simulation = Simulation::<2>::new(&parse(&scenario(0.15, 1e-3, &bodies, &[]))).expect("valid");
    simulation.advance(f64::INFINITY, || false).expect("runs");
    let summary = simulation.summary();
    assert!(
        !summary.contacts.is_empty() && summary.min_gap < -0.2,
        "the corner is inside: {}",
        summary.min_gap
    );
    let (energy, retried) = (summary.energy, summary.retried_steps);
    assert!(energy.last < energy.initial * (1.0 + 1e-9), "{energy:?}");
    assert_eq!(retried, 0);
}

/// Symptom: nodes on the far side of a thin body, behind the far side of another, passed for nodes deep inside, and held the two together.
#[test]
fn the_far_sides_of_thin_bodies_do_not_touch() {
    for condition in ["gap", "midpoint"] {
        let bodies = [
            body("first", bar([0.0, 0.0], [0.02, 1.0], [1, 40]), [2.0, 0.0]),
            body("second", bar([0.025, 0.0], [0.02, 1.0], [1, 40]), [0.0, 0.0]),
        ];
        let mut case = scenario(0.02, 5e-4, &bodies, &[]);
        case["contact"]["condition"] = json!(condition);
        let mut simulation = Simulation::<2>::new(&parse(&case)).expect("valid");
        simulation.advance(f64::INFINITY, || false).expect("runs");
        let summary = simulation.summary();
        assert!(!summary.contacts.is_empty(), "{condition}: they meet");
        assert!(summary.min_gap > -2.0 * 1e-3, "{condition}: {} m", summary.min_gap);
    }
}
