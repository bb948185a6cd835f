//! Time per step of two discs of 2,084 unknowns with a floor bounce and a disc–disc impact in 600 steps of 1 ms, on one thread: the
//! problem that other codes were measured on. criterion reports elements (steps) per second; the median is printed per step.

use std::time::{Duration, Instant};

use carom::{Scenario, Simulation};
use criterion::{Criterion, Throughput};
use serde_json::json;

const STEPS: u64 = 600;

fn scenario(friction: f64, condition: &str) -> Scenario {
    let disc = |name: &str, centre: [f64; 2], velocity: [f64; 2]| {
        json!({
            "name": name, "material": "elastic", "hypothesis": "plane-strain", "thickness": 1.0, "mass": "consistent",
            "mesh": {"kind": "disc", "centre": centre, "radius": 1.0, "divisions": 10, "rings": 10},
            "velocity": velocity, "spin": 0.0,
        })
    };
    let plane = |name: &str, point: [f64; 2], normal: [f64; 2]| json!({"name": name, "kind": "plane", "point": point, "normal": normal});
    serde_json::from_value(json!({
        "analysis": {
            "kind": "dynamic", "end_time": STEPS as f64 * 1e-3, "time_step": 1e-3, "max_halvings": 8, "gravity": null,
            "scheme": {"kind": "theta", "theta": 0.5, "xi": 0.5},
            "newton": {"tolerance": 1e-9, "max_iterations": 50},
        },
        "output": {"fields_every": 0.05, "history_every": 0.01, "merge_contacts": 0.03},
        "materials": {
            "elastic": {"kind": "saint-venant-kirchhoff", "young": 2700.0, "poisson": 0.33, "density": 1.0},
        },
        "bodies": [disc("left", [2.0, 1.2], [1.0, -2.0]), disc("right", [3.9, 2.6], [0.0, 0.0])],
        "obstacles": [
            plane("floor", [0.0, 0.0], [0.0, 1.0]), plane("east", [10.0, 0.0], [-1.0, 0.0]),
            plane("ceiling", [0.0, 6.0], [0.0, -1.0]), plane("west", [0.0, 0.0], [1.0, 0.0]),
        ],
        "contact": {
            "condition": condition, "friction": friction, "sources": "first", "certificate_tolerance": 1e-9, "targets": "faceted",
            "solver": {"kind": "gauss-seidel", "tolerance": 1e-12, "max_iterations": 10000},
        },
    }))
    .expect("a complete scenario")
}

fn main() {
    let mut criterion = Criterion::default().sample_size(10).configure_from_args();
    for (condition, friction) in [("gap", 0.0), ("gap", 0.2), ("midpoint", 0.2)] {
        let scenario = scenario(friction, condition);
        let mut times: Vec<Duration> = Vec::new();
        let mut group = criterion.benchmark_group("cylinders, 2084 dofs");
        group.throughput(Throughput::Elements(STEPS));
        group.bench_function(format!("{condition}, friction {friction}"), |bencher| {
            bencher.iter_custom(|runs| {
                let mut total = Duration::ZERO;
                for _ in 0..runs {
                    let mut simulation = Simulation::new(&scenario).expect("valid");
                    let start = Instant::now();
                    simulation.advance(f64::INFINITY, || false).expect("runs");
                    times.push(start.elapsed());
                    total += start.elapsed();
                    assert_eq!(simulation.step(), STEPS);
                }
                total
            });
        });
        group.finish();
        times.sort_unstable();
        let median = times[times.len() / 2].as_secs_f64() / STEPS as f64;
        println!(
            "{condition}, friction {friction}: median {:.3} ms per step of {} runs",
            1e3 * median,
            times.len()
        );
    }
    criterion.final_summary();
}
