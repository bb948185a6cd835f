//! How much of a contact step it takes to search for contacts and to measure what is inside what.
//!
//! `cargo bench -p carom --bench detection_share -- [SCENARIO.json ...]` takes discs, balls and stacks with default settings, or scenarios that
//! `carom.Scenario.to_json()` has written. Printed are medians over the runs.

use std::time::{Duration, Instant};

use carom::{Scenario, Simulation};
use serde_json::{Value, json};

/// Runs after a warm-up.
const RUNS: usize = 3;

/// The contact steps of a run, those that posed a contact problem.
#[derive(Default)]
struct Times {
    steps: u32,
    total: Duration,
    detection: Duration,
    friction: Duration,
}

impl Times {
    fn per_step(&self) -> f64 {
        1e3 * self.total.as_secs_f64() / f64::from(self.steps)
    }

    fn percent(&self, part: Duration) -> f64 {
        100.0 * part.as_secs_f64() / self.total.as_secs_f64()
    }
}

fn run<const D: usize>(scenario: &Scenario) -> Times {
    let mut simulation = Simulation::<D>::new(scenario).expect("valid");
    let mut times = Times::default();
    while simulation.step() < simulation.steps() {
        let (start, before) = (Instant::now(), [simulation.detection_time(), simulation.friction_time()]);
        simulation.advance(f64::INFINITY, || true).expect("runs");
        let (total, friction) = (start.elapsed(), simulation.friction_time() - before[1]);
        if !friction.is_zero() {
            times.steps += 1;
            times.total += total;
            times.detection += simulation.detection_time() - before[0];
            times.friction += friction;
        }
    }
    times
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_unstable_by(f64::total_cmp);
    values[values.len() / 2]
}

fn print(name: &str, scenario: &Scenario) {
    let run = || if scenario.dimension == 3 { run::<3>(scenario) } else { run::<2>(scenario) };
    run();
    let runs: Vec<Times> = (0..RUNS).map(|_| run()).collect();
    println!(
        "| {name} | {} | {:.3} | {:.1} % | {:.1} % |",
        runs[0].steps,
        median(runs.iter().map(Times::per_step)),
        median(runs.iter().map(|t| t.percent(t.detection))),
        median(runs.iter().map(|t| t.percent(t.friction))),
    );
}

/// Bodies of rubber of about a metre that fall on a floor and on one another.
fn scene(dimension: usize, condition: &str, meshes: &[Value]) -> Scenario {
    let vector = |last: f64| {
        let mut v = vec![0.0; dimension];
        v[dimension - 1] = last;
        v
    };
    let spin = if dimension == 3 { json!([0.0, 0.0, 0.0]) } else { json!(0.0) };
    let bodies: Vec<Value> = meshes
        .iter()
        .enumerate()
        .map(|(k, mesh)| {
            json!({
                "name": format!("body-{k}"), "material": "rubber", "hypothesis": "plane-strain", "thickness": 1.0,
                "mass": "consistent", "mesh": mesh, "velocity": vector(-(k as f64)), "spin": spin,
            })
        })
        .collect();
    serde_json::from_value(json!({
        "dimension": dimension,
        "analysis": {
            "kind": "dynamic", "end_time": 0.4, "time_step": 2e-3, "max_halvings": 8, "gravity": vector(-9.81),
            "scheme": {"kind": "conserving"}, "newton": {"tolerance": 1e-9, "max_iterations": 50},
        },
        "output": {"fields_every": 1e3, "history_every": 1e3, "merge_contacts": 1e3},
        "materials": {
            "rubber": {"kind": "neo-hookean", "young": 1e6, "poisson": 0.3, "density": 1000.0},
        },
        "bodies": bodies,
        "obstacles": [{"name": "floor", "kind": "plane", "point": vector(0.0), "normal": vector(1.0)}],
        "contact": {
            "condition": condition, "friction": 0.3, "sources": "both", "targets": "smooth",
            "certificate_tolerance": 1e-9, "penetration_tolerance": 0.01,
            "solver": {"kind": "auto", "tolerance": 1e-12, "max_iterations": 10000},
        },
    }))
    .expect("a complete scenario")
}

/// Some scenes with their names.
fn scenes(condition: &str) -> Vec<(String, Scenario)> {
    let disc = |x: f64, z: f64| json!({"kind": "disc", "centre": [x, z], "radius": 0.5, "divisions": 10, "rings": 10});
    let ball = |x: f64, z: f64| json!({"kind": "ball", "centre": [x, 0.0, z], "radius": 0.5, "divisions": 4, "cell": "hex8"});
    let square = |k: usize, cells: usize| json!({"kind": "rectangle", "corner": [0.0, k as f64], "size": [1.0, 1.0], "divisions": [cells, cells]});
    let cube = |k: usize, cells: usize| json!({"kind": "box", "corner": [0.0, 0.0, k as f64], "size": [1.0, 1.0, 1.0], "divisions": [cells, cells, cells], "cell": "hex8"});
    let cells = |k: usize, few: usize, many: usize| if k % 2 == 0 { few } else { many };
    let squares: Vec<Value> = (0..5).map(|k| square(k, cells(k, 10, 15))).collect();
    let cubes: Vec<Value> = (0..3).map(|k| cube(k, cells(k, 3, 4))).collect();
    let named = |name: &str, scenario: Scenario| (format!("{name}, `{condition}`"), scenario);
    vec![
        named("two discs", scene(2, condition, &[disc(0.0, 0.501), disc(0.1, 1.51)])),
        named("two balls", scene(3, condition, &[ball(0.0, 0.501), ball(0.1, 1.51)])),
        named("five squares, 10 and 15 cells wide", scene(2, condition, &squares)),
        named("three cubes, 3 and 4 cells wide", scene(3, condition, &cubes)),
    ]
}

fn main() {
    let files: Vec<String> = std::env::args().skip(1).filter(|a| a.ends_with(".json")).collect();
    println!("| scene | contact steps | ms each | search and measure | friction solver |");
    println!("|---|---|---|---|---|");
    for file in &files {
        let text = std::fs::read_to_string(file).expect("a file");
        print(file, &serde_json::from_str(&text).expect("a complete scenario"));
    }
    if files.is_empty() {
        for condition in ["midpoint", "gap"] {
            scenes(condition).iter().for_each(|(name, scenario)| print(name, scenario));
        }
    }
}
