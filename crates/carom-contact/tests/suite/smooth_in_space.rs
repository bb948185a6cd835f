//! Targets in space that are smooth surfaces: gaps without kinks, and the forces that follow from them.

use carom_contact::{Contact, Path, Search, Target};
use carom_mesh::{CellBlock, CellKind, Facet, Matrix, Mesh, Vector, generate};

use crate::common::Scene;

type Vector3 = Vector<3>;

/// The source is a cell whose first node is placed freely.
fn scene_of(target: &Mesh<3>, is_smooth: bool) -> Scene<3> {
    Scene::new(target, |x| x, &generate::grid([0.0; 3], [1.0; 3], [1, 1, 1]).expect("valid"), is_smooth)
}

fn distance(scene: &Scene<3>, nodes: &[Vector3], x: Vector3) -> f64 {
    let at = |n: u32| nodes[n as usize];
    scene.model.closest(std::iter::once(x), Target::Surface(0), &at).expect("a point").gap
}

fn middle(facet: &Facet, nodes: &[Vector3]) -> Vector3 {
    let corners = &facet.nodes[..facet.kind.corner_count()];
    corners.iter().map(|&n| nodes[n as usize]).sum::<Vector3>() / corners.len() as f64
}

/// One kind of every facet, the ball of two kinds of triangles and of three of quadrilaterals.
const KINDS: [CellKind; 5] =
    [CellKind::Tet4, CellKind::Tet10, CellKind::Hex8, CellKind::Hex20, CellKind::Hex27];

fn ball(kind: CellKind) -> Mesh<3> {
    generate::Ball { centre: [0.0; 3], radius: 1.0, divisions: 4, rings: None }.mesh(kind).expect("valid")
}

fn cylinder(kind: CellKind) -> Mesh<3> {
    let axis = generate::Axis { base: [0.0; 3], direction: [0.0, 0.0, 1.0], height: 1.0 };
    let cylinder = generate::Cylinder { axis, radius: 1.0, divisions: 4, rings: None, layers: 2 };
    cylinder.mesh(kind).expect("valid")
}

/// A deformation that is not small.
fn bend(x: &Vector3) -> Vector3 {
    Vector3::new(1.1 * x[0] + 0.2 * x[1], 0.9 * x[1] + 0.1 * x[2] * x[2], 1.05 * x[2] - 0.2 * x[0] * x[1])
}

/// It, and a scatter of nodes that no smooth deformation has.
fn deformed(nodes: &[Vector3]) -> Vec<Vector3> {
    let noise = |k: usize| Vector3::from_fn(|i, _| 2e-3 * (2.4 * (k * k) as f64 + 1.7 * i as f64).sin());
    nodes.iter().enumerate().map(|(k, x)| bend(x) + noise(k)).collect()
}

/// Points all over the unit sphere, and their number.
fn directions(count: usize) -> impl Iterator<Item = Vector3> {
    (0..count).map(move |k| {
        let z = 1.0 - (2.0 * k as f64 + 1.0) / count as f64;
        let (sin, cos) = (2.399_963 * k as f64).sin_cos();
        Vector3::new(cos, sin, 0.0) * (1.0 - z * z).sqrt() + Vector3::new(0.0, 0.0, z)
    })
}

fn row(contact: &Contact<3>, k: usize) -> Vector3 {
    contact.frame.row(k).transpose()
}

/// Target point of a contact.
fn foot(contact: &Contact<3>, nodes: &[Vector3]) -> Vector3 {
    contact.stencil().skip(1).fold(Vector3::zeros(), |sum, (n, weight)| sum - nodes[n] * weight)
}

