//! What must not change the physics: where the scene stands and how it is turned, the units, and the two sides of an impact.

use crate::common::{body, disc, parse, plane, scenario};
use carom::{Meshes, Simulation, Summary, Workspace, build, step};
use carom_friction::SolverKind;
use carom_mesh::Vector;
use serde_json::{Value, json};

fn run(case: &Value) -> (Simulation<2>, Summary) {
    let mut simulation = Simulation::<2>::new(&parse(case)).expect("valid");
    simulation.advance(f64::INFINITY, || false).expect("runs");
    let summary = simulation.summary();
    (simulation, summary)
}

/// Two discs that meet and bounce off a floor with friction, turned by `angle` about the origin, lengths × `length`,
/// times × `time`, masses × `mass`.
fn scene(angle: f64, shift: [f64; 2], length: f64, time: f64, mass: f64) -> Value {
    let (c, s) = (angle.cos(), angle.sin());
    let turn = |v: [f64; 2], scale: f64| [(c * v[0] - s * v[1]) * scale, (s * v[0] + c * v[1]) * scale];
    let place = |v: [f64; 2]| {
        let [x, y] = turn(v, length);
        [x + shift[0] * length, y + shift[1] * length]
    };
    let speed = length / time;
    let discs = [
        body("left", disc(place([0.0, 1.0003]), length, 4), turn([1.0, -2.0], speed)),
        body("right", disc(place([2.1, 1.5]), length, 4), turn([-0.5, 0.0], speed)),
    ];
    let floor = plane("floor", place([0.0, 0.0]), turn([0.0, 1.0], 1.0));
    let mut case = scenario(0.25 * time, 1e-3 * time, &discs, &[floor]);
    let pressure = mass / (length * time * time);
    let density = mass / length.powi(3);
    case["contact"]["friction"] = json!(0.2);
    case["materials"]["elastic"]["young"] = json!(2700.0 * pressure);
    case["materials"]["elastic"]["density"] = json!(density);
    case["output"]["merge_contacts"] = json!(0.03 * time);
    case["output"]["history_every"] = json!(0.01 * time);
    for b in case["bodies"].as_array_mut().expect("bodies") {
        b["thickness"] = json!(length);
    }
    case
}

/// Energies in the units of the scene, and the events.
fn assert_same(a: &Summary, b: &Summary, energy: f64, time: f64, tolerance: f64) {
    for (x, y) in [
        (a.energy.last, b.energy.last),
        (a.energy.terms.strain, b.energy.terms.strain),
        (a.energy.terms.friction, b.energy.terms.friction),
        (a.energy.terms.normal_contact, b.energy.terms.normal_contact),
    ] {
        assert!((x - y / energy).abs() < tolerance * a.energy.initial, "{x} J became {} J", y / energy);
    }
    assert_eq!(a.contacts.len(), b.contacts.len());
    for (a, b) in a.contacts.iter().zip(&b.contacts) {
        assert_eq!(a.pair, b.pair);
        assert!((a.onset - b.onset / time).abs() < 1e-9);
    }
}

#[test]
fn scene_is_eventful_and_lawful() {
    let (simulation, summary) = run(&scene(0.0, [0.0; 2], 1.0, 1.0, 1.0));
    assert_eq!(summary.contacts.len(), 2, "{:?}", summary.contacts);
    assert!(summary.energy.terms.friction > 0.01);
    assert!(summary.min_gap > -1e-12, "no penetration at the ends of steps: {}", summary.min_gap);
    assert!(summary.certificate.max_joule < 1e-10 && summary.certificate.max_residual < 1e-11);
    assert!(summary.energy.max_defect < 1e-3 * summary.energy.initial);
    assert!(simulation.state().is_finite(&simulation.model().assembly));
}

#[test]
fn turning_and_moving_the_scene_turns_and_moves_the_motion() {
    let (_, still) = run(&scene(0.0, [0.0; 2], 1.0, 1.0, 1.0));
    // The mesh of a disc is the same after a quarter turn only.
    let (_, turned) = run(&scene(std::f64::consts::FRAC_PI_2, [3.0, -1.0], 1.0, 1.0, 1.0));
    assert_same(&still, &turned, 1.0, 1.0, 1e-8);
}

/// The scene with the defaults of case files: massless nodes that conserve energy, on smooth targets.
fn conserving(mut case: Value) -> Value {
    case["analysis"]["scheme"] = json!({"kind": "conserving"});
    case["contact"]["condition"] = json!("massless");
    case["contact"]["targets"] = json!("smooth");
    case
}

/// Every row of the history, of columns that are energies [J] or lengths [m], in units of the scene; energies relative to the
/// first total.
fn dimensionless(case: &Value, length: f64) -> Vec<f64> {
    const ENERGIES: [&str; 5] = ["kinetic", "strain", "total", "friction", "normal_contact"];
    let (mut simulation, summary) = run(case);
    let columns = simulation.history_columns().to_vec();
    let scales: Vec<Option<f64>> = columns
        .iter()
        .map(|c| match c.as_str() {
            c if ENERGIES.contains(&c) => Some(summary.energy.initial),
            "left.x" | "left.y" | "right.x" | "right.y" => Some(length),
            _ => None,
        })
        .collect();
    let rows = simulation.take_history();
    rows.iter().zip(scales.iter().cycle()).filter_map(|(x, scale)| scale.map(|s| x / s)).collect()
}

