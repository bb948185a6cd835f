//! Mortar rows: means over surfaces that do not match, exact for uniform pressures, linear motions and plane gaps.

use carom_contact::{
    Candidate, Contact, ContactModel, ContactSurface, Discretisation, Mortar, Pair, Path, Target,
};
use carom_mesh::{CellBlock, CellKind, Mesh, Surface, Vector, generate, tensor};

/// A source and, behind its nodes, a target, as one mortar pair.
struct Scene<const D: usize> {
    model: ContactModel<D>,
    nodes: Vec<Vector<D>>,
    /// Number of nodes of the source.
    sources: usize,
}

impl<const D: usize> Scene<D> {
    fn new(source: &Mesh<D>, target: &Mesh<D>) -> Self {
        let sources = source.nodes().len();
        let nodes: Vec<Vector<D>> = source.nodes().iter().chain(target.nodes()).copied().collect();
        let at = |n: u32| nodes[n as usize];
        let surfaces = vec![
            ContactSurface::new(&Surface::of(source), 0, &at).sided(&at),
            ContactSurface::new(&Surface::of(target), sources as u32, &at),
        ];
        let pair = Pair {
            source: 0,
            target: Target::Surface(1),
            friction: 0.3,
            discretisation: Discretisation::Mortar,
        };
        let model = ContactModel { surfaces, obstacles: vec![], pairs: vec![pair].into() };
        Self { model, nodes, sources }
    }

    /// The contacts within `margin` [m] where the nodes are at `nodes`, and their candidates.
    fn contacts(&self, nodes: &[Vector<D>], margin: f64) -> (Vec<Candidate>, Vec<Contact<D>>) {
        let at = |n: u32| nodes[n as usize];
        let (mut mortar, mut candidates, mut contacts) = (Mortar::default(), Vec::new(), Vec::new());
        self.model.detect_mortar(&Path::resting(&at, margin), &mut mortar, &mut candidates);
        self.model.evaluate_all(&candidates, &at, &mut mortar, &mut contacts);
        (candidates, contacts)
    }

    /// The nodal forces of a uniform pressure of 1 Pa.
    fn uniform_pressure(&self) -> Vec<Vector<D>> {
        let mut force = vec![Vector::zeros(); self.nodes.len()];
        let mut unit = Vector::zeros();
        unit[0] = 1.0;
        for contact in self.contacts(&self.nodes, 0.1).1 {
            contact.add_force(&(unit * contact.area), &mut force);
        }
        force
    }
}

/// A block above, or below, the plane of the last coordinate 0.
fn block<const D: usize>(corner: [f64; D], size: [f64; D], divisions: [usize; D]) -> Mesh<D> {
    generate::grid(corner, size, divisions).expect("valid")
}

/// The mesh with its nodes moved.
fn mapped<const D: usize>(mesh: &Mesh<D>, map: impl Fn(&Vector<D>) -> Vector<D>) -> Mesh<D> {
    Mesh::new(mesh.nodes().iter().map(map).collect(), mesh.blocks().to_vec()).expect("valid")
}

/// Six tetrahedra along a diagonal for every cube (Kuhn).
fn tetrahedra(mesh: &Mesh<3>) -> Mesh<3> {
    const CORNER: [usize; 8] = [0, 1, 3, 2, 4, 5, 7, 6];
    let mut connectivity = Vec::new();
    for cell in mesh.blocks()[0].cells() {
        for [i, j, k] in [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]] {
            let path = [0, 1 << i, (1 << i) | (1 << j), (1 << i) | (1 << j) | (1 << k)];
            let mut tet = path.map(|bits: usize| cell[CORNER[bits]]);
            let x = tet.map(|n| mesh.nodes()[n as usize]);
            if (x[1] - x[0]).cross(&(x[2] - x[0])).dot(&(x[3] - x[0])) < 0.0 {
                tet.swap(2, 3);
            }
            connectivity.extend(tet);
        }
    }
    let cells = CellBlock { kind: CellKind::Tet4, connectivity };
    Mesh::new(mesh.nodes().to_vec(), vec![cells]).expect("valid")
}

/// ∫ N over the side x_last = 0 of a block, for every node.
fn consistent_load<const D: usize>(mesh: &Mesh<D>) -> Vec<f64> {
    let mut load = vec![0.0; mesh.nodes().len()];
    for facet in Surface::of(mesh).facets() {
        if facet.nodes.iter().all(|&n| mesh.nodes()[n as usize][D - 1].abs() < 1e-12) {
            let share = facet.area_vector(mesh).norm() / facet.nodes.len() as f64;
            facet.nodes.iter().for_each(|&n| load[n as usize] += share);
        }
    }
    load
}

