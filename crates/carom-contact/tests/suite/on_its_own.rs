//! Contact without the rest of carom: positions are functions of the caller's, and nothing has to be known of obstacles, multipliers or edges.

use carom_contact::{
    Candidate, ContactModel, ContactSurface, Discretisation, Obstacle, Pair, Path, RigidShape, Search, Site,
    Target,
};
use carom_mesh::{Mesh, Surface, Vector, generate};

fn pair(source: usize, target: Target, discretisation: Discretisation) -> Pair {
    Pair { source, target, friction: 0.3, discretisation }
}

/// Surfaces of two meshes, numbered one after the other, and where their nodes are.
fn surfaces<const D: usize>(meshes: [&Mesh<D>; 2]) -> (Vec<ContactSurface>, Vec<Vector<D>>) {
    let x: Vec<Vector<D>> = meshes.iter().flat_map(|m| m.nodes()).copied().collect();
    let first = [0, meshes[0].nodes().len() as u32];
    let surface = |k: usize| ContactSurface::new(&Surface::of(meshes[k]), first[k], &|n| x[n as usize]);
    (vec![surface(0), surface(1)], x)
}

/// Positions are asked of nodes alone.
#[test]
fn an_obstacle_without_a_number_rests() {
    let square = generate::grid([0.0, 0.01], [1.0, 1.0], [2, 2]).expect("valid");
    let at = |n: u32| square.nodes()[n as usize];
    let (corner, size) = (Vector::<2>::new(-0.75, -1.0), Vector::<2>::new(1.0, 1.0));
    let shapes = [
        RigidShape::Plane { point: Vector::zeros(), normal: Vector::<2>::new(0.0, 1.0) },
        RigidShape::Box { corner, size },
    ];
    for (shape, expected) in shapes.into_iter().zip([3, 2]) {
        let model = ContactModel {
            surfaces: vec![ContactSurface::new(&Surface::of(&square), 0, &at)],
            obstacles: vec![Obstacle::new(shape)],
            pairs: vec![pair(0, Target::Obstacle(0), Discretisation::default())].into(),
        };
        let mut found = Vec::new();
        model.detect(&Path::resting(&at, 0.1), &mut Search::default(), &mut found);
        // Of the plane the three nodes at the bottom; of the box the corner on its left, and its own corner between two nodes.
        assert_eq!(found.len(), expected, "{found:?}");
        assert_eq!(
            found.iter().filter(|c| matches!(c.site, Site::Corner(_))).count(),
            usize::from(expected == 2)
        );
        for candidate in &found {
            let contact = model.evaluate(candidate, &at);
            assert!((contact.gap - 0.01).abs() < 1e-15, "{contact:?}");
            assert!(contact.stencil().all(|(n, _)| n < square.nodes().len()), "{contact:?}");
        }
    }
}

/// Closed form: with one side parallel to the other every mean of the gap is the gap, and multipliers share the length of the source.
#[test]
fn multipliers_are_found_and_evaluated_as_nodes_are() {
    let lower = generate::grid([0.0, 0.0], [1.0, 1.0], [2, 2]).expect("valid");
    let upper = generate::grid([0.0, 1.01], [1.0, 1.0], [3, 3]).expect("valid");
    let (surfaces, x) = surfaces([&lower, &upper]);
    let at = |n: u32| x[n as usize];
    let pairs = vec![pair(0, Target::Surface(1), Discretisation::Mortar)];
    let model = ContactModel { surfaces, obstacles: vec![], pairs: pairs.into() };
    let (mut search, mut found, mut contacts) = (Search::default(), Vec::new(), Vec::new());
    model.detect(&Path::resting(&at, 0.1), &mut search, &mut found);
    model.evaluate_all(&found, &at, &mut search.mortar, &mut contacts);
    assert_eq!(contacts.len(), 3);
    assert!((contacts.iter().map(|c| c.area).sum::<f64>() - 1.0).abs() < 1e-14);
    for (candidate, contact) in found.iter().zip(&contacts) {
        assert!((contact.gap - 0.01).abs() < 1e-14, "{contact:?}");
        assert_eq!(&model.evaluate(candidate, &at), contact);
    }
    // One that nobody has found, and that nothing covers, is as far away as its node.
    let away =
        |n: u32| if n < lower.nodes().len() as u32 { at(n) } else { at(n) + Vector::<2>::new(3.0, 0.5) };
    let node = found[0].node().expect("a multiplier has a node");
    let contact = model.evaluate(&Candidate::at_node(0, node, None), &away);
    assert!((contact.source_point(&away) - at(node)).norm() < 1e-15);
    assert!(contact.gap.is_finite() && contact.gap > 0.5, "{contact:?}");
}

/// Two bars that cross touch with their edges: no node of one is near a facet of the other.
#[test]
fn crossed_bars_are_found_whatever_has_been_said_of_edges() {
    let along_x = generate::grid([0.0, 0.45, 0.0], [1.0, 0.1, 0.1], [1, 1, 1]).expect("valid");
    let along_y = generate::grid([0.45, 0.0, 0.101], [0.1, 1.0, 0.1], [1, 1, 1]).expect("valid");
    let (surfaces, x) = surfaces([&along_x, &along_y]);
    let at = |n: u32| x[n as usize];
    let pairs = [0, 1].map(|s| pair(s, Target::Surface(1 - s), Discretisation::default())).to_vec();
    let model = ContactModel { surfaces, obstacles: vec![], pairs: pairs.into() };
    let mut found = Vec::new();
    model.detect(&Path::resting(&at, 0.01), &mut Search::default(), &mut found);
    assert_eq!(found.len(), 4, "{found:?}");
    for candidate in &found {
        assert!(matches!(candidate.site, Site::Crossing(..)));
        let contact = model.evaluate(candidate, &at);
        assert!((contact.gap - 0.001).abs() < 1e-15, "{contact:?}");
    }
}
