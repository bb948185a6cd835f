//! Edges against edges in space: found where bodies meet with them, at the distance of the bodies, and nowhere else.

use carom_contact::{
    Candidate, Contact, ContactModel, ContactSurface, Discretisation, Pair, Path, Search, Target,
};
use carom_mesh::{CellBlock, CellKind, Matrix, Mesh, Surface, Tie, Vector, generate};

type Vector3 = Vector<3>;

/// Deterministic numbers in −1..1.
fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// A rotation drawn from `next`.
fn turn(next: &mut impl FnMut() -> f64) -> Matrix<3> {
    let axis = Vector3::from_fn(|_, _| next());
    rotation(&axis.normalize(), std::f64::consts::PI * next())
}

/// Rodrigues' formula.
fn rotation(axis: &Vector3, angle: f64) -> Matrix<3> {
    let k = axis.cross_matrix();
    Matrix::<3>::identity() + k * angle.sin() + k * k * (1.0 - angle.cos())
}

fn moved(mesh: &Mesh<3>, turn: &Matrix<3>, by: &Vector3) -> Mesh<3> {
    Mesh::new(mesh.nodes().iter().map(|x| turn * x + by).collect(), mesh.blocks().to_vec()).expect("valid")
}

/// A box around the origin.
fn cuboid(size: [f64; 3], cells: [usize; 3]) -> Mesh<3> {
    generate::grid(size.map(|s| -0.5 * s), size, cells).expect("valid")
}

/// Two bodies, each a source against the other, where they are.
struct Scene {
    model: ContactModel<3>,
    x: Vec<Vector3>,
    first_of_second: usize,
}

impl Scene {
    fn new(a: &Mesh<3>, b: &Mesh<3>) -> Self {
        let x: Vec<Vector3> = a.nodes().iter().chain(b.nodes()).copied().collect();
        let first_of_second = a.nodes().len();
        let reference = |n: u32| x[n as usize];
        let surface =
            |mesh: &Mesh<3>, first: usize| ContactSurface::new(&Surface::of(mesh), first as u32, &reference);
        let pair = |source: usize, target: usize| Pair {
            source,
            target: Target::Surface(target),
            friction: 0.0,
            discretisation: Discretisation::default(),
        };
        let surfaces = vec![surface(a, 0), surface(b, first_of_second)];
        let model = ContactModel { surfaces, obstacles: vec![], pairs: vec![pair(0, 1), pair(1, 0)].into() };
        Self { model, x, first_of_second }
    }

    /// The candidates within `margin`, with the second body moved `by`.
    fn found(&self, margin: f64, by: &Vector3) -> Vec<(Candidate, Contact<3>)> {
        let at = |n: u32| {
            self.x[n as usize] + if (n as usize) < self.first_of_second { Vector3::zeros() } else { *by }
        };
        let (mut search, mut out) = (Search::default(), Vec::new());
        self.model.detect(&Path::resting(&at, margin), &mut search, &mut out);
        assert!(out.is_sorted());
        let mut found: Vec<_> = out.into_iter().map(|c| (c, self.model.evaluate(&c, &at))).collect();
        found.retain(|(c, contact)| {
            contact.gap >= 0.0 || !self.model.is_beyond(c, contact, 1e-9, &at, &search)
        });
        found
    }

    fn crossings(&self, margin: f64, by: &Vector3) -> Vec<(Candidate, Contact<3>)> {
        let mut found = self.found(margin, by);
        found.retain(|(c, _)| c.node().is_none() && !c.redundant);
        found
    }
}

/// A box in space.
struct Turned {
    turn: Matrix<3>,
    centre: Vector3,
    half: Vector3,
}

impl Turned {
    fn nearest(&self, x: &Vector3) -> Vector3 {
        let local = self.turn.transpose() * (x - self.centre);
        self.turn * Vector3::from_fn(|i, _| local[i].clamp(-self.half[i], self.half[i])) + self.centre
    }

    fn corner(&self, k: usize) -> Vector3 {
        let sign = |i: usize| if k >> i & 1 == 0 { -self.half[i] } else { self.half[i] };
        self.turn * Vector3::from_fn(|i, _| sign(i)) + self.centre
    }

