//! A body that is not of finite elements: a point mass on a spring. The step knows nothing of cells, and so takes it as any other.

use carom::{
    Assembly, Body, BodyEnd, BodyLedger, BodyState, ContactCondition, Energies, Forecast, Guess, Interval,
    Jolt, Member, Method, NewtonRule, Scheme, State, StepError, StressRule, Workspace, step,
};
use carom_contact::{ContactModel, ContactSurface, Discretisation, Obstacle, Pair, Target};
use carom_friction::{Criterion, SolverKind, StoppingRule};
use carom_mesh::{Matrix, Surface, Vector};

const MASS: f64 = 2.0;
const GRAVITY: f64 = 10.0;
const DT: f64 = 1e-3;

/// A point of mass m that a spring of stiffness k pulls back along x, under gravity along y.
#[derive(Default)]
struct PointMass {
    stiffness: f64,
    gravity: Vector<2>,
    /// The diagonal of K̄⁻¹ [m/N].
    compliance: Vector<2>,
    /// What is being solved for.
    right_hand_side: Vector<2>,
    generation: u64,
}

impl PointMass {
    fn force(&self, u: &Vector<2>) -> Vector<2> {
        Vector::<2>::new(self.stiffness * u[0], 0.0)
    }

    /// The mean force of a step: of a linear spring the same by every rule.
    fn mean_force(&self, guess: &Guess<'_, 2>) -> Vector<2> {
        let map = &guess.interval.map;
        let ends = [guess.start.displacement[0], guess.displacement[0]].map(|u| self.force(&u));
        match map.stress {
            StressRule::Weighted => ends[0] * (1.0 - map.xi) + ends[1] * map.xi,
            StressRule::Conserving => (ends[0] + ends[1]) * 0.5,
        }
    }
}

impl Body<2> for PointMass {
    fn measure(&self, state: &BodyState<'_, 2>, internal_force: &mut [Vector<2>]) -> Energies {
        let u = &state.displacement[0];
        internal_force[0] = self.force(u);
        Energies {
            kinetic: 0.5 * MASS * state.velocity[0].norm_squared(),
            strain: 0.5 * u.dot(&internal_force[0]),
            springs: 0.0,
        }
    }

    fn mean_velocity(&self, velocity: &[Vector<2>]) -> Vector<2> {
        velocity[0]
    }

    fn begin_step(
        &mut self,
        interval: &Interval,
        start: &BodyState<'_, 2>,
        _motion: &mut [Vector<2>],
    ) -> Result<Forecast, StepError> {
        let map = &interval.map;
        let inertia = MASS * map.mass_coefficient();
        self.compliance =
            Vector::<2>::new(1.0 / (inertia + map.stiffness_coefficient() * self.stiffness), 1.0 / inertia);
        self.generation += 1;
        Ok(Forecast {
            speed: start.velocity[0].norm(),
            acceleration: self.gravity.norm(),
            driven: 0.0,
            is_factorised: true,
        })
    }

    fn residual(&mut self, guess: &Guess<'_, 2>, _blend: Option<f64>, out: &mut [Vector<2>]) {
        let map = &guess.interval.map;
        let v0 = &guess.start.velocity[0];
        let v1 = map.end_velocity(v0, &guess.motion[0]);
        out[0] = (self.gravity - (v1 - v0) / map.dt) * MASS - self.mean_force(guess);
    }

    fn begin_solve(&mut self, residual: &[Vector<2>]) {
        self.right_hand_side = residual[0];
    }

    fn set_reach(&mut self, _nodes: &[u32]) {}

    fn partial_solve(&mut self, _nodes: &[u32], out: &mut [Vector<2>]) {
        out[0] = self.right_hand_side.component_mul(&self.compliance);
    }

    fn add_forces(&mut self, _nodes: &[u32], forces: &[Vector<2>]) {
        self.right_hand_side += forces[0];
    }

    fn end_solve(&mut self, correction: &mut [Vector<2>]) {
        correction[0] = self.right_hand_side.component_mul(&self.compliance);
    }

    fn renew(&mut self, _guess: &Guess<'_, 2>, _again: bool) -> Result<(), StepError> {
        Ok(())
    }

    fn forget(&mut self) {}

