//! Targets that are smooth curves: gaps without kinks, and the forces that follow from them.

use std::f64::consts::PI;

use carom_contact::{Candidate, Contact, Path, Search, Target};
use carom_mesh::{Matrix, Mesh, Vector, generate};

use crate::common::Scene;

type Vector2 = Vector<2>;

/// A smooth target; the source is a cell whose first node is placed freely.
fn smooth(target: &Mesh<2>, shape: impl Fn(Vector2) -> Vector2) -> Scene<2> {
    Scene::new(target, shape, &generate::grid([0.0; 2], [1.0; 2], [1, 1]).expect("valid"), true)
}

fn detect(scene: &Scene<2>, nodes: &[Vector2], margin: f64) -> Vec<Candidate> {
    let at = |n: u32| nodes[n as usize];
    let mut candidates = Vec::new();
    scene.model.detect(&Path::resting(&at, margin), &mut Search::default(), &mut candidates);
    candidates
}

/// A disc of radius 1 with this number of nodes on its boundary, a multiple of 8.
fn disc(boundary: usize) -> Mesh<2> {
    let disc = generate::Disc { centre: [0.0; 2], radius: 1.0, divisions: boundary / 4, rings: None };
    disc.quadrilaterals().expect("valid")
}

fn polar(radius: f64, angle: f64) -> Vector2 {
    Vector2::new(radius * angle.cos(), radius * angle.sin())
}

/// The disc with facets whose lengths differ by a factor of 1.9.
fn graded(x: Vector2) -> Vector2 {
    let angle = x[1].atan2(x[0]);
    polar(x.norm(), angle + 0.3 * angle.sin())
}

/// Stretch, shear and a scatter of nodes that no smooth deformation has.
fn deformed(nodes: &[Vector2]) -> Vec<Vector2> {
    let f = Matrix::<2>::new(1.1, 0.2, -0.1, 0.95);
    let scatter = |k: usize| polar(2e-3, 2.4 * (k * k) as f64);
    nodes.iter().enumerate().map(|(k, x)| f * x + scatter(k)).collect()
}

/// Target point of a contact.
fn foot(contact: &Contact<2>, nodes: &[Vector2]) -> Vector2 {
    contact.stencil().skip(1).fold(Vector2::zeros(), |sum, (n, weight)| sum - nodes[n] * weight)
}

fn row(frame: &Matrix<2>, k: usize) -> Vector2 {
    frame.row(k).transpose()
}

#[test]
fn a_node_that_slides_over_vertices_feels_no_jump() {
    let scene = smooth(&disc(32), graded);
    let nodes = deformed(&scene.reference);
    let f = Matrix::<2>::new(1.1, 0.2, -0.1, 0.95);
    for radius in [0.99, 1.0, 1.05] {
        let x = |s: f64| f * polar(radius, s);
        // The facet is the one of the start throughout; the node slides over about five more, in either direction.
        for direction in [1.0, -1.0] {
            let start = scene.facet(&nodes, &x(0.3));
            let h = 1e-4;
            let mut last: Option<(Vector2, Contact<2>)> = None;
            for k in 0..10_000 {
                let x = x(0.3 + direction * h * f64::from(k));
                let contact = scene.contact(&nodes, x, start);
                let (n, t) = (row(&contact.frame, 0), row(&contact.frame, 1));
                let offset = x - foot(&contact, &nodes);
                assert!(t.dot(&offset).abs() < 2e-15, "{:e} at step {k}", t.dot(&offset));
                assert!((n.dot(&offset) - contact.gap).abs() < 2e-15);
                if let Some((x0, before)) = last {
                    let n0 = row(&before.frame, 0);
                    assert!((n - n0).norm() < 3.0 * h, "the normal turns by {:e}", (n - n0).norm());
                    let rise = (n + n0).dot(&(x - x0)) * 0.5;
                    let kink = (contact.gap - before.gap - rise).abs();
                    assert!(kink < h * h, "the gap changes by {kink:e} more than its slope says");
                }
                last = Some((x, contact));
            }
            let end = last.expect("steps").1;
            let on_start =
                |n: usize| scene.model.surfaces[0].facets[start as usize].nodes.contains(&(n as u32));
            assert!(!end.stencil().any(|(n, _)| on_start(n)), "the node has left its facet");
        }
    }
}

