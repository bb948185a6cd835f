//! Scenarios that several tests share.

use carom::Scenario;
use serde_json::{Value, json};

/// A body of the material "elastic".
pub fn body(name: &str, mesh: Value, velocity: [f64; 2]) -> Value {
    json!({
        "name": name, "material": "elastic", "hypothesis": "plane-strain", "thickness": 1.0, "mass": "consistent",
        "mesh": mesh, "velocity": velocity, "spin": 0.0,
    })
}

/// A disc with as many `divisions`.
pub fn disc(centre: [f64; 2], radius: f64, divisions: usize) -> Value {
    json!({"kind": "disc", "centre": centre, "radius": radius, "divisions": divisions})
}

/// A plane obstacle.
pub fn plane(name: &str, point: [f64; 2], normal: [f64; 2]) -> Value {
    json!({"name": name, "kind": "plane", "point": point, "normal": normal})
}

/// A scenario of these bodies and obstacles with the material of the paper's cylinders.
///
/// Scheme, contact condition, sources and friction solver are those of the paper, `theta`, `gap`, `first` and `gauss-seidel`, not the
/// defaults of the case file: tests of others set them.
pub fn scenario(end_time: f64, time_step: f64, bodies: &[Value], obstacles: &[Value]) -> Value {
    json!({
        "title": "test",
        "analysis": {
            "kind": "dynamic", "end_time": end_time, "time_step": time_step, "max_halvings": 8, "gravity": null,
            "scheme": {"kind": "theta", "theta": 0.5, "xi": 0.5},
            "newton": {"tolerance": 1e-9, "max_iterations": 50},
        },
        "output": {"fields_every": 0.05, "history_every": 0.01, "merge_contacts": 0.03},
        "materials": {
            "elastic": {"kind": "saint-venant-kirchhoff", "young": 2700.0, "poisson": 0.33, "density": 1.0},
        },
        "bodies": bodies,
        "obstacles": obstacles,
        "contact": {
            "condition": "gap", "friction": 0.0, "sources": "first", "certificate_tolerance": 1e-9, "penetration_tolerance": 0.01, "targets": "faceted",
            "solver": {"kind": "gauss-seidel", "tolerance": 1e-12, "max_iterations": 10000},
        },
    })
}

/// The scenario as the core takes it.
pub fn parse(value: &Value) -> Scenario {
    serde_json::from_value(value.clone()).expect("a complete scenario")
}