#[test]
fn a_node_that_slides_over_edges_feels_no_jump() {
    for kind in KINDS {
        let scene = scene_of(&ball(kind), true);
        let nodes = deformed(&scene.reference);
        for (turn, radius) in [(0.3, 0.99), (1.7, 1.0), (2.9, 1.05)] {
            let axis = Vector3::new(0.3, 0.2, 1.0).normalize();
            let across = Vector3::new(1.0, 0.1, 0.0).cross(&axis).normalize();
            let along = axis.cross(&across);
            let x = |s: f64| bend(&((across * (s + turn).cos() + along * (s + turn).sin()) * radius));
            // The facet is the one of the start throughout; the node slides over three to six more.
            let start = scene.facet(&nodes, &x(0.0));
            let h = 2e-4;
            let mut last: Option<(Vector3, Contact<3>)> = None;
            for k in 0..6000 {
                let x = x(h * f64::from(k));
                let contact = scene.contact(&nodes, x, start);
                let offset = x - foot(&contact, &nodes);
                let n = row(&contact, 0);
                assert!((offset - n * contact.gap).norm() < 3e-15, "{kind:?} {k}: {offset} {n}");
                if let Some((x0, before)) = last {
                    let n0 = row(&before, 0);
                    assert!((n - n0).norm() < 8.0 * h, "{kind:?}: the normal turns by {:e}", (n - n0).norm());
                    let rise = (n + n0).dot(&(x - x0)) * 0.5;
                    let kink = (contact.gap - before.gap - rise).abs();
                    assert!(
                        kink < 4.0 * h * h,
                        "{kind:?}: the gap changes by {kink:e} more than its slope says"
                    );
                }
                last = Some((x, contact));
            }
            let (x, end) = last.expect("steps");
            assert!((end.gap - distance(&scene, &nodes, x)).abs() < 1e-14, "{kind:?}: {}", end.gap);
        }
    }
}

#[test]
fn the_gradient_of_the_gap_is_the_normal_row() {
    let h = 1e-6;
    let check = |scene: &Scene<3>, nodes: &[Vector3], x: Vector3, facet: u32| {
        let contact = scene.contact(nodes, x, facet);
        let stencil: Vec<usize> = contact.stencil().map(|(n, _)| n).collect();
        for &n in &stencil {
            for i in 0..3 {
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
                let unit = |m: usize| Vector3::from_fn(|j, _| f64::from(m == n && i == j));
                let expected = contact.relative(unit)[0];
                assert!((slope - expected).abs() < 2e-8, "{slope} for {expected} at {x}, node {n}");
            }
        }
    };
    for kind in KINDS {
        let scene = scene_of(&ball(kind), true);
        let nodes = deformed(&scene.reference);
        for (k, x) in directions(11).enumerate() {
            let x = bend(&(x * (1.0 + 0.02 * (k as f64).sin())));
            check(&scene, &nodes, x, scene.facet(&nodes, &x));
        }
        // At a node.
        let x = nodes[scene.model.surfaces[0].nodes[5] as usize] * 1.01;
        check(&scene, &nodes, x, scene.facet(&nodes, &x));
    }
    // Next to the rim of a cylinder.
    for kind in KINDS.into_iter().chain([CellKind::Wedge6, CellKind::Wedge15]) {
        let scene = scene_of(&cylinder(kind), true);
        let nodes = deformed(&scene.reference);
        for (angle, z) in [(0.1, 0.9), (1.2, 0.95), (2.2, 0.97)] {
            let at = |z: f64| bend(&Vector3::new(1.03 * f64::cos(angle), 1.03 * f64::sin(angle), z));
            check(&scene, &nodes, at(z), scene.facet(&nodes, &at(0.8)));
        }
    }
}

#[test]
fn beyond_a_rim_the_distance_is_along_the_normal() {
    for kind in KINDS.into_iter().chain([CellKind::Wedge6, CellKind::Wedge15]) {
        let scene = scene_of(&cylinder(kind), true);
        let nodes = deformed(&scene.reference);
        for k in 0..200 {
            let (sin, cos) = (0.031_4 * f64::from(k)).sin_cos();
            let at = |z: f64| bend(&Vector3::new(1.03 * cos, 1.03 * sin, z));
            let x = at(1.0 + 4e-4 * f64::from(k));
            let contact = scene.contact(&nodes, x, scene.facet(&nodes, &at(0.8)));
            let offset = x - foot(&contact, &nodes);
            assert!((offset - row(&contact, 0) * contact.gap).norm() < 1e-14, "{kind:?} {k}");
            let weights: f64 = contact.targets().map(|(_, weight)| weight).sum();
            assert!((weights + 1.0).abs() < 1e-14);
        }
    }
}

