//! Nodes before edges and corners of facets in space: a facet is found wherever the node comes from, and its force has no moment.

use carom_contact::{
    Candidate, Contact, ContactModel, ContactSurface, Discretisation, Pair, Path, Search, Target,
};
use carom_mesh::{CellBlock, CellKind, Mesh, Surface, Vector, generate};

type Vector3 = Vector<3>;

/// A tip pointing at a target: the tetrahedron with its apex, node 0, at `x` and the others behind it, along `back`.
fn tip(x: &Vector3, back: &Vector3) -> Mesh<3> {
    let side = back.cross(&Vector3::ith(back.iamin(), 1.0)).normalize();
    let other = back.cross(&side);
    let base = |k: f64| {
        let (sin, cos) = (2.0 * std::f64::consts::PI * k / 3.0).sin_cos();
        x + (back + (side * cos + other * sin) * 0.4) * 0.02
    };
    let cells = CellBlock { kind: CellKind::Tet4, connectivity: vec![0, 1, 2, 3] };
    let nodes = vec![*x, base(0.0), base(1.0), base(2.0)];
    Mesh::new(nodes, vec![cells]).expect("a tetrahedron")
}

/// The mesh with each hexahedron cut into six tetrahedra around its diagonal (Kuhn).
fn tetrahedra(mesh: &Mesh<3>) -> Mesh<3> {
    let paths = [[1, 2], [2, 3], [3, 7], [7, 4], [4, 5], [5, 1]];
    let cut = |cell: &[u32]| {
        paths.iter().flat_map(|&[a, b]| [cell[0], cell[a], cell[b], cell[6]]).collect::<Vec<_>>()
    };
    let connectivity = mesh.blocks().iter().flat_map(|b| b.cells()).flat_map(cut).collect();
    Mesh::new(mesh.nodes().to_vec(), vec![CellBlock { kind: CellKind::Tet4, connectivity }]).expect("valid")
}

/// What the apex of a tip at `x` makes of `target`, if it faces it.
fn contact(target: &Mesh<3>, surface: &Surface, x: &Vector3, back: &Vector3) -> Option<Contact<3>> {
    let tip = tip(x, back);
    let count = tip.nodes().len() as u32;
    let at = |n: u32| if n < count { tip.nodes()[n as usize] } else { target.nodes()[(n - count) as usize] };
    let model = ContactModel::<3> {
        surfaces: vec![
            ContactSurface::new(&Surface::of(&tip), 0, &at),
            ContactSurface::new(surface, count, &at),
        ],
        obstacles: vec![],
        pairs: vec![Pair {
            source: 0,
            target: Target::Surface(1),
            friction: 0.0,
            discretisation: Discretisation::default(),
        }]
        .into(),
    };
    let mut found: Vec<Candidate> = Vec::new();
    model.detect(&Path::resting(&at, 0.1), &mut Search::default(), &mut found);
    let contact = found.iter().find(|c| c.node() == Some(0)).map(|c| model.evaluate(c, &at))?;
    // The pair of forces has no moment.
    let mut forces = vec![Vector3::zeros(); count as usize + target.nodes().len()];
    contact.add_force(&Vector3::new(1.0, 0.0, 0.0), &mut forces);
    let moment: Vector3 = (0..).zip(&forces).map(|(n, f)| at(n).cross(f)).sum();
    assert!(forces.iter().sum::<Vector3>().norm() < 1e-14 && moment.norm() < 1e-14, "{moment}");
    Some(contact)
}

#[test]
fn a_box_is_met_from_everywhere() {
    let cubes = generate::grid([-0.5; 3], [1.0; 3], [2; 3]).expect("valid");
    for target in [tetrahedra(&cubes), cubes] {
        let surface = Surface::of(&target);
        // A point of the box and a direction into the open: on faces, their joints, edges and corners; straight on and aslant.
        let steps = [-1.0, -0.6, 0.0, 0.3, 1.0];
        let slants = [0.0, 0.2, 0.7, 1.0];
        for k in 0..steps.len().pow(3) * slants.len().pow(3) {
            let digit = |place: u32| k / 20_usize.pow(place) % 20;
            let at = Vector3::from_fn(|i, _| steps[digit(i as u32) / 4]);
            let out = at.map(|x| if x.abs() == 1.0 { x } else { 0.0 });
            let out = Vector3::from_fn(|i, _| out[i] * slants[digit(i as u32) % 4]);
            let Some(out) = out.try_normalize(1e-9) else { continue };
            let distance = 0.05;
            let x = at * 0.5 + out * distance;
            let contact = contact(&target, &surface, &x, &out)
                .unwrap_or_else(|| panic!("nothing before {x} from {out}"));
            let normal = contact.frame.row(0).transpose();
            assert!((contact.gap - distance * normal.dot(&out)).abs() < 1e-14);
            assert!(normal.dot(&out) >= 3.0_f64.sqrt().recip() - 1e-12, "{x}: {normal}");
            // Deeper than the corner of the box: there is a hold too.
            if k % 7 == 0 {
                assert!(contact_behind(&target, &surface, &(at * 0.49), &out), "nothing behind {at}");
            }
        }
    }
}