/// mm–t–s instead of m–kg–s.
#[test]
fn units_do_not_matter() {
    for dress in [std::convert::identity, conserving] {
        let of = |length, time, mass| dress(scene(0.0, [0.0; 2], length, time, mass));
        let (_, si) = run(&of(1.0, 1.0, 1.0));
        assert_eq!(si.contacts.len(), 2);
        let history = dimensionless(&of(1.0, 1.0, 1.0), 1.0);
        for (length, time, mass) in [(1e3, 1.0, 1e-3), (1e-3, 1e-6, 1.0)] {
            let case = of(length, time, mass);
            let (_, other) = run(&case);
            assert_same(&si, &other, mass * length * length / (time * time), time, 1e-9);
            let there = dimensionless(&case, length);
            assert_eq!(there.len(), history.len());
            let farthest = history.iter().zip(&there).fold(0.0, |d: f64, (a, b)| d.max((a - b).abs()));
            assert!(farthest < 1e-9, "length × {length}, time × {time}, mass × {mass}: {farthest:e}");
        }
    }
}

/// Reactions between bodies cancel: without walls linear momentum is constant to round-off, with or without friction.
#[test]
fn action_is_reaction() {
    for sources in ["first", "second", "both"] {
        let mut case = scene(0.0, [0.0; 2], 1.0, 1.0, 1.0);
        case["obstacles"] = json!([]);
        case["bodies"][0]["velocity"] = json!([1.0, 0.4]);
        case["contact"]["sources"] = json!(sources);
        let mut simulation = Simulation::<2>::new(&parse(&case)).expect("valid");
        let momentum = |s: &Simulation<2>| -> Vector<2> {
            s.model()
                .bodies
                .iter()
                .map(|b| b.body.mean(&s.state().velocity[b.nodes()]) * b.body.total_mass())
                .sum()
        };
        let before = momentum(&simulation);
        simulation.advance(f64::INFINITY, || false).expect("runs");
        assert_eq!(simulation.summary().contacts.len(), 1, "the discs meet");
        assert!((momentum(&simulation) - before).norm() < 1e-11 * before.norm(), "sources = {sources}");
    }
}

/// The same state and the same numbers, however the run is cut into slices.
#[test]
fn a_run_in_slices_is_bit_identical() {
    let case = scene(0.0, [0.0; 2], 1.0, 1.0, 1.0);
    let (whole, _) = run(&case);
    let mut sliced = Simulation::<2>::new(&parse(&case)).expect("valid");
    for k in 1..=25 {
        sliced.advance(k as f64 * 0.01, || k % 2 == 0).expect("runs");
    }
    sliced.advance(f64::INFINITY, || false).expect("runs");
    assert_eq!(whole.state(), sliced.state());
}

/// Symptom guarded against: a disc that still spun while another had settled in contact made the books of the contact wrong.
#[test]
fn a_body_elsewhere_does_not_touch_the_books_of_an_impact() {
    let mut alone = scene(0.0, [0.0; 2], 1.0, 1.0, 1.0);
    alone["bodies"][1]["mesh"]["centre"] = json!([20.0, 20.0]);
    let mut spinning = alone.clone();
    spinning["bodies"][1]["velocity"] = json!([0.3, 0.2]);
    spinning["bodies"][1]["spin"] = json!(25.0);
    alone["bodies"][1]["velocity"] = json!([0.0, 0.0]);
    let ((_, a), (_, b)) = (run(&alone), run(&spinning));
    assert_eq!((a.contacts.len(), b.contacts.len()), (1, 1));
    for (x, y) in [
        (a.energy.terms.friction, b.energy.terms.friction),
        (a.energy.terms.normal_contact, b.energy.terms.normal_contact),
    ] {
        assert!((x - y).abs() < 1e-9, "{x} J alone, {y} J in company");
    }
}

/// Every friction solver gives the same motion.
#[test]
fn the_friction_solver_does_not_change_the_motion() {
    let (_, gauss_seidel) = run(&scene(0.0, [0.0; 2], 1.0, 1.0, 1.0));
    for kind in SolverKind::ALL {
        let mut case = scene(0.0, [0.0; 2], 1.0, 1.0, 1.0);
        case["contact"]["solver"]["kind"] = json!(kind);
        case["contact"]["solver"]["max_iterations"] = json!(1_000_000);
        let (_, other) = run(&case);
        assert_same(&gauss_seidel, &other, 1.0, 1.0, 1e-9);
    }
}

/// A workspace holds no result: without it a run goes on as it would have, but for round-off.
#[test]
fn a_workspace_that_is_thrown_away_takes_nothing_with_it() {
    let scenario = parse(&scene(0.0, [0.0; 2], 1.0, 1.0, 1.0));
    let ends = [false, true].map(|throws_away| {
        let (model, method, mut state) = build::<2>(&scenario, Meshes::new()).expect("valid");
        let (mut next, mut work) = (state.clone(), Workspace::new(&model));
        for k in 0..200 {
            if throws_away && k % 10 == 0 {
                work = Workspace::new(&model);
            }
            step(&model.assembly, &method, &state, &mut next, 1e-3, &mut work).expect("converges");
            std::mem::swap(&mut state, &mut next);
        }
        assert!(state.friction_energy.iter().sum::<f64>() > 1e-3, "they have touched");
        state.displacement
    });
    let apart = ends[0].iter().zip(&ends[1]).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    assert!(apart < 1e-9, "{apart:e}");
}