/// Blocks on the unit square that do not match, of hexahedra and of tetrahedra, in all combinations.
fn blocks_in_space() -> Vec<Scene<3>> {
    let upper = block([0.0; 3], [1.0; 3], [3, 4, 1]);
    let lower = block([0.0, 0.0, -1.0], [1.0; 3], [4, 3, 1]);
    let [upper_tets, lower_tets] = [&upper, &lower].map(tetrahedra);
    [(&upper, &lower), (&upper, &lower_tets), (&upper_tets, &lower), (&upper_tets, &lower_tets)]
        .map(|(a, b)| Scene::new(a, b))
        .into()
}

/// Forces of a uniform pressure on blocks with the same side: those of the pressure itself, on both.
fn assert_consistent<const D: usize>(scene: &Scene<D>, source: &Mesh<D>, target: &Mesh<D>) {
    let force = scene.uniform_pressure();
    let loads = consistent_load(source).into_iter().chain(consistent_load(target).into_iter().map(|l| -l));
    for (f, load) in force.iter().zip(loads) {
        let expected = Vector::<D>::from_fn(|i, _| if i == D - 1 { load } else { 0.0 });
        assert!((f - expected).norm() < 1e-15, "{f} and not {load}");
    }
}

#[test]
fn uniform_pressure_loads_both_sides_consistently() {
    for (n, m) in [(1, 1), (3, 4), (5, 2), (7, 7)] {
        let upper = block([0.0, 0.0], [1.0, 1.0], [n, 1]);
        let lower = block([0.0, -1.0], [1.0, 1.0], [m, 1]);
        assert_consistent(&Scene::new(&upper, &lower), &upper, &lower);
    }
    let upper = block([0.0; 3], [1.0; 3], [3, 4, 1]);
    let lower = block([0.0, 0.0, -1.0], [1.0; 3], [4, 3, 1]);
    let (upper_tets, lower_tets) = (tetrahedra(&upper), tetrahedra(&lower));
    for (a, b) in [(&upper, &lower), (&upper, &lower_tets), (&upper_tets, &lower), (&upper_tets, &lower_tets)]
    {
        assert_consistent(&Scene::new(a, b), a, b);
    }
}

/// The nodal forces of 1 Pa on a disc of radius 1, ∫ 2πr N dr, are πh²k·2 at r = kh and a third of πh² on the axis.
#[test]
fn uniform_pressure_on_bodies_of_revolution_acts_on_circles() {
    let upper = block([0.0, 0.0], [1.0, 1.0], [4, 1]);
    let lower = block([0.0, -1.0], [1.0, 1.0], [3, 1]);
    let mut scene = Scene::new(&upper, &lower);
    scene.model.surfaces = scene.model.surfaces.into_iter().map(ContactSurface::revolved).collect();
    let force = scene.uniform_pressure();
    let count = upper.nodes().len();
    for (range, h, sign) in [(0..count, 0.25, 1.0), (count..scene.nodes.len(), 1.0 / 3.0, -1.0)] {
        let mut total = 0.0;
        for n in range {
            let x = scene.nodes[n];
            if x[1] != 0.0 {
                continue;
            }
            let load = std::f64::consts::PI
                * match x[0] {
                    0.0 => h * h / 3.0,
                    1.0 => h * (1.0 - h / 3.0),
                    r => 2.0 * h * r,
                };
            total += load;
            assert!(
                (force[n] - Vector::<2>::new(0.0, sign * load)).norm() < 1e-14,
                "{} and not {load}",
                force[n]
            );
        }
        assert!((total - std::f64::consts::PI).abs() < 1e-14, "{total}");
    }
}

