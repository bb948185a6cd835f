use carom_mesh::{CellKind, Mesh, Surface, generate};

use super::*;
use crate::domain::Domain;

type Vector3 = Vector<3>;

/// The kinds of cells of bodies in space.
fn solid_kinds() -> impl Iterator<Item = CellKind> {
    CellKind::ALL.into_iter().filter(|k| k.dimension() == 3)
}

fn ball(kind: CellKind, divisions: usize) -> Mesh<3> {
    generate::Ball { centre: [0.0; 3], radius: 1.0, divisions, rings: None }.mesh(kind).expect("valid")
}

fn cylinder(kind: CellKind, divisions: usize) -> Mesh<3> {
    let axis = generate::Axis { base: [0.0; 3], direction: [0.0, 0.0, 1.0], height: 2.0 };
    let layers = divisions.div_ceil(2);
    generate::Cylinder { axis, radius: 1.0, divisions, rings: None, layers }.mesh(kind).expect("valid")
}

/// The kinds of cells that a ball has.
fn ball_kinds() -> impl Iterator<Item = CellKind> {
    solid_kinds().filter(|k| !k.is_wedge())
}

fn sheet(mesh: &Mesh<3>) -> Sheet {
    Sheet::through(Surface::of(mesh).facets(), &|n| mesh.nodes()[n as usize])
}

/// Stretch, shear, a bend, and a scatter of nodes that no smooth deformation has.
fn deformed(nodes: &[Vector3]) -> Vec<Vector3> {
    let noise =
        |k: usize| Vector3::from_fn(|i, _| 4e-3 * (1.0 + (2.4 * (k * k) as f64 + 1.7 * i as f64)).sin());
    let bent = |x: &Vector3| {
        Vector3::new(1.1 * x[0] + 0.2 * x[1], 0.9 * x[1] + 0.1 * x[2] * x[2], 1.05 * x[2] - 0.3 * x[0] * x[1])
    };
    nodes.iter().enumerate().map(|(k, x)| bent(x) + noise(k)).collect()
}

/// The largest difference of position and of normals between tiles along the sides that they have in common, but those in flat parts.
fn jumps(mesh: &Mesh<3>, nodes: &[Vector3]) -> (f64, f64) {
    let surface = Surface::of(mesh);
    let sheet = sheet(mesh);
    let network = Network::new(surface.facets(), &|n| mesh.nodes()[n as usize]);
    let is_flat = |n: u32| network.sectors.iter().any(|s| s.node == n && s.is_flat);
    let at = |n: u32| nodes[n as usize];
    let (mut of_points, mut of_normals, mut compared) = (0.0_f64, 0.0_f64, 0);
    for tile in &sheet.tiles {
        for (side, neighbour) in tile.neighbours.iter().enumerate() {
            let Some((other, there)) = *neighbour else { continue };
            let corners = tile.domain.corners().len();
            let ends = [side, (side + 1) % corners].map(|k| tile.nodes_at_corners()[k]);
            if ends.into_iter().any(is_flat) {
                continue;
            }
            compared += 1;
            let other = &sheet.tiles[other as usize];
            for k in 0..=10 {
                let s = f64::from(k) / 10.0;
                let local = |tile: &Tile, side: usize, s: f64| {
                    tile.seen_from(&Vector3::zeros(), &at).local(&tile.domain.on_edge(side, s))
                };
                let (a, b) = (local(tile, side, s), local(other, there as usize, 1.0 - s));
                of_points = of_points.max((a.point - b.point).norm());
                of_normals = of_normals.max((normal(&a.tangents) - normal(&b.tangents)).norm());
            }
        }
    }
    assert!(compared > 0);
    (of_points, of_normals)
}

#[test]
fn tiles_have_one_tangent_plane_where_they_meet_however_nodes_move() {
    let balls = ball_kinds().map(|kind| (kind, ball(kind, 4)));
    for (kind, mesh) in balls.chain(solid_kinds().map(|kind| (kind, cylinder(kind, 4)))) {
        for nodes in [mesh.nodes().to_vec(), deformed(mesh.nodes())] {
            let (points, normals) = jumps(&mesh, &nodes);
            println!("{kind:?}: {points:e} {normals:e}");
            assert!(points < 1e-15 && normals < 1e-13, "{kind:?}: {points:e} {normals:e}");
        }
    }
}

