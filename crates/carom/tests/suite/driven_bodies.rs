//! Supports, loads and moving obstacles: what they do is known, and the books have their work.

use std::f64::consts::PI;

use carom::{
    ContactCondition, Load, Method, Model, ModelBody, Motion, NewtonRule, ObstacleMotion, Scheme, Signal,
    SignalSpec, State, Workspace, step,
};
use carom_contact::{ContactModel, ContactSurface, Discretisation, Obstacle, Pair, Target};
use carom_fem::material::{ElasticConstants, LawSpec, Mat3, Viscosity};
use carom_fem::{Body, BodySpec, Formulation, Hypothesis, MassKind, RayleighDamping};
use carom_friction::{Criterion, SolverKind, StoppingRule};
use carom_mesh::{Facet, Mesh, Vector, generate};

fn formula(text: &str) -> Signal {
    Signal::new(&SignalSpec::Expression(text.into())).expect("valid")
}

fn spec(law: LawSpec, density: f64, massless_contact: bool) -> BodySpec {
    BodySpec {
        law,
        density,
        damping: RayleighDamping::default(),
        viscosity: Viscosity::default(),
        regions: Vec::new(),
        mass: MassKind::Consistent,
        thickness: 1.0,
        hypothesis: Hypothesis::PlaneStrain,
        formulation: Formulation::Standard,
        initial_stress: Mat3::zeros(),
        grows: false,
        points: Vec::new(),
        massless_contact,
        share: None,
    }
}

fn method<const D: usize>(scheme: Scheme, condition: ContactCondition) -> Method<D> {
    Method {
        scheme,
        condition,
        solver: SolverKind::Auto.solver(),
        stopping: StoppingRule {
            tolerance: 1e-13,
            criterion: Criterion::Natural,
            max_iterations: 10_000,
            ..StoppingRule::default()
        },
        cross_check: false,
        newton: NewtonRule { tolerance: 1e-11, max_iterations: 60 },
        max_halvings: 0,
        bridges: false,
        certificate_tolerance: 1e-9,
        penetration_tolerance: 0.01,
    }
}

fn nodes_where<const D: usize>(mesh: &Mesh<D>, keep: impl Fn(&Vector<D>) -> bool) -> Vec<u32> {
    (0..mesh.nodes().len() as u32).filter(|&n| keep(&mesh.nodes()[n as usize])).collect()
}

fn facets_where<const D: usize>(body: &Body<D>, keep: impl Fn(&Vector<D>) -> bool) -> Vec<Facet> {
    let at = |n: &u32| body.mesh().nodes()[*n as usize];
    body.surface().facets().iter().filter(|f| f.nodes.iter().all(|n| keep(&at(n)))).cloned().collect()
}

const THETA: Scheme = Scheme::Theta { theta: 0.5, xi: 0.5 };

/// A bar along x on rollers, so that it is a bar: every y is held at zero.
fn bar(cells: usize, law: LawSpec, density: f64) -> Body<2> {
    let mesh = generate::grid([0.0, 0.0], [1.0, 0.1], [cells, 1]).expect("valid");
    Body::new(mesh, &spec(law, density, false)).expect("valid")
}

fn model_of<const D: usize>(body: Body<D>) -> Model<D> {
    let surface = ContactSurface::new(body.surface(), 0, &|n| body.mesh().nodes()[n as usize]);
    let contact = ContactModel { surfaces: vec![surface], ..ContactModel::default() };
    let bodies = vec![ModelBody::new("part", body, 0)];
    Model::new(bodies, contact, vec![], Vector::zeros())
}

fn motion<const D: usize>(nodes: Vec<u32>, components: [Option<Signal>; D]) -> Motion<D> {
    Motion { name: "support".into(), body: 0, nodes, components, turns: [None, None, None], since: 0.0 }
}

/// Largest |defect| of a step, the state at the end, and the sums of (external, prescribed) work.
fn run<const D: usize>(
    model: &Model<D>,
    method: &Method<D>,
    steps: usize,
    dt: f64,
    mut observe: impl FnMut(&State<D>, &Workspace<D>),
) -> (State<D>, f64, [f64; 2]) {
    let mut state = model.initial_state(vec![Vector::zeros(); model.node_count()]);
    let mut next = state.clone();
    let mut work = Workspace::new(model);
    let (mut defect, mut sums) = (0.0_f64, [0.0; 2]);
    for k in 1..=steps {
        let report = step(&model.assembly, method, &state, &mut next, dt, &mut work).expect("converges");
        next.time = k as f64 * dt;
        std::mem::swap(&mut state, &mut next);
        defect = defect.max(report.ledger.defect().abs());
        for body in &work.body_ledgers {
            defect = defect.max(body.defect().abs());
        }
        sums[0] += report.ledger.external;
        sums[1] += report.ledger.prescribed;
        observe(&state, &work);
    }
    (state, defect, sums)
}

