//! What has come to rest takes no part in steps, and moves as it would have in the step in which something changes.

use carom::{Meshes, Simulation, State, Workspace, build, step};
use serde_json::{Value, json};

use crate::checkpoint::goes_on_identically;
use crate::common::{body, parse, plane, scenario};

const DT: f64 = 1e-3;

/// Two squares on one another and on a floor, and one that sinks through something thick, so slowly that the others are long at rest when it comes.
fn scene(end_time: f64, fall: f64) -> Value {
    let square = |name: &str, corner: [f64; 2], cells: usize| {
        let mesh =
            json!({"kind": "rectangle", "corner": corner, "size": [1.0, 1.0], "divisions": [cells, cells]});
        body(name, mesh, [0.0, 0.0])
    };
    let bodies = [
        square("lower", [0.0, 0.0], 2),
        square("upper", [0.1, 1.0], 3),
        square("falling", [-0.2, 2.0 + fall], 2),
    ];
    let mut case = scenario(end_time, DT, &bodies, &[plane("floor", [0.0, 0.0], [0.0, 1.0])]);
    case["analysis"]["scheme"] = json!({"kind": "conserving"});
    case["analysis"]["gravity"] = json!([0.0, -9.81]);
    case["materials"]["elastic"] = json!({
        "kind": "saint-venant-kirchhoff", "young": 1e8, "poisson": 0.3, "density": 1000.0,
        "damping": {"mass": 100.0, "stiffness": 1e-4},
    });
    case["contact"]["condition"] = json!("midpoint");
    case["contact"]["friction"] = json!(0.5);
    case["contact"]["sources"] = Value::Null;
    case["contact"]["solver"]["kind"] = json!("auto");
    case
}

/// The same without the third.
fn two(end_time: f64) -> Value {
    let mut case = scene(end_time, 1.0);
    case["bodies"].as_array_mut().expect("bodies").pop();
    case
}

fn started(case: &Value) -> Simulation<2> {
    Simulation::new(&parse(case)).expect("valid")
}

/// Goes on to a time [s].
fn go_on(simulation: &mut Simulation<2>, until: f64) {
    simulation.advance(until, || false).expect("runs");
}

/// The states of a case whose bodies never rest, after each of so many steps.
fn awake(case: &Value, steps: u64, mut observe: impl FnMut(u64, &State<2>)) {
    let (model, method, mut state) = build::<2>(&parse(case), Meshes::new()).expect("valid");
    let (mut next, mut work) = (state.clone(), Workspace::new(&model));
    for k in 1..=steps {
        step(&model.assembly, &method, &state, &mut next, DT, &mut work).expect("converges");
        next.time = k as f64 * DT;
        std::mem::swap(&mut state, &mut next);
        observe(k, &state);
    }
}

/// How far apart bodies are in two states [m].
fn apart(a: &State<2>, b: &State<2>) -> f64 {
    a.displacement.iter().zip(&b.displacement).map(|(u, v)| (u - v).norm()).fold(0.0, f64::max)
}

#[test]
fn a_stack_at_rest_takes_no_iterations_and_its_state_and_books_are_complete() {
    let case = two(1.5);
    let mut simulation = started(&case);
    go_on(&mut simulation, 0.9);
    assert_eq!(simulation.resting(), [true, true]);
    let before = (simulation.state().clone(), simulation.books().clone(), simulation.newton_iterations());
    go_on(&mut simulation, f64::INFINITY);
    let (state, books) = (simulation.state(), simulation.books());
    assert_eq!(simulation.newton_iterations(), before.2);
    assert_eq!(state.displacement, before.0.displacement);
    assert_eq!(state.reactions, before.0.reactions);
    assert_eq!(state.contact_force, before.0.contact_force);
    assert_eq!(*books, before.1);
    let weight = 2.0 * 1000.0 * 9.81;
    let normal: f64 = simulation.nominal_step().normal_force;
    assert!((normal - 1.5 * weight).abs() < 1e-6 * weight, "{normal} N on the floor and between the two");
    assert!(books.total.defect().abs() < 1e-12 * books.total.external.abs(), "{:e}", books.total.defect());
    let summary = simulation.summary();
    assert!(summary.contacts.iter().all(|event| event.release.is_none_or(|t| t < 0.9)), "both still touch");
    // What steps would have done instead is less than what their iterations leave.
    let mut end = None;
    awake(&case, simulation.steps(), |k, state| end = (k == 1500).then(|| state.clone()));
    let end = end.expect("the last step");
    assert!(apart(&end, simulation.state()) < 1e-13, "{:e} m", apart(&end, simulation.state()));
    let energies = [&end, simulation.state()].map(|state| state.energies.total());
    assert!((energies[0] - energies[1]).abs() < 1e-10 * energies[0].abs(), "{energies:?} J");
}

#[test]
fn what_falls_on_a_stack_at_rest_finds_it_as_if_it_had_never_rested() {
    let case = scene(1.3, 0.1);
    let mut simulation = started(&case);
    go_on(&mut simulation, 0.9);
    assert_eq!(simulation.resting(), [true, true, false]);
    let (mut states, mut worst, mut roused) = (Vec::new(), 0.0_f64, None);
    awake(&case, simulation.steps(), |_, state| states.push(state.clone()));
    while simulation.step() < simulation.steps() {
        simulation.advance(f64::INFINITY, || true).expect("runs");
        worst = worst.max(apart(&states[simulation.step() as usize - 1], simulation.state()));
        if roused.is_none() && simulation.resting() == [false; 3] {
            roused = Some(simulation.step());
        }
    }
    let landed =
        states.iter().position(|state| state.reactions.iter().any(|r| r.node() >= 25)).expect("it lands");
    let roused = roused.expect("they move");
    assert!(roused <= landed as u64 + 1, "roused in step {roused}, and hit in step {}", landed + 1);
    assert!(roused + 20 > landed as u64, "{roused}, {landed}");
    assert!(worst < 1e-9, "{worst:e} m");
}