/// Largest error of position and of normal, relative to the radius.
fn errors(
    mesh: &Mesh<3>,
    radial: impl Fn(&Vector3) -> Vector3,
    on_it: impl Fn(&Vector3) -> bool,
) -> (f64, f64) {
    let sheet = sheet(mesh);
    let at = |n: u32| mesh.nodes()[n as usize];
    let (mut of_points, mut of_normals) = (0.0_f64, 0.0_f64);
    for tile in &sheet.tiles {
        let controls = tile.seen_from(&Vector3::zeros(), &at);
        for (i, j) in (0..=8).flat_map(|i| (0..=8).map(move |j| (i, j))) {
            let [a, b] = [i, j].map(|k| f64::from(k) / 8.0);
            let xi = if tile.domain == Domain::Triangle {
                [a, b * (1.0 - a)]
            } else {
                [2.0 * a - 1.0, 2.0 * b - 1.0]
            };
            let middle = controls.local(&tile.domain.middle());
            if !on_it(&middle.point) {
                continue;
            }
            let local = controls.local(&xi);
            let r = radial(&local.point);
            of_points = of_points.max((r.norm() - 1.0).abs());
            of_normals = of_normals.max((normal(&local.tangents) - r.normalize()).norm());
        }
    }
    (of_points, of_normals)
}

/// Checks the errors of a shape with 4, 8 and 16 divisions: of fourth order in position and of third in the normal.
fn is_round(name: &str, errors: [(f64, f64); 3]) {
    let rate = |of: fn(&(f64, f64)) -> f64| (of(&errors[1]) / of(&errors[2])).log2();
    let (points, normals) = (rate(|e| e.0), rate(|e| e.1));
    println!(
        "{name}: position {:e}, rate {points:.2}, normal {:e}, rate {normals:.2}",
        errors[2].0, errors[2].1
    );
    assert!(points > 3.8 && normals > 2.6, "{name}: {errors:?}");
    assert!(errors[2].0 < 5e-6 && errors[2].1 < 4e-4, "{name}: {errors:?}");
}

#[test]
fn spheres_and_cylinders_are_round_to_fourth_order() {
    for kind in ball_kinds() {
        is_round(&format!("ball, {kind:?}"), [4, 8, 16].map(|n| errors(&ball(kind, n), |x| *x, |_| true)));
    }
    let around = |x: &Vector3| Vector3::new(x[0], x[1], 0.0);
    let on_side = |x: &Vector3| x[2] > 1e-9 && x[2] < 2.0 - 1e-9;
    for kind in solid_kinds() {
        let errors = [4, 8, 16].map(|n| errors(&cylinder(kind, n), around, on_side));
        is_round(&format!("cylinder, {kind:?}"), errors);
    }
}

/// A run of it tells how long the closest point of a smooth surface and of facets takes to find.
#[test]
#[ignore = "a measurement"]
fn time_of_a_closest_point() {
    use crate::ContactSurface;
    for kind in ball_kinds() {
        let mesh = ball(kind, 8);
        let at = |n: u32| mesh.nodes()[n as usize];
        let faceted = ContactSurface::new(&Surface::of(&mesh), 0, &at);
        let smooth = faceted.clone().smoothed(&at);
        let nodes = (0..smooth.facets.len() as u32).map(|f| smooth.nodes_over(f, 0).len());
        println!("{kind:?}: {} nodes in a stencil at most", nodes.max().expect("facets"));
        for (name, surface) in [("smooth", smooth), ("faceted", faceted)] {
            let start = std::time::Instant::now();
            let mut count = 0;
            for (f, facet) in (0..).zip(&surface.facets) {
                for &n in &facet.nodes {
                    let x = at(n) * 1.01 + Vector3::new(0.01, 0.02, 0.03);
                    assert!(surface.project(f, &x, Reach::Beyond, &at).point.norm() > 0.5);
                    count += 1;
                }
            }
            println!("  {name}: {:?} each", start.elapsed() / count);
            let start = std::time::Instant::now();
            let boxes = (0..surface.facets.len() as u32).map(|f| surface.bounds(f, &at).diameter());
            let sum: f64 = boxes.sum();
            println!("  a box {:?} {sum}", start.elapsed() / surface.facets.len() as u32);
        }
    }
}
