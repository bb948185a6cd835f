//! The measure of penetration against depths that are known.

use std::slice::from_ref;

use carom_contact::{Boundaries, Obstacle, Penetration, RigidShape, Solid};
use carom_mesh::{CellBlock, CellKind, Mesh, Surface, Vector, generate};

fn block<const D: usize>(corner: [f64; D], size: [f64; D], divisions: [usize; D]) -> Mesh<D> {
    generate::grid(corner, size, divisions).expect("valid")
}

/// A fixed rotation, so that nothing lies along an axis.
fn turned<const D: usize>(x: &Vector<D>) -> Vector<D> {
    let mut y = *x;
    for (i, j, angle) in [(0, 1, 0.7_f64), (1, D - 1, 0.4), (0, D - 1, -1.1)] {
        if i != j {
            let (c, s) = (angle.cos(), angle.sin());
            (y[i], y[j]) = (c * y[i] - s * y[j], s * y[i] + c * y[j]);
        }
    }
    y
}

/// All that is found among these bodies, whose nodes are moved to their `place`, and obstacles.
fn measured<const D: usize>(
    meshes: &[Mesh<D>],
    obstacles: Vec<RigidShape<D>>,
    place: impl Fn(&Vector<D>) -> Vector<D>,
) -> Vec<Penetration<D>> {
    let mut firsts = Vec::new();
    let mut nodes = Vec::new();
    for mesh in meshes {
        firsts.push(nodes.len() as u32);
        nodes.extend(mesh.nodes());
    }
    let node = nodes.len() as u32;
    let obstacles: Vec<Obstacle<D>> =
        obstacles.into_iter().map(|shape| Obstacle::new(shape).numbered(node, node + 1)).collect();
    nodes.push(Vector::zeros());
    let surfaces: Vec<Surface> = meshes.iter().map(Surface::of).collect();
    let mut boundaries = Boundaries::new(surfaces.iter().zip(firsts), &obstacles, &|n| nodes[n as usize]);
    nodes[..node as usize].iter_mut().for_each(|x| *x = place(x));
    let mut all = Vec::new();
    boundaries.measure(&obstacles, |_| true, &|n| nodes[n as usize], |found| all.push(found));
    all
}

fn deepest<const D: usize>(found: &[Penetration<D>]) -> f64 {
    found.iter().map(|p| p.depth).fold(0.0, f64::max)
}

fn depth<const D: usize>(meshes: &[Mesh<D>], obstacles: Vec<RigidShape<D>>) -> f64 {
    deepest(&measured(meshes, obstacles, |x| *x))
}

#[track_caller]
fn close(a: f64, b: f64) {
    assert!((a - b).abs() < 1e-12, "{a} {b}");
}

#[test]
fn blocks_that_overlap_are_as_deep_in_one_another_as_drawn() {
    for (other, overlap) in [(2, 0.05), (3, 0.05), (3, 0.2), (7, 1e-9)] {
        let flat = [block([0.0; 2], [1.0; 2], [2; 2]), block([0.0, 1.0 - overlap], [1.0; 2], [other; 2])];
        let solid =
            [block([0.0; 3], [1.0; 3], [2; 3]), block([0.0, 0.0, 1.0 - overlap], [1.0; 3], [other; 3])];
        // Their sides are flush: only what is within is deep, here the middle of the end faces.
        let inset = [block([0.0; 2], [1.0; 2], [2; 2]), block([0.2, 1.0 - overlap], [0.6; 2], [other; 2])];
        close(deepest(&measured(&inset, vec![], turned)), overlap);
        close(depth(&flat, vec![]), overlap);
        close(deepest(&measured(&flat, vec![], turned)), overlap);
        close(depth(&solid, vec![]), overlap);
        close(deepest(&measured(&solid, vec![], turned)), overlap);
    }
}

#[test]
fn blocks_that_touch_are_not_in_one_another() {
    let inset = [block([0.0; 2], [1.0; 2], [2; 2]), block([0.3, 1.0], [0.5; 2], [3; 2])];
    let solid = [block([0.0; 3], [1.0; 3], [2; 3]), block([0.0, 0.0, 1.0], [1.0; 3], [3; 3])];
    let beside = [block([0.0; 2], [1.0; 2], [2; 2]), block([1.0 + 1e-6, -3.0], [1.0, 9.0], [1; 2])];
    assert!(depth(&inset, vec![]) < 1e-15 && depth(&solid, vec![]) < 1e-15);
    assert!(deepest(&measured(&inset, vec![], turned)) < 1e-15);
    assert!(deepest(&measured(&solid, vec![], turned)) < 1e-15);
    assert!(measured(&beside, vec![], |x| *x).is_empty());
}