#[test]
fn the_gradient_of_the_gap_is_the_normal_row() {
    let h = 1e-6;
    let check = |scene: &Scene<2>, nodes: &[Vector2], x: Vector2, facet: u32| {
        let contact = scene.contact(nodes, x, facet);
        for n in 0..=scene.probe as usize {
            for i in 0..2 {
                let gap = |h: f64| {
                    let (mut nodes, mut x) = (nodes.to_vec(), x);
                    if n == scene.probe as usize {
                        x[i] += h;
                    } else {
                        nodes[n][i] += h;
                    }
                    scene.contact(&nodes, x, facet).gap
                };
                let slope = (gap(h) - gap(-h)) / (2.0 * h);
                let unit = |m: usize| {
                    let mut d = Vector2::zeros();
                    d[i] = if m == n { 1.0 } else { 0.0 };
                    d
                };
                let expected = contact.relative(unit)[0];
                assert!((slope - expected).abs() < 5e-7, "{slope} for {expected} at {x}, node {n}");
            }
        }
    };
    let round = smooth(&disc(32), graded);
    let nodes = deformed(&round.reference);
    for node in &round.model.surfaces[0].nodes {
        // Before, at and behind a vertex, and in the middle of a facet.
        let vertex = nodes[*node as usize];
        for (along, out) in [(-1e-3, 0.01), (-1e-7, -0.02), (0.0, 0.03), (1e-7, 0.0), (0.09, -0.01)] {
            let x = vertex * (1.0 + out) + Vector2::new(-vertex[1], vertex[0]) * along;
            check(&round, &nodes, x, round.facet(&nodes, &x));
        }
    }
    // Next to the corners of a rectangle, and beyond them by up to half a facet.
    let bar = smooth(&generate::grid([0.0; 2], [2.0, 1.0], [4, 4]).expect("valid"), |x| x);
    let nodes = deformed(&bar.reference);
    let corner = nodes[4];
    for (dx, dy) in [(0.01, 0.05), (0.01, -0.01), (0.01, -0.1), (0.01, -1e-7), (-0.01, 0.0), (-0.02, 0.01)] {
        let x = corner + Vector2::new(dx, dy);
        check(&bar, &nodes, x, bar.facet(&nodes, &(corner + Vector2::new(0.0, 0.1))));
    }
}

#[test]
fn rigid_motion_leaves_gap_and_weights_and_turns_the_frame() {
    let scene = smooth(&disc(24), graded);
    let nodes = deformed(&scene.reference);
    let (sin, cos) = 0.7_f64.sin_cos();
    let rotation = Matrix::<2>::new(cos, -sin, sin, cos);
    let moved = |x: &Vector2| rotation * x + Vector2::new(3.0, -2.0);
    let turned: Vec<Vector2> = nodes.iter().map(moved).collect();
    for k in 0..100 {
        let x = polar(1.0, 0.07 * f64::from(k));
        let facet = scene.facet(&nodes, &x);
        let a = scene.contact(&nodes, x, facet);
        let b = scene.contact(&turned, moved(&x), facet);
        assert!((a.gap - b.gap).abs() < 1e-14);
        assert!((b.frame - a.frame * rotation.transpose()).norm() < 1e-13);
        for ((n, weight), (m, other)) in a.stencil().zip(b.stencil()) {
            assert!(n == m && (weight - other).abs() < 1e-13);
        }
        assert!(
            a.relative(|_| Vector2::new(0.3, -0.7)).norm() < 1e-15,
            "a translation is no relative motion"
        );
    }
}

#[test]
fn a_force_pair_has_no_resultant_and_where_it_touches_no_moment() {
    let scene = smooth(&disc(24), graded);
    let nodes = deformed(&scene.reference);
    let moment = |x: Vector2, facet: u32, r: Vector2| {
        let contact = scene.contact(&nodes, x, facet);
        let mut forces = vec![Vector2::zeros(); nodes.len()];
        contact.add_force(&r, &mut forces);
        assert!(forces.iter().sum::<Vector2>().norm() < 1e-14);
        contact.stencil().map(|(n, _)| n).fold(0.0, |sum, n| {
            let (x, f) = (if n == scene.probe as usize { x } else { nodes[n] }, forces[n]);
            sum + x[0] * f[1] - x[1] * f[0]
        })
    };
    for k in 0..100 {
        let x = polar(1.02, 0.07 * f64::from(k));
        let facet = scene.facet(&nodes, &x);
        assert!(moment(x, facet, Vector2::new(2.0, 0.0)).abs() < 1e-14, "a normal force acts along one line");
        let x = foot(&scene.contact(&nodes, x, facet), &nodes);
        assert!(scene.contact(&nodes, x, facet).gap.abs() < 1e-15);
        assert!(moment(x, facet, Vector2::new(2.0, -3.0)).abs() < 1e-14);
    }
}

