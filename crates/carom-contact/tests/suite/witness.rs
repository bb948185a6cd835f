//! What a measure finds inside becomes a candidate, whatever the rules of the search say.

use carom_contact::{
    Boundaries, Candidate, ContactModel, ContactSurface, Discretisation, Feature, Pair, Path, Search, Site,
    Target, Witness,
};
use carom_mesh::generate::Grid;
use carom_mesh::{CellKind, Mesh, Surface, Vector, generate};

/// Two bodies in space, each checked against the other.
struct Scene {
    model: ContactModel<3>,
    boundaries: Boundaries<3>,
    start: Vec<Vector<3>>,
    end: Vec<Vector<3>>,
}

impl Scene {
    /// Of bodies whose nodes are moved by `motion` [m].
    fn new(bodies: [&Mesh<3>; 2], motion: impl Fn(&Vector<3>) -> Vector<3>) -> Self {
        let start: Vec<_> = bodies.iter().flat_map(|mesh| mesh.nodes()).copied().collect();
        let end = start.iter().map(|x| x + motion(x)).collect();
        let at = |n: u32| start[n as usize];
        let firsts = [0, bodies[0].nodes().len() as u32];
        let outlines = bodies.map(Surface::of);
        let surfaces = [0, 1].map(|i| ContactSurface::new(&outlines[i], firsts[i], &at)).to_vec();
        let pair = |source: usize| Pair {
            source,
            target: Target::Surface(1 - source),
            friction: 0.0,
            discretisation: Discretisation::default(),
        };
        let boundaries = Boundaries::new(outlines.iter().zip(firsts), &[], &at);
        let model = ContactModel { surfaces, obstacles: Vec::new(), pairs: vec![pair(0), pair(1)].into() };
        Self { model, boundaries, start, end }
    }

    /// The same two, which have come to be bent: node n of the first is where the first of these `shapes` says at the start, and so on; they are moved by
    /// `motion` [m] from there.
    fn bent(
        mut self,
        shapes: [&dyn Fn(&Vector<3>) -> Vector<3>; 2],
        motion: impl Fn(&Vector<3>) -> Vector<3>,
    ) -> Self {
        let first = self.model.surfaces[1].nodes[0] as usize;
        for (n, (start, end)) in self.start.iter_mut().zip(&mut self.end).enumerate() {
            *start = shapes[usize::from(n >= first)](start);
            *end = *start + motion(start);
        }
        self
    }

    /// The greatest depth at the end [m], what is inside, and the candidates that it makes.
    fn judged(&mut self) -> (f64, Vec<Witness>, Vec<Candidate>) {
        let Self { model, boundaries, start, end } = self;
        let (start, end) = (|n: u32| start[n as usize], |n: u32| end[n as usize]);
        let mut depth: f64 = 0.0;
        boundaries.measure(&[], |between| between[0] != between[1], &end, |p| depth = depth.max(p.depth));
        let witnesses = boundaries.witnesses().to_vec();
        let mut candidates = Vec::new();
        model.witnessed(
            &witnesses,
            &Path { start: &start, end: &end, margin: 0.0 },
            &mut Search::default(),
            &mut candidates,
        );
        (depth, witnesses, candidates)
    }

    /// What the search finds.
    fn detected(&self) -> Vec<Candidate> {
        let (start, end) = (|n: u32| self.start[n as usize], |n: u32| self.end[n as usize]);
        let mut candidates = Vec::new();
        let path = Path { start: &start, end: &end, margin: 1e-3 };
        self.model.detect(&path, &mut Search::default(), &mut candidates);
        candidates
    }
}

/// A box on another, a little wider one of fewer cells.
fn stack() -> [Mesh<3>; 2] {
    let below = generate::grid([0.0, -0.001, 0.0], [1.0, 1.002, 1.0], [2, 2, 2]).expect("valid");
    let above = generate::grid([0.0, 0.0, 1.0], [1.0, 1.0, 1.0], [3, 3, 3]).expect("valid");
    [below, above]
}