/// u(x, t) of a fixed–free bar pulled by p sin(ωt) at its end: before the wave is back from the wall and out again,
/// the end moves as a half-infinite bar's would, v = p(t)/(ρc), and the support feels 2p(t − L/c).
#[test]
fn wave_from_a_load_is_doubled_at_the_support() {
    let (cells, density, young) = (200, 1.0, 1.0);
    let body = bar(cells, LawSpec::LinearElastic(ElasticConstants { young, poisson: 0.0 }), density);
    let all: Vec<u32> = (0..body.node_count() as u32).collect();
    let wall = nodes_where(body.mesh(), |x| x[0] == 0.0);
    let tip = facets_where(&body, |x| x[0] == 1.0);
    let load = Load::traction(&body, tip, [formula("1e-3*sin(pi*t)^2*step(1 - t)"), Signal::Constant(0.0)]);
    let zero = || Some(Signal::Constant(0.0));
    let model = model_of(body)
        .with_motions(vec![motion(wall, [zero(), None]), motion(all, [None, zero()])])
        .with_load(0, load);
    let dt = 2.5e-3;
    let pull = |t: f64| if (0.0..1.0).contains(&t) { 1e-3 * (PI * t).sin().powi(2) } else { 0.0 };
    let tip_node = model.assembly.reference.iter().position(|x| x[0] == 1.0).expect("a tip");
    let (mut worst_tip, mut worst_wall) = (0.0_f64, 0.0_f64);
    let (_, defect, _) = run(&model, &method(THETA, ContactCondition::Gap), 760, dt, |state, _| {
        worst_tip = worst_tip.max((state.velocity[tip_node][0] - pull(state.time)).abs());
        // On a face of 0.1 m²; the support pulls back.
        let force = -state.support[0][0];
        worst_wall = worst_wall.max((force - 0.1 * 2.0 * pull(state.time - 0.5 * dt - 1.0)).abs());
    });
    assert!(worst_tip < 1e-2 * 1e-3, "{worst_tip:.2e} m/s");
    assert!(worst_wall < 1e-2 * 2e-4, "{worst_wall:.2e} N");
    assert!(defect < 1e-18, "{defect:.1e} J");
}

/// A shaken wall: steady shaking of a bar's end at ω gives u = A cos(ω(L − x)/c)/cos(ωL/c) sin ωt after a start that is
/// slow enough to leave no free waves.
#[test]
fn shaken_bar_answers_with_its_standing_wave() {
    let body = bar(40, LawSpec::LinearElastic(ElasticConstants { young: 4.0, poisson: 0.0 }), 1.0);
    let all: Vec<u32> = (0..body.node_count() as u32).collect();
    let wall = nodes_where(body.mesh(), |x| x[0] == 0.0);
    // A start so smooth that it leaves no free waves, whose first frequency is π.
    let shake = "1e-3*sin(t)*0.5*(1 + tanh((t - 15)/3))";
    let zero = || Some(Signal::Constant(0.0));
    let model = model_of(body)
        .with_motions(vec![motion(wall, [Some(formula(shake)), None]), motion(all, [None, zero()])]);
    let tip = model.assembly.reference.iter().position(|x| x[0] == 1.0).expect("a tip");
    let (mut worst, mut peak) = (0.0_f64, 0.0_f64);
    let (_, defect, [_, prescribed]) =
        run(&model, &method(Scheme::Conserving, ContactCondition::Gap), 4000, 0.01, |state, _| {
            if state.time > 32.0 {
                let exact = 1e-3 / 0.5_f64.cos() * state.time.sin();
                worst = worst.max((state.displacement[tip][0] - exact).abs());
                peak = peak.max(exact.abs());
            }
        });
    assert!(worst < 1e-3 * peak, "{worst:.2e} of {peak:.2e}");
    assert!(defect < 1e-20 && prescribed > 1e-9, "{defect:.1e} of {prescribed:.1e} J");
}

