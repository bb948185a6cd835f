//! Bodies so large, in steps so short, that a polynomial stands for the factor of K̄, with more contacts than are solved to the end in
//! every iteration.

use carom::Simulation;
use carom_mesh::Vector;
use serde_json::{Value, json};

use crate::common::{parse, scenario};

const CELLS: usize = 14;
const LAYERS: usize = 4;

/// A flat block of hexahedra that spins above a floor, or falls on it with all nodes of its base.
pub fn block(spin: [f64; 3]) -> Value {
    let h = 1.0 / CELLS as f64;
    // A step in which a wave crosses a cell.
    let dt = h / 63.0;
    let mut case = scenario(14.0 * dt, dt, &[], &[]);
    case["dimension"] = json!(3);
    let falls = spin == [0.0; 3];
    let height = if falls { 0.02 * h } else { 1.0 };
    case["bodies"] = json!([{
        "name": "block", "material": "elastic", "hypothesis": "plane-strain", "thickness": 1.0, "mass": "consistent",
        "mesh": {
            "kind": "box", "corner": [0.0, 0.0, height], "size": [1.0, 1.0, LAYERS as f64 * h],
            "divisions": [CELLS, CELLS, LAYERS], "cell": "hex8",
        },
        "velocity": [0.3, 0.1, -1.0], "spin": spin,
    }]);
    case["obstacles"] =
        json!([{"name": "floor", "kind": "plane", "point": [0.0, 0.0, 0.0], "normal": [0.0, 0.0, 1.0]}]);
    case["analysis"]["scheme"] = json!({"kind": "conserving"});
    case["contact"]["condition"] = json!("midpoint");
    case["contact"]["friction"] = json!(0.2);
    case["contact"]["solver"] = json!({"kind": "auto", "tolerance": 1e-12, "max_iterations": 10000});
    case
}

/// No factor of a body in space is smaller than this per unknown.
fn assert_made_without_a_factor(simulation: &Simulation<3>) {
    let dofs = simulation.summary().dofs;
    assert!(
        simulation.factor_bytes() < 500 * dofs,
        "{} bytes for {dofs} unknowns",
        simulation.factor_bytes()
    );
}

#[test]
fn a_block_that_lands_flat_loses_what_friction_takes() {
    let case = block([0.0; 3]);
    let mut simulation = Simulation::<3>::new(&parse(&case)).expect("valid");
    let mut most = 0;
    while simulation.step() < simulation.steps() {
        simulation.advance(f64::INFINITY, || true).expect("runs");
        most = most.max(simulation.progress().contacts);
    }
    let summary = simulation.summary();
    assert_eq!(most, (CELLS + 1) * (CELLS + 1));
    assert_made_without_a_factor(&simulation);
    assert!(summary.energy.terms.friction > 1e-3 * summary.energy.initial, "{summary:?}");
    assert!(summary.energy.max_defect < 1e-11 * summary.energy.initial, "{summary:?}");
    assert!(summary.certificate.max_residual < 1e-9, "{summary:?}");
    // It acts against the sliding, but for the base that spreads as it lands, and by Coulomb's law at most.
    let slid = Vector::<3>::new(0.3, 0.1, 0.0);
    let mean = simulation.model().bodies[0].body.mean(&simulation.state().velocity);
    let lost = Vector::<3>::new(slid[0] - mean[0], slid[1] - mean[1], 0.0);
    assert!(lost.cross(&slid).norm() < 0.01 * lost.norm() * slid.norm(), "{lost}");
    assert!(lost.dot(&slid) > 0.0 && lost.norm() < 0.2 * (mean[2] + 1.0), "{lost}");
}

#[test]
fn a_block_that_spins_keeps_its_momentum() {
    let mut case = block([9.0, -4.0, 5.0]);
    case["analysis"]["newton"]["tolerance"] = json!(1e-11);
    let mut simulation = Simulation::<3>::new(&parse(&case)).expect("valid");
    let momenta = |simulation: &Simulation<3>| {
        let body = &simulation.model().bodies[0].body;
        let state = simulation.state();
        let mut mv = vec![Vector::zeros(); body.node_count()];
        body.mass().multiply(&state.velocity, &mut mv);
        (mv.iter().sum::<Vector<3>>(), body.angular_momentum(&state.displacement, &mv))
    };
    let (linear, angular) = momenta(&simulation);
    simulation.advance(f64::INFINITY, || false).expect("runs");
    assert_made_without_a_factor(&simulation);
    assert!(simulation.summary().newton_iterations > 2 * simulation.steps(), "it vibrates");
    let (linear_after, angular_after) = momenta(&simulation);
    assert!((linear_after - linear).norm() < 1e-12 * linear.norm());
    let (before, after) = (Vector::from(angular), Vector::from(angular_after));
    assert!((after - before).norm() < 1e-10 * before.norm(), "{before} became {after}");
    let energy = simulation.summary().energy;
    assert!(energy.max_defect < 1e-12 * energy.initial, "{energy:?}");
}

/// From 100 contacts on their problem is solved loosely at first: as loosely as the motion bears it, not the weight.
#[test]
fn a_block_at_rest_takes_no_more_iterations_for_more_contacts() {
    let iterations = |divisions: [usize; 3]| {
        let h = 0.1;
        let mut case = scenario(0.2, 1e-3, &[], &[]);
        case["dimension"] = json!(3);
        let size = divisions.map(|n| n as f64 * h);
        case["bodies"] = json!([{
            "name": "block", "material": "elastic", "hypothesis": "plane-strain", "thickness": 1.0, "mass": "consistent",
            "mesh": {"kind": "box", "corner": [0.0, 0.0, 0.0], "size": size, "divisions": divisions, "cell": "hex8"},
            "velocity": [0.0, 0.0, 0.0], "spin": [0.0, 0.0, 0.0],
        }]);
        case["materials"]["elastic"]["damping"] = json!({"mass": 20.0, "stiffness": 1e-3});
        case["obstacles"] =
            json!([{"name": "floor", "kind": "plane", "point": [0.0, 0.0, 0.0], "normal": [0.0, 0.0, 1.0]}]);
        case["analysis"]["gravity"] = json!([0.0, 0.0, -2.0]);
        case["contact"]["friction"] = json!(0.3);
        case["contact"]["solver"] = json!({"kind": "auto", "tolerance": 1e-12, "max_iterations": 10000});
        let mut simulation = Simulation::<3>::new(&parse(&case)).expect("valid");
        simulation.advance(f64::INFINITY, || false).expect("runs");
        assert_eq!(simulation.progress().contacts, (divisions[0] + 1) * (divisions[1] + 1));
        simulation.summary().newton_iterations as f64 / simulation.steps() as f64
    };
    let (fewer, more) = (iterations([10, 8, 3]), iterations([9, 9, 3]));
    assert!(more < 1.2 * fewer, "{fewer} with 99 contacts, {more} with 100");
}
