//! Every law in motion: impact with the scheme `conserving` keeps the books, and viscosity damps as it should.

use crate::common::{body, disc, parse, scenario};
use carom::{Simulation, Summary};
use carom_mesh::Vector;
use serde_json::{Value, json};

/// Laws of large strain that no other test runs, about as stiff as the material of the paper's cylinders.
fn rubbers() -> [Value; 4] {
    [
        json!({"kind": "mooney-rivlin", "c10": 350.0, "c01": 150.0, "bulk": 2700.0, "density": 1.0}),
        json!({"kind": "yeoh", "c10": 500.0, "c20": -40.0, "c30": 20.0, "bulk": 2700.0, "density": 1.0}),
        json!({"kind": "ogden", "mu": [800.0, 50.0, -200.0], "alpha": [1.3, 4.0, -2.0], "bulk": 2700.0, "density": 1.0}),
        json!({"kind": "blatz-ko", "shear": 1000.0, "poisson": 0.25, "fraction": 0.0, "density": 1.0}),
    ]
}

/// Two discs, one spinning, that meet off centre in free space.
fn impact(material: &Value, friction: f64) -> Simulation<2> {
    let discs = [
        body("left", disc([0.0, 0.0], 1.0, 4), [1.5, 0.3]),
        body("right", disc([2.05, 0.4], 1.0, 4), [-0.5, 0.0]),
    ];
    let mut case = scenario(0.2, 1e-3, &discs, &[]);
    case["bodies"][0]["spin"] = json!(4.0);
    case["materials"]["elastic"] = material.clone();
    case["analysis"]["scheme"] = json!({"kind": "conserving"});
    case["analysis"]["newton"]["tolerance"] = json!(1e-11);
    case["contact"]["condition"] = json!("midpoint");
    case["contact"]["friction"] = json!(friction);
    let mut simulation = Simulation::<2>::new(&parse(&case)).expect("valid");
    let before = angular_momentum(&simulation);
    simulation.advance(f64::INFINITY, || false).expect("runs");
    assert_eq!(simulation.summary().contacts.len(), 1, "the discs meet");
    // Friction at the bottom of a gap has a moment.
    if friction == 0.0 {
        let after = angular_momentum(&simulation);
        assert!((after - before).abs() < 1e-10 * before.abs(), "{material}: {before} became {after}");
    }
    simulation
}

fn angular_momentum(simulation: &Simulation<2>) -> f64 {
    let of = |b: &carom::ModelBody<2>| {
        let (u, v) = (&simulation.state().displacement[b.nodes()], &simulation.state().velocity[b.nodes()]);
        let mut mv = vec![Vector::zeros(); v.len()];
        b.body.mass().multiply(v, &mut mv);
        b.body.angular_momentum(u, &mv)[2]
    };
    simulation.model().bodies.iter().map(|b| of(b)).sum()
}

#[test]
fn rubber_and_foam_conserve_energy_and_angular_momentum_in_an_impact() {
    for material in rubbers() {
        let energy = impact(&material, 0.0).summary().energy;
        assert!(energy.max_drift < 1e-10 * energy.initial, "{material}: drift {:e}", energy.max_drift);
    }
}

#[test]
fn viscosity_takes_energy_but_no_angular_momentum() {
    for mut material in rubbers() {
        material["viscosity"] = json!({"shear": 4.0, "bulk": 2.0});
        let energy = impact(&material, 0.0).summary().energy;
        assert!(energy.terms.viscous > 0.01 * energy.initial, "{material}: {energy:?}");
        assert!(energy.max_defect < 1e-10 * energy.initial, "{material}: defect {:e}", energy.max_defect);
    }
}

#[test]
fn viscosity_and_friction_share_what_is_lost() {
    let mut material = rubbers()[0].clone();
    material["viscosity"] = json!({"shear": 4.0, "bulk": 2.0});
    let energy = impact(&material, 0.3).summary().energy;
    assert!(energy.terms.viscous > 0.0 && energy.terms.friction > 0.0, "{energy:?}");
    assert!(energy.max_defect < 1e-10 * energy.initial, "defect {:e}", energy.max_defect);
}

