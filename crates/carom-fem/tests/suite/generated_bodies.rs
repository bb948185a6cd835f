//! Every shape in every cell: no inverted cell, named sets in place, and a volume that converges to the true one.

use std::f64::consts::PI;

use carom_fem::Body;
use carom_fem::material::LawSpec;
use carom_mesh::{CellKind, Mesh, MeshError, Surface, Vector, generate};

use crate::common::elastic;

fn volume<const D: usize>(mesh: Mesh<D>) -> f64 {
    let spec = crate::common::spec(LawSpec::SaintVenantKirchhoff(elastic()));
    Body::new(mesh, &spec).expect("no inverted cell").volume()
}

fn kinds(dimension: usize) -> impl Iterator<Item = CellKind> {
    CellKind::ALL.into_iter().filter(move |kind| kind.dimension() == dimension)
}

/// Facets of straight edges miss the circle by O(h²); through mid nodes on it the error is O(h⁴), as for Simpson's rule.
fn expected_rate(kind: CellKind) -> f64 {
    2.0 * kind.reference().degree as f64
}

/// The error of the volume at `divisions` and twice as many falls at the rate of the cell.
fn check_rate<const D: usize>(
    kinds: impl Iterator<Item = CellKind>,
    exact: f64,
    divisions: usize,
    mesh: impl Fn(usize, CellKind) -> Result<Mesh<D>, MeshError>,
) {
    for kind in kinds {
        let error = |n: usize| volume(mesh(n, kind).expect("valid")) / exact - 1.0;
        let (coarse, fine) = (error(divisions), error(2 * divisions));
        let (rate, expected) = ((coarse / fine).abs().log2(), expected_rate(kind));
        assert!((rate - expected).abs() < 0.2, "{kind:?}: {coarse:.2e}, {fine:.2e}: rate {rate:.2}");
        assert!(fine.abs() < 0.05 * 4.0_f64.powf(2.0 - expected), "{kind:?}: {fine:.2e}");
    }
}

/// How far a point is from where the nodes of a set belong [m].
type Distance<'a, const D: usize> = &'a dyn Fn(&Vector<D>) -> f64;