#[test]
fn a_load_that_sets_in_and_a_floor_that_moves_off_are_felt_in_their_step() {
    let mut pushed = two(1.0);
    pushed["loads"] =
        json!([{"kind": "traction", "body": "upper", "on": "top", "traction": [0.0, "-1e3*step(t - 0.9)"]}]);
    let mut carried = two(1.0);
    carried["obstacles"][0]["motion"] = json!({"y": "0.05*step(t - 0.9)*(t - 0.9)"});
    for case in [pushed, carried] {
        let mut simulation = started(&case);
        go_on(&mut simulation, 0.9 - 1.5 * DT);
        assert_eq!(simulation.resting(), [true, true], "{case}");
        let mut states = Vec::new();
        awake(&case, simulation.steps(), |_, state| states.push(state.clone()));
        let still = simulation.state().clone();
        // Later on the stack bounces, and which of two corners is first hangs on round-off.
        while simulation.step() < 905 {
            simulation.advance(f64::INFINITY, || true).expect("runs");
            let (now, other) = (simulation.state(), &states[simulation.step() as usize - 1]);
            assert!(apart(now, other) < 1e-10, "step {}: {:e} m", simulation.step(), apart(now, other));
        }
        assert!(apart(&still, simulation.state()) > 1e-6, "it moves");
        assert_eq!(simulation.resting(), [false, false]);
    }
}

/// Symptom guarded against: what lies on a plate whose motion has not begun, or that is clamped, never rested.
#[test]
fn what_lies_on_a_support_that_will_move_rests_until_it_does_and_its_force_stays() {
    for motion in [
        json!({"kind": "prescribed", "body": "lower", "on": "bottom", "x": 0.0, "y": "0.05*step(t - 0.9)*(t - 0.9)"}),
        json!({"kind": "fixed", "body": "lower", "on": "bottom"}),
    ] {
        let mut case = two(1.0);
        case["obstacles"] = json!([]);
        let moves = motion["kind"] == "prescribed";
        case["motions"] = json!([motion]);
        case["output"]["history_every"] = json!(DT);
        let mut simulation = started(&case);
        go_on(&mut simulation, 0.9 - 1.5 * DT);
        assert_eq!(simulation.resting(), [true, true], "{case}");
        let weight = 2.0 * 1000.0 * 9.81;
        let held = simulation.state().support[0][1];
        assert!((held - weight).abs() < 1e-6 * weight, "{held} N hold {weight} N");
        let mut states = Vec::new();
        awake(&case, 905, |_, state| states.push(state.clone()));
        let still = simulation.state().clone();
        while simulation.step() < 905 {
            simulation.advance(f64::INFINITY, || true).expect("runs");
            let (now, other) = (simulation.state(), &states[simulation.step() as usize - 1]);
            assert!(apart(now, other) < 1e-10, "step {}: {:e} m", simulation.step(), apart(now, other));
            let off = (now.support[0] - other.support[0]).norm();
            assert!(off < 1e-6 * weight, "step {}: {off:e} N", simulation.step());
        }
        assert_eq!(simulation.resting(), [!moves; 2]);
        assert_eq!(apart(&still, simulation.state()) > 1e-6, moves);
        let defect = simulation.books().total.defect().abs();
        assert!(defect < 1e-10 * simulation.books().total.external.abs(), "{defect:e} J");
    }
}

/// Whether anything rests in any step.
fn ever_rests(case: &Value) -> bool {
    let mut simulation = started(case);
    let mut rests = false;
    while simulation.step() < simulation.steps() {
        simulation.advance(f64::INFINITY, || true).expect("runs");
        rests |= simulation.resting().iter().any(|rests| *rests);
    }
    rests
}

#[test]
fn what_creeps_falls_rings_or_drifts_never_rests() {
    // A floor that carries its load along at a picometre per second.
    let mut creeping = two(1.5);
    creeping["obstacles"][0]["velocity"] = json!([1e-12, 0.0]);
    assert!(!ever_rests(&creeping), "creeping");
    // Free fall and a drift in steps so short that no motion is above round-off.
    for (gravity, speed) in [(-9.81, 0.0), (0.0, 1e-5)] {
        let mut short = two(5e-9);
        short["analysis"]["time_step"] = json!(1e-12);
        short["analysis"]["gravity"] = json!([0.0, gravity]);
        short["bodies"][1]["velocity"] = json!([0.0, speed]);
        short["bodies"][1]["mesh"]["corner"] = json!([0.1, 1.5]);
        short["bodies"].as_array_mut().expect("bodies").remove(0);
        assert!(!ever_rests(&short), "gravity {gravity}, speed {speed}");
    }
    let mut ringing = two(1.0);
    ringing["materials"]["elastic"].as_object_mut().expect("a law").remove("damping");
    assert!(!ever_rests(&ringing), "ringing");
}

#[test]
fn bodies_at_rest_go_on_identically_with_any_number_of_threads() {
    let case = scene(3.3, 0.1);
    let whole = goes_on_identically::<2>(&case, 8);
    assert!(!whole.summary().contacts.is_empty());
    let end = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let mut simulation = started(&case);
            go_on(&mut simulation, f64::INFINITY);
            assert_eq!(simulation.resting(), [true; 3]);
            (simulation.state().clone(), simulation.books().clone())
        })
    };
    assert!(end(1) == end(3));
}
