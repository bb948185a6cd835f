//! Surfaces that press on one another because they are pushed apart, drawn into one another, or grown: against closed forms, and their books.

use carom::Simulation;
use serde_json::{Value, json};

use crate::common::{body, parse, plane, scenario};

/// Plane wave modulus of E = 2700 Pa, ν = 0.33 [Pa]: stress per strain where nothing moves sideways.
const MODULUS: f64 = 2700.0 * 0.67 / (1.33 * 0.34);
/// How far the two blocks overlap, or are pushed apart [m].
const DELTA: f64 = 1e-3;

/// Two blocks of 1 m × 0.5 m, one on the other, that nothing lets move sideways, between a bottom and a top that are held. Their meshes do
/// not match; the upper one starts `overlap` [m] lower.
fn blocks(overlap: f64) -> Value {
    let block = |name: &str, y: f64, cells: usize| {
        let mesh =
            json!({"kind": "rectangle", "corner": [0.0, y], "size": [1.0, 0.5], "divisions": [cells, 3]});
        body(name, mesh, [0.0, 0.0])
    };
    let mut case = scenario(1.0, 0.25, &[block("lower", 0.0, 4), block("upper", 0.5 - overlap, 5)], &[]);
    case["materials"]["elastic"]["kind"] = json!("linear-elastic");
    let fixed = |body: &str, on: &str, axis: &str| json!({"kind": "fixed", "body": body, "on": on, "components": [axis]});
    let sides = ["lower", "upper"].map(|b| ["left", "right"].map(|on| fixed(b, on, "x")));
    let ends = [fixed("lower", "bottom", "y"), fixed("upper", "top", "y")];
    case["motions"] = json!(sides.iter().flatten().chain(&ends).collect::<Vec<_>>());
    case["contact"]["sources"] = json!(null);
    case["contact"]["solver"]["kind"] = json!("auto");
    case
}

fn as_load_steps(mut case: Value) -> Value {
    case["analysis"] = json!({
        "kind": "static", "end_time": 1.0, "time_step": 0.25, "max_halvings": 4, "gravity": null,
        "newton": {"tolerance": 1e-12, "max_iterations": 50},
    });
    case
}

fn run(case: &Value) -> Simulation<2> {
    let mut simulation = Simulation::new(&parse(case)).expect("a valid case");
    simulation.advance(f64::INFINITY, || false).expect("converges");
    simulation
}

fn normal_force(simulation: &Simulation<2>) -> f64 {
    simulation.state().reactions.iter().map(|r| r.force[0]).sum()
}

/// p = M δ/(h₁ + h₂) of layers of h₁ + h₂ that press on one another over δ.
fn presses_as_layers_do(case: &Value, height: f64, name: &str) {
    let simulation = run(case);
    let pressed = MODULUS * DELTA / height;
    let force = normal_force(&simulation);
    assert!((force / pressed - 1.0).abs() < 1e-9, "{name}: {force} N instead of {pressed} N");
    let summary = simulation.summary();
    assert!(summary.min_gap > -1e-12, "{name}: {:e}", summary.min_gap);
    let strain = simulation.books().total.strain;
    assert!((strain / (0.5 * pressed * DELTA) - 1.0).abs() < 1e-9, "{name}: {strain} J");
    assert!(simulation.books().total.defect().abs() < 1e-12 * strain, "{name}");
}

/// Symptom guarded against: two-sided contacts keep what they are inside by at the start of a step, so that nothing was pushed apart by what is
/// there at t = 0.
#[test]
fn interference_presses_layers_as_their_stiffness_says() {
    for discretisation in ["node-to-segment", "mortar"] {
        for interference in [json!(DELTA), json!(format!("{DELTA}*t")), json!(format!("{DELTA}*min(2*t, 1)"))]
        {
            let mut case = as_load_steps(blocks(0.0));
            case["contact"]["discretisation"] = json!(discretisation);
            case["contact"]["pairs"] = json!([{"between": ["upper", "lower"], "interference": interference}]);
            presses_as_layers_do(&case, 1.0, &format!("{discretisation} {interference}"));
        }
    }
}

#[test]
fn overlaps_at_the_start_are_taken_up() {
    for discretisation in ["node-to-segment", "mortar"] {
        for until in [json!(null), json!(0.5)] {
            let mut case = as_load_steps(blocks(DELTA));
            case["contact"]["discretisation"] = json!(discretisation);
            case["contact"]["resolve_overlap"] = json!(true);
            case["contact"]["overlap_resolved_at"] = until.clone();
            let mut halfway = Simulation::<2>::new(&parse(&case)).expect("a valid case");
            halfway.advance(0.25, || false).expect("converges");
            let share = if until.is_null() { 0.25 } else { 0.5 };
            let force = normal_force(&halfway) / (MODULUS * DELTA);
            assert!((force - share).abs() < 1e-9, "{discretisation}: {force} of the whole, not {share}");
            presses_as_layers_do(&case, 1.0, discretisation);
        }
    }
}

