//! The scene that benchmarks share: two discs of 2,084 unknowns, a floor bounce and a disc–disc impact.

use carom::Scenario;
use serde_json::json;

/// Steps of 1 ms.
pub const STEPS: u64 = 600;

/// The scenario with this coefficient of friction, contact condition and friction solver.
pub fn scenario(friction: f64, condition: &str, solver: &str) -> Scenario {
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
            "solver": {"kind": solver, "tolerance": 1e-12, "max_iterations": 10000},
        },
    }))
    .expect("a complete scenario")
}