/// Whichever side reaches beyond the other, and at any angle: the side that is wholly covered has the forces of the pressure, and
/// the other the same resultant in the same place.
#[test]
fn uniform_pressure_is_exact_where_one_side_reaches_beyond_the_other() {
    let small = block([0.0; 3], [1.0; 3], [3, 4, 1]);
    let wide = block([-1.0, -0.7, -1.0], [3.1, 2.4, 1.0], [4, 3, 1]);
    let (s, c) = 0.4_f64.sin_cos();
    let turned =
        mapped(&wide, |x| Vector::<3>::new(c * x[0] - s * x[1] + 0.2, s * x[0] + c * x[1] - 0.3, x[2]));
    let turned_tets = tetrahedra(&turned);
    for other in [&turned, &turned_tets] {
        let upside_down = |mesh: &Mesh<3>| mapped(mesh, |x| Vector::<3>::new(x[0], -x[1], -x[2]));
        let (up, down) = (upside_down(other), upside_down(&small));
        for (scene, covered, range) in [
            (Scene::new(&small, other), &small, 0..small.nodes().len()),
            (Scene::new(&up, &down), &down, up.nodes().len()..up.nodes().len() + down.nodes().len()),
        ] {
            let force = scene.uniform_pressure();
            for (f, load) in force[range].iter().zip(consistent_load(covered)) {
                assert!((f[2].abs() - load).abs() < 1e-14, "{f} and not {load}");
            }
            let total: Vector<3> = force.iter().sum();
            let moment = force.iter().zip(&scene.nodes).fold([0.0; 3], |mut sum, (f, x)| {
                let m = tensor::cross(x, f);
                (0..3).for_each(|i| sum[i] += m[i]);
                sum
            });
            assert!(total.norm() < 1e-14, "{total}");
            assert!(moment.iter().all(|m| m.abs() < 1e-13), "{moment:?}");
        }
    }
}

/// ∫ N n over the sides of a body in the planes x_i = 0, along the axis of every side.
fn load_on_walls<const D: usize>(mesh: &Mesh<D>) -> Vec<Vector<D>> {
    let mut load = vec![Vector::zeros(); mesh.nodes().len()];
    for facet in Surface::of(mesh).facets() {
        let is_on = |i: &usize| facet.nodes.iter().all(|&n| mesh.nodes()[n as usize][*i] == 0.0);
        if let Some(i) = (0..D).find(is_on) {
            let share = facet.area_vector(mesh).norm() / facet.nodes.len() as f64;
            facet.nodes.iter().for_each(|&n| load[n as usize][i] += share);
        }
    }
    load
}

/// A block of this many cells a side in the inner corner of another, which is larger by its own size and lacks the quadrant of the first.
fn corner_in_corner<const D: usize>(own: usize, other: usize) {
    let source = block([0.0; D], [1.0; D], [own; D]);
    let whole = block([-1.0; D], [2.0; D], [2 * other; D]);
    let is_left = |cell: &&[u32]| {
        let centre: Vector<D> = cell.iter().map(|&n| whole.nodes()[n as usize]).sum();
        centre.iter().any(|&x| x < 0.0)
    };
    let CellBlock { kind, .. } = whole.blocks()[0];
    let connectivity: Vec<u32> = whole.blocks()[0].cells().filter(is_left).flatten().copied().collect();
    let mut kept = connectivity.clone();
    kept.sort_unstable();
    kept.dedup();
    let number = |n: &u32| kept.binary_search(n).expect("kept") as u32;
    let connectivity = connectivity.iter().map(number).collect();
    let nodes = kept.iter().map(|&n| whole.nodes()[n as usize]).collect();
    let target = Mesh::new(nodes, vec![CellBlock { kind, connectivity }]);
    let target = target.expect("an angle");
    let scene = Scene::new(&source, &target);
    let force = scene.uniform_pressure();
    let loads = load_on_walls(&target).into_iter().map(|load| -load);
    for (k, (f, load)) in force.iter().zip(load_on_walls(&source).into_iter().chain(loads)).enumerate() {
        assert!((f - load).norm() < 1e-14, "node {k}: {f} and not {load}");
    }
    let corners = scene.contacts(&scene.nodes, 0.1).0.iter().filter(|c| c.node() == Some(0)).count();
    assert_eq!(corners, D, "the corner has a multiplier on every side");
}

/// Each side of a corner has the forces of its own pressure, in the plane and in space; one multiplier there would have the resultant of the
/// mean of their normals.
#[test]
fn uniform_pressure_in_an_inner_corner_loads_every_side_consistently() {
    for (own, other) in [(1, 1), (3, 2), (2, 3)] {
        corner_in_corner::<2>(own, other);
        corner_in_corner::<3>(own, other);
    }
}

