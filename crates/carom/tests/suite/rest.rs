//! Rest is rest: stacks of boxes with flush sides stay where they are, whoever is first, and what is reported as velocity is motion.

use carom::Simulation;
use serde_json::{Value, json};

use crate::common::{parse, scenario};

const DT: f64 = 1e-3;

/// Unit boxes on one another and on a floor, each with its own number of cells per side, listed in this `order`.
fn stack<const D: usize>(cells: &[usize], order: &[usize], condition: &str) -> Value {
    let up = |height: f64| {
        let mut x = [0.0; D];
        x[D - 1] = height;
        x.to_vec()
    };
    let bodies: Vec<Value> = order
        .iter()
        .map(|&k| {
            let kind = if D == 2 { "rectangle" } else { "box" };
            let (size, divisions) = (vec![1.0; D], vec![cells[k]; D]);
            let spin = if D == 2 { json!(0.0) } else { json!(up(0.0)) };
            json!({
                "name": format!("box {k}"), "material": "elastic", "hypothesis": "plane-strain", "thickness": 1.0,
                "mass": "consistent", "velocity": up(0.0), "spin": spin,
                "mesh": {"kind": kind, "corner": up(k as f64), "size": size, "divisions": divisions},
            })
        })
        .collect();
    let floor = json!({"name": "floor", "kind": "plane", "point": up(0.0), "normal": up(1.0)});
    let mut case = scenario(1.5, DT, &bodies, &[floor]);
    case["dimension"] = json!(D);
    case["analysis"]["scheme"] = json!({"kind": "conserving"});
    case["analysis"]["gravity"] = json!(up(-9.81));
    case["materials"]["elastic"] = json!({
        "kind": "saint-venant-kirchhoff", "young": 1e7, "poisson": 0.3, "density": 1000.0,
        "damping": {"mass": 20.0, "stiffness": 1e-3},
    });
    case["contact"]["condition"] = json!(condition);
    case["contact"]["sources"] = Value::Null;
    case["contact"]["friction"] = json!(0.5);
    case["contact"]["solver"]["kind"] = json!("auto");
    case
}

/// What is left of a stack after a while.
struct Rest {
    /// The farthest that a box has moved sideways, and the deepest that anything was inside anything else [m].
    aside: f64,
    depth: f64,
    kinetic: f64,
    /// Largest |v| less largest |Δu|/Δt over the last step [m/s].
    not_motion: f64,
    iterations: usize,
    strain: f64,
    settled: f64,
    defect: f64,
}

fn rest<const D: usize>(cells: &[usize], order: &[usize], condition: &str) -> Rest {
    let mut simulation = Simulation::<D>::new(&parse(&stack::<D>(cells, order, condition))).expect("valid");
    simulation.advance(1.5 - DT, || false).expect("runs");
    let before = simulation.state().displacement.clone();
    simulation.advance(f64::INFINITY, || false).expect("runs");
    let (state, summary) = (simulation.state(), simulation.summary());
    let assembly = &simulation.model().assembly;
    let aside = |body: usize| {
        let nodes = assembly.nodes(body);
        let mean = carom_mesh::nodal::total(&state.displacement[nodes.clone()]) / nodes.len() as f64;
        (0..D - 1).map(|i| mean[i].abs()).fold(0.0, f64::max)
    };
    let speed = state.velocity.iter().map(|v| v.norm()).fold(0.0, f64::max);
    let moved = state.displacement.iter().zip(&before).map(|(u, b)| (u - b).norm()).fold(0.0, f64::max);
    Rest {
        aside: (0..cells.len()).map(aside).fold(0.0, f64::max),
        depth: summary.penetration.max_depth,
        kinetic: state.energies.kinetic,
        not_motion: speed - moved / DT,
        iterations: simulation.nominal_step().newton_iterations,
        strain: state.energies.strain,
        settled: summary.energy.terms.settling,
        defect: summary.energy.max_defect,
    }
}

/// Symptom guarded against: the top box of a stack slid by 96 mm in a second and sank by 59 mm, and in ten boxes at rest velocities of 0.1 m/s
/// changed sign in every step while nothing moved.
fn stays<const D: usize>(cells: &[usize], condition: &str) {
    let order: Vec<usize> = (0..cells.len()).collect();
    let weight = 1000.0 * 9.81 * cells.len() as f64;
    let worth = weight * 0.5 * cells.len() as f64;
    let r = rest::<D>(cells, &order, condition);
    let what = format!("{D}D, {cells:?}, {condition}");
    println!(
        "{what}: aside {:.1e} m, inside {:.1e} m, kinetic {:.1e} of {worth:.1e} J, |v| beyond motion {:.1e} m/s, {} iterations, defect {:.1e} J",
        r.aside, r.depth, r.kinetic, r.not_motion, r.iterations, r.defect
    );
    assert!(r.aside < 1e-9, "{what}: {:e} m aside", r.aside);
    assert!(r.depth < 1e-8, "{what}: {:e} m inside", r.depth);
    assert!(r.kinetic < 1e-15 * worth, "{what}: {:e} J of motion", r.kinetic);
    assert!(r.not_motion < 1e-9, "{what}: {:e} m/s that are no motion", r.not_motion);
    assert!(r.iterations <= 3, "{what}: {} iterations at rest", r.iterations);
    assert!(r.settled > 0.0 && r.defect < 1e-10 * worth, "{what}: {:e} J", r.defect);
}

#[test]
fn stacks_of_flush_boxes_stay_where_they_are() {
    for condition in ["midpoint", "gap"] {
        stays::<2>(&[4, 4, 4, 4, 4], condition);
        stays::<3>(&[2, 2], condition);
    }
    stays::<3>(&[3, 2], "midpoint");
}

/// Symptom guarded against: other orders of bodies changed the energy by 9 %.
#[test]
fn the_order_of_bodies_does_not_matter_to_a_stack() {
    for condition in ["midpoint", "gap"] {
        let [here, there] = [[0, 1, 2], [2, 0, 1]].map(|order| rest::<2>(&[4, 4, 4], &order, condition));
        let apart = (here.strain - there.strain).abs() / here.strain;
        assert!(apart < 1e-9, "{condition}: {apart:e} of the strain energy");
    }
}
