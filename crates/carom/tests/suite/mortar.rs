//! Impacts of bodies with mortar contact: energy, momenta, and how far the surfaces go through one another.

use crate::common::{body, disc, parse, scenario};
use carom::Simulation;
use carom_mesh::Vector;
use serde_json::{Value, json};

/// Two discs of different meshes, with 24 and 16 facets times `refinement`, one spinning, that meet off centre in free space.
fn impact(refinement: usize, condition: &str, friction: f64) -> Value {
    let discs = [
        body("left", disc([0.0, 0.0], 1.0, 6 * refinement), [1.5, 0.3]),
        body("right", disc([2.05, 0.4], 1.0, 4 * refinement), [-0.5, 0.0]),
    ];
    let mut case = scenario(0.3, 1e-3, &discs, &[]);
    case["bodies"][0]["spin"] = json!(4.0);
    case["analysis"]["scheme"] = json!({"kind": "conserving"});
    case["analysis"]["newton"]["tolerance"] = json!(1e-11);
    case["contact"]["condition"] = json!(condition);
    case["contact"]["discretisation"] = json!("mortar");
    case["contact"]["friction"] = json!(friction);
    case
}

fn run(case: &Value) -> Simulation<2> {
    let mut simulation = Simulation::new(&parse(case)).expect("valid");
    simulation.advance(f64::INFINITY, || false).expect("runs");
    simulation
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

/// Energy and linear momentum to round-off on any mesh. The forces of both sides are equal and opposite, but not in the same line
/// where the surfaces curve: angular momentum is kept as far as the mesh resolves the gap.
#[test]
fn impact_with_midpoint_keeps_energy_and_linear_momentum() {
    for (refinement, friction, turning) in [(1, 0.0, 1e-3), (1, 0.3, 5e-3), (2, 0.0, 1e-4), (2, 0.3, 1e-3)] {
        let case = impact(refinement, "midpoint", friction);
        let (linear, angular) = momenta(&Simulation::<2>::new(&parse(&case)).expect("valid"));
        let simulation = run(&case);
        let summary = simulation.summary();
        let energy = summary.energy;
        assert_eq!(summary.contacts.len(), 1, "the discs meet");
        assert!(summary.contacts[0].peak_force > 10.0, "{:?}", summary.contacts);
        let defect = energy.max_defect / energy.initial;
        let (linear_after, angular_after) = momenta(&simulation);
        let turned = (angular_after - angular).abs() / angular.abs();
        println!(
            "refinement {refinement}, friction {friction}: defect {defect:.1e} E0, angular momentum off by {turned:.1e}"
        );
        assert!(defect < 1e-10, "friction {friction}: {defect:e}");
        assert!((linear_after - linear).norm() < 1e-11 * linear.norm(), "{linear_after}");
        assert!(turned < turning, "friction {friction}: {angular} became {angular_after}");
        if friction > 0.0 {
            assert!(energy.terms.friction > 0.01 * energy.initial, "{energy:?}");
            assert!(summary.least_friction > -1e-12 * energy.initial, "{energy:?}");
        }
    }
}

/// Two blocks of hexahedra that do not match, one spinning and both askew, meet in free space: a face, then an edge of it.
#[test]
fn impact_in_space_keeps_energy_and_linear_momentum() {
    for friction in [0.0, 0.3] {
        let block = |name: &str,
                     corner: [f64; 3],
                     divisions: [usize; 3],
                     velocity: [f64; 3],
                     spin: [f64; 3]| {
            json!({
                "name": name, "material": "elastic", "hypothesis": "plane-strain", "thickness": 1.0,
                "mass": "consistent", "velocity": velocity, "spin": spin,
                "mesh": {"kind": "box", "corner": corner, "size": [1.0, 1.0, 0.5], "divisions": divisions},
            })
        };
        let blocks = [
            block("lower", [0.0, 0.0, 0.0], [3, 2, 1], [0.0, 0.0, 0.5], [0.0; 3]),
            block("upper", [0.2, 0.3, 0.503], [2, 3, 1], [0.4, 0.1, -0.5], [0.3, 0.2, 0.4]),
        ];
        let mut case = scenario(0.06, 1e-3, &blocks, &[]);
        case["dimension"] = json!(3);
        case["analysis"]["scheme"] = json!({"kind": "conserving"});
        case["analysis"]["newton"]["tolerance"] = json!(1e-11);
        case["contact"]["condition"] = json!("midpoint");
        case["contact"]["discretisation"] = json!("mortar");
        case["contact"]["friction"] = json!(friction);
        let mut simulation = Simulation::<3>::new(&parse(&case)).expect("valid");
        let momentum = |simulation: &Simulation<3>| {
            let bodies = simulation.model().bodies.iter();
            bodies.fold(Vector::zeros(), |sum: Vector<3>, b| {
                sum + b.body.mean(&simulation.state().velocity[b.nodes()]) * b.body.total_mass()
            })
        };
        let before = momentum(&simulation);
        simulation.advance(f64::INFINITY, || false).expect("runs");
        let summary = simulation.summary();
        let energy = summary.energy;
        assert_eq!(summary.contacts.len(), 1, "the blocks meet");
        assert!(summary.contacts[0].peak_force > 1.0, "{:?}", summary.contacts);
        println!("friction {friction}: defect {:.1e} E0", energy.max_defect / energy.initial);
        assert!(energy.max_defect < 1e-10 * energy.initial, "friction {friction}: {energy:?}");
        assert!((momentum(&simulation) - before).norm() < 1e-12, "friction {friction}");
        assert!((friction == 0.0) == (energy.terms.friction == 0.0), "{energy:?}");
    }
}

/// An iron with sharp corners is pressed half a metre into a soft slab and drawn across it, without inertia. On the way its side comes to face what the slab
/// heaps up before it, as facets begin to count that look away from one another by less than 60°, and nodes of the slab turn round
/// its corners. Iterations converge quadratically all the same: without the change of the weights in the tangent they do so by 0.8, or not at all.
#[test]
fn an_iron_with_sharp_corners_is_drawn_across_a_slab() {
    let rectangle = |corner: [f64; 2], size: [f64; 2], divisions: [usize; 2]| json!({"kind": "rectangle", "corner": corner, "size": size, "divisions": divisions});
    let slab = body("slab", rectangle([0.0, 0.0], [8.0, 3.0], [24, 9]), [0.0, 0.0]);
    let mut iron = body("iron", rectangle([2.0, 3.0], [1.2, 0.6], [6, 3]), [0.0, 0.0]);
    iron["material"] = json!("hard");
    let mut case = scenario(2.0, 0.05, &[slab, iron], &[]);
    case["analysis"] = json!({
        "kind": "static", "end_time": 2.0, "time_step": 0.05, "max_halvings": 8, "gravity": null,
        "newton": {"tolerance": 1e-10, "max_iterations": 50},
    });
    for (name, young) in [("elastic", 1e3), ("hard", 1e4)] {
        case["materials"][name] =
            json!({"kind": "neo-hookean", "young": young, "poisson": 0.32, "density": 1.0});
    }
    let down = json!({"time": [0.0, 1.0], "value": [0.0, -0.5]});
    let across = json!({"time": [0.0, 1.0, 2.0], "value": [0.0, 0.0, 2.0]});
    case["motions"] = json!([
        {"kind": "fixed", "body": "slab", "on": "bottom"},
        {"kind": "prescribed", "body": "iron", "on": "top", "x": across, "y": down},
    ]);
    case["contact"]["condition"] = json!("gap");
    case["contact"]["discretisation"] = json!("mortar");
    case["contact"]["sources"] = json!("finer");
    case["contact"]["targets"] = json!("smooth");
    case["contact"]["friction"] = json!(0.3);
    case["contact"]["solver"]["kind"] = json!("auto");
    let mut simulation = Simulation::<2>::new(&parse(&case)).expect("valid");
    let mut pressed = Vec::new();
    for step in 1..=20 {
        simulation.advance(1.0 + 0.05 * f64::from(step), || false).expect("converges");
        let nodes = simulation.model().bodies.iter().map(|b| b.nodes());
        let forces: Vec<Vector<2>> =
            nodes.map(|nodes| simulation.state().contact_force[nodes].iter().sum()).collect();
        assert!((forces[0] + forces[1]).norm() < 1e-12 * forces[0].norm(), "action and reaction");
        pressed.push(-forces[0][1]);
    }
    // While it slides the iron is pressed up alike, wherever facets and nodes are.
    let slid = &pressed[6..];
    let mean = slid.iter().sum::<f64>() / slid.len() as f64;
    let scatter = slid.iter().map(|f| (f / mean - 1.0).abs()).fold(0.0, f64::max);
    let summary = simulation.summary();
    let iterations = simulation.newton_iterations();
    println!(
        "{mean:.2} N to {scatter:.1e}, {iterations} iterations in {} steps, {} taken in halves",
        summary.steps, summary.retried_steps
    );
    assert!(scatter < 0.05, "{pressed:?}");
    assert!(iterations < 600, "{iterations}");
    assert!(summary.certificate.max_joule < 1e-9, "{:?}", summary.certificate);
}

/// With these conditions normal reactions do work: as with nodes at first touch, and as the weights of a row follow the sliding,
/// which its gradient leaves out. The latter falls with the mesh.
#[test]
fn impact_with_gap_and_endpoint_closes_its_books() {
    for condition in ["gap", "endpoint"] {
        let simulation = run(&impact(2, condition, 0.3));
        let summary = simulation.summary();
        let energy = summary.energy;
        assert_eq!(summary.contacts.len(), 1, "{condition}: the discs meet");
        assert!(energy.max_defect < 1e-10 * energy.initial, "{condition}: {energy:?}");
        assert!(energy.last < energy.initial, "{condition}: {energy:?}");
        println!(
            "{condition}: normal reactions take {:.1e} E0",
            energy.terms.normal_contact / energy.initial
        );
        assert!(energy.terms.normal_contact.abs() < 1e-2 * energy.initial, "{condition}: {energy:?}");
    }
}

/// Gaps are closed in the mean, so that corners of one polygon go through sides of the other: by no more than the heights of their
/// facets' arcs.
#[test]
fn nodes_go_through_the_target_by_less_than_the_height_of_facets() {
    let simulation = run(&impact(2, "gap", 0.0));
    let min_gap = simulation.summary().min_gap;
    let height = |facets: f64| 1.0 - (std::f64::consts::PI / facets).cos();
    let heights = height(48.0) + height(32.0);
    println!("min_gap {min_gap:e} m, heights of facets {heights:e} m");
    assert!(min_gap < 0.0 && min_gap > -heights, "{min_gap:e}");
}

#[test]
fn what_mortar_cannot_do_is_refused_with_a_remedy() {
    let mut both = impact(1, "midpoint", 0.0);
    both["contact"]["discretisation"] = json!("node-to-segment");
    both["contact"]["pairs"] =
        json!([{"between": ["left", "right"], "sources": "both", "discretisation": "mortar"}]);
    let error = Simulation::<2>::new(&parse(&both)).err().expect("refused");
    assert!(error.key == "contact.pairs.0.discretisation", "{error:?}");
    assert!(error.to_string().contains("multipliers"), "{error:?}");
}