    /// From the nearest point of this box to that of another that is apart: one of them is on an edge of this one, where the distance is a
    /// convex function of the place, or a corner of the other.
    fn offset(&self, other: &Self) -> Vector3 {
        let edges =
            (0..8).flat_map(|k| (0..3).filter(move |i| k >> i & 1 == 0).map(move |i| [k, k | 1 << i]));
        let on_edges = edges.map(|ends| {
            let [a, b] = ends.map(|k| self.corner(k));
            let offset = |s: f64| {
                let x = a + (b - a) * s;
                other.nearest(&x) - x
            };
            let (mut low, mut high) = (0.0, 1.0);
            for _ in 0..100 {
                let [s, t] = [low + (high - low) / 3.0, high - (high - low) / 3.0];
                if offset(s).norm() < offset(t).norm() { high = t } else { low = s }
            }
            [0.5 * (low + high), 0.0, 1.0].map(offset)
        });
        let at_corners = (0..8).map(|k| other.corner(k) - self.nearest(&other.corner(k)));
        at_corners.chain(on_edges.flatten()).min_by(|a, b| a.norm().total_cmp(&b.norm())).expect("many")
    }
}

/// Boxes of one cell, turned at random, that come from somewhere to a hundredth of their size, and then into one another by as much.
/// What is found is as far apart as the boxes are, whether they meet with a corner and a face or with two edges; nothing is
/// found deeper inside than they are, and they are never without a hold.
#[test]
fn the_smallest_gap_is_the_distance_of_the_bodies() {
    let mut next = numbers(3);
    let half = Vector3::new(0.5, 0.35, 0.6);
    let shape = cuboid([1.0, 0.7, 1.2], [1; 3]);
    let origin = Vector3::zeros();
    let (mut edges, mut nodes, mut far) = (0, 0, 0);
    for _ in 0..400 {
        let (r, s) = (turn(&mut next), turn(&mut next));
        let from = Vector3::from_fn(|_, _| next()).normalize();
        let first = Turned { turn: r, centre: origin, half };
        let mut second = Turned { turn: s, centre: from * 4.0, half };
        for _ in 0..30 {
            let offset = first.offset(&second);
            second.centre -= from * ((offset.norm() - 0.01) / from.dot(&offset.normalize()));
        }
        let offset = first.offset(&second);
        let (d, along) = (offset.norm(), offset.normalize());
        let scene = Scene::new(&moved(&shape, &r, &origin), &moved(&shape, &s, &second.centre));
        let found = scene.found(0.05, &origin);
        let smallest = found.iter().map(|(c, at)| (c, at.gap)).min_by(|a, b| a.1.total_cmp(&b.1));
        let inside = scene.found(0.05, &(along * -0.02));
        assert!(inside.iter().any(|(c, at)| !c.redundant && at.gap < -0.1 * (0.02 - d)), "no hold");
        let crossings = || inside.iter().filter(|(c, _)| c.node().is_none());
        for (c, at) in crossings() {
            assert!(at.gap > 1.1 * (d - 0.02), "{c:?} is {} deep", at.gap);
        }
        match smallest {
            Some((c, gap)) if gap < d + 1e-9 && c.node().is_none() => {
                edges += 1;
                assert!(gap > d - 1e-9, "{gap} {d}");
                let stays = crossings().any(|(o, at)| o.site == c.site && (at.gap - d + 0.02).abs() < 1e-9);
                assert!(c.redundant || stays);
            }
            // A node before a corner or an edge is not as far in front of a facet as it is away.
            Some((_, gap)) if gap < d + 1e-9 => nodes += 1,
            _ => far += 1,
        }
    }
    println!(
        "{edges} with edges, {nodes} with a node, {far} with a node that does not see what it is close to"
    );
    assert!(edges > 100 && nodes > 100 && far < 4, "{edges} {nodes} {far}");
}