/// Symptom guarded against: a node at a corner that was outside of the other block by the last digit, beside it, was pushed out at once, and the
/// blocks pressed by up to 0.44 of the whole instead of 0.25.
#[test]
fn overlaps_are_taken_up_at_the_same_pace_wherever_the_blocks_are() {
    for cells in [[2, 3], [2, 6], [4, 3], [4, 6], [5, 3], [7, 7]] {
        for (x, width) in [(0.0, 3.3), (0.3, 0.7), (0.123_456_7, 3.3), (-7.7, 0.7)] {
            let mut case = as_load_steps(blocks(DELTA));
            for (k, y) in [0.0, 0.5 - DELTA].into_iter().enumerate() {
                let mesh = &mut case["bodies"][k]["mesh"];
                mesh["corner"] = json!([x, y]);
                mesh["size"] = json!([width, 0.5]);
                mesh["divisions"] = json!([cells[k], 3]);
            }
            case["contact"]["resolve_overlap"] = json!(true);
            let mut quarter = Simulation::<2>::new(&parse(&case)).expect("a valid case");
            quarter.advance(0.25, || false).expect("converges");
            let force = normal_force(&quarter) / (MODULUS * DELTA * width);
            assert!((force - 0.25).abs() < 1e-9, "{cells:?} at {x} m, {width} m wide: {force} of the whole");
        }
    }
}

/// Free in height alone the lower block grows by γ (1 + ν)/(1 − ν): δ is that of its height.
#[test]
fn a_layer_that_grows_presses_as_if_it_were_pushed_apart() {
    let mut case = as_load_steps(blocks(0.0));
    let growth = DELTA / 0.5 * 0.67 / 1.33;
    case["bodies"][0]["growth"] = json!(format!("{growth}*t"));
    let simulation = run(&case);
    let force = normal_force(&simulation);
    assert!((force / (MODULUS * DELTA) - 1.0).abs() < 1e-9, "{force}");
    let total = simulation.books().total;
    assert!((total.prescribed - total.strain).abs() < 1e-12 * total.strain, "elastic: {total:?}");
    assert!(total.defect().abs() < 1e-13 * total.strain);
}

/// An obstacle is no other target: half the height presses for the same δ with twice the force.
#[test]
fn obstacles_have_interference_and_overlaps_too() {
    for drawn in [false, true] {
        let mut case = as_load_steps(blocks(0.0));
        case["bodies"] = json!([case["bodies"][0]]);
        case["motions"] = json!(case["motions"].as_array().expect("a list")[..2]);
        let by = if drawn { DELTA } else { 0.0 };
        case["obstacles"] =
            json!([plane("floor", [0.0, 0.0], [0.0, 1.0]), plane("lid", [0.0, 0.5 - by], [0.0, -1.0])]);
        if drawn {
            case["contact"]["pairs"] = json!([{"between": ["lower", "lid"], "resolve_overlap": true}]);
        } else {
            case["contact"]["pairs"] =
                json!([{"between": ["lower", "lid"], "interference": format!("{DELTA}*t")}]);
        }
        let simulation = run(&case);
        let force = 0.5 * normal_force(&simulation);
        assert!((force / (2.0 * MODULUS * DELTA) - 1.0).abs() < 1e-9, "{drawn}: {force}");
    }
}

/// With clearance nothing presses before the bodies are as deep in one another as it lets them.
#[test]
fn negative_interference_is_clearance() {
    let mut case = as_load_steps(blocks(0.0));
    case["contact"]["pairs"] = json!([{"between": ["upper", "lower"], "interference": -DELTA}]);
    let motions = case["motions"].as_array_mut().expect("a list");
    let top = motions.last_mut().expect("the top");
    *top = json!({"kind": "prescribed", "body": "upper", "on": "top", "y": format!("{}*t", -2.0 * DELTA)});
    let simulation = run(&case);
    let force = normal_force(&simulation);
    assert!((force / (MODULUS * DELTA) - 1.0).abs() < 1e-9, "{force}");
    let summary = simulation.summary();
    assert!(summary.min_gap.abs() < 1e-12 && summary.penetration.max_depth < 1e-12, "{summary:?}");
}