#[test]
fn rigid_motion_leaves_gap_and_weights_and_turns_the_normal() {
    let turn = Matrix::<3>::new(0.36, 0.48, -0.8, -0.8, 0.6, 0.0, 0.48, 0.64, 0.6);
    let moved = |x: &Vector3| turn * x + Vector3::new(3.0, -2.0, 1.0);
    for kind in KINDS {
        let scene = scene_of(&ball(kind), true);
        let nodes = deformed(&scene.reference);
        let turned: Vec<Vector3> = nodes.iter().map(moved).collect();
        // The surface made of a body that was drawn elsewhere, and turned, is the same one, too.
        let elsewhere = {
            let mesh = ball(kind);
            let blocks = mesh.blocks().iter();
            let blocks = blocks.map(|b| CellBlock { kind: b.kind, connectivity: b.connectivity.clone() });
            scene_of(
                &Mesh::new(mesh.nodes().iter().map(moved).collect(), blocks.collect()).expect("valid"),
                true,
            )
        };
        for x in directions(60) {
            let x = bend(&(x * 1.01));
            let facet = scene.facet(&nodes, &x);
            let a = scene.contact(&nodes, x, facet);
            for b in [scene.contact(&turned, moved(&x), facet), elsewhere.contact(&turned, moved(&x), facet)]
            {
                assert!((a.gap - b.gap).abs() < 1e-13, "{kind:?}: {} {}", a.gap, b.gap);
                assert!((turn * row(&a, 0) - row(&b, 0)).norm() < 1e-12);
                for ((n, weight), (m, other)) in a.stencil().zip(b.stencil()) {
                    assert!(n == m && (weight - other).abs() < 1e-11, "{kind:?}: {weight} {other}");
                }
            }
            assert!(
                a.relative(|_| Vector3::new(0.3, -0.7, 0.2)).norm() < 1e-14,
                "a translation is no relative motion"
            );
        }
    }
}

/// What the surface is does not depend on how nodes and cells are numbered.
#[test]
fn numbers_of_nodes_do_not_matter() {
    for kind in KINDS {
        let mesh = ball(kind);
        let count = mesh.nodes().len();
        let number = |n: u32| ((n as usize * 7919 + 13) % count) as u32;
        assert!(count % 7919 != 0);
        let mut nodes = vec![Vector3::zeros(); count];
        (0..count).for_each(|n| nodes[number(n as u32) as usize] = mesh.nodes()[n]);
        let blocks = mesh.blocks().iter().map(|b| {
            let cells = b.connectivity.chunks_exact(b.kind.node_count()).rev();
            CellBlock { kind: b.kind, connectivity: cells.flatten().map(|&n| number(n)).collect() }
        });
        let other = scene_of(&Mesh::new(nodes, blocks.collect()).expect("valid"), true);
        let scene = scene_of(&mesh, true);
        let placed = deformed(mesh.nodes());
        let mut renumbered = placed.clone();
        (0..count).for_each(|n| renumbered[number(n as u32) as usize] = placed[n]);
        for x in directions(60) {
            let x = bend(&(x * 1.01));
            let a = scene.contact(&placed, x, scene.facet(&placed, &x));
            let b = other.contact(&renumbered, x, other.facet(&renumbered, &x));
            assert!((a.gap - b.gap).abs() < 1e-14, "{kind:?}: {} {}", a.gap, b.gap);
            assert!((row(&a, 0) - row(&b, 0)).norm() < 1e-13);
            for (n, weight) in a.stencil().skip(1).filter(|(_, weight)| weight.abs() > 1e-9) {
                let found = b.stencil().find(|&(m, _)| m == number(n as u32) as usize);
                assert!((found.expect("the same nodes").1 - weight).abs() < 1e-12, "{kind:?}");
            }
        }
    }
}

#[test]
fn a_force_pair_has_no_resultant_and_where_it_touches_no_moment() {
    for kind in KINDS {
        let scene = scene_of(&ball(kind), true);
        let nodes = deformed(&scene.reference);
        let moment = |x: Vector3, facet: u32, r: Vector3| {
            let contact = scene.contact(&nodes, x, facet);
            let mut forces = vec![Vector3::zeros(); nodes.len()];
            contact.add_force(&r, &mut forces);
            assert!(forces.iter().sum::<Vector3>().norm() < 1e-14);
            contact.stencil().fold(Vector3::zeros(), |sum, (n, _)| {
                sum + (if n == scene.probe as usize { x } else { nodes[n] }).cross(&forces[n])
            })
        };
        for x in directions(60) {
            let x = bend(&(x * 1.02));
            let facet = scene.facet(&nodes, &x);
            let normal = moment(x, facet, Vector3::new(2.0, 0.0, 0.0));
            assert!(normal.norm() < 1e-14, "a normal force acts along one line");
            let x = foot(&scene.contact(&nodes, x, facet), &nodes);
            assert!(scene.contact(&nodes, x, facet).gap.abs() < 1e-15);
            assert!(moment(x, facet, Vector3::new(2.0, -3.0, 1.0)).norm() < 1e-14);
        }
    }
}

