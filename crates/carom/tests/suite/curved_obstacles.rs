//! Spheres, cylinders, boxes and closed surfaces as obstacles: the books close although the normal turns from place to place.

use crate::common::{body, disc, parse, scenario};
use carom::Simulation;
use carom_mesh::Vector;
use serde_json::{Value, json};

/// A conserving run of `bodies` among `obstacles`.
fn run<const D: usize>(bodies: &[Value], obstacles: &[Value], friction: f64, end: f64) -> Simulation<D> {
    let mut case = scenario(end, 2e-3, bodies, obstacles);
    case["dimension"] = json!(D);
    case["analysis"]["scheme"] = json!({"kind": "conserving"});
    case["analysis"]["newton"]["tolerance"] = json!(1e-11);
    case["contact"]["condition"] = json!("midpoint");
    case["contact"]["friction"] = json!(friction);
    let mut simulation = Simulation::<D>::new(&parse(&case)).expect("a valid case");
    simulation.advance(f64::INFINITY, || false).expect("converges");
    simulation
}

/// A cube of 2³ cells with its centre at `centre`.
fn cube(centre: [f64; 3], velocity: [f64; 3], spin: [f64; 3]) -> Value {
    let corner = centre.map(|x| x - 0.25);
    let mesh = json!({"kind": "box", "corner": corner, "size": [0.5, 0.5, 0.5], "divisions": [2, 2, 2]});
    let mut cube = body("cube", mesh, [0.0, 0.0]);
    cube["velocity"] = json!(velocity);
    cube["spin"] = json!(spin);
    cube
}

/// The angular momentum about the origin.
fn angular_momentum<const D: usize>(simulation: &Simulation<D>) -> [f64; 3] {
    let (body, state) = (&simulation.model().bodies[0].body, simulation.state());
    let nodes = body.node_count();
    let mut mv = vec![Vector::zeros(); nodes];
    body.mass().multiply(&state.velocity[..nodes], &mut mv);
    body.angular_momentum(&state.displacement[..nodes], &mv)
}

fn check<const D: usize>(simulation: &Simulation<D>, friction: f64, speed: f64) {
    let summary = simulation.summary();
    let energy = summary.energy;
    assert!(!summary.contacts.is_empty(), "they meet");
    assert!(summary.min_gap > -2.0 * speed * 2e-3, "{:e}", summary.min_gap);
    if friction == 0.0 {
        assert!(energy.max_drift < 1e-10 * energy.initial, "{:e} of {}", energy.max_drift, energy.initial);
    } else {
        assert!(energy.terms.friction > 1e-3 * energy.initial, "{}", energy.terms.friction);
        assert!(energy.max_defect < 1e-9 * energy.initial, "{:e} of {}", energy.max_defect, energy.initial);
    }
}

/// All forces of a smooth cavity point to its centre.
#[test]
fn angular_momentum_about_the_centre_of_a_smooth_cavity_is_constant() {
    let cavity =
        json!({"name": "wall", "kind": "sphere", "centre": [0.0, 0.0], "radius": 2.0, "cavity": true});
    for friction in [0.0, 0.2] {
        let ball = body("ball", disc([0.6, 0.2], 0.8, 4), [1.5, 1.0]);
        let simulation = run::<2>(&[ball], std::slice::from_ref(&cavity), friction, 1.2);
        check(&simulation, friction, 3.0);
        let mass = simulation.model().bodies[0].body.total_mass();
        let before = mass * (0.6 * 1.0 - 0.2 * 1.5);
        let change = angular_momentum(&simulation)[2] - before;
        assert!((change.abs() < 1e-10) == (friction == 0.0), "{change:e}");
    }
    let cavity =
        json!({"name": "wall", "kind": "sphere", "centre": [0.0, 0.0, 0.0], "radius": 0.8, "cavity": true});
    let cube = cube([0.1, 0.05, 0.0], [1.5, 1.0, 0.3], [0.0; 3]);
    let simulation = run::<3>(&[cube], &[cavity], 0.0, 0.5);
    check(&simulation, 0.0, 3.0);
    let (x, v) = (Vector::<3>::new(0.1, 0.05, 0.0), Vector::<3>::new(1.5, 1.0, 0.3));
    let before = x.cross(&v) * simulation.model().bodies[0].body.total_mass();
    assert!((Vector::from(angular_momentum(&simulation)) - before).norm() < 1e-10);
}

