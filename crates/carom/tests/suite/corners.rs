//! Obstacles with corners and edges, and such as are small beside a facet: what rests on them need not have a node there.

use carom::{Meshes, Simulation, Summary};
use serde_json::{Value, json};

use crate::common::{parse, scenario};

/// How a damped plate lies on `obstacles` after a while.
fn lay<const D: usize>(
    corner: [f64; D],
    size: [f64; D],
    divisions: [usize; D],
    obstacles: &[Value],
    condition: &str,
) -> Summary {
    let mut up = [0.0; D];
    up[D - 1] = 1.0;
    let kind = if D == 2 { "rectangle" } else { "box" };
    let spin = if D == 2 { json!(0.0) } else { json!([0.0, 0.0, 0.0]) };
    let plate = json!({
        "name": "plate", "material": "elastic", "hypothesis": "plane-strain", "thickness": 1.0, "mass": "consistent",
        "velocity": vec![0.0; D], "spin": spin,
        "mesh": {"kind": kind, "corner": corner.to_vec(), "size": size.to_vec(), "divisions": divisions.to_vec()},
    });
    let mut case = scenario(0.5, 2e-3, &[plate], obstacles);
    case["dimension"] = json!(D);
    case["analysis"]["scheme"] = json!({"kind": "conserving"});
    case["analysis"]["gravity"] = json!(up.map(|x| -9.81 * x).to_vec());
    case["materials"]["elastic"] = json!({
        "kind": "saint-venant-kirchhoff", "young": 1e7, "poisson": 0.3, "density": 1000.0,
        "damping": {"mass": 30.0, "stiffness": 1e-3},
    });
    case["contact"]["condition"] = json!(condition);
    case["contact"]["friction"] = json!(0.3);
    case["contact"]["solver"]["kind"] = json!("auto");
    let mut simulation = Simulation::<D>::with_meshes(&parse(&case), Meshes::new()).expect("valid");
    simulation.advance(f64::INFINITY, || false).expect("runs");
    simulation.finish();
    simulation.summary()
}

fn block(corner: &[f64], size: &[f64]) -> Value {
    json!({"name": "post", "kind": "box", "corner": corner, "size": size})
}