/// Symptom guarded against: a node of a flat side, just beyond the rim of the box on it, rose past the rim, which lay on no node. The
/// box sank by a thousandth of its size.
#[test]
fn a_rim_that_an_edge_of_a_flat_side_goes_through_is_found() {
    let rise = |x: &Vector<3>| {
        let is_beyond = (x[0] - 0.5).abs() < 1e-9 && x[1] < -1e-4 && x[2] == 1.0;
        Vector::<3>::new(0.0, 0.0, if is_beyond { 2e-3 } else { 0.0 })
    };
    let [below, above] = stack();
    let mut found = Vec::new();
    for bodies in [[&below, &above], [&above, &below]] {
        let mut scene = Scene::new(bodies, rise);
        let (depth, witnesses, candidates) = scene.judged();
        assert!((9e-4..2.1e-3).contains(&depth), "{depth}");
        assert!(witnesses.iter().any(|w| matches!(w.feature, Feature::Edge(_))));
        let end = |n: u32| scene.end[n as usize];
        let crossings = candidates.iter().filter(|c| matches!(c.site, Site::Crossing(..)));
        let behind: Vec<_> =
            crossings.map(|c| scene.model.evaluate(c, &end)).filter(|c| c.gap < -1e-3).collect();
        assert_eq!(behind.len(), 1, "{candidates:?}");
        let normal = behind[0].frame.row(0).transpose();
        assert!(normal[2].abs() > 0.999, "{normal}");
        found.push(behind[0].gap);
        let known = scene.detected();
        assert!(candidates.iter().any(|c| known.iter().all(|k| k.key() != c.key())));
    }
    assert!((found[0] - found[1]).abs() < 1e-15);
}

/// Symptom guarded against: what is nearest to where a node has come is the side of the target, by which it did not come.
#[test]
fn a_node_is_kept_out_where_it_came_in() {
    let below = generate::grid([0.0; 3], [1.0; 3], [2, 2, 2]).expect("valid");
    let above = generate::grid([0.9, 0.3, 1.02], [1.0; 3], [1, 1, 1]).expect("valid");
    let falls = |x: &Vector<3>| Vector::<3>::new(0.0, 0.0, if x[2] > 1.01 { -0.22 } else { 0.0 });
    let mut scene = Scene::new([&below, &above], falls);
    let (depth, _, candidates) = scene.judged();
    assert!((depth - 0.1).abs() < 1e-12, "{depth}");
    let end = |n: u32| scene.end[n as usize];
    let nodes: Vec<_> = candidates.iter().filter(|c| c.node().is_some()).collect();
    assert!(!nodes.is_empty());
    for candidate in nodes {
        assert!((scene.model.evaluate(candidate, &end).gap + 0.2).abs() < 1e-12, "{candidate:?}");
    }
}

#[test]
fn what_touches_is_no_witness() {
    let [below, above] = stack();
    let (depth, witnesses, candidates) = Scene::new([&below, &above], |_| Vector::zeros()).judged();
    assert!(depth < 1e-15, "{depth:e}");
    assert_eq!((witnesses.len(), candidates.len()), (0, 0));
}

