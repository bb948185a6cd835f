//! Pressures on facets are normal reactions: none of them negative, none on sides that touch nothing, and their sum that of the reactions.

use crate::common::{body, disc, parse, plane, scenario};
use carom::{Meshes, Simulation, SurfaceFields};
use carom_mesh::{Matrix, Mesh, Vector, generate};
use serde_json::{Value, json};

fn run<const D: usize>(case: &Value) -> Simulation<D> {
    let mut simulation = Simulation::<D>::new(&parse(case)).expect("a valid case");
    simulation.advance(f64::INFINITY, || false).expect("converges");
    simulation
}

/// A block pressed on a rough floor by its weight, sliding.
fn sliding<const D: usize>(friction: f64) -> Simulation<D> {
    let size: Vec<f64> = [1.0, 0.6, 0.8][..D].to_vec();
    let divisions: Vec<usize> = [3, 2, 2][..D].to_vec();
    let kind = if D == 2 { "rectangle" } else { "box" };
    let mesh = json!({"kind": kind, "corner": vec![0.0; D], "size": size, "divisions": divisions});
    let mut block = body("block", mesh, [3.0, 0.0]);
    let mut velocity = vec![0.0; D];
    velocity[0] = 3.0;
    block["velocity"] = json!(velocity);
    block["spin"] = if D == 2 { json!(0.0) } else { json!([0.0, 0.0, 0.0]) };
    let up: Vec<f64> = (0..D).map(|i| if i == D - 1 { 1.0 } else { 0.0 }).collect();
    let floor = json!({"name": "floor", "kind": "plane", "point": vec![0.0; D], "normal": up});
    let mut case = scenario(0.05, 1e-3, &[block], &[floor]);
    case["dimension"] = json!(D);
    case["analysis"]["gravity"] = json!(up.iter().map(|u| -10.0 * u).collect::<Vec<_>>());
    case["materials"]["elastic"]["young"] = json!(1e6);
    case["materials"]["elastic"]["density"] = json!(1000.0);
    case["materials"]["elastic"]["damping"] = json!({"mass": 0.0, "stiffness": 1e-3});
    case["contact"]["friction"] = json!(friction);
    run(&case)
}

/// Σ p A of the facets of a body whose normal in the reference configuration makes at least a right angle with `up`, and of the others.
fn by_side<const D: usize>(simulation: &Simulation<D>, fields: &SurfaceFields) -> [f64; 2] {
    let body = &simulation.model().bodies[0].body;
    let rest = vec![Vector::<D>::zeros(); body.node_count()];
    let mut sums = [0.0; 2];
    for (k, facet) in body.surface().facets().iter().enumerate() {
        let down = -facet.normal(body.mesh(), &rest)[D - 1];
        sums[usize::from(down < 0.5)] += fields.pressure[k] * fields.area[k];
    }
    sums
}

/// Symptom guarded against: side facets that share nodes with the sole had friction for a pressure, of either sign.
#[test]
fn friction_is_no_pressure() {
    fn check<const D: usize>() {
        for friction in [0.0, 0.6] {
            let simulation = sliding::<D>(friction);
            let fields = simulation.surface_fields();
            let normal: f64 = simulation.state().reactions.iter().map(|r| r.force[0]).sum();
            assert!(normal > 0.0 && fields.pressure.iter().all(|&p| p >= 0.0), "{D}D, {friction}");
            let [sole, sides] = by_side(&simulation, &fields);
            assert!((sole - normal).abs() < 1e-12 * normal, "{D}D, {friction}: {sole} N of {normal} N");
            assert!(sides == 0.0, "{D}D, {friction}: {sides} N on the sides");
        }
    }
    check::<2>();
    check::<3>();
}

/// The pressures of either side of a contact are the same reactions, whoever is the source.
#[test]
fn both_sides_bear_the_whole_contact() {
    for (sources, condition) in
        [("first", "gap"), ("second", "midpoint"), ("both", "gap"), ("first", "massless")]
    {
        let discs = [
            body("left", disc([0.0, 0.0], 1.0, 4), [1.0, 0.3]),
            body("right", disc([2.003, 0.2], 1.0, 4), [-1.0, 0.0]),
        ];
        let mut case = scenario(0.03, 1e-3, &discs, &[plane("floor", [0.0, -1.2], [0.0, 1.0])]);
        case["analysis"]["scheme"] = json!({"kind": "conserving"});
        case["contact"]["friction"] = json!(0.4);
        case["contact"]["sources"] = json!(sources);
        case["contact"]["condition"] = json!(condition);
        // With `midpoint` some steps end without a reaction: the last that has one counts.
        let mut simulation = Simulation::<2>::new(&parse(&case)).expect("a valid case");
        let mut found = 0;
        for k in 1..=30 {
            simulation.advance(f64::from(k) * 1e-3, || false).expect("converges");
            let normal: f64 = simulation.state().reactions.iter().map(|r| r.force[0]).sum();
            if normal == 0.0 {
                continue;
            }
            found += 1;
            let fields = simulation.surface_fields();
            assert!(fields.pressure.iter().all(|&p| p >= 0.0), "{sources} {condition}");
            let facets = simulation.model().bodies[0].body.surface().facets().len();
            let sum = |range: std::ops::Range<usize>| -> f64 {
                range.map(|k| fields.pressure[k] * fields.area[k]).sum()
            };
            for side in [sum(0..facets), sum(facets..fields.area.len())] {
                assert!(
                    (side - normal).abs() < 1e-12 * normal,
                    "{sources} {condition}: {side} N of {normal} N"
                );
            }
        }
        assert!(found > 0, "{sources} {condition}: they touch");
    }
}

/// A block that stands on one corner: the two facets there share what it bears as they face the floor.
#[test]
fn a_corner_is_borne_by_the_facets_that_face_what_it_stands_on() {
    let turn = Matrix::<2>::new(0.6, -0.8, 0.8, 0.6);
    let grid = generate::grid([0.0, 0.0], [1.0, 1.0], [1, 1]).expect("valid");
    let mesh =
        Mesh::new(grid.nodes().iter().map(|x| turn * x).collect(), grid.blocks().to_vec()).expect("turned");
    let mut case = scenario(
        1e-3,
        1e-3,
        &[body("block", json!({"kind": "file", "file": "block"}), [0.0, -1.0])],
        &[plane("floor", [0.0, 0.0], [0.0, 1.0])],
    );
    case["contact"]["friction"] = json!(0.3);
    let meshes: Meshes<2> = [("block".to_string(), mesh)].into();
    let mut simulation = Simulation::<2>::with_meshes(&parse(&case), meshes).expect("a valid case");
    simulation.advance(f64::INFINITY, || false).expect("converges");
    let normal: f64 = simulation.state().reactions.iter().map(|r| r.force[0]).sum();
    let fields = simulation.surface_fields();
    let mut borne: Vec<f64> = fields.pressure.iter().zip(&fields.area).map(|(p, a)| p * a).collect();
    borne.sort_unstable_by(f64::total_cmp);
    assert!(normal > 0.0 && borne[0] == 0.0 && borne[1] == 0.0, "{borne:?}");
    // Facets at cos 0.6 and 0.8 to the floor, of equal length.
    assert!(
        (borne[2] / normal - 0.6 / 1.4).abs() < 0.01 && (borne[3] / normal - 0.8 / 1.4).abs() < 0.01,
        "{borne:?}"
    );
}
