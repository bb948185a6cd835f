//! The same step in 3D: a cube of hexahedra dropped on a plane and on another cube.

use carom::{
    ContactCondition, Method, Model, ModelBody, NewtonRule, Scheme, Simulation, State, Workspace, step,
};
use carom_contact::{ContactModel, ContactSurface, Discretisation, Obstacle, Pair, Target};
use carom_fem::material::{ElasticConstants, LawSpec, Mat3, Viscosity};
use carom_fem::{Body, BodySpec, Formulation, Hypothesis, MassKind, RayleighDamping};
use carom_friction::{Criterion, SolverKind, StoppingRule};
use carom_mesh::{CellKind, Vector, generate};
use serde_json::json;

use crate::common::{parse, scenario};

fn cube(name: &str, corner: [f64; 3], first_node: usize) -> ModelBody<3> {
    block(name, corner, first_node, 3, false)
}

fn massless_cube(name: &str, corner: [f64; 3], first_node: usize) -> ModelBody<3> {
    block(name, corner, first_node, 4, true)
}

fn block(name: &str, corner: [f64; 3], first_node: usize, cells: usize, massless: bool) -> ModelBody<3> {
    block_of(CellKind::Hex8, name, corner, first_node, cells, massless)
}

fn block_of(
    kind: CellKind,
    name: &str,
    corner: [f64; 3],
    first_node: usize,
    cells: usize,
    massless: bool,
) -> ModelBody<3> {
    let spec = BodySpec {
        law: LawSpec::SaintVenantKirchhoff(ElasticConstants { young: 2700.0, poisson: 0.33 }),
        density: 1.0,
        damping: RayleighDamping::default(),
        viscosity: Viscosity::default(),
        regions: Vec::new(),
        mass: MassKind::Consistent,
        hypothesis: Hypothesis::PlaneStrain,
        formulation: Formulation::Standard,
        thickness: 1.0,
        initial_stress: Mat3::zeros(),
        grows: false,
        points: Vec::new(),
        massless_contact: massless,
        share: None,
    };
    let mesh = generate::Grid { corner, size: [1.0; 3], divisions: [cells; 3] }.mesh(kind).expect("valid");
    ModelBody::new(name, Body::new(mesh, &spec).expect("valid"), first_node)
}

fn model(bodies: Vec<ModelBody<3>>, obstacles: Vec<Obstacle<3>>, pairs: Vec<Pair>) -> Model<3> {
    let surface = |b: &ModelBody<3>| {
        let at = |n: u32| b.body.mesh().nodes()[n as usize - b.first_node];
        ContactSurface::new(b.body.surface(), b.first_node as u32, &at)
    };
    let contact =
        ContactModel { surfaces: bodies.iter().map(surface).collect(), obstacles, pairs: pairs.into() };
    let names = contact.obstacles.iter().enumerate().map(|(o, _)| format!("obstacle {o}")).collect();
    Model::new(bodies, contact, names, Vector::zeros())
}

fn method(condition: ContactCondition) -> Method<3> {
    Method {
        scheme: Scheme::Theta { theta: 0.5, xi: 0.5 },
        condition,
        solver: SolverKind::GaussSeidel.solver(),
        stopping: StoppingRule { tolerance: 1e-12, criterion: Criterion::Natural, ..StoppingRule::default() },
        cross_check: false,
        newton: NewtonRule { tolerance: 1e-9, max_iterations: 50 },
        max_halvings: 8,
        bridges: false,
        certificate_tolerance: 1e-9,
        penetration_tolerance: 0.01,
    }
}

/// Steps until `end`; returns the state, the cumulated friction work, the largest |defect|, the smallest gap and whether there was
/// contact.
fn run(
    model: &Model<3>,
    method: &Method<3>,
    velocity: Vec<Vector<3>>,
    end: f64,
) -> (State<3>, f64, f64, f64, bool) {
    let mut state = model.initial_state(velocity);
    let mut next = state.clone();
    let mut work = Workspace::new(model);
    let (mut friction, mut defect, mut min_gap, mut touched) = (0.0, 0.0_f64, f64::INFINITY, false);
    let mut sum = 0.0;
    while state.time < end {
        let report = step(&model.assembly, method, &state, &mut next, 1e-3, &mut work).expect("converges");
        friction += report.ledger.friction;
        sum += report.ledger.defect();
        defect = defect.max(sum.abs());
        min_gap = min_gap.min(report.min_gap);
        touched |= report.contacts > 0;
        assert!(report.ledger.friction > -1e-12);
        std::mem::swap(&mut state, &mut next);
    }
    (state, friction, defect, min_gap, touched)
}

