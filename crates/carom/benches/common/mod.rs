//! The scenes that benchmarks share: two discs of 1,042 unknowns each.

#![allow(dead_code, reason = "every benchmark takes what it needs")]

use carom::Scenario;
use serde_json::{Value, json};

/// Steps of 1 ms of the window that other codes were measured on: a floor bounce and an impact of the discs.
pub const STEPS: u64 = 600;

/// A scenario and what it is called.
pub struct Scene {
    pub name: String,
    pub scheme: &'static str,
    pub scenario: Scenario,
}

/// How the discs are taken through time.
struct Method<'a> {
    scheme: &'a str,
    condition: &'a str,
    friction: f64,
    solver: &'a str,
}

/// The scenario with this coefficient of friction, contact condition and friction solver, in the paper's scheme.
pub fn scenario(friction: f64, condition: &str, solver: &str) -> Scenario {
    let bodies = json!([disc("left", [2.0, 1.2], [1.0, -2.0]), disc("right", [3.9, 2.6], [0.0, 0.0])]);
    discs(&Method { scheme: "theta", condition, friction, solver }, STEPS as f64 * 1e-3, [10.0, 6.0], bodies)
}

/// The window that other codes were measured on.
pub fn scene(scheme: &'static str, condition: &str, friction: f64) -> Scene {
    let bodies = json!([disc("left", [2.0, 1.2], [1.0, -2.0]), disc("right", [3.9, 2.6], [0.0, 0.0])]);
    let method = Method { scheme, condition, friction, solver: "auto" };
    let scenario = discs(&method, STEPS as f64 * 1e-3, [10.0, 6.0], bodies);
    Scene { name: format!("0.6 s, {scheme}, {condition}, μ = {friction}"), scheme, scenario }
}

/// The paper's two cylinders, 15 s, on the mesh of [`scene`].
pub fn paper_scene(scheme: &'static str, condition: &str, friction: f64) -> Scene {
    let bodies = json!([disc("left", [2.0, 4.0], [1.0, -2.0]), disc("right", [6.0, 4.0], [0.0, 0.0])]);
    let scenario = discs(&Method { scheme, condition, friction, solver: "auto" }, 15.0, [8.0, 8.0], bodies);
    Scene { name: format!("15 s, {scheme}, {condition}, μ = {friction}"), scheme, scenario }
}

fn disc(name: &str, centre: [f64; 2], velocity: [f64; 2]) -> Value {
    json!({
        "name": name, "material": "elastic", "hypothesis": "plane-strain", "thickness": 1.0, "mass": "consistent",
        "mesh": {"kind": "disc", "centre": centre, "radius": 1.0, "divisions": 10, "rings": 10},
        "velocity": velocity, "spin": 0.0,
    })
}

fn discs(method: &Method<'_>, end_time: f64, room: [f64; 2], bodies: Value) -> Scenario {
    let Method { scheme, condition, friction, solver } = *method;
    let plane = |name: &str, point: [f64; 2], normal: [f64; 2]| json!({"name": name, "kind": "plane", "point": point, "normal": normal});
    // Without mass the surfaces are what a case has by default; the others are as other codes have them.
    let (sources, targets) =
        if condition == "massless" { (None, "smooth") } else { (Some("first"), "faceted") };
    let scheme = match scheme {
        "theta" => json!({"kind": "theta", "theta": 0.5, "xi": 0.5}),
        other => json!({"kind": other}),
    };
    serde_json::from_value(json!({
        "analysis": {
            "kind": "dynamic", "end_time": end_time, "time_step": 1e-3, "max_halvings": 8, "gravity": null,
            "scheme": scheme,
            "newton": {"tolerance": 1e-9, "max_iterations": 50},
        },
        "output": {"fields_every": 0.05, "history_every": 0.01, "merge_contacts": 0.03},
        "materials": {
            "elastic": {"kind": "saint-venant-kirchhoff", "young": 2700.0, "poisson": 0.33, "density": 1.0},
        },
        "bodies": bodies,
        "obstacles": [
            plane("floor", [0.0, 0.0], [0.0, 1.0]), plane("east", [room[0], 0.0], [-1.0, 0.0]),
            plane("ceiling", [0.0, room[1]], [0.0, -1.0]), plane("west", [0.0, 0.0], [1.0, 0.0]),
        ],
        "contact": {
            "condition": condition, "friction": friction, "sources": sources, "certificate_tolerance": 1e-9, "penetration_tolerance": 0.01, "targets": targets,
            "solver": {"kind": solver, "tolerance": 1e-12, "max_iterations": 10000},
        },
    }))
    .expect("a complete scenario")
}