    fn end_step(
        &mut self,
        guess: &Guess<'_, 2>,
        _blend: Option<f64>,
        end: BodyEnd<'_, 2>,
    ) -> (BodyLedger, Energies) {
        let (map, start, d) = (&guess.interval.map, &guess.start, &guess.motion[0]);
        end.velocity[0] = map.end_velocity(&start.velocity[0], d);
        let (u, v) = ([guess.displacement[0]], [end.velocity[0]]);
        let at_end = BodyState { displacement: &u, velocity: &v, ..*start };
        let energies = self.measure(&at_end, end.internal_force);
        let jump = v[0] - start.velocity[0];
        let stretch = end.internal_force[0] - start.internal_force[0];
        let ledger = BodyLedger {
            kinetic: energies.kinetic - start.energies.kinetic,
            strain: energies.strain - start.energies.strain,
            external: MASS * self.gravity.dot(d),
            scheme: map.kinetic_dissipation * MASS * jump.norm_squared()
                + map.strain_dissipation * d.dot(&stretch),
            contact: end.mean_contact_force[0].dot(d),
            ..BodyLedger::default()
        };
        (ledger, energies)
    }

    fn mass_of(&self, _node: u32) -> f64 {
        MASS
    }

    fn jolt(
        &mut self,
        impulse: &mut [Vector<2>],
        _state: &BodyState<'_, 2>,
        change: &mut [Vector<2>],
        _support: &mut [Vector<2>],
    ) -> Jolt {
        change[0] = impulse[0] / MASS;
        Jolt::default()
    }

    fn generation(&self) -> u64 {
        self.generation
    }

    fn respond(&mut self, _nodes: &[u32]) {}

    fn response(&self, _a: u32, _b: u32, _number: usize) -> Matrix<2> {
        Matrix::from_diagonal(&self.compliance)
    }
}

/// A point mass above a floor, or against a wall that stands `gap` [m] before it.
struct Setting {
    assembly: Assembly<2>,
    bodies: Vec<Box<dyn Body<2>>>,
}

fn setting(stiffness: f64, gravity: f64, obstacle: Obstacle<2>, friction: f64) -> Setting {
    let pair = Pair {
        source: 0,
        target: Target::Obstacle(0),
        friction,
        discretisation: Discretisation::NodeToSegment,
    };
    let contact = ContactModel {
        surfaces: vec![ContactSurface::of_points(vec![0])],
        obstacles: vec![obstacle],
        pairs: vec![pair].into(),
    };
    let member = Member {
        name: "mass".into(),
        reference: vec![Vector::zeros()],
        diameter: 1.0,
        boundary: Surface::default(),
        held: Vec::new(),
        is_massless: false,
        turns: false,
        axis: Vec::new(),
        stepped: Vec::new(),
    };
    let body = PointMass { stiffness, gravity: Vector::<2>::new(0.0, -gravity), ..PointMass::default() };
    Setting {
        assembly: Assembly::new(vec![member], contact, vec!["obstacle".into()]),
        bodies: vec![Box::new(body)],
    }
}

fn method(scheme: Scheme, condition: ContactCondition) -> Method<2> {
    Method {
        scheme,
        condition,
        solver: SolverKind::GaussSeidel.solver(),
        stopping: StoppingRule { tolerance: 1e-14, criterion: Criterion::Natural, ..StoppingRule::default() },
        cross_check: false,
        newton: NewtonRule { tolerance: 1e-12, max_iterations: 50 },
        max_halvings: 0,
        bridges: false,
        certificate_tolerance: 1e-9,
        penetration_tolerance: 0.01,
    }
}

/// Steps `count` times from a `velocity` along x [m/s]; `observe` sees every state and what friction has taken so far [J].
fn run(
    setting: Setting,
    method: &Method<2>,
    velocity: f64,
    count: usize,
    mut observe: impl FnMut(&State<2>, f64),
) {
    let Setting { assembly, bodies } = setting;
    let mut state = State::initial(&assembly, &bodies, vec![Vector::<2>::new(velocity, 0.0)]);
    let (mut next, mut friction) = (state.clone(), 0.0);
    let mut work = Workspace::with_bodies(&assembly, bodies);
    let energy = state.energies.total();
    for _ in 0..count {
        let report = step(&assembly, method, &state, &mut next, DT, &mut work).expect("converges");
        assert!(report.ledger.defect().abs() < 1e-13 * energy, "{:?}", report.ledger);
        friction += report.ledger.friction;
        std::mem::swap(&mut state, &mut next);
        observe(&state, friction);
    }
}