/// A clamped block driven through large rotations and strains: whatever the scheme, what supports do closes the books.
#[test]
fn work_of_supports_closes_the_books_of_large_motion() {
    let law = LawSpec::SaintVenantKirchhoff(ElasticConstants { young: 100.0, poisson: 0.3 });
    for damping in [0.0, 0.2] {
        let mesh = generate::grid([0.0; 3], [0.3, 0.2, 1.0], [2, 2, 5]).expect("valid");
        let mut spec = spec(law.clone(), 1.0, false);
        spec.damping = RayleighDamping { mass: damping, stiffness: 1e-3 * damping };
        let body = Body::new(mesh, &spec).expect("valid");
        let bottom = nodes_where(body.mesh(), |x| x[2] == 0.0);
        let top = nodes_where(body.mesh(), |x| x[2] == 1.0 && x[0] == 0.0);
        let side = facets_where(&body, |x| x[0] == 0.3);
        let zero = || Some(Signal::Constant(0.0));
        let shaken = [Some(formula("0.2*sin(5*t)")), Some(formula("0.1*t^2")), zero()];
        let pulled = [None, Some(formula("-0.3*t")), None];
        let load = Load::follower_pressure(&body, side, formula("2*t"));
        let model =
            model_of(body).with_motions(vec![motion(bottom, shaken), motion(top, pulled)]).with_load(0, load);
        let (state, defect, [external, prescribed]) =
            run(&model, &method(Scheme::Conserving, ContactCondition::Midpoint), 100, 0.01, |_, _| ());
        let energy = state.energies.total();
        assert!(
            prescribed.abs() > 0.05 * energy && external.abs() > 0.01 * energy,
            "{prescribed} {external}"
        );
        assert!(defect < 1e-11 * energy, "{defect:.1e} of {energy:.1e} J");
        let bottom = model.motions[0].nodes[0] as usize;
        assert_eq!(state.displacement[bottom][0], 0.2 * 5.0_f64.sin());
        assert!((state.velocity[bottom][0] - 5.0_f64.cos()).abs() < 1e-14, "the rate of the signal");
    }
}

/// Pressure on all of a body's boundary has no resultant and no moment, dead or follower, whatever the configuration.
#[test]
fn pressure_all_around_moves_nothing() {
    let disc = generate::Disc { centre: [0.3, -0.2], radius: 0.5, divisions: 4, rings: None };
    let law = LawSpec::SaintVenantKirchhoff(ElasticConstants { young: 100.0, poisson: 0.3 });
    for follower in [false, true] {
        let body =
            Body::new(disc.quadrilaterals().expect("valid"), &spec(law.clone(), 1.0, false)).expect("valid");
        let facets = body.surface().facets().to_vec();
        let load = if follower {
            Load::follower_pressure(&body, facets, formula("20*t"))
        } else {
            Load::dead_pressure(&body, facets, formula("20*t"))
        };
        let model = model_of(body).with_load(0, load);
        let (state, defect, [external, _]) =
            run(&model, &method(Scheme::Conserving, ContactCondition::Gap), 100, 0.005, |_, _| ());
        let nodes = model.node_count();
        let centre = model.bodies[0].body.mean(&state.displacement[..nodes]);
        assert!(centre.norm() < 1e-12, "{follower}: {centre}");
        assert!(external > 0.1 && defect < 1e-12 * external, "{follower}: {defect:.1e} of {external:.1e} J");
    }
}

/// A force on nodes accelerates the body's centre as Newton says: F = M a, to round-off.
#[test]
fn force_on_nodes_accelerates_the_centre() {
    let mesh = generate::grid([0.0; 3], [1.0, 0.5, 0.5], [2, 1, 1]).expect("valid");
    let law = LawSpec::NeoHookean(ElasticConstants { young: 1e3, poisson: 0.3 });
    let body = Body::new(mesh, &spec(law, 8.0, false)).expect("valid");
    let corner = nodes_where(body.mesh(), |x| x[0] == 1.0);
    let count = corner.len() as f64;
    let force = [formula("3*t"), Signal::Constant(0.0), Signal::Constant(-1.0)];
    let model = model_of(body).with_load(0, Load::nodal_force(&corner, force));
    let (state, defect, [external, _]) =
        run(&model, &method(Scheme::Conserving, ContactCondition::Gap), 100, 0.01, |_, _| ());
    let velocity = model.bodies[0].body.mean(&state.velocity);
    // ∫F dt by the trapezoid rule is exact for forces linear in time. Mass 2 kg.
    let expected = Vector::<3>::new(1.5, 0.0, -1.0) * (count / 2.0);
    assert!((velocity - expected).norm() < 1e-10, "{velocity}");
    assert!(defect < 1e-11 * external, "{defect:.1e} J");
}