const CELLS: usize = 20;
const LENGTH: f64 = 2.0;
const YOUNG: f64 = 2700.0;
/// Time of viscous relaxation 2 η/E [s].
const BETA: f64 = 1e-3;

/// The left end of a free bar after `t` [s]: mode cos(πx/L) has the frequency ω² = 6 c²/h² (1 − cos kh)/(2 + cos kh) in linear elements, and
/// in a bar of E ε + 2 η ε̇ (ν = 0, ζ = ⅔ η) it decays with the rate ½ β ω².
fn exact(t: f64) -> f64 {
    let (h, k, c) = (LENGTH / CELLS as f64, std::f64::consts::PI / LENGTH, YOUNG.sqrt());
    let omega = c / h * (6.0 * (1.0 - (k * h).cos()) / (2.0 + (k * h).cos())).sqrt();
    let decay = 0.5 * BETA * omega * omega;
    let damped = (omega * omega - decay * decay).sqrt();
    (-decay * t).exp() * (damped * t).sin() / damped
}

/// A free bar of a law with viscosity, set swinging in its first axial mode with `speed` [m/s] for 0.1 s.
fn bar(law: &str, scheme: &Value, dt: f64, speed: f64) -> (f64, Summary) {
    let mesh =
        json!({"kind": "rectangle", "corner": [0.0, 0.0], "size": [LENGTH, 0.1], "divisions": [CELLS, 1]});
    let mut case = scenario(0.1, dt, &[body("bar", mesh, [0.0, 0.0])], &[]);
    case["analysis"]["scheme"] = scheme.clone();
    case["analysis"]["newton"]["tolerance"] = json!(1e-11);
    let viscosity = json!({"shear": 0.5 * BETA * YOUNG, "bulk": BETA * YOUNG / 3.0});
    case["materials"]["elastic"] =
        json!({"kind": law, "young": YOUNG, "poisson": 0.0, "density": 1.0, "viscosity": viscosity});
    let mut simulation = Simulation::<2>::new(&parse(&case)).expect("valid");
    let mode = |x: &Vector<2>| Vector::<2>::new(speed * (std::f64::consts::PI * x[0] / LENGTH).cos(), 0.0);
    let velocity = simulation.model().assembly.reference.iter().map(mode).collect();
    simulation.set_initial_velocity(velocity);
    simulation.advance(f64::INFINITY, || false).expect("runs");
    (simulation.state().displacement[0][0] / speed, simulation.summary())
}

#[test]
fn a_viscous_bar_decays_at_the_rate_of_its_relaxation_time() {
    let theta = |theta: f64| json!({"kind": "theta", "theta": theta, "xi": theta});
    for (scheme, order) in [(theta(0.5), 2.0), (theta(1.0), 1.0), (json!({"kind": "conserving"}), 2.0)] {
        let errors = [2e-3, 1e-3, 5e-4, 2.5e-4].map(|dt| {
            let (u, summary) = bar("linear-elastic", &scheme, dt, 1.0);
            assert!(summary.energy.max_defect < 1e-12 * summary.energy.initial);
            assert!(summary.energy.terms.viscous > 0.1 * summary.energy.initial);
            (u - exact(0.1)).abs() / 0.02
        });
        let rate = (errors[2] / errors[3]).log2();
        assert!((rate - order).abs() < 0.15, "{scheme}: errors {errors:?}");
    }
}

/// At a strain of 1e-5 a law of large strain is the linear one.
#[test]
fn viscosity_of_large_strain_is_that_of_small_strain_where_strains_are_small() {
    let conserving = json!({"kind": "conserving"});
    let (linear, _) = bar("linear-elastic", &conserving, 5e-4, 1e-3);
    let (large, _) = bar("neo-hookean", &conserving, 5e-4, 1e-3);
    assert!((large / linear - 1.0).abs() < 1e-3, "{large} {linear}");
}