/// Symptom guarded against: coarse bodies of second order went into others by up to a tenth of a cell, where their sides or edges bulge between
/// the nodes.
#[test]
fn an_edge_in_a_side_of_second_order_touches_between_its_nodes() {
    let grid = Grid { corner: [0.0; 3], size: [1.0; 3], divisions: [1, 1, 1] };
    let mut tops = Vec::new();
    for kind in [CellKind::Hex20, CellKind::Hex27] {
        let flat = grid.mesh(kind).expect("valid");
        // Its top was flat and has come to be as high as 4 h x (1 - x); above it lies a bar whose ends are beyond it.
        let bulge = |x: &Vector<3>| x + Vector::<3>::z() * (0.2 * x[2] * x[0] * (1.0 - x[0]) * 4.0);
        let above = generate::grid([-0.5, 0.3, 1.201], [2.0, 0.25, 0.3], [1, 1, 1]).expect("valid");
        let falls = |x: &Vector<3>| Vector::<3>::new(0.0, 0.0, if x[2] > 1.2005 { -0.011 } else { 0.0 });
        let mut scene = Scene::new([&flat, &above], |_| Vector::zeros()).bent([&bulge, &|x| *x], falls);
        let (depth, _, candidates) = scene.judged();
        assert!((depth - 0.01).abs() < 1e-4, "{depth}");
        let end = |n: u32| scene.end[n as usize];
        let between = candidates.iter().filter(|c| matches!(c.site, Site::Between(..) | Site::Crossing(..)));
        let found: Vec<_> = between.map(|c| (c.site, scene.model.evaluate(c, &end))).collect();
        let deepest = found.iter().map(|(_, c)| c.gap).fold(0.0, f64::min);
        assert!((deepest + 0.01).abs() < 1e-3, "{kind:?} {candidates:?} {deepest}");
        assert!(found.iter().all(|(_, c)| c.gap > -0.011 && c.frame[(0, 2)].abs() > 0.99), "{found:?}");
        tops.push(found.iter().filter(|(site, _)| matches!(site, Site::Between(..))).count());
    }
    assert!(tops.iter().all(|count| *count > 0), "{tops:?}");
}

/// The normal row is the gradient of the gap, and the forces of both sides have no moment: of points of edges before curved facets, and of curved
/// edges that cross.
#[test]
fn gaps_between_nodes_change_as_their_rows_say() {
    let grid = |corner: [f64; 3]| Grid { corner, size: [1.0; 3], divisions: [1, 1, 1] };
    let bent =
        |x: &Vector<3>, by: f64| x + Vector::<3>::new(0.3 * x[1] * x[1], 0.0, by * x[0] * (1.0 - x[0]));
    let below = grid([0.0; 3]).mesh(CellKind::Hex20).expect("valid");
    let above = grid([0.2, -0.3, 1.19]).mesh(CellKind::Hex27).expect("valid");
    let falls = |x: &Vector<3>| Vector::<3>::new(0.0, 0.0, if x[2] > 1.105 { -0.03 } else { 0.0 });
    let mut scene = Scene::new([&below, &above], |_| Vector::zeros())
        .bent([&|x| bent(x, 0.4), &|x| bent(x, -0.3)], falls);
    let (_, _, candidates) = scene.judged();
    let is_between = |c: &&Candidate| matches!(c.site, Site::Between(..) | Site::Crossing(..));
    let between: Vec<_> = candidates.iter().filter(is_between).collect();
    assert!(!between.is_empty());
    let motion = |n: u32| Vector::<3>::from_fn(|i, _| (f64::from(n) * 1.7 + i as f64 * 2.3).sin());
    for candidate in between {
        let gap = |h: f64| scene.model.evaluate(candidate, &|n| scene.end[n as usize] + motion(n) * h).gap;
        let contact = scene.model.evaluate(candidate, &|n| scene.end[n as usize]);
        let h = 1e-5;
        let rate = (gap(h) - gap(-h)) / (2.0 * h);
        assert!((rate - contact.relative(|n| motion(n as u32))[0]).abs() < 1e-7, "{candidate:?} {rate}");
        let mut forces = vec![Vector::zeros(); scene.end.len()];
        contact.add_force(&Vector::<3>::x(), &mut forces);
        let moment: Vector<3> = scene.end.iter().zip(&forces).map(|(x, f)| x.cross(f)).sum();
        assert!(forces.iter().sum::<Vector<3>>().norm() < 1e-14 && moment.norm() < 1e-13);
    }
}
