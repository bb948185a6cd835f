//! The paper's two cylinders from Rust: `cargo run --release --example cylinders [friction] [end_time]`.

use carom::{Scenario, Simulation};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let friction: f64 = arguments.next().map_or(Ok(0.2), |a| a.parse())?;
    let end_time: f64 = arguments.next().map_or(Ok(3.0), |a| a.parse())?;
    let disc = |name: &str, x: f64, velocity: [f64; 2]| {
        serde_json::json!({
            "name": name, "material": "elastic", "hypothesis": "plane-strain", "thickness": 1.0, "mass": "consistent",
            "mesh": {"kind": "disc", "centre": [x, 4.0], "radius": 1.0, "divisions": 8},
            "velocity": velocity, "spin": 0.0,
        })
    };
    let plane = |name: &str, point: [f64; 2], normal: [f64; 2]| serde_json::json!({"name": name, "kind": "plane", "point": point, "normal": normal});
    let scenario: Scenario = serde_json::from_value(serde_json::json!({
        "title": "Two cylinders in a rigid box",
        "analysis": {
            "kind": "dynamic", "end_time": end_time, "time_step": 1e-3, "max_halvings": 8, "gravity": null,
            "scheme": {"kind": "theta", "theta": 0.5, "xi": 0.5},
            "newton": {"tolerance": 1e-9, "max_iterations": 50},
        },
        "output": {"fields_every": 0.05, "history_every": 0.01, "merge_contacts": 0.03},
        "materials": {
            "elastic": {"kind": "saint-venant-kirchhoff", "young": 2700.0, "poisson": 0.33, "density": 1.0},
        },
        "bodies": [disc("left", 2.0, [1.0, -2.0]), disc("right", 6.0, [0.0, 0.0])],
        "obstacles": [
            plane("floor", [0.0, 0.0], [0.0, 1.0]), plane("east", [8.0, 0.0], [-1.0, 0.0]),
            plane("ceiling", [0.0, 8.0], [0.0, -1.0]), plane("west", [0.0, 0.0], [1.0, 0.0]),
        ],
        "contact": {
            "condition": "gap", "friction": friction, "sources": "first",
            "solver": {"kind": "gauss-seidel", "tolerance": 1e-12, "max_iterations": 10000},
        },
    }))?;
    let mut simulation = Simulation::new(&scenario)?;
    let start = std::time::Instant::now();
    simulation.advance(f64::INFINITY, || false)?;
    let elapsed = start.elapsed().as_secs_f64();
    println!("{}", serde_json::to_string_pretty(&simulation.summary())?);
    println!("{:.4} ms per step", 1e3 * elapsed / simulation.steps() as f64);
    Ok(())
}