/// A block on a corner is turned until its second side comes to face the ground, as it does from 30° on: nothing happens to the rows of the first.
#[test]
fn rows_beside_a_corner_do_not_leap_when_its_other_side_comes_to_face_the_target() {
    let ground = block([-3.0, -1.0], [6.0, 1.0], [7, 1]);
    let upright = block([0.0, 0.0], [1.0, 1.0], [4, 4]);
    let scene = Scene::new(&upright, &ground);
    let rows = |turn: f64| {
        let (s, c) = turn.sin_cos();
        let turned = |x: &Vector<2>| Vector::<2>::new(c * x[0] - s * x[1], s * x[0] + c * x[1]);
        let (own, other) = scene.nodes.split_at(scene.sources);
        let nodes: Vec<Vector<2>> = own.iter().map(turned).chain(other.iter().copied()).collect();
        let (candidates, contacts) = scene.contacts(&nodes, 1.0);
        candidates.into_iter().zip(contacts).collect::<Vec<_>>()
    };
    let before = rows(29.99_f64.to_radians());
    let after = rows(30.01_f64.to_radians());
    assert!(before.len() < after.len(), "the second side faces the ground: {} rows", after.len());
    for (candidate, contact) in &before {
        let (_, there) = after.iter().find(|(other, _)| other == candidate).expect("still there");
        // The gap is x tan of the turn at x ≤ 1 m along the side: 0.02° more make it 4.7e-4 m larger.
        assert!((there.gap - contact.gap).abs() < 4.7e-4, "{candidate:?}: {} {}", contact.gap, there.gap);
        assert!((there.frame - contact.frame).norm() < 1e-3, "{candidate:?}");
    }
}

#[test]
fn rows_know_the_distance_of_planes_and_no_rigid_motion() {
    for scene in blocks_in_space() {
        let h = 0.05;
        let lifted: Vec<Vector<3>> = (0..)
            .zip(&scene.nodes)
            .map(|(n, x)| if n < scene.sources { x + Vector::<3>::new(0.0, 0.0, h) } else { *x })
            .collect();
        let (candidates, contacts) = scene.contacts(&lifted, 0.1);
        assert_eq!(candidates.len(), 20, "the nodes of the lower side, and none of the others");
        for contact in &contacts {
            assert!((contact.gap - h).abs() < 1e-15, "{}", contact.gap);
            assert!((contact.frame.row(0).transpose() - Vector::<3>::new(0.0, 0.0, 1.0)).norm() < 1e-15);
            assert!(contact.sources().all(|(n, weight)| n < scene.sources && weight >= 0.0));
            assert!(contact.targets().all(|(n, weight)| n >= scene.sources && weight <= 0.0));
            let rigid = contact.relative(|_| Vector::<3>::new(0.3, -0.7, 0.2));
            assert!(rigid.norm() < 1e-15, "{rigid}");
        }
        // About any axis, where the sides coincide.
        for contact in &scene.contacts(&scene.nodes, 0.1).1 {
            let turning = |n: usize| tensor::rotation_velocity(&[0.4, -0.2, 0.9], &scene.nodes[n]);
            assert!(contact.relative(turning).norm() < 1e-14);
        }
        let area: f64 = contacts.iter().map(|c| c.area).sum();
        assert!((area - 1.0).abs() < 1e-14, "{area}");
    }
}

/// The common part is what multipliers see: here the half of the source.
#[test]
fn multipliers_beyond_the_edge_of_the_target_have_no_row() {
    let upper = block([0.0, 0.0], [1.0, 1.0], [4, 1]);
    for (end, rows, covered) in [(0.5, 3, 0.5), (0.6, 4, 0.6), (0.5 - 1e-10, 3, 0.5), (0.5 + 1e-13, 3, 0.5)] {
        let lower = block([-1.0, -1.0], [1.0 + end, 1.0], [3, 1]);
        let scene = Scene::new(&upper, &lower);
        let (candidates, contacts) = scene.contacts(&scene.nodes, 0.1);
        assert_eq!(candidates.len(), rows, "{end}");
        let area: f64 = contacts.iter().map(|c| c.area).sum();
        assert!((area - covered).abs() < 1e-9, "{end}: {area}");
    }
}

/// A multiplier that the target leaves between the search and a later guess keeps the row that it had.
#[test]
fn a_row_outlives_the_cover_of_the_step() {
    let upper = block([0.0, 0.0], [1.0, 1.0], [4, 1]);
    let lower = block([-1.0, -1.0], [1.3, 1.0], [3, 1]);
    let scene = Scene::new(&upper, &lower);
    let at = |shift: f64| {
        let nodes = &scene.nodes;
        move |n: u32| nodes[n as usize] + Vector::<2>::new(if n < 10 { shift } else { 0.0 }, 0.0)
    };
    let (mut mortar, mut candidates, mut contacts) = (Mortar::default(), Vec::new(), Vec::new());
    scene.model.detect_mortar(&Path::resting(&at(0.0), 0.1), &mut mortar, &mut candidates);
    assert_eq!(candidates.len(), 3);
    scene.model.evaluate_all(&candidates, &at(0.1), &mut mortar, &mut contacts);
    assert_eq!(contacts.len(), 3);
    for contact in &contacts {
        assert!(contact.gap.abs() < 1e-15 && contact.area > 0.0);
        assert!((contact.sources().map(|(_, w)| w).sum::<f64>() - 1.0).abs() < 1e-14);
    }
}

