//! The scheme `conserving` with the conditions `midpoint` and `massless`: energy and momenta of an impact to round-off, whatever
//! the law.

use crate::common::{body, disc, parse, scenario};
use carom::Simulation;
use carom_mesh::Vector;
use serde_json::json;

const LAWS: [&str; 2] = ["saint-venant-kirchhoff", "neo-hookean"];
const CONDITIONS: [&str; 2] = ["midpoint", "massless"];

/// Every law with every condition.
fn variants() -> impl Iterator<Item = (&'static str, &'static str)> {
    LAWS.into_iter().flat_map(|law| CONDITIONS.map(|condition| (law, condition)))
}

/// Two discs, one spinning, that meet off centre in free space; what `massless` checks against is smooth.
fn impact(law: &str, condition: &str, friction: f64) -> Simulation<2> {
    let discs = [
        body("left", disc([0.0, 0.0], 1.0, 4), [1.5, 0.3]),
        body("right", disc([2.05, 0.4], 1.0, 4), [-0.5, 0.0]),
    ];
    let mut case = scenario(0.3, 1e-3, &discs, &[]);
    case["bodies"][0]["spin"] = json!(4.0);
    case["materials"]["elastic"]["kind"] = json!(law);
    case["analysis"]["scheme"] = json!({"kind": "conserving"});
    case["analysis"]["newton"]["tolerance"] = json!(1e-11);
    case["contact"]["condition"] = json!(condition);
    case["contact"]["targets"] = json!(if condition == "massless" { "smooth" } else { "faceted" });
    case["contact"]["friction"] = json!(friction);
    Simulation::<2>::new(&parse(&case)).expect("valid")
}

/// Linear and angular momentum about the origin.
fn momenta(simulation: &Simulation<2>) -> (Vector<2>, f64) {
    let (mut linear, mut angular) = (Vector::zeros(), 0.0);
    for b in &simulation.model().bodies {
        let (u, v) = (&simulation.state().displacement[b.nodes()], &simulation.state().velocity[b.nodes()]);
        let mut mv = vec![Vector::zeros(); v.len()];
        b.body.mass().multiply(v, &mut mv);
        linear += mv.iter().sum::<Vector<2>>();
        angular += b.body.angular_momentum(u, &mv)[2];
    }
    (linear, angular)
}

#[test]
fn frictionless_impact_conserves_energy_and_both_momenta() {
    for (law, condition) in variants() {
        let mut simulation = impact(law, condition, 0.0);
        let (linear, angular) = momenta(&simulation);
        simulation.advance(f64::INFINITY, || false).expect("runs");
        let summary = simulation.summary();
        assert_eq!(summary.contacts.len(), 1, "{law}, {condition}: the discs meet");
        assert!(summary.contacts[0].peak_force > 10.0, "{law}, {condition}: {:?}", summary.contacts);
        let energy = summary.energy;
        assert!(
            energy.max_drift < 1e-10 * energy.initial,
            "{law}, {condition}: drift {:e} of {}",
            energy.max_drift,
            energy.initial
        );
        let (linear_after, angular_after) = momenta(&simulation);
        assert!((linear_after - linear).norm() < 1e-11 * linear.norm(), "{law}, {condition}: {linear_after}");
        assert!(
            (angular_after - angular).abs() < 1e-10 * angular.abs(),
            "{law}, {condition}: {angular} became {angular_after}"
        );
    }
}

#[test]
fn with_friction_all_that_is_lost_is_booked_as_friction() {
    for (law, condition) in variants() {
        let mut simulation = impact(law, condition, 0.3);
        simulation.advance(f64::INFINITY, || false).expect("runs");
        let energy = simulation.summary().energy;
        assert!(energy.terms.friction > 0.01 * energy.initial, "{law}, {condition}: {energy:?}");
        assert!(
            energy.max_defect < 1e-10 * energy.initial,
            "{law}, {condition}: defect {:e}",
            energy.max_defect
        );
        assert!((energy.initial - energy.last - energy.terms.friction).abs() < 1e-10 * energy.initial);
    }
}

/// Symptom guarded against: with massless nodes the step after the last reaction still rubs, and the event did not count it.
#[test]
fn events_book_all_friction_of_the_ledger() {
    for (law, condition) in variants() {
        let mut simulation = impact(law, condition, 0.3);
        simulation.advance(f64::INFINITY, || false).expect("runs");
        let summary = simulation.summary();
        let booked: f64 = summary.contacts.iter().map(|c| c.friction_work).sum();
        let all = summary.energy.terms.friction;
        assert!((booked - all).abs() < 1e-12 * all, "{law}, {condition}: {booked} of {all} J");
    }
}