/// The normal row of the map from nodal to relative motion is the gradient of the gap, and the pair of forces has no moment.
#[test]
fn the_gap_changes_as_its_row_says() {
    let mut next = numbers(11);
    let up = rotation(&Vector3::x(), 0.25 * std::f64::consts::PI);
    let low = moved(&cuboid([3.0, 1.0, 1.0], [3, 1, 1]), &up, &Vector3::zeros());
    let across = rotation(&Vector3::z(), 1.3) * up;
    let high = moved(&cuboid([3.0, 1.0, 1.0], [3, 1, 1]), &across, &Vector3::new(0.1, 0.2, 1.45));
    let scene = Scene::new(&low, &high);
    let found = scene.crossings(0.1, &Vector3::zeros());
    let [(candidate, contact)] = &found[..] else { panic!("{found:?}") };
    assert!((contact.gap - (1.45 - 2.0_f64.sqrt())).abs() < 1e-12);
    let motion: Vec<Vector3> = scene.x.iter().map(|_| Vector3::from_fn(|_, _| next())).collect();
    let gap = |h: f64| {
        let at = |n: u32| scene.x[n as usize] + motion[n as usize] * h;
        scene.model.evaluate(candidate, &at).gap
    };
    let h = 1e-5;
    assert!(((gap(h) - gap(-h)) / (2.0 * h) - contact.relative(|n| motion[n])[0]).abs() < 1e-8);
    let mut forces = vec![Vector3::zeros(); scene.x.len()];
    contact.add_force(&Vector3::new(1.0, 0.0, 0.0), &mut forces);
    let moment: Vector3 = scene.x.iter().zip(&forces).map(|(x, f)| x.cross(f)).sum();
    assert!(forces.iter().sum::<Vector3>().norm() < 1e-14 && moment.norm() < 1e-14);
    let [sources, targets] =
        [contact.sources().map(|(_, w)| w).sum(), contact.targets().map(|(_, w)| w).sum::<f64>()];
    assert!((sources - 1.0_f64).abs() < 1e-15 && (targets + 1.0).abs() < 1e-15);
}

/// Bars whose only nodes are far from one another: their four corners of contact are where the rims cross, as finely as they are cut and
/// however they are turned.
#[test]
fn flat_bars_across_one_another_touch_at_four_places() {
    let mut next = numbers(5);
    for k in 0..60 {
        let around = if k == 0 { Matrix::<3>::identity() } else { turn(&mut next) };
        let up = around * Vector3::z();
        for (cells, overlap) in [(1, 0.0), (2, 0.0), (1, 1e-4), (5, -1e-4)] {
            let bar = cuboid([8.0, 1.0, 1.0], [cells, 1, 1]);
            let low = moved(&bar, &around, &Vector3::zeros());
            let across = around * rotation(&Vector3::z(), 1.2);
            let high = moved(&bar, &across, &(around * Vector3::new(0.01, 0.02, 1.0 - overlap)));
            let found = Scene::new(&low, &high).crossings(0.1, &Vector3::zeros());
            let upright = found.iter().filter(|(_, c)| (c.frame.row(0) * up).norm() > 1.0 - 1e-9);
            assert!(upright.clone().count() == 4 && found.len() == 4, "{k}: {found:?}");
            assert!(upright.clone().all(|(_, c)| (c.gap + overlap).abs() < 1e-12));
        }
    }
}

/// Bars that lie one across the other, slid along until a node of one is over the rim of the other, to either side: never without a hold.
#[test]
fn a_bar_slides_across_a_rim_without_a_hole() {
    let up = rotation(&Vector3::y(), 0.25 * std::f64::consts::PI)
        * rotation(&Vector3::z(), 0.5 * std::f64::consts::PI);
    let low = moved(&cuboid([3.0, 1.0, 1.0], [3, 2, 2]), &up, &Vector3::zeros());
    let tilt = rotation(&Vector3::x(), 0.25 * std::f64::consts::PI);
    let high = moved(&cuboid([3.0, 1.0, 1.0], [3, 2, 2]), &tilt, &Vector3::new(0.0, 0.0, 2.0_f64.sqrt()));
    let scene = Scene::new(&low, &high);
    for k in 0..400 {
        for depth in [-1e-3, 0.0, 1e-3] {
            let along = f64::from(k - 200) * 0.0051;
            let found = scene.found(0.01, &Vector3::new(along, 0.3 * along, -depth));
            let upright = |c: &Contact<3>| c.frame[(0, 2)].abs() > 0.6;
            assert!(
                found.iter().any(|(c, at)| !c.redundant && upright(at)),
                "nothing at {along}, {depth} deep"
            );
            let crossings = found.iter().filter(|(c, _)| c.node().is_none() && !c.redundant);
            assert!(
                crossings.clone().all(|(_, at)| (at.gap + depth).abs() < 1e-12) && crossings.count() <= 1
            );
        }
    }
}

