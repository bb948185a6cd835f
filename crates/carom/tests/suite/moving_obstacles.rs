//! Obstacles that move: the observer does not matter, and the books have the work of the motion.

use crate::common::{body, disc, parse, plane, scenario};
use carom::Simulation;
use carom_mesh::Vector;
use serde_json::json;

const VARIANTS: [(&str, &str); 5] = [
    ("theta", "gap"),
    ("theta", "endpoint"),
    ("theta", "massless"),
    ("conserving", "midpoint"),
    ("conserving", "massless"),
];

/// A spinning disc that meets a rough floor obliquely, as an observer with velocity −`boost` sees it.
fn impact(scheme: &str, condition: &str, boost: [f64; 2]) -> Simulation<2> {
    let velocity = [0.8 + boost[0], -1.5 + boost[1]];
    let mut case = scenario(
        0.3,
        1e-3,
        &[body("ball", disc([0.0, 1.0503], 1.0, 4), velocity)],
        &[plane("floor", [0.0, 0.0], [0.0, 1.0])],
    );
    case["analysis"]["scheme"] = if scheme == "theta" {
        json!({"kind": scheme, "theta": 0.5, "xi": 0.5})
    } else {
        json!({"kind": scheme})
    };
    case["analysis"]["newton"]["tolerance"] = json!(1e-11);
    case["bodies"][0]["spin"] = json!(1.0);
    case["obstacles"][0]["velocity"] = json!(boost);
    case["contact"]["condition"] = json!(condition);
    case["contact"]["friction"] = json!(0.3);
    let mut simulation = Simulation::<2>::new(&parse(&case)).expect("a valid case");
    simulation.advance(f64::INFINITY, || false).expect("converges");
    simulation
}

#[test]
fn floor_that_comes_to_the_ball_is_a_ball_that_comes_to_the_floor() {
    for (scheme, condition) in VARIANTS {
        let still = impact(scheme, condition, [0.0, 0.0]);
        let boost = [-0.8, 1.5];
        let moving = impact(scheme, condition, boost);
        let travel = Vector::<2>::from(boost) * 0.3;
        let nodes = still.model().node_count();
        let pairs = still.state().displacement[..nodes].iter().zip(&moving.state().displacement[..nodes]);
        let apart = pairs.map(|(a, b)| (b - travel - a).norm()).fold(0.0, f64::max);
        // The blend keeps the angular momentum about a fixed point, with the forces of start and end where they act. An observer
        // who moves finds another moment for their difference: ¼ Δt² V × (F₁ − F₀), which sums to nearly nothing over an impact.
        let tolerance = if (scheme, condition) == ("conserving", "massless") { 2e-6 } else { 1e-8 };
        assert!(apart < tolerance, "{scheme} {condition}: {apart:.1e} m");
        let (a, b) = (still.books().total, moving.books().total);
        assert!((a.friction - b.friction).abs() < 10.0 * tolerance * a.friction, "{scheme} {condition}");
        assert!(a.prescribed == 0.0 && b.prescribed > 1.0, "{scheme} {condition}: {} J", b.prescribed);
    }
}

#[test]
fn work_of_a_moving_floor_closes_the_books() {
    for condition in ["midpoint", "massless"] {
        let simulation = impact("conserving", condition, [-0.8, 1.5]);
        let books = simulation.books();
        let scale = books.total.prescribed;
        assert!(books.total.defect().abs() < 1e-10 * scale, "{condition}: {:.1e}", books.total.defect());
        let pairs: f64 = books.pairs.values().map(|p| p.prescribed - p.friction - p.normal_contact).sum();
        let bodies: f64 = books.bodies.iter().map(|b| b.contact).sum();
        assert!((pairs - bodies).abs() < 1e-9 * scale, "{condition}");
    }
}