#[test]
fn boxes_keep_their_sides_and_edges() {
    for kind in [CellKind::Tet4, CellKind::Tet10, CellKind::Hex8, CellKind::Hex20, CellKind::Hex27] {
        let grid = generate::Grid { corner: [0.0; 3], size: [2.0, 1.0, 1.0], divisions: [3, 2, 2] };
        let mesh = grid.mesh(kind).expect("valid");
        let [smooth, faceted] = [true, false].map(|is_smooth| scene_of(&mesh, is_smooth));
        assert_eq!(smooth.model.surfaces[0].facets, faceted.model.surfaces[0].facets);
        let nodes = deformed(&smooth.reference);
        for x in directions(200) {
            let x = bend(&(Vector3::new(1.0, 0.5, 0.5) + Vector3::new(1.1 * x[0], 0.6 * x[1], 0.6 * x[2])));
            let facet = smooth.facet(&nodes, &x);
            assert_eq!(smooth.contact(&nodes, x, facet), faceted.contact(&nodes, x, facet));
            assert_eq!(distance(&smooth, &nodes, x), distance(&faceted, &nodes, x));
        }
    }
}

/// The rim of a cylinder is a round edge: both its sides end in it, and its ends are plane.
#[test]
fn a_cylinder_keeps_its_rim_and_its_plane_ends() {
    for kind in KINDS.into_iter().chain([CellKind::Wedge6, CellKind::Wedge15]) {
        let scene = scene_of(&cylinder(kind), true);
        let nodes = &scene.reference;
        for k in 0..200 {
            let (sin, cos) = (0.031_4 * f64::from(k)).sin_cos();
            let at = |r: f64, z: f64| Vector3::new(r * cos, r * sin, z);
            for r in [0.2, 0.6, 0.9, 0.99] {
                let gap = distance(&scene, nodes, at(r, 1.01));
                assert!((gap - 0.01).abs() < 1e-15, "{kind:?}: {gap} at {r}");
            }
            let gap = distance(&scene, nodes, at(1.02, 0.6));
            assert!((gap - 0.02).abs() < 1e-3, "{kind:?}: {gap}");
            let corner = distance(&scene, nodes, at(1.03, 1.04));
            assert!((corner - 0.05).abs() < 1e-3, "{kind:?}: {corner}");
        }
    }
}

#[test]
fn signed_distance_and_gap_are_measured_to_the_same_surface() {
    for kind in KINDS {
        let scene = scene_of(&ball(kind), true);
        let nodes = deformed(&scene.reference);
        for (k, x) in directions(300).enumerate() {
            let x = bend(&(x * (0.9 + 0.2 * (0.37 * k as f64).sin().abs())));
            let gap = scene.contact(&nodes, x, scene.facet(&nodes, &x)).gap;
            let distance = distance(&scene, &nodes, x);
            assert!((gap - distance).abs() < 1e-14, "{kind:?}: {gap} for {distance} at {x}");
        }
    }
}

#[test]
fn a_node_between_facet_and_surface_is_found() {
    for (is_smooth, count) in [(true, 1), (false, 0)] {
        let scene = scene_of(&ball(CellKind::Hex8), is_smooth);
        let facets = &scene.model.surfaces[0].facets;
        // The first node of the source is its corner that looks this way.
        let towards = Vector3::new(1.0, 1.0, 1.0).normalize();
        let directions = facets.iter().map(|f| middle(f, &scene.reference).normalize());
        let before: Vec<Vector3> = directions.filter(|d| d.dot(&towards) > 0.8).collect();
        assert!(before.len() > 3);
        for direction in before {
            // Under the surface, over the facet.
            let mut nodes = scene.reference.clone();
            for x in &mut nodes[scene.probe as usize..] {
                *x += direction * 0.995;
            }
            let at = |n: u32| nodes[n as usize];
            let mut found = Vec::new();
            scene.model.detect(&Path::resting(&at, 0.0), &mut Search::default(), &mut found);
            assert_eq!(found.iter().filter(|c| c.node() == Some(scene.probe)).count(), count);
        }
    }
}