/// Symptom guarded against: a plate impaled on a post, of which no node is inside the other.
#[test]
fn bars_that_cross_without_a_node_inside_are_found() {
    let flat = [block([-2.0, -0.1], [4.0, 0.2], [1; 2]), block([-0.2, -2.0], [0.4, 4.0], [1; 2])];
    close(depth(&flat, vec![]), 0.2);
    let solid = [
        block([-2.0, -0.1, -0.1], [4.0, 0.2, 0.2], [1; 3]),
        block([-0.2, -2.0, 0.0], [0.4, 4.0, 0.4], [1; 3]),
    ];
    // The upper edges of the first run 0.1 above the lower side of the second.
    close(depth(&solid, vec![]), 0.1);
    let post = RigidShape::Box { corner: Vector::<2>::new(-0.2, -2.0), size: Vector::<2>::new(0.4, 2.05) };
    close(depth(&flat[..1], vec![post]), 0.15);
    let post = RigidShape::Box {
        corner: Vector::<3>::new(-0.2, -0.05, -2.0),
        size: Vector::<3>::new(0.4, 0.1, 2.05),
    };
    close(depth(&solid[..1], vec![post]), 0.05);
}

/// Symptom guarded against: an indenter of the radius of five cells ended a run as intersecting, before a node had touched it.
#[test]
fn a_round_obstacle_may_bulge_into_a_facet_that_is_not_larger_than_its_radius() {
    let arcs = |radius: f64| {
        let ball = RigidShape::Sphere { centre: [0.5, 1.0 + radius - 0.01].into(), radius, cavity: false };
        let found = measured(&[block([0.0; 2], [1.0; 2], [1; 2])], vec![ball], |x| *x);
        assert_eq!(found.len(), 1);
        close(found[0].depth, 0.01);
        found[0].arcs
    };
    close(arcs(1.0), 0.125);
    close(arcs(5.0), 0.025);
    assert_eq!(arcs(0.9), 0.0);
}

/// Symptom guarded against: what pressed a round side in so far that its facets turned by more than a corner does was said to be deeper in it
/// than allowed, though it touched the curve that the facets stand for.
#[test]
fn a_side_that_was_round_or_flat_has_no_corner_where_it_is_folded() {
    let post = || RigidShape::Box { corner: Vector::<2>::new(0.2, 0.75), size: Vector::<2>::new(0.02, 1.0) };
    let dented =
        |x: &Vector<2>| if *x == Vector::<2>::new(0.5, 1.0) { Vector::<2>::new(0.5, 0.5) } else { *x };
    let found = measured(&[block([0.0; 2], [1.0; 2], [2, 1])], vec![post()], dented);
    close(deepest(&found), 0.05 * 0.5_f64.sqrt());
    close(found[0].arcs, 0.5_f64.sqrt() * std::f64::consts::FRAC_PI_2 / 8.0);
    let corner = RigidShape::Box { corner: Vector::<2>::new(0.95, 0.98), size: Vector::<2>::new(1.0, 1.0) };
    let found = measured(&[block([0.0; 2], [1.0; 2], [2, 1])], vec![corner], |x| *x);
    assert!(!found.is_empty() && found.iter().all(|p| p.arcs == 0.0));
}

/// Symptom guarded against: a rod that is thinner than a facet went through it, and nothing said so.
#[test]
fn a_thin_rod_through_a_facet_is_as_deep_as_it_is_thick() {
    let rod = |x: f64, slope: f64| RigidShape::Cylinder {
        point: Vector::<3>::new(x, 0.3, 5.0),
        axis: Vector::<3>::new(slope, 0.0, 1.0).normalize(),
        radius: 0.05,
        cavity: false,
    };
    for cells in [1, 2] {
        let cube = [block([0.0; 3], [1.0; 3], [cells; 3])];
        close(depth(&cube, vec![rod(0.3, 0.0)]), 0.05);
        close(depth(&cube, vec![rod(0.3, -0.05)]), 0.05);
        assert_eq!(depth(&cube, vec![rod(1.06, 0.0)]), 0.0);
    }
}

#[test]
fn a_ball_is_found_between_the_nodes_that_it_presses_into() {
    let plate = [block([-1.0, -1.0, 0.0], [2.0, 2.0, 0.5], [1; 3])];
    let ball = RigidShape::Sphere { centre: Vector::<3>::new(0.1, 0.2, 0.97), radius: 0.5, cavity: false };
    close(depth(&plate, vec![ball]), 0.03);
    let rod = [block([-1.0, 0.0], [2.0, 0.5], [1; 2])];
    let disc = RigidShape::Sphere { centre: Vector::<2>::new(0.1, 0.97), radius: 0.5, cavity: false };
    close(depth(&rod, vec![disc]), 0.03);
    let floor = RigidShape::Plane { point: Vector::<2>::new(0.0, 0.02), normal: Vector::<2>::new(0.0, 1.0) };
    close(depth(&rod, vec![floor]), 0.02);
}