#[test]
fn where_faces_hold_edges_do_not() {
    let cube = cuboid([1.0; 3], [2; 3]);
    let slab = cuboid([3.0, 3.0, 1.0], [3, 3, 1]);
    let still = Matrix::<3>::identity();
    for overlap in [-1e-3, 0.0, 1e-9, 1e-3] {
        let none = |a: &Mesh<3>, b: &Mesh<3>| {
            let found = Scene::new(a, b).crossings(0.05, &Vector3::zeros());
            assert!(found.is_empty(), "{overlap}: {found:?}");
        };
        // A cube within the top of a slab, straight and turned; cubes on one another, and one that leans on the side of the other.
        for angle in [0.0, 0.4] {
            let turn = rotation(&Vector3::z(), angle);
            none(&slab, &moved(&cube, &turn, &Vector3::new(0.3, 0.2, 1.0 - overlap)));
        }
        none(&cube, &moved(&cube, &still, &Vector3::new(0.0, 0.0, 1.0 - overlap)));
        none(&cube, &moved(&cube, &still, &Vector3::new(1.0 - overlap, 0.0, 0.5)));
        // Round bodies have no edges.
        let round = |x: &Vector3| if x.amax() > 0.0 { x * (x.amax() / x.norm()) } else { *x };
        let grid = cuboid([2.0; 3], [6; 3]);
        let ball =
            Mesh::new(grid.nodes().iter().map(round).collect(), grid.blocks().to_vec()).expect("valid");
        let other = moved(
            &ball,
            &rotation(&Vector3::new(0.6, 0.0, 0.8), 0.3),
            &Vector3::new(0.0, 0.0, 2.0 - overlap),
        );
        none(&ball, &other);
    }
}

/// A plate over another: the upper rim of the one and the lower rim of the other are far sides, not two edges that have passed.
#[test]
fn rims_of_thin_plates_do_not_meet_through_them() {
    let plate = cuboid([4.0, 4.0, 0.05], [4, 4, 1]);
    for distance in [0.0, 0.1, 0.4] {
        let other = moved(&plate, &rotation(&Vector3::z(), 0.7), &Vector3::new(0.1, 0.2, 0.05 + distance));
        for (c, at) in Scene::new(&plate, &other).crossings(0.5, &Vector3::zeros()) {
            assert!((at.gap - distance).abs() < 1e-12, "{c:?} is {} deep", at.gap);
        }
    }
}

/// Symptom guarded against: nodes on a floor gave way to edges that came close to a wall there, and the block tipped into the floor.
#[test]
fn a_block_in_a_corner_keeps_the_floor() {
    let grid = generate::grid([0.0; 3], [3.0, 3.0, 2.0], [3, 3, 2]).expect("valid");
    let is_kept = |cell: &[u32]| {
        let middle = cell.iter().map(|&n| grid.nodes()[n as usize]).sum::<Vector3>() / 8.0;
        middle[2] < 1.0 || (middle[0] < 1.0 && middle[1] > 1.0 && middle[1] < 2.0)
    };
    let kept: Vec<u32> = grid.blocks()[0].cells().filter(|c| is_kept(c)).flat_map(<[u32]>::to_vec).collect();
    let used: Vec<u32> = (0..grid.nodes().len() as u32).filter(|n| kept.contains(n)).collect();
    let number = |n: &u32| used.binary_search(n).expect("kept") as u32;
    let cells = CellBlock { kind: CellKind::Hex8, connectivity: kept.iter().map(number).collect() };
    let step =
        Mesh::new(used.iter().map(|&n| grid.nodes()[n as usize]).collect(), vec![cells]).expect("valid");
    for (beside, shift) in [(1e-3, 0.0), (1e-3, 2e-3), (1e-5, 0.0), (0.0, 0.0)] {
        let block = generate::grid([1.0 + beside, 1.0 + shift, 1.0], [0.8, 1.0, 0.8], [1; 3]).expect("valid");
        let scene = Scene::new(&block, &step);
        let found = scene.found(0.01, &Vector3::zeros());
        for corner in (0..8).filter(|&n| block.nodes()[n][2] == 1.0) {
            let holds = |(c, at): &(Candidate, Contact<3>)| {
                !c.redundant
                    && at.frame[(0, 2)].abs() > 0.9
                    && at.stencil().any(|(n, w)| n == corner && w.abs() > 0.9)
            };
            assert!(found.iter().any(holds), "corner {corner}, {beside} from the wall, is without the floor");
        }
    }
}