/// Forces of a smooth cylinder have no moment about its axis and do not act along it.
#[test]
fn a_cube_thrown_on_a_cylinder_keeps_what_the_cylinder_cannot_take() {
    let bar = json!({"name": "bar", "kind": "cylinder", "point": [0.0, 0.0, 0.0], "axis": [0.0, 3.0, 0.0], "radius": 0.4});
    for friction in [0.0, 0.3] {
        let cube = cube([0.1, 0.0, 0.67], [0.3, 0.2, -2.0], [0.5, 0.3, 0.0]);
        let simulation = run::<3>(&[cube], std::slice::from_ref(&bar), friction, 0.3);
        check(&simulation, friction, 3.0);
        if friction == 0.0 {
            let body = &simulation.model().bodies[0].body;
            let along = body.mean(&simulation.state().velocity[..body.node_count()])[1];
            assert!((along - 0.2).abs() < 1e-11, "{along}");
            let before = (Vector::<3>::new(0.1, 0.0, 0.67).cross(&Vector::<3>::new(0.3, 0.2, -2.0)))[1]
                * body.total_mass()
                + 0.3 * body.total_mass() * 0.5 * 0.5 / 6.0;
            let after = angular_momentum(&simulation)[1];
            assert!((after - before).abs() < 1e-10, "{after} {before}");
        }
    }
}

/// A cube that tumbles over the edge of a box, once as a box and once as twelve triangles.
#[test]
fn a_box_of_triangles_is_the_box() {
    let (low, high) = ([-1.0, -1.0, -1.0], [0.0, 1.0, 0.0]);
    let vertices: Vec<[f64; 3]> =
        (0..8).map(|k| std::array::from_fn(|i| if k >> i & 1 == 1 { high[i] } else { low[i] })).collect();
    let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles: Vec<[u32; 3]> = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let solid = json!({"name": "block", "kind": "box", "corner": low, "size": [1.0, 2.0, 1.0]});
    let surface = json!({"name": "block", "kind": "surface", "vertices": vertices, "triangles": triangles});
    let ends = [solid, surface].map(|block| {
        let cube = cube([0.07, 0.03, 0.3], [0.2, 0.1, -1.0], [0.0, 2.0, 0.5]);
        let simulation = run::<3>(&[cube], &[block], 0.2, 0.3);
        check(&simulation, 0.2, 3.0);
        simulation.state().displacement.clone()
    });
    let apart = ends[0].iter().zip(&ends[1]).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    assert!(apart < 1e-8, "{apart:e}");
}

#[test]
fn obstacles_that_cannot_be_are_refused_with_the_key() {
    let refused = |obstacle: Value| {
        let case = scenario(0.1, 1e-3, &[body("ball", disc([0.0, 0.0], 1.0, 4), [0.0, 0.0])], &[obstacle]);
        let error = Simulation::<2>::new(&parse(&case)).err().expect("refused");
        (error.key.clone(), error.message)
    };
    let sphere = |radius: f64, cavity: bool| json!({"name": "o", "kind": "sphere", "centre": [1.5, 0.0], "radius": radius, "cavity": cavity});
    assert_eq!(refused(sphere(-1.0, false)).0, "obstacles.0.radius");
    let (_, message) = refused(sphere(1.0, false));
    assert!(message.contains("overlaps") && message.contains("0.500000 m"), "{message}");
    let (key, message) = refused(
        json!({"name": "o", "kind": "cylinder", "point": [0.0, 0.0], "axis": [1.0, 0.0], "radius": 1.0}),
    );
    assert!(key == "obstacles.0.kind" && message.contains("take a sphere"), "{key} {message}");
    let flat = json!({"name": "o", "kind": "box", "corner": [2.0, 0.0], "size": [1.0, 0.0]});
    assert_eq!(refused(flat).0, "obstacles.0.size");
}