/// A strip of unit length along a curve.
fn strip(cells: usize, width: f64, curve: impl Fn(f64) -> [f64; 2]) -> Mesh<2> {
    let flat = block([0.0, -0.5], [1.0, 1.0], [cells, 1]);
    let nodes = flat.nodes().iter().map(|x| {
        let [p, q] = [curve(x[0] - 1e-4), curve(x[0] + 1e-4)];
        let along = Vector::<2>::new(q[0] - p[0], q[1] - p[1]).normalize();
        let middle = curve(x[0]);
        Vector::<2>::new(middle[0] - along[1] * width * x[1], middle[1] + along[0] * width * x[1])
    });
    let blocks =
        flat.blocks().iter().map(|b| CellBlock { kind: b.kind, connectivity: b.connectivity.clone() });
    Mesh::new(nodes.collect(), blocks.collect()).expect("valid")
}

#[test]
fn a_strip_that_goes_through_itself_is_told_and_one_that_does_not_is_not() {
    use std::f64::consts::TAU;
    // One turn and a fifth of a spiral, whose turns are less apart than the strip is wide by `overlap`.
    let spiral = |overlap: f64| {
        move |s: f64| {
            let (angle, radius) = (1.2 * TAU * s, 1.0 + (0.1 - overlap) * 1.2 * s);
            [radius * angle.cos(), radius * angle.sin()]
        }
    };
    for (cells, overlap) in [(60, 0.02), (75, 0.02), (200, 0.05)] {
        let found = measured(&[strip(cells, 0.1, spiral(overlap))], vec![], |x| *x);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].between, [Solid::Body(0); 2]);
        assert!((found[0].depth / overlap - 1.0).abs() < 0.1, "{cells} {overlap}: {:?}", found[0]);
        assert!(measured(&[strip(cells, 0.1, spiral(-0.02))], vec![], |x| *x).is_empty());
    }
}

/// Symptom guarded against: a crushed ring whose halves touched was said to be as deep in itself as its wall is thick.
#[test]
fn parts_that_touch_are_not_in_one_another() {
    for overlap in [0.0, 1e-12, 1e-9, 1e-3] {
        // Two arms of three cells, one on the other, that hang together in their first cell.
        let row = |y: f64| (0..4).map(move |i| Vector::<2>::new(f64::from(i), y));
        let mut nodes: Vec<_> = row(0.0).chain(row(1.0)).chain(row(2.0)).collect();
        nodes.extend([2.0, 3.0].map(|x| Vector::<2>::new(x, 1.0 - overlap)));
        let lower = [[0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6]];
        let upper = [[4, 5, 9, 8], [5, 12, 10, 9], [12, 13, 11, 10]];
        let connectivity = lower.into_iter().chain(upper).flatten().collect();
        let arms = Mesh::new(nodes, vec![CellBlock { kind: CellKind::Quad4, connectivity }]).expect("valid");
        let found = measured(&[arms], vec![], |x| *x);
        let deepest = found.iter().map(|f| f.depth).fold(0.0, f64::max);
        assert!((deepest - overlap).abs() <= 1e-9, "{overlap:e}: {found:?}");
    }
}

#[test]
fn second_order_boundaries_are_measured_by_their_curves() {
    // The upper side of the cell is the parabola y = 1.1 − 0.1 x².
    let curved = curved_cell([6, 2], [0.1, 0.0]);
    let parabola = |x: f64| 1.1 - 0.1 * x * x;
    let corner = [0.2, parabola(0.2) - 0.01];
    let found = depth(&[curved, block(corner, [0.1, 1.0], [1; 2])], vec![]);
    let way = |s: f64| (s - corner[0]).hypot(parabola(s) - corner[1]);
    let closest = (0..=100_000).map(|k| way(0.15 + 1e-6 * f64::from(k))).fold(f64::INFINITY, f64::min);
    assert!((found - closest).abs() < 1e-9, "{found} {closest}");
}