/// Two edges meet in a node and what follows it, where a mesh is tied to itself: one line, dented there, whatever way it is numbered.
#[test]
fn a_line_of_edges_goes_on_through_a_seam() {
    let up = rotation(&Vector3::x(), 0.25 * std::f64::consts::PI);
    let bar = |tied: bool| {
        let grid = generate::grid([-2.0, -0.5, -0.5], [4.0, 1.0, 1.0], [2, 1, 1]).expect("valid");
        let is_middle = |n: &u32| grid.nodes()[*n as usize][0] == 0.0;
        let seam: Vec<u32> = (0..grid.nodes().len() as u32).filter(is_middle).collect();
        let mut nodes: Vec<Vector3> = grid.nodes().iter().map(|x| up * x).collect();
        seam.iter().for_each(|&n| nodes[n as usize][2] *= 0.9);
        let mut connectivity = grid.blocks()[0].connectivity.clone();
        let mut ties = Vec::new();
        for &master in seam.iter().filter(|_| tied) {
            let image = nodes.len() as u32;
            nodes.push(nodes[master as usize]);
            connectivity[8..].iter_mut().filter(|n| **n == master).for_each(|n| *n = image);
            ties.push(Tie { image, master });
        }
        let block = CellBlock { kind: CellKind::Hex8, connectivity };
        Mesh::new(nodes, vec![block]).and_then(|mesh| mesh.with_ties(ties)).expect("valid")
    };
    let across = rotation(&Vector3::z(), 0.5 * std::f64::consts::PI) * up;
    let high = cuboid([4.0, 1.0, 1.0], [1, 1, 1]);
    let count = |tied: bool, along: f64, depth: f64| {
        let by = Vector3::new(along, 0.0, 1.9 * 0.5_f64.sqrt() - depth);
        Scene::new(&bar(tied), &moved(&high, &across, &by)).crossings(0.05, &Vector3::zeros()).len()
    };
    for (along, depth) in [(0.0, 1e-3), (0.001, 1e-3), (0.001, 0.0), (0.1, 0.0), (0.0, 0.0)] {
        let (plain, tied) = (count(false, along, depth), count(true, along, depth));
        assert!(plain == tied && plain > 0, "{along}, {depth}: {plain} {tied}");
    }
}

/// Rods with many sides touch along lines of long cells, between nodes that are far away.
#[test]
fn round_rods_with_long_cells_hold_one_another() {
    for cells in [2, 4, 6, 10] {
        let grid = generate::grid([-1.5, -1.0, -1.0], [3.0, 2.0, 2.0], [3, cells, cells]).expect("valid");
        let round = |x: &Vector3| {
            let radius = (x[1] * x[1] + x[2] * x[2]).sqrt();
            let shrink = if radius > 0.0 { x[1].abs().max(x[2].abs()) / radius } else { 1.0 };
            Vector3::new(x[0], x[1] * shrink, x[2] * shrink)
        };
        let rod = Mesh::new(grid.nodes().iter().map(round).collect(), grid.blocks().to_vec()).expect("valid");
        let across = rotation(&Vector3::z(), 0.5 * std::f64::consts::PI);
        let scene = Scene::new(&rod, &moved(&rod, &across, &Vector3::new(0.0, 0.0, 1.999)));
        let found = scene.crossings(0.05, &Vector3::zeros());
        let holds = found.iter().any(|(_, c)| (c.gap + 0.001).abs() < 1e-12 && c.frame[(0, 2)].abs() > 0.999);
        assert!(holds, "{} sides: {found:?}", 4 * cells);
    }
}