/// What grows does prescribed work: r_n times the growth of the interference, and the change of the energy with growth.
#[test]
fn books_close_while_surfaces_are_pushed_apart_or_grow() {
    let growing = "5e-3*(1 - cos(30*t))";
    for drive in ["interference", "growth"] {
        for (law, condition, scheme, allowed) in [
            ("saint-venant-kirchhoff", "midpoint", json!({"kind": "conserving"}), 1e-12),
            ("neo-hookean", "gap", json!({"kind": "conserving"}), 1e-12),
            ("saint-venant-kirchhoff", "endpoint", json!({"kind": "conserving"}), 1e-10),
            ("linear-elastic", "midpoint", json!({"kind": "theta", "theta": 0.5, "xi": 0.5}), 1e-12),
            ("linear-elastic", "gap", json!({"kind": "theta", "theta": 0.6, "xi": 0.6}), 1e-12),
        ] {
            let mut case = blocks(0.0);
            case["analysis"]["end_time"] = json!(0.1);
            case["analysis"]["time_step"] = json!(2e-3);
            case["analysis"]["scheme"] = scheme;
            case["materials"]["elastic"]["kind"] = json!(law);
            case["contact"]["condition"] = json!(condition);
            case["contact"]["friction"] = json!(0.2);
            match drive {
                "growth" => case["bodies"][0]["growth"] = json!(growing),
                _ => {
                    let pair = json!({"between": ["upper", "lower"], "interference": growing});
                    case["contact"]["pairs"] = json!([pair]);
                }
            }
            let simulation = run(&case);
            let books = simulation.books();
            let largest = simulation.summary().energy.max_defect;
            let scale = books.total.prescribed.abs();
            assert!(scale > 1e-3, "{drive} {condition}: {scale} J");
            assert!(largest < allowed * scale, "{drive} {law} {condition}: {largest:e} of {scale} J");
            let of_pairs: f64 = books.pairs.values().map(|p| p.prescribed).sum();
            let of_bodies: f64 = books.bodies.iter().map(|b| b.prescribed).sum();
            let of_drive = if drive == "growth" { of_bodies } else { of_pairs };
            assert!(
                (of_drive / books.total.prescribed - 1.0).abs() < 1e-9,
                "{drive}: {of_drive} of {scale} J"
            );
            if condition == "midpoint" {
                assert!(
                    books.total.normal_contact.abs() < 1e-11 * scale,
                    "the rest of the reactions does no work"
                );
            }
        }
    }
}

#[test]
fn what_cannot_be_is_refused_with_its_remedy() {
    let refused = |case: &Value| match Simulation::<2>::new(&parse(case)) {
        Ok(_) => panic!("accepted"),
        Err(e) => format!("{}: {e}", e.key),
    };
    let with_pair = |mut case: Value, key: &str, value: Value| {
        case["contact"]["pairs"] = json!([{"between": ["upper", "lower"], key: value}]);
        case
    };
    let overlapping = refused(&as_load_steps(blocks(DELTA)));
    assert!(overlapping.contains("contact.resolve_overlap = true"), "{overlapping}");
    let moving = refused(&blocks(DELTA));
    assert!(!moving.contains("resolve_overlap"), "{moving}");
    let message = refused(&with_pair(blocks(0.0), "interference", json!(DELTA)));
    assert!(message.contains("contact.pairs.0.interference") && message.contains("let it grow"), "{message}");
    let message = refused(&with_pair(blocks(0.0), "interference", json!(-0.2)));
    assert!(
        message.contains("contact.pairs.0.interference") && message.contains("less clearance"),
        "{message}"
    );
    let message = refused(&with_pair(blocks(0.0), "resolve_overlap", json!(true)));
    assert!(message.contains("contact.pairs.0.resolve_overlap"), "{message}");
    let deep = with_pair(as_load_steps(blocks(0.2)), "resolve_overlap", json!(true));
    assert!(refused(&deep).contains("half a facet"), "{}", refused(&deep));
    let mut case = as_load_steps(blocks(0.0));
    case["contact"]["overlap_resolved_at"] = json!(0.5);
    assert!(refused(&case).contains("contact.overlap_resolved_at"));
    case["contact"]["resolve_overlap"] = json!(true);
    case["contact"]["overlap_resolved_at"] = json!(2.0);
    assert!(refused(&case).contains("analysis.end_time"));
    let mut case = blocks(0.0);
    case["bodies"][0]["growth"] = json!(0.1);
    assert!(refused(&case).contains("let it grow from 0"));
    case["bodies"][0]["growth"] = json!("-t");
    assert!(refused(&case).contains("linear strain"));
}