/// A pyramid of triangles with its tip at `tip`.
fn pyramid(tip: [f64; 3]) -> Value {
    let base = [[-0.3, -0.3, 0.0], [0.3, -0.3, 0.0], [0.3, 0.3, 0.0], [-0.3, 0.3, 0.0], tip];
    let triangles = [[0, 2, 1], [0, 3, 2], [0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];
    json!({"name": "post", "kind": "surface", "vertices": base, "triangles": triangles})
}

fn assert_lies_on(what: &str, summary: &Summary, weight: f64) {
    let depth = summary.penetration.max_depth;
    assert!(depth < 1e-12, "{what}: {depth:e} m inside");
    assert!(summary.min_gap > -1e-12, "{what}: {:e}", summary.min_gap);
    let force = summary.contacts.last().expect("they touch").peak_force;
    assert!(force > 0.99 * weight, "{what}: {force} of {weight} N");
    assert!(summary.contacts.last().expect("they touch").release.is_none(), "{what}: {:?}", summary.contacts);
}

/// Symptom guarded against: a coarse plate was impaled on a narrow post down to the floor, `completed`, with a smallest gap of round-off.
#[test]
fn a_plate_lies_on_a_post_between_its_nodes() {
    for condition in ["gap", "midpoint"] {
        for across in [4, 5] {
            let post = block(&[-0.08, 0.0], &[0.16, 0.3]);
            let summary = lay([-0.5, 0.301], [1.0, 0.2], [across, 2], &[post], condition);
            assert_lies_on(&format!("2D, {condition}, {across}"), &summary, 200.0 * 9.81);
            let post = block(&[-0.08, -0.08, 0.0], &[0.16, 0.16, 0.3]);
            let summary = lay([-0.5, -0.5, 0.301], [1.0, 1.0, 0.2], [across, across, 2], &[post], condition);
            assert_lies_on(&format!("3D, {condition}, {across}"), &summary, 200.0 * 9.81);
        }
    }
}

/// No node of either is over the other: the edges of the beam cross those of the facets that lie on it.
#[test]
fn a_plate_lies_across_a_beam() {
    for condition in ["gap", "midpoint"] {
        let beam = block(&[-1.0, -0.08, 0.0], &[2.0, 0.16, 0.3]);
        let summary =
            lay([-0.5, -0.5, 0.301], [1.0, 1.0, 0.2], [5, 5, 2], std::slice::from_ref(&beam), condition);
        assert_lies_on(&format!("plate, {condition}"), &summary, 200.0 * 9.81);
        let summary = lay([-0.05, -0.5, 0.301], [0.1, 1.0, 0.1], [1, 5, 1], &[beam], condition);
        assert_lies_on(&format!("strip, {condition}"), &summary, 10.0 * 9.81);
    }
}

#[test]
fn a_plate_lies_on_the_tip_of_a_pyramid_and_a_post_beside_it() {
    let beside =
        json!({"name": "beside", "kind": "box", "corner": [0.35, -0.4, 0.0], "size": [0.1, 0.8, 0.3]});
    let far = json!({"name": "far", "kind": "box", "corner": [-0.45, -0.4, 0.0], "size": [0.1, 0.8, 0.3]});
    let summary = lay(
        [-0.5, -0.5, 0.301],
        [1.0, 1.0, 0.2],
        [5, 5, 2],
        &[pyramid([0.02, 0.03, 0.3]), beside, far],
        "midpoint",
    );
    assert!(summary.penetration.max_depth < 5e-10, "{:?}", summary.penetration);
    assert!(summary.contacts.iter().any(|c| c.pair[1] == "post"), "{:?}", summary.contacts);
}

/// A ridge between two nodes, beside a dent of the same polygon in which a corner of the plate lies.
#[test]
fn a_plate_lies_on_a_ridge_and_in_a_dent() {
    let corners =
        [[-0.7, 0.0], [0.5, 0.0], [0.5, 0.2], [0.13, 0.3], [0.05, 0.25], [-0.55, 0.25], [-0.7, 0.45]];
    for condition in ["gap", "midpoint"] {
        let block = json!({"name": "block", "kind": "polygon", "points": corners});
        let summary = lay([-0.5, 0.301], [1.0, 0.2], [5, 2], &[block], condition);
        assert_lies_on(condition, &summary, 200.0 * 9.81);
    }
}

/// A ball of 0.1 m with its top at 0.3 m, or a bar of that radius along y.
fn round_post<const D: usize>(name: &str, x: f64, y: f64, is_bar: bool) -> Value {
    let at = if D == 2 { vec![x, 0.2] } else { vec![x, y, 0.2] };
    if is_bar {
        json!({"name": name, "kind": "cylinder", "point": at, "axis": [0.0, 1.0, 0.0], "radius": 0.1})
    } else {
        json!({"name": name, "kind": "sphere", "centre": at, "radius": 0.1})
    }
}

/// Symptom guarded against: a round obstacle smaller than a facet touched nothing between its nodes, and the plate fell through it.
#[test]
fn a_plate_lies_on_balls_and_bars_that_are_small_beside_its_facets() {
    // Under a plate that bends what is round is touched along a curve: on it `midpoint` drifts, by 1.7e-11 m.
    for (condition, deepest) in [("gap", 1e-12), ("midpoint", 1e-10)] {
        let balls = [("a", -0.2), ("b", 0.2)].map(|(name, x)| round_post::<2>(name, x, 0.0, false));
        let plane = lay([-0.5, 0.301], [1.0, 0.2], [5, 2], &balls, condition);
        let places = [("a", -0.2, -0.2), ("b", 0.2, -0.2), ("c", 0.2, 0.2), ("d", -0.2, 0.2)];
        let balls = places.map(|(name, x, y)| round_post::<3>(name, x, y, false));
        let bars = [("a", -0.2), ("b", 0.2)].map(|(name, x)| round_post::<3>(name, x, 0.0, true));
        let on = |posts: &[Value]| lay([-0.5, -0.5, 0.301], [1.0, 1.0, 0.2], [5, 5, 2], posts, condition);
        for (what, summary) in [("discs", plane), ("balls", on(&balls)), ("bars", on(&bars))] {
            let depth = summary.penetration.max_depth;
            assert!(depth < deepest, "{what}, {condition}: {depth:e} m inside");
            let resting = summary.contacts.iter().filter(|c| c.release.is_none());
            let force: f64 = resting.map(|c| c.peak_force).sum();
            assert!(force > 0.99 * 200.0 * 9.81, "{what}, {condition}: {force} N");
        }
    }
}

/// It comes from below between the nodes, and carries the plate on.
#[test]
fn small_balls_that_move_carry_a_plate() {
    let mut balls = [("a", -0.2), ("b", 0.2)].map(|(name, x)| round_post::<2>(name, x, 0.0, false));
    balls.iter_mut().for_each(|ball| ball["velocity"] = json!([0.1, 0.5]));
    let floor = json!({"name": "floor", "kind": "plane", "point": [0.0, 0.31], "normal": [0.0, 1.0]});
    let summary =
        lay([-0.5, 0.31], [1.0, 0.2], [5, 2], &[balls[0].clone(), balls[1].clone(), floor], "midpoint");
    assert!(summary.penetration.max_depth < 1e-5, "{:?}", summary.penetration);
    assert!(summary.energy.terms.prescribed > 0.9 * 200.0 * 9.81 * 0.24, "{:?}", summary.energy.terms);
    let defect = summary.energy.max_defect;
    assert!(defect < 1e-9 * summary.energy.terms.prescribed, "{defect:e}");
}

/// An obstacle that pushes with its corner does the work that the body receives.
#[test]
fn a_wedge_that_is_pushed_against_a_plate_does_work() {
    let mut post = block(&[-0.08, 0.0], &[0.16, 0.3]);
    post["velocity"] = json!([0.0, 0.5]);
    let mut floor = json!({"name": "floor", "kind": "plane", "point": [0.0, 0.305], "normal": [0.0, 1.0]});
    floor["velocity"] = json!([0.0, 0.0]);
    let summary = lay([-0.5, 0.305], [1.0, 0.2], [5, 2], &[post, floor], "midpoint");
    assert!(summary.penetration.max_depth < 1e-11, "{:?}", summary.penetration);
    // It lifts 200 kg by about 0.245 m.
    assert!(summary.energy.terms.prescribed > 0.9 * 200.0 * 9.81 * 0.245, "{:?}", summary.energy.terms);
    assert!(
        summary.energy.max_defect < 1e-10 * summary.energy.terms.prescribed,
        "{:e}",
        summary.energy.max_defect
    );
}

#[test]
fn an_obstacle_with_a_corner_inside_a_body_is_refused() {
    let post = block(&[0.02, 0.0], &[0.04, 0.35]);
    let plate = json!({
        "name": "plate", "material": "elastic", "hypothesis": "plane-strain", "thickness": 1.0, "mass": "consistent",
        "velocity": [0.0, 0.0], "spin": 0.0,
        "mesh": {"kind": "rectangle", "corner": [-0.5, 0.3], "size": [1.0, 0.2], "divisions": [5, 2]},
    });
    let made = Simulation::<2>::new(&parse(&scenario(0.1, 1e-3, &[plate], &[post])));
    let refused = made.err().expect("they overlap");
    let words = "obstacle \"post\" overlaps body \"plate\" at the start: near (";
    assert!(refused.to_string().contains(words), "{refused}");
}