#[test]
fn cube_with_friction_on_a_plane_loses_what_friction_and_contact_take() {
    let floor = Obstacle::plane(Vector::zeros(), Vector::<3>::new(0.0, 0.0, 1.0));
    let pair = Pair {
        source: 0,
        target: Target::Obstacle(0),
        friction: 0.3,
        discretisation: Discretisation::NodeToSegment,
    };
    let model = model(vec![cube("cube", [0.0, 0.0, 0.00513], 0)], vec![floor], vec![pair]);
    let speed = Vector::<3>::new(2.0, 1.0, -2.0);
    let velocity = vec![speed; model.node_count()];
    let (state, friction, defect, min_gap, touched) =
        run(&model, &method(ContactCondition::Gap), velocity, 0.08);
    let initial = 0.5 * speed.norm_squared();
    assert!(touched && friction > 0.02 * initial, "friction {friction} J of {initial} J");
    assert!(defect < 2e-3 * initial, "defect {defect} J of {initial} J");
    assert!(min_gap > -1e-12);
    let mean = model.bodies[0].body.mean(&state.velocity);
    assert!(mean[2] > 0.0, "it bounces");
    // Friction acts against the sliding, whichever way that points in the plane.
    let lost = speed - mean;
    assert!((lost[0] / lost[1] - 2.0).abs() < 0.05, "{lost}");
}

#[test]
fn cubes_with_facing_quadrilaterals_exchange_momentum() {
    let a = cube("a", [0.0, 0.0, 0.0], 0);
    let b = cube("b", [0.13, 0.21, 1.00513], a.body.node_count());
    let nodes = a.body.node_count();
    let pair = Pair {
        source: 1,
        target: Target::Surface(0),
        friction: 0.0,
        discretisation: Discretisation::NodeToSegment,
    };
    let model = model(vec![a, b], vec![], vec![pair]);
    let velocity =
        (0..2 * nodes).map(|n| Vector::<3>::new(0.0, 0.0, if n < nodes { 0.5 } else { -0.5 })).collect();
    let (state, _, defect, min_gap, touched) = run(&model, &method(ContactCondition::Gap), velocity, 0.1);
    assert!(touched);
    assert!(min_gap > -1e-12, "{min_gap}");
    assert!(defect < 1e-3 * 0.25);
    let mean: Vec<f64> = model.bodies.iter().map(|b| b.body.mean(&state.velocity[b.nodes()])[2]).collect();
    assert!((mean[0] + mean[1]).abs() < 1e-12, "momentum is kept: {mean:?}");
    assert!(mean[0] < -0.2 && mean[1] > 0.2, "they part: {mean:?}");
}

/// Cubes of 4³ cells, so that there are nodes inside to carry the mass.
#[test]
fn massless_cube_conserves_energy_and_momenta_and_does_not_penetrate() {
    for friction in [0.0, 0.3] {
        let floor = Obstacle::plane(Vector::zeros(), Vector::<3>::new(0.0, 0.0, 1.0));
        let pair = Pair {
            source: 0,
            target: Target::Obstacle(0),
            friction,
            discretisation: Discretisation::NodeToSegment,
        };
        let cube = massless_cube("cube", [0.0, 0.0, 0.00513], 0);
        let model = model(vec![cube], vec![floor], vec![pair]);
        let speed = Vector::<3>::new(2.0, 1.0, -2.0);
        let velocity = vec![speed; model.node_count()];
        let mut method = method(ContactCondition::Massless);
        method.scheme = Scheme::Conserving;
        let (state, lost, defect, min_gap, touched) = run(&model, &method, velocity, 0.08);
        let initial = 0.5 * speed.norm_squared();
        assert!(touched);
        assert!(defect < 1e-9 * initial, "friction {friction}: defect {defect:e} J of {initial} J");
        assert!((state.energies.total() + lost - initial).abs() < 1e-9 * initial);
        assert!(min_gap > -1e-12, "{min_gap:e}");
        let mean = model.bodies[0].body.mean(&state.velocity);
        assert!(mean[2] > 0.0, "it bounces: {mean}");
        if friction == 0.0 {
            assert!(lost == 0.0 && (mean - speed).xy().norm() < 1e-10, "the floor is smooth: {mean}");
        } else {
            assert!(lost > 0.02 * initial, "friction takes {lost} J of {initial} J");
        }
    }
}

#[test]
fn massless_cubes_conserve_energy_and_momenta() {
    let a = massless_cube("a", [0.0, 0.0, 0.0], 0);
    let nodes = a.body.node_count();
    let b = massless_cube("b", [0.13, 0.21, 1.00513], nodes);
    let pair = Pair {
        source: 1,
        target: Target::Surface(0),
        friction: 0.0,
        discretisation: Discretisation::NodeToSegment,
    };
    let model = model(vec![a, b], vec![], vec![pair]);
    let velocity: Vec<_> =
        (0..2 * nodes).map(|n| Vector::<3>::new(0.0, 0.0, if n < nodes { 0.5 } else { -0.5 })).collect();
    let mut method = method(ContactCondition::Massless);
    method.scheme = Scheme::Conserving;
    let (state, _, defect, min_gap, touched) = run(&model, &method, velocity, 0.1);
    assert!(touched);
    assert!(min_gap > -1e-12, "{min_gap:e}");
    assert!(defect < 1e-9 * 0.25, "{defect:e} J of 0.25 J");
    let (mut linear, mut angular) = (Vector::<3>::zeros(), Vector::<3>::zeros());
    for b in &model.bodies {
        let (u, v) = (&state.displacement[b.nodes()], &state.velocity[b.nodes()]);
        let mut mv = vec![Vector::zeros(); v.len()];
        b.body.mass().multiply(v, &mut mv);
        linear += mv.iter().sum::<Vector<3>>();
        angular += Vector::from(b.body.angular_momentum(u, &mv));
    }
    // Before: none of either but the moment of two momenta of ½ whose lines are 0.13 and 0.21 apart.
    let before = Vector::<3>::new(-0.21, 0.13, 0.0) * 0.5;
    assert!(linear.norm() < 1e-10, "{linear}");
    assert!((angular - before).norm() < 1e-10, "{angular}");
}