/// Closed form: the trapezoidal rule swings with the frequency ω̂ = (2/Δt) arctan(ωΔt/2), and with the amplitude v/ω for ever.
#[test]
fn a_point_mass_on_a_spring_swings_as_the_scheme_says() {
    let stiffness = 5e3;
    let omega = (stiffness / MASS).sqrt();
    let discrete = 2.0 / DT * (0.5 * omega * DT).atan();
    for scheme in [Scheme::Conserving, Scheme::Theta { theta: 0.5, xi: 0.5 }] {
        let far = Obstacle::plane(Vector::<2>::new(-1.0, 0.0), Vector::<2>::new(1.0, 0.0));
        let method = method(scheme, ContactCondition::Gap);
        run(setting(stiffness, 0.0, far, 0.0), &method, 1.0, 2000, |state, _| {
            let expected = (discrete * state.time).sin() / omega;
            assert!((state.displacement[0][0] - expected).abs() < 1e-12, "{} {expected}", state.time);
        });
    }
}

/// Closed form: a wall half way out turns it back, so that it swings with the energy that it has, between the wall and its own amplitude.
#[test]
fn a_point_mass_that_bounces_off_a_wall_keeps_its_energy() {
    let stiffness = 5e3;
    let omega = (stiffness / MASS).sqrt();
    let amplitude = 1.0 / omega;
    let wall = Obstacle::plane(Vector::<2>::new(-0.5 * amplitude, 0.0), Vector::<2>::new(1.0, 0.0));
    let method = method(Scheme::Conserving, ContactCondition::Midpoint);
    let (mut bounces, mut before, mut largest) = (0, 1.0, 0.0_f64);
    run(setting(stiffness, 0.0, wall, 0.0), &method, 1.0, 2000, |state, _| {
        assert!((state.energies.total() - 0.5 * MASS).abs() < 1e-12);
        largest = largest.max(state.displacement[0][0]);
        assert!(state.displacement[0][0] > -0.5 * amplitude - 1e-15, "it lands on the wall");
        let v = state.velocity[0][0];
        bounces += usize::from(before < 0.0 && v > 0.5);
        before = v;
    });
    // Out to the wall and back takes ⅔ of a period: sin⁻¹(−½) is a twelfth of one from the middle.
    let period = 2.0 * std::f64::consts::PI / omega;
    let expected = (2000.0 * DT - 7.0 / 12.0 * period) / (2.0 / 3.0 * period) + 1.0;
    assert!((bounces as f64 - expected).abs() < 1.5, "{bounces} bounces, {expected} expected");
    assert!((largest / amplitude - 1.0).abs() < 2e-3, "{largest} of {amplitude}");
}

/// Closed form: Coulomb friction takes 2μmg/k of the amplitude in every half period, until the spring cannot move the mass any more.
#[test]
fn coulomb_friction_takes_the_same_from_every_swing() {
    let (stiffness, friction) = (50.0, 0.1);
    let floor = Obstacle::plane(Vector::zeros(), Vector::<2>::new(0.0, 1.0));
    let method = method(Scheme::Conserving, ContactCondition::Gap);
    let loss = 2.0 * friction * MASS * GRAVITY / stiffness;
    let (mut turns, mut last): (Vec<f64>, (f64, f64)) = (Vec::new(), (0.0, 1.0));
    let start = 3.0;
    run(setting(stiffness, GRAVITY, floor, friction), &method, start, 8000, |state, taken| {
        let (u, v) = (state.displacement[0][0], state.velocity[0][0]);
        if v * last.1 < 0.0 {
            turns.push(last.0.abs());
        }
        if v != 0.0 {
            last = (u, v);
        }
        let kept = state.energies.total();
        assert!((kept + taken - 0.5 * MASS * start * start).abs() < 1e-10, "{kept} {taken}");
    });
    // Where the spring pulls less than friction holds, nothing turns any more.
    turns.retain(|&u| u > 0.5 * loss);
    assert!(turns.len() > 3, "{turns:?}");
    for pair in turns.windows(2) {
        assert!((pair[0] - pair[1] - loss).abs() < 2e-3 * loss, "{pair:?}, {loss}");
    }
}
