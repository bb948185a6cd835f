//! A free bar in its first axial mode with Rayleigh damping is a damped oscillator, and the scheme converges to it at its order.

use carom::Simulation;
use carom_mesh::Vector;
use serde_json::json;

const CELLS: usize = 20;
const LENGTH: f64 = 2.0;
const ALPHA: f64 = 0.8;
const BETA: f64 = 1e-3;

/// Mode cos(πx/L) is an exact eigenvector of linear elements of equal length with consistent mass, of frequency
/// ω² = 6 c²/h² (1 − cos kh)/(2 + cos kh); with damping α + βω² = 2ζω its amplitude is (v₀/ω_d) exp(−ζωt) sin ω_d t.
fn exact(t: f64) -> f64 {
    let (h, k, c) = (LENGTH / CELLS as f64, std::f64::consts::PI / LENGTH, 2700.0_f64.sqrt());
    let omega = c / h * (6.0 * (1.0 - (k * h).cos()) / (2.0 + (k * h).cos())).sqrt();
    let decay = 0.5 * (ALPHA + BETA * omega * omega);
    let damped = (omega * omega - decay * decay).sqrt();
    (-decay * t).exp() * (damped * t).sin() / damped
}

/// Error of the displacement of the left end after `t` = 0.1 s, and the defect of the ledger relative to the energy.
fn error(theta: f64, xi: f64, dt: f64) -> (f64, f64, carom::Summary) {
    let mesh =
        json!({"kind": "rectangle", "corner": [0.0, 0.0], "size": [LENGTH, 0.1], "divisions": [CELLS, 1]});
    let mut case = crate::common::scenario(0.1, dt, &[crate::common::body("bar", mesh, [0.0, 0.0])], &[]);
    case["analysis"]["scheme"] = json!({"kind": "theta", "theta": theta, "xi": xi});
    case["materials"]["elastic"] = json!({
        "kind": "linear-elastic", "young": 2700.0, "poisson": 0.0, "density": 1.0,
        "damping": {"mass": ALPHA, "stiffness": BETA},
    });
    let mut simulation = Simulation::<2>::new(&crate::common::parse(&case)).expect("valid");
    let velocity = simulation
        .model()
        .assembly
        .reference
        .iter()
        .map(|x| Vector::<2>::new((std::f64::consts::PI * x[0] / LENGTH).cos(), 0.0))
        .collect();
    simulation.set_initial_velocity(velocity);
    simulation.advance(f64::INFINITY, || false).expect("runs");
    let u = simulation.state().displacement[0][0];
    let summary = simulation.summary();
    ((u - exact(0.1)).abs() / 0.02, summary.energy.max_defect / summary.energy.initial, summary)
}

#[test]
fn damped_oscillator_is_reproduced_at_the_order_of_the_scheme() {
    for (theta, xi, order) in [(0.5, 0.5, 2.0), (1.0, 1.0, 1.0), (0.75, 0.5, 1.0)] {
        let steps = [2e-3, 1e-3, 5e-4, 2.5e-4];
        let errors: Vec<f64> = steps.iter().map(|&dt| error(theta, xi, dt).0).collect();
        let rates: Vec<f64> = errors.windows(2).map(|e| (e[0] / e[1]).log2()).collect();
        let last = rates[rates.len() - 1];
        assert!((last - order).abs() < 0.15, "θ = {theta}, ξ = {xi}: errors {errors:?}, rates {rates:?}");
    }
}

#[test]
fn books_of_a_damped_linear_body_close_to_round_off_for_every_theta_and_xi() {
    for (theta, xi) in [(0.5, 0.5), (0.55, 0.55), (1.0, 1.0), (0.8, 0.3), (0.5, 1.0)] {
        let (_, defect, summary) = error(theta, xi, 1e-3);
        assert!(defect < 1e-12, "θ = {theta}, ξ = {xi}: defect {defect:e}");
        assert!(summary.energy.terms.viscous > 0.0);
        if theta > 0.5 || xi > 0.5 {
            assert!(summary.energy.terms.scheme != 0.0, "θ = {theta}, ξ = {xi} dissipates by its algebra");
        }
    }
}