/// A box of wedges shows triangles at its ends and quadrilaterals around; both are touched, by a floor and by a box of hexahedra.
#[test]
fn boxes_of_wedges_fall_and_slide_with_their_books_closed() {
    for (kind, axis) in [(CellKind::Wedge6, 2), (CellKind::Wedge6, 0), (CellKind::Wedge15, 2)] {
        let mut normal = Vector::<3>::zeros();
        normal[axis] = 1.0;
        let above = |height: f64, aside: f64| -> [f64; 3] {
            std::array::from_fn(|k| if k == axis { height } else { aside })
        };
        let a = block_of(kind, "a", above(0.00513, 0.0), 0, 2, false);
        let nodes = a.body.node_count();
        let b = block_of(CellKind::Hex8, "b", above(1.0113, 0.13), nodes, 2, false);
        let discretisation = Discretisation::NodeToSegment;
        let pair = |source, target| Pair { source, target, friction: 0.3, discretisation };
        let pairs = vec![pair(0, Target::Obstacle(0)), pair(1, Target::Surface(0))];
        let floor = Obstacle::plane(Vector::zeros(), normal);
        let model = model(vec![a, b], vec![floor], pairs);
        let speed = Vector::<3>::from_element(0.5) - normal * 1.5;
        let velocity = vec![speed; model.node_count()];
        let mut method = method(ContactCondition::Midpoint);
        method.scheme = Scheme::Conserving;
        let (state, lost, defect, _, touched) = run(&model, &method, velocity, 0.08);
        let initial = speed.norm_squared();
        assert!(touched, "{kind:?}");
        assert!(lost > 1e-3 * initial, "{kind:?} along {axis}: friction takes {lost} J of {initial} J");
        assert!(defect < 1e-9 * initial, "{kind:?} along {axis}: defect {defect:e} J of {initial} J");
        let mean = model.bodies[0].body.mean(&state.velocity[..nodes]);
        assert!(mean[axis] > speed[axis] + 0.5, "{kind:?} along {axis}: the floor has stopped it: {mean}");
    }
}

/// Symptom guarded against: where the normal of a flat contact trembles about the vertical, the tangents of its frame jumped by a right angle,
/// and the reactions known in these with them: 10 to 99 iterations in a step where carried tangents take 5.
#[test]
fn reactions_of_flat_contact_are_known_in_frames_that_are_carried_along() {
    const CELLS: usize = 10;
    let speed = (1.346e7_f64 / 1000.0).sqrt();
    let dt = 1.0 / CELLS as f64 / speed;
    let mut case = scenario(3.0 * dt, dt, &[], &[]);
    case["dimension"] = json!(3);
    case["analysis"]["gravity"] = json!([0.0, 0.0, -9.81]);
    let law = json!({"kind": "saint-venant-kirchhoff", "young": 1e7, "poisson": 0.3, "density": 1000.0});
    case["materials"]["elastic"]
        .as_object_mut()
        .expect("a table")
        .extend(law.as_object().expect("a table").clone());
    let block = |name: &str, corner: [f64; 3], size: [f64; 3], cells: usize, velocity: [f64; 3]| {
        json!({
            "name": name, "material": "elastic", "hypothesis": "plane-strain", "thickness": 1.0, "mass": "consistent",
            "mesh": {"kind": "box", "corner": corner, "size": size, "divisions": [cells, cells, 3], "cell": "hex8"},
            "velocity": velocity, "spin": [0.0, 0.0, 0.0],
        })
    };
    case["bodies"] = json!([
        block("lower", [-0.1, -0.1, 0.0], [1.2, 1.2, 0.15], 12, [0.0; 3]),
        block("upper", [0.0, 0.0, 0.15], [1.0, 1.0, 0.15], CELLS, [1.0, 0.3, -0.05]),
    ]);
    case["obstacles"] =
        json!([{"name": "floor", "kind": "plane", "point": [0.0, 0.0, 0.0], "normal": [0.0, 0.0, 1.0]}]);
    case["contact"]["friction"] = json!(0.3);
    case["contact"]["solver"] = json!({"kind": "auto", "tolerance": 1e-12, "max_iterations": 10000});
    for condition in ["gap", "midpoint"] {
        case["contact"]["condition"] = json!(condition);
        let mut simulation = Simulation::<3>::new(&parse(&case)).expect("valid");
        while simulation.step() < simulation.steps() {
            simulation.advance(f64::INFINITY, || true).expect("runs");
            let step = simulation.nominal_step();
            assert!(step.contacts > 200 && step.newton_iterations <= 6, "{condition}: {step:?}");
        }
    }
}