/// A cell of second order with sides of length 2 about the origin, the middle and the right end of one side moved by these heights [m].
fn curved_cell(side: [usize; 2], heights: [f64; 2]) -> Mesh<2> {
    let mut x = [
        [-1.0, -1.0],
        [1.0, -1.0],
        [1.0, 1.0],
        [-1.0, 1.0],
        [0.0, -1.0],
        [1.0, 0.0],
        [0.0, 1.0],
        [-1.0, 0.0],
    ];
    side.iter().zip(heights).for_each(|(&node, height)| x[node][1] += height);
    let cell = CellBlock { kind: CellKind::Quad8, connectivity: (0..8).collect() };
    Mesh::new(x.map(|x| Vector::<2>::new(x[0], x[1])).to_vec(), vec![cell]).expect("valid")
}

/// Symptom guarded against: where two parts of second order met, nothing was told of 0.2 mm.
#[test]
fn a_curved_side_is_in_another_body_between_its_nodes() {
    // Above the parabola y = 1.1 − 0.1 x² at all its nodes and below it between 0.55 and 0.95, by 0.004 at most.
    let line = |x: f64| 1.152_25 - 0.15 * x;
    let corners = [[0.5, line(0.5)], [2.5, line(2.5)], [2.5, 3.0], [0.5, 3.0]];
    let cell = CellBlock { kind: CellKind::Quad4, connectivity: (0..4).collect() };
    let above = Mesh::new(corners.map(|x| Vector::<2>::new(x[0], x[1])).to_vec(), vec![cell]).expect("valid");
    let expected = 0.004 / 1.0_f64.hypot(0.15);
    for bodies in [[curved_cell([6, 2], [0.1, 0.0]), above.clone()], [above, curved_cell([6, 2], [0.1, 0.0])]]
    {
        let found = depth(&bodies, vec![]);
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    }
}

#[test]
fn a_curved_side_is_in_a_floor_between_its_nodes() {
    // Heights of 0, 0 and h at its nodes: −h / 8 at a quarter.
    let floor = RigidShape::Plane { point: Vector::<2>::new(0.0, -1.0), normal: Vector::<2>::new(0.0, 1.0) };
    let found = depth(&[curved_cell([4, 1], [0.0, 0.08])], vec![floor]);
    assert!((found - 0.01).abs() < 1e-14, "{found}");
}

/// Into how many parts a motion of two blocks against one another is cut, however the two are turned.
fn parts_of_a_passage(aside: f64, angle: f64) -> usize {
    let (c, s) = (angle.cos(), angle.sin());
    let turned = |x: Vector<2>| Vector::<2>::new(c * x[0] - s * x[1], s * x[0] + c * x[1]);
    let bodies = [block([0.0, 0.0], [0.2, 0.2], [2, 2]), block([1.0, aside], [0.1, 1.0], [1, 5])];
    let surfaces = bodies.each_ref().map(Surface::of);
    let first = bodies[0].nodes().len();
    let x: Vec<Vector<2>> = bodies.iter().flat_map(|mesh| mesh.nodes()).map(|x| turned(*x)).collect();
    let way = turned(Vector::<2>::new(1.49, 0.0));
    let start = |n: u32| x[n as usize];
    let end = |n: u32| if (n as usize) < first { x[n as usize] + way } else { x[n as usize] };
    let boundaries = Boundaries::<2>::new(surfaces.iter().zip([0, first as u32]), &[], &start);
    boundaries.parts(1.5, &[], |_| true, &start, &end)
}

#[test]
fn a_motion_is_cut_into_as_many_parts_whichever_way_it_goes() {
    // Halves of a cell of 0.1 in a way of 1.49.
    for angle in [0.0, 0.3, 0.8, 2.1] {
        assert_eq!(parts_of_a_passage(-0.4, angle), 30);
        assert_eq!(parts_of_a_passage(2.0, angle), 1);
    }
}

/// Symptom guarded against: chords between the nodes of a hollow side were in a box that lay in the hollow, and the run failed.
#[test]
fn what_lies_in_the_hollow_of_a_curved_side_is_not_in_it() {
    // The upper side is the parabola y = 0.9 + 0.1 x², up to 0.936 at 0.6, where its chord is at 0.96.
    let hollow = curved_cell([6, 2], [-0.1, 0.0]);
    let shape = RigidShape::Box { corner: Vector::<2>::new(0.4, 0.94), size: Vector::<2>::new(0.2, 0.2) };
    assert_eq!(depth(from_ref(&hollow), vec![shape]), 0.0);
    assert_eq!(depth(&[hollow, block([0.4, 0.94], [0.2; 2], [1; 2])], vec![]), 0.0);
}