/// The nodes of each set are where they belong, and all the sets together are the boundary.
fn check_sets<const D: usize>(mesh: &Mesh<D>, sets: &[(&str, Distance<'_, D>)]) {
    let surface = Surface::of(mesh);
    let mut facets = 0;
    for (name, distance) in sets {
        let part = mesh.surface_of(name, &surface).expect("there");
        facets += part.facets().len();
        assert!(part.nodes().iter().all(|&n| distance(&mesh.nodes()[n as usize]).abs() < 1e-12), "{name}");
    }
    assert_eq!(facets, surface.facets().len());
    assert_eq!(mesh.sets().names().len(), sets.len() + 1);
}

#[test]
fn boxes_in_every_cell_are_filled() {
    for kind in kinds(2) {
        let grid = generate::Grid { corner: [0.1, -0.2], size: [2.0, 3.0], divisions: [2, 3] };
        let mesh = grid.mesh(kind).expect("valid");
        check_sets(
            &mesh,
            &[
                ("left", &|x| x[0] - 0.1),
                ("right", &|x| x[0] - 2.1),
                ("bottom", &|x| x[1] + 0.2),
                ("top", &|x| x[1] - 2.8),
            ],
        );
        assert!((volume(mesh) - 6.0).abs() < 1e-13, "{kind:?}");
    }
    for kind in kinds(3) {
        let grid = generate::Grid { corner: [0.1, -0.2, 0.0], size: [2.0, 3.0, 0.5], divisions: [2, 3, 1] };
        let mesh = grid.mesh(kind).expect("valid");
        check_sets(
            &mesh,
            &[
                ("left", &|x| x[0] - 0.1),
                ("right", &|x| x[0] - 2.1),
                ("front", &|x| x[1] + 0.2),
                ("back", &|x| x[1] - 2.8),
                ("bottom", &|x| x[2]),
                ("top", &|x| x[2] - 0.5),
            ],
        );
        assert!((volume(mesh) - 3.0).abs() < 1e-13, "{kind:?}");
    }
}

#[test]
fn discs_and_rings_converge_to_their_area() {
    let disc = |divisions| generate::Disc { centre: [2.0, 4.0], radius: 0.7, divisions, rings: None };
    check_rate(kinds(2), PI * 0.49, 4, |n, kind| disc(n).mesh(kind));
    let ring = |n| generate::Ring {
        centre: [2.0, 4.0],
        inner_radius: 0.4,
        outer_radius: 0.7,
        divisions: [4 * n, n],
    };
    check_rate(kinds(2), PI * (0.49 - 0.16), 2, |n, kind| ring(n).mesh(kind));
    for kind in kinds(2) {
        let from = |x: &Vector<2>| (x - Vector::from([2.0, 4.0])).norm();
        check_sets(&disc(2).mesh(kind).expect("valid"), &[("surface", &|x| from(x) - 0.7)]);
        check_sets(
            &ring(1).mesh(kind).expect("valid"),
            &[("inner", &|x| from(x) - 0.4), ("outer", &|x| from(x) - 0.7)],
        );
    }
}

/// All but wedges, whose sides would not meet.
fn of_balls() -> impl Iterator<Item = CellKind> {
    kinds(3).filter(|kind| !kind.is_wedge())
}

#[test]
fn balls_converge_to_their_volume() {
    let ball = |divisions| generate::Ball { centre: [1.0, -2.0, 3.0], radius: 1.5, divisions, rings: None };
    check_rate(of_balls(), 4.5 * PI, 4, |n, kind| ball(n).mesh(kind));
    for kind in of_balls() {
        let mesh = ball(2).mesh(kind).expect("valid");
        check_sets(&mesh, &[("surface", &|x| (x - Vector::from([1.0, -2.0, 3.0])).norm() - 1.5)]);
    }
}

#[test]
fn cylinders_and_tubes_converge_to_their_volume_whichever_way_they_stand() {
    let (direction, height) = ([2.0, -1.0, 2.0], 1.5);
    let base = Vector::from([0.3, 0.2, -0.1]);
    let axis = generate::Axis { base: base.into(), direction, height };
    let cylinder = |n| generate::Cylinder { axis, radius: 0.8, divisions: n, rings: None, layers: n };
    check_rate(kinds(3), PI * 0.64 * height, 4, |n, kind| cylinder(n).mesh(kind));
    let tube = |n| generate::Tube { axis, inner_radius: 0.5, outer_radius: 0.8, divisions: [4 * n, n, n] };
    check_rate(kinds(3), PI * (0.64 - 0.25) * height, 2, |n, kind| tube(n).mesh(kind));
    let along = |x: &Vector<3>| (x - base).dot(&Vector::from(direction)) / 3.0;
    let from = |x: &Vector<3>| ((x - base).norm_squared() - along(x).powi(2)).sqrt();
    for kind in kinds(3) {
        check_sets(
            &cylinder(2).mesh(kind).expect("valid"),
            &[("bottom", &along), ("top", &|x| along(x) - height), ("side", &|x| from(x) - 0.8)],
        );
        check_sets(
            &tube(1).mesh(kind).expect("valid"),
            &[
                ("bottom", &along),
                ("top", &|x| along(x) - height),
                ("inner", &|x| from(x) - 0.5),
                ("outer", &|x| from(x) - 0.8),
            ],
        );
    }
}

#[test]
fn a_cylinder_along_z_is_not_turned_and_one_against_it_is_upside_down() {
    for (direction, sign) in [([0.0, 0.0, 3.0], 1.0), ([0.0, 0.0, -3.0], -1.0)] {
        let axis = generate::Axis { base: [0.0; 3], direction, height: 2.0 };
        let cylinder = generate::Cylinder { axis, radius: 1.0, divisions: 2, rings: None, layers: 1 };
        let mesh = cylinder.mesh(CellKind::Hex8).expect("valid");
        let (low, high) = mesh.bounds();
        assert_eq!([low[2], high[2]], if sign > 0.0 { [0.0, 2.0] } else { [-2.0, 0.0] });
        assert!((volume(mesh) - 4.0 * 2.0_f64.sqrt()).abs() < 1e-13, "eight sides");
    }
}

#[test]
fn facets_of_tetrahedra_agree_where_blocks_meet() {
    let ball = generate::Ball { centre: [0.0; 3], radius: 1.0, divisions: 4, rings: None };
    let surface = |kind| Surface::of(&ball.mesh(kind).expect("valid")).facets().len();
    assert_eq!(surface(CellKind::Hex8), 6 * 16);
    // Facets that did not agree would count as boundary.
    assert_eq!(surface(CellKind::Tet4), 2 * 6 * 16);
}

/// Facets that did not agree between layers would count as boundary.
#[test]
fn facets_of_wedges_are_triangles_at_the_ends_and_quadrilaterals_around() {
    let axis = generate::Axis { base: [0.0; 3], direction: [0.0, 0.0, 1.0], height: 1.0 };
    let cylinder = generate::Cylinder { axis, radius: 1.0, divisions: 4, rings: None, layers: 2 };
    for (kind, hexahedra) in [(CellKind::Wedge6, CellKind::Hex8), (CellKind::Wedge15, CellKind::Hex20)] {
        let facets = |kind: CellKind, corners: usize| {
            let surface = Surface::of(&cylinder.mesh(kind).expect("valid"));
            surface.facets().iter().filter(|f| f.kind.corner_count() == corners).count()
        };
        let (around, ends) = (2 * 16, 2 * (16 + 2 * 16));
        assert_eq!(facets(hexahedra, 4), around + ends);
        assert_eq!((facets(kind, 4), facets(kind, 3)), (around, 2 * ends), "{kind:?}");
    }
}

#[test]
fn impossible_bodies_are_refused_with_the_parameter() {
    let parameter = |result: Result<Mesh<3>, MeshError>| match result {
        Err(MeshError::Generator { parameter, .. }) => parameter,
        other => panic!("{other:?}"),
    };
    let axis = generate::Axis { base: [0.0; 3], direction: [0.0, 0.0, 1.0], height: 1.0 };
    let ball = generate::Ball { centre: [0.0; 3], radius: 1.0, divisions: 4, rings: None };
    let cylinder = generate::Cylinder { axis, radius: 1.0, divisions: 4, rings: None, layers: 2 };
    let tube = generate::Tube { axis, inner_radius: 0.5, outer_radius: 1.0, divisions: [8, 1, 1] };
    let kind = CellKind::Hex8;
    assert_eq!(parameter(generate::Ball { radius: 0.0, ..ball }.mesh(kind)), "radius");
    assert_eq!(parameter(generate::Ball { divisions: 3, ..ball }.mesh(kind)), "divisions");
    assert_eq!(parameter(generate::Ball { divisions: 4000, ..ball }.mesh(kind)), "divisions");
    assert_eq!(parameter(generate::Ball { rings: Some(0), ..ball }.mesh(kind)), "rings");
    assert_eq!(parameter(ball.mesh(CellKind::Wedge6)), "cell");
    assert_eq!(parameter(generate::Cylinder { layers: 0, ..cylinder }.mesh(kind)), "layers");
    assert_eq!(parameter(generate::Cylinder { radius: f64::NAN, ..cylinder }.mesh(kind)), "radius");
    assert_eq!(parameter(generate::Tube { inner_radius: 0.0, ..tube }.mesh(kind)), "inner_radius");
    assert_eq!(parameter(generate::Tube { outer_radius: 0.4, ..tube }.mesh(kind)), "outer_radius");
    assert_eq!(parameter(generate::Tube { divisions: [2, 1, 1], ..tube }.mesh(kind)), "divisions");
    let lying = generate::Axis { direction: [0.0; 3], ..axis };
    assert_eq!(parameter(generate::Tube { axis: lying, ..tube }.mesh(kind)), "axis");
    let flat = generate::Axis { height: -1.0, ..axis };
    assert_eq!(parameter(generate::Cylinder { axis: flat, ..cylinder }.mesh(kind)), "height");
    let refused = ball.mesh(CellKind::Quad4);
    assert_eq!(refused, Err(MeshError::WrongDimension { kind: "quad4", dimension: 3 }));
}

#[test]
fn inverted_cells_are_counted_and_named() {
    let mesh = generate::grid([0.0; 3], [4.0, 1.0, 1.0], [4, 1, 1]).expect("valid");
    let mut block = mesh.blocks()[0].clone();
    for cell in [1, 3] {
        block.connectivity[8 * cell..8 * (cell + 1)].rotate_left(4);
    }
    let mesh = Mesh::new(mesh.nodes().to_vec(), vec![block]).expect("valid");
    let spec = crate::common::spec(LawSpec::SaintVenantKirchhoff(elastic()));
    let message = Body::new(mesh, &spec).expect_err("inverted").to_string();
    assert!(message.starts_with("cell 1 with nodes ["), "{message}");
    assert!(message.contains("is inverted, and so are 1 more: [3]"), "{message}");
}