/// Also from the opposite side, and where the distance is the same everywhere the walk ends.
#[test]
fn a_node_far_from_its_facet_finds_the_closest_point() {
    let scene = smooth(&disc(32), |x| x);
    let nodes = &scene.reference;
    for facet in 0..scene.model.surfaces[0].facets.len() as u32 {
        for x in [Vector2::new(1.3, 0.2), Vector2::new(-0.02, 0.9), Vector2::new(100.0, 3.0)] {
            let contact = scene.contact(nodes, x, facet);
            let closest = scene.facet(nodes, &x);
            let expected = scene.contact(nodes, x, closest).gap;
            assert!((expected - (x.norm() - 1.0)).abs() < 1e-4, "{expected}");
            assert!((contact.gap - expected).abs() < 1e-13, "{} for {expected}", contact.gap);
        }
        // Every point of the circle is closest to its centre.
        assert!((scene.contact(nodes, Vector2::zeros(), facet).gap + 1.0).abs() < 1e-4);
    }
}

#[test]
fn rectangles_keep_their_sides_and_corners() {
    let bar = generate::grid([0.0; 2], [2.0, 1.0], [7, 4]).expect("valid");
    let source = generate::grid([0.0; 2], [1.0; 2], [1, 1]).expect("valid");
    let [smooth, faceted] = [true, false].map(|smooth| Scene::new(&bar, |x| x, &source, smooth));
    for k in 0..400 {
        // A path around the bar, in and out of it and around its corners.
        let s = 0.0157 * f64::from(k);
        let x = Vector2::new(1.0, 0.5) + Vector2::new(1.03 * s.cos(), 0.53 * s.sin());
        let facet = smooth.facet(&smooth.reference, &x);
        let [a, b] = [&smooth, &faceted].map(|s| s.contact(&s.reference, x, facet));
        assert!((a.gap - b.gap).abs() < 1e-15 && (a.frame - b.frame).norm() < 1e-14);
        let [p, q] = [&smooth, &faceted].map(|s| {
            let at = |n: u32| s.reference[n as usize];
            s.model.closest(std::iter::once(x), Target::Surface(0), &at).expect("a point").gap
        });
        assert!((p - q).abs() < 1e-15);
    }
}

/// Largest distance between a circle and the curve through nodes on it.
fn radius_error(boundary: usize, shape: impl Fn(Vector2) -> Vector2) -> f64 {
    let scene = smooth(&disc(boundary), shape);
    let gap = |k: u32| {
        let x = polar(1.0, 0.000_628_4 * f64::from(k));
        scene.contact(&scene.reference, x, scene.facet(&scene.reference, &x)).gap.abs()
    };
    (0..10_000).map(gap).fold(0.0, f64::max)
}

#[test]
fn circles_are_round_to_fourth_order() {
    for (name, shape) in [("uniform", (|x| x) as fn(Vector2) -> Vector2), ("graded", graded)] {
        let errors = [16, 32, 64, 128].map(|n| radius_error(n, shape));
        for (coarse, fine) in errors.iter().zip(&errors[1..]) {
            let rate = (coarse / fine).log2();
            println!("{name}: {coarse:e} -> {fine:e}, rate {rate:.2}");
            assert!(rate > 3.5, "{name}: {errors:?}");
        }
        // The sagitta of a facet, for comparison.
        assert!(errors[1] < 0.1 * (1.0 - (PI / 32.0).cos()));
    }
}