/// Symptom guarded against: a ball that a body was drawn around, with no node in it, was not seen.
#[test]
fn a_ball_within_a_body_is_found_without_a_node_in_it() {
    let ball =
        |x: f64| RigidShape::Sphere { centre: Vector::<3>::new(x, 0.5, 0.5), radius: 0.1, cavity: false };
    let disc = |x: f64| RigidShape::Sphere { centre: Vector::<2>::new(x, 0.5), radius: 0.1, cavity: false };
    for x in [0.3, 0.45, 0.5] {
        close(depth(&[block([0.0; 3], [1.0; 3], [1; 3])], vec![ball(x)]), x + 0.1);
        close(depth(&[block([0.0; 2], [1.0; 2], [3; 2])], vec![disc(x)]), x + 0.1);
    }
    assert_eq!(depth(&[block([0.0; 2], [1.0; 2], [3; 2])], vec![disc(1.2)]), 0.0);
}

/// Symptom guarded against: a ball of 3 mm was let into a wall of 4 mm by a share of its facets, which were half a metre long.
#[test]
fn a_depth_is_judged_by_the_wall_and_by_what_is_in_it() {
    let plate = [block([0.0; 2], [1.0, 4e-3], [2, 1])];
    let shot = |size: f64| RigidShape::Box {
        corner: Vector::<2>::new(0.13, 3e-3),
        size: Vector::<2>::new(size, size),
    };
    let cell =
        |size: f64| measured(&plate, vec![shot(size)], |x| *x).iter().map(|p| p.cell).fold(1.0, f64::min);
    close(cell(3e-3), 3e-3);
    close(cell(9e-3), 4e-3);
    let pressed = [plate[0].clone(), block([0.1, 3.9e-3], [0.5, 0.5], [1; 2])];
    let found = measured(&pressed, vec![], |x| *x);
    close(found.iter().map(|p| p.cell).fold(1.0, f64::min), 4e-3);
}

/// Two blocks of one mesh, the second moved by an offset.
fn two_parts<const D: usize>(offset: [f64; D]) -> Mesh<D> {
    let part = block([0.0; D], [1.0; D], [3; D]);
    let count = part.nodes().len() as u32;
    let offset = Vector::<D>::from(offset);
    let nodes = part.nodes().iter().copied().chain(part.nodes().iter().map(|x| x + offset)).collect();
    let blocks = part.blocks().iter().map(|b| {
        let again = b.connectivity.iter().map(|n| n + count);
        CellBlock { kind: b.kind, connectivity: b.connectivity.iter().copied().chain(again).collect() }
    });
    Mesh::new(nodes, blocks.collect()).expect("valid")
}

/// Symptom guarded against: of two blocks in one mesh the upper one lay flush on the lower one, and edges that went through its side by round-off
/// were told to be as deep as they reach beyond it.
#[test]
fn parts_of_a_body_that_lie_flush_on_one_another_are_not_in_one_another() {
    for aside in [0.0, 0.13, 0.3, 0.8] {
        for sunk in [0.0, 1e-14, 1e-12] {
            let flat = two_parts([aside, 1.0 - sunk]);
            assert!(depth(from_ref(&flat), vec![]) < 2e-12, "{aside} {sunk:e}");
            assert!(deepest(&measured(&[flat], vec![], turned)) < 2e-12, "{aside} {sunk:e}");
            let solid = two_parts([aside, 0.07, 1.0 - sunk]);
            assert!(depth(from_ref(&solid), vec![]) < 2e-12, "{aside} {sunk:e}");
            assert!(deepest(&measured(&[solid], vec![], turned)) < 2e-12, "{aside} {sunk:e}");
        }
    }
}

/// Edges that cross, of which no node is inside, are as deep as what they leave of one another.
#[test]
fn edges_of_one_body_that_go_through_one_another_are_told() {
    let bar = |corner: [f64; 3], size: [f64; 3]| block(corner, size, [1; 3]);
    let (along, across) = (bar([-2.0, -0.1, 0.0], [4.0, 0.2, 0.2]), bar([-0.1, -2.0, 0.17], [0.2, 4.0, 0.2]));
    let count = along.nodes().len() as u32;
    let nodes = along.nodes().iter().chain(across.nodes()).copied().collect();
    let connectivity = (along.blocks()[0].connectivity.iter().copied())
        .chain(across.blocks()[0].connectivity.iter().map(|n| n + count))
        .collect();
    let cross = Mesh::new(nodes, vec![CellBlock { kind: CellKind::Hex8, connectivity }]).expect("valid");
    // They are asked just before themselves, by a millionth of a facet.
    let found = [depth(from_ref(&cross), vec![]), deepest(&measured(&[cross], vec![], turned))];
    assert!(found.iter().all(|depth| (depth - 0.03).abs() < 4e-6), "{found:?}");
}