/// A block that is pressed on a floor that shakes, and guided along a wall.
fn shaken_block(condition: ContactCondition) -> Model<2> {
    let law = LawSpec::SaintVenantKirchhoff(ElasticConstants { young: 1e3, poisson: 0.3 });
    let mesh = generate::grid([0.0, 0.0], [1.0, 1.0], [5, 5]).expect("valid");
    let body = Body::new(mesh, &spec(law, 1.0, condition == ContactCondition::Massless)).expect("valid");
    let top = nodes_where(body.mesh(), |x| x[1] == 1.0);
    let side = nodes_where(body.mesh(), |x| x[0] == 0.0);
    let contact = ContactModel {
        surfaces: vec![ContactSurface::new(body.surface(), 0, &|n| body.mesh().nodes()[n as usize])],
        obstacles: vec![Obstacle::plane(Vector::zeros(), Vector::<2>::new(0.0, 1.0))],
        pairs: vec![Pair {
            source: 0,
            target: Target::Obstacle(0),
            friction: 0.4,
            discretisation: Discretisation::NodeToSegment,
        }]
        .into(),
    };
    let bodies = vec![ModelBody::new("part", body, 0)];
    let pressed = [Some(Signal::Constant(0.0)), Some(formula("-0.05*(1 - cos(2*pi*t))"))];
    // The left side slides along a wall: its lower corner is a contact that cannot answer along the floor.
    let guided = [Some(Signal::Constant(0.0)), None];
    let floor = ObstacleMotion::Displacement(Box::new([formula("0.05*sin(8*t)"), formula("-0.02*sin(9*t)")]));
    Model::new(bodies, contact, vec!["floor".into()], Vector::zeros())
        .with_motions(vec![motion(top, pressed), motion(side, guided)])
        .with_obstacle_motions(vec![floor])
}

/// A block clamped at its top is lowered onto a rough floor that shakes; condition by condition the books close.
#[test]
fn block_pressed_on_a_shaking_floor_keeps_the_books() {
    for condition in [ContactCondition::Midpoint, ContactCondition::Gap, ContactCondition::Massless] {
        let model = shaken_block(condition);
        let mut friction = 0.0;
        let mut lowest: f64 = 0.0;
        let (state, defect, [_, prescribed]) =
            run(&model, &method(Scheme::Conserving, condition), 300, 2e-3, |state, work| {
                friction += work.pair_reports.values().map(|pair| pair.ledger.friction).sum::<f64>();
                let floor = state.displacement[model.node_count()][1];
                for n in 0..model.node_count() {
                    lowest = lowest.min(model.assembly.reference[n][1] + state.displacement[n][1] - floor);
                }
            });
        let scale = prescribed.abs() + friction + state.energies.total();
        assert!(friction > 0.05, "{condition:?}: {friction} J");
        assert!(defect < 1e-9 * scale, "{condition:?}: {defect:.1e} of {scale:.1e} J");
        assert!(lowest > -1e-3, "{condition:?}: {lowest:.1e} m inside");
        if condition != ContactCondition::Midpoint {
            assert!(lowest > -1e-9, "{condition:?}: {lowest:.1e} m inside");
        }
    }
}

/// Symptom guarded against: the impulses of landing were not in the forces of supports.
#[test]
fn supports_and_floor_give_a_block_its_momentum() {
    for condition in [ContactCondition::Midpoint, ContactCondition::Gap] {
        let model = shaken_block(condition);
        let body = &model.bodies[0].body;
        let mut momentum = Vector::<2>::zeros();
        let (mut worst, mut largest, mut landed) = (0.0_f64, 0.0_f64, 0);
        run(&model, &method(Scheme::Conserving, condition), 300, 2e-3, |state, work| {
            let mut of_nodes = vec![Vector::zeros(); body.node_count()];
            body.mass().multiply(&state.velocity[..body.node_count()], &mut of_nodes);
            let now: Vector<2> = of_nodes.iter().sum();
            let contact: Vector<2> = state.contact_force[..body.node_count()].iter().sum();
            let support: Vector<2> = state.support.iter().sum();
            worst = worst.max((now - momentum - (contact + support) * 2e-3).norm());
            largest = largest.max(now.norm());
            momentum = now;
            landed += work.pair_reports.values().filter(|pair| pair.ledger.normal_contact != 0.0).count();
        });
        assert!(worst < 1e-12 * largest, "{condition:?}: {worst:.1e} of {largest:.1e} N s");
        assert!(landed > 3, "{condition:?}: {landed}");
    }
}