fn contact_behind(target: &Mesh<3>, surface: &Surface, x: &Vector3, back: &Vector3) -> bool {
    contact(target, surface, x, back).is_some_and(|c| c.gap < 0.0)
}

/// A ball of facets that are neither in one plane nor flat; nodes above and a little below all of its edges.
#[test]
fn a_ball_has_no_holes_between_its_facets() {
    let grid = generate::grid([-1.0; 3], [2.0; 3], [3; 3]).expect("valid");
    let round = |x: &Vector3| if x.amax() > 0.0 { x * (x.amax() / x.norm()) } else { *x };
    let nodes: Vec<Vector3> = grid.nodes().iter().map(round).collect();
    let ball = Mesh::new(nodes, grid.blocks().to_vec()).expect("valid");
    for target in [tetrahedra(&ball), ball] {
        let surface = Surface::of(&target);
        let node = |n: u32| target.nodes()[n as usize];
        for facet in surface.facets() {
            let corners = facet.nodes.len();
            for k in 0..corners {
                let (a, b) = (node(facet.nodes[k]), node(facet.nodes[(k + 1) % corners]));
                for s in [0.0, 0.13, 0.5, 1.0 - 1e-12] {
                    let edge = a + (b - a) * s;
                    for height in [-0.01, -1e-6, 0.0, 1e-9, 0.03] {
                        let out = edge.normalize();
                        let found = contact(&target, &surface, &(edge + out * height), &out);
                        let gap = found.unwrap_or_else(|| panic!("nothing at {edge}, {height} above")).gap;
                        assert!((gap - height).abs() < 0.12 * height.abs() + 1e-12, "{gap} for {height}");
                    }
                }
            }
        }
    }
}

/// Symptom guarded against: a node that had gone a little way into a concave edge faced no facet and was lost.
#[test]
fn a_notch_holds_what_is_pressed_into_its_edge() {
    let grid = generate::grid([-1.0; 3], [2.0; 3], [2; 3]).expect("valid");
    let open = |cell: &[u32]| cell.iter().all(|&n| grid.nodes()[n as usize].xy().min() >= 0.0);
    let kept: Vec<u32> =
        grid.blocks()[0].cells().filter(|cell| !open(cell)).flat_map(<[u32]>::to_vec).collect();
    let used: Vec<u32> = (0..grid.nodes().len() as u32).filter(|n| kept.contains(n)).collect();
    let number = |n: &u32| used.binary_search(n).expect("kept") as u32;
    let cells = CellBlock { kind: CellKind::Hex8, connectivity: kept.iter().map(number).collect() };
    let nodes = used.iter().map(|&n| grid.nodes()[n as usize]).collect();
    let notched = Mesh::new(nodes, vec![cells]).expect("valid");
    let surface = Surface::of(&notched);
    let out = Vector3::new(1.0, 1.0, 0.0).normalize();
    for depth in [1e-9, 1e-5, 1e-3, 0.02] {
        for (a, b) in [(1.0, 1.0), (0.3, 1.0), (1.0, 0.1)] {
            let x = Vector3::new(-a * depth, -b * depth, 0.3);
            let gap = contact(&notched, &surface, &x, &out).expect("in the notch").gap;
            assert!((gap + depth).abs() < 1e-12, "{gap:e}: not as deep as behind one of its sides");
        }
    }
}

/// Symptom guarded against: a node beside the rim of a surface that ends was caught by the plane of its last facet.
#[test]
fn beside_the_rim_of_an_open_surface_is_nothing() {
    let cube = generate::grid([-0.5; 3], [1.0; 3], [2; 3]).expect("valid");
    let top = Surface::of(&cube).part(|f| f.nodes.iter().all(|&n| cube.nodes()[n as usize][2] == 0.5));
    let up = Vector3::z();
    for (x, y) in [(0.55, 0.2), (0.55, 0.55), (-0.52, 0.0)] {
        for z in [-0.03, -1e-3, 0.01] {
            assert_eq!(contact(&cube, &top, &Vector3::new(x, y, 0.5 + z), &up), None);
        }
    }
    assert!(contact(&cube, &top, &Vector3::new(0.45, 0.2, 0.49), &up).is_some());
}