#[test]
fn signed_distance_and_gap_are_measured_to_the_same_curve() {
    let scene = smooth(&disc(32), graded);
    let nodes = deformed(&scene.reference);
    for k in 0..1000 {
        let x = polar(0.8 + 0.4 * (0.37 * f64::from(k)).sin().abs(), 0.02 * f64::from(k));
        let gap = scene.contact(&nodes, x, scene.facet(&nodes, &x)).gap;
        let at = |n: u32| nodes[n as usize];
        let distance = scene.model.closest(std::iter::once(x), Target::Surface(0), &at).expect("a point").gap;
        assert!((gap - distance).abs() < 1e-14, "{gap} for {distance} at {x}");
    }
}

#[test]
fn a_node_between_chord_and_curve_is_found() {
    let source = generate::Disc { centre: [0.0; 2], radius: 0.3, divisions: 4, rings: None };
    let source = source.quadrilaterals().expect("valid");
    // The middle of a facet lies on the axis.
    let turned = |x: Vector2| polar(x.norm(), x[1].atan2(x[0]) + PI / 16.0);
    for (smooth, found) in [(true, 1), (false, 0)] {
        let scene = Scene::new(&disc(16), turned, &source, smooth);
        let mut nodes = scene.reference.clone();
        for x in &mut nodes[scene.probe as usize..] {
            x[0] += 1.295;
        }
        let candidates = detect(&scene, &nodes, 0.0);
        assert_eq!(candidates.len(), found);
        for candidate in &candidates {
            let gap = scene.model.evaluate(candidate, &|n| nodes[n as usize]).gap;
            assert!((gap + 0.005).abs() < 1e-3, "{gap}");
        }
    }
}

#[test]
fn no_node_that_presses_into_a_valley_or_a_hill_is_missed() {
    let target = generate::grid([-1.0, -1.0], [2.0, 1.0], [8, 4]).expect("valid");
    let source = generate::grid([0.0; 2], [0.3, 0.3], [1, 1]).expect("valid");
    for curvature in [0.6, -0.6] {
        let bent = |x: Vector2| Vector2::new(x[0], x[1] + 0.5 * curvature * x[0] * x[0]);
        let scene = Scene::new(&target, bent, &source, true);
        for k in 0..1400 {
            let mut nodes = scene.reference.clone();
            let shift = bent(Vector2::new(1e-3 * f64::from(k) - 0.7, 0.0)) - Vector2::new(0.0, 0.02);
            for x in &mut nodes[scene.probe as usize..] {
                *x += shift;
            }
            let candidates = detect(&scene, &nodes, 0.0);
            let probe = candidates.iter().find(|c| c.node() == Some(scene.probe));
            let gap = scene.model.evaluate(probe.expect("found"), &|n| nodes[n as usize]).gap;
            assert!((-0.0205..-0.018).contains(&gap), "{gap} at {}", shift[0]);
        }
    }
}

/// A straight side that has bent: where nothing is smoothed.
#[test]
fn at_a_kink_a_node_goes_on_to_the_next_facet_or_stays_before_a_concave_one() {
    let scene =
        smooth(&generate::grid([0.0; 2], [4.0, 1.0], [4, 1]).expect("valid"), |x| x - Vector2::new(2.0, 1.0));
    for (rise, known, slope) in [(0.2, false, 0.2), (0.2, true, -0.2), (-0.2, true, -0.2)] {
        let bent = |x: &Vector2| Vector2::new(x[0], x[1] + rise * x[0].abs());
        let nodes: Vec<Vector2> = scene.reference.iter().map(bent).collect();
        let own = scene.facet(&nodes, &Vector2::new(-0.5, 0.5 * rise));
        let x = Vector2::new(0.3, 0.1);
        let at = |n: u32| if n == scene.probe { x } else { nodes[n as usize] };
        let mut candidate = Candidate::at_node(0, scene.probe, Some(own));
        let kinks = scene.model.concave_kinks(&candidate, &at);
        assert_eq!(kinks.iter().filter(|is_concave| **is_concave).count(), usize::from(rise > 0.0));
        if known {
            candidate.stays = kinks;
        }
        let contact = scene.model.evaluate(&candidate, &at);
        let normal = Vector2::new(-slope, 1.0).normalize();
        assert!((row(&contact.frame, 0) - normal).norm() < 1e-15, "{:?}", contact.frame);
        assert!((contact.gap - normal.dot(&x)).abs() < 1e-15, "{:e}", contact.gap);
    }
}