/// Frictionless reactions on curved sides have a moment that falls with the second power of the size of the facets.
#[test]
fn moment_of_reactions_on_discs_falls_with_the_mesh() {
    let moment = |divisions: usize| {
        // The second disc is turned by an angle of its own, so that nothing is symmetric.
        let disc = |x: f64, turn: f64, divisions| {
            let disc = generate::Disc { centre: [0.0, 0.0], radius: 1.0, divisions, rings: None };
            let (s, c) = turn.sin_cos();
            mapped(&disc.quadrilaterals().expect("valid"), |y| {
                Vector::<2>::new(x + c * y[0] - s * y[1], s * y[0] + c * y[1])
            })
        };
        let apart = 2.0 - 0.3 / divisions as f64;
        let scene = Scene::new(&disc(0.0, 0.0, divisions), &disc(apart, 0.02, divisions + 2));
        let (_, contacts) = scene.contacts(&scene.nodes, 0.0);
        assert!(contacts.len() > 1, "{divisions}");
        let mut force = vec![Vector::zeros(); scene.nodes.len()];
        let mut total = 0.0;
        for contact in &contacts {
            let r = -contact.gap * contact.area;
            total += r;
            contact.add_force(&Vector::<2>::new(r, 0.0), &mut force);
        }
        let sum: f64 = force.iter().zip(&scene.nodes).map(|(f, x)| tensor::cross(x, f)[2]).sum();
        assert!(force.iter().sum::<Vector<2>>().norm() < 1e-15, "action and reaction");
        sum.abs() / total
    };
    let [coarse, fine] = [moment(16), moment(64)];
    println!("moment per force: {coarse:e} m with 16 divisions, {fine:e} m with 64");
    assert!(coarse < 1e-3 && fine < coarse / 8.0, "{coarse:e} {fine:e}");
}

/// The fastest change of a gap [m/rad] where a source turns by two radians about `centre`, in the plane of its last axes. Of rows that cover less than
/// a tenth of what the largest covers it is not asked: their means are of little.
fn fastest_change<const D: usize>(scene: &Scene<D>, centre: [f64; 2]) -> f64 {
    const STEP: f64 = 2e-3;
    let rows = |angle: f64| {
        let (sin, cos) = angle.sin_cos();
        let turned = |x: &Vector<D>| {
            let [a, b] = [x[D - 2] - centre[0], x[D - 1] - centre[1]];
            let mut y = *x;
            (y[D - 2], y[D - 1]) = (centre[0] + cos * a - sin * b, centre[1] + sin * a + cos * b);
            y
        };
        let nodes = scene.nodes.iter().enumerate();
        let nodes: Vec<_> = nodes.map(|(n, x)| if n < scene.sources { turned(x) } else { *x }).collect();
        let (candidates, contacts) = scene.contacts(&nodes, 10.0);
        let least = 0.1 * contacts.iter().map(|c| c.area).fold(0.0, f64::max);
        let all = candidates.into_iter().zip(contacts).filter(|(_, c)| c.area > least);
        all.map(|(candidate, c)| (candidate.site, c.gap)).collect::<Vec<_>>()
    };
    let mut fastest = 0.0_f64;
    let mut before = rows(0.0);
    for k in 1..=1000 {
        let after = rows(STEP * f64::from(k));
        for (site, gap) in &before {
            if let Some((_, then)) = after.iter().find(|(other, _)| other == site) {
                fastest = fastest.max((then - gap).abs() / STEP);
            }
        }
        before = after;
    }
    fastest
}

/// A facet that came to face another at a bound of angle, reach or depth made gaps leap.
#[test]
fn gaps_do_not_leap_as_bodies_turn_before_one_another() {
    let below = block([-1.0, -1.0], [2.0, 1.0], [5, 1]);
    let square = block([-0.4, 0.1], [0.8, 0.8], [3, 3]);
    let round = generate::Disc { centre: [0.0, 0.48], radius: 0.5, divisions: 4, rings: None };
    for above in [square, round.quadrilaterals().expect("valid")] {
        let fastest = fastest_change(&Scene::new(&above, &below), [0.0, 0.5]);
        assert!(fastest < 2.0, "{fastest} m/rad");
    }
    let below = block([-1.0, -1.0, -1.0], [2.0, 2.0, 1.0], [1, 5, 1]);
    let cube = block([-0.5, -0.4, 0.1], [1.0, 0.8, 0.8], [1, 3, 3]);
    let fastest = fastest_change(&Scene::new(&cube, &below), [0.0, 0.5]);
    assert!(fastest < 2.0, "{fastest} m/rad");
}
