//! Bodies that contacts connect iterate together, islands of them each to an end of its own.

use carom::{Simulation, State};
use serde_json::{Value, json};

use crate::checkpoint::goes_on_identically;
use crate::common::{body, disc, parse, plane, scenario};

/// A disc that slides into another on a floor, gently, and far away two that hit one another, or fly apart.
fn two_islands(condition: &str, hits: bool) -> Value {
    let speed = if hits { 3.0 } else { -3.0 };
    let bodies = [
        body("slow", disc([0.0, 1.0002], 1.0, 6), [0.1, -0.01]),
        body("its neighbour", disc([2.001, 1.0002], 1.0, 4), [0.0, -0.01]),
        body("fast", disc([20.0, 3.0], 1.0, 4), [speed, 0.0]),
        body("its opponent", disc([22.1, 3.4], 1.0, 6), [-speed, 0.0]),
    ];
    let mut case = scenario(0.1, 2e-3, &bodies, &[plane("floor", [0.0, 0.0], [0.0, 1.0])]);
    case["analysis"]["scheme"] = json!({"kind": "conserving"});
    case["contact"]["condition"] = json!(condition);
    case["contact"]["friction"] = json!(0.3);
    case["contact"]["sources"] = Value::Null;
    case["contact"]["solver"]["kind"] = json!("auto");
    case
}

fn run(case: &Value) -> Simulation<2> {
    let mut simulation = Simulation::<2>::new(&parse(case)).expect("valid");
    simulation.advance(f64::INFINITY, || false).expect("runs");
    simulation
}

/// Where the first two bodies are, and how fast, and how many contacts press there.
fn of_first_two(simulation: &Simulation<2>) -> (Vec<f64>, usize) {
    let nodes = simulation.model().bodies[1].nodes().end;
    let State { displacement, velocity, reactions, .. } = simulation.state();
    let parts = [&displacement[..nodes], &velocity[..nodes]];
    let numbers = parts.into_iter().flatten().flat_map(|x| x.iter().copied()).collect();
    (numbers, reactions.iter().filter(|r| (r.node() as usize) < nodes).count())
}

/// How far the first two move otherwise where the others hit one another [m], [m/s].
fn trace(condition: &str, friction: &Value, cohesion: &Value) -> f64 {
    let [with, without] = [true, false].map(|hits| {
        let mut case = two_islands(condition, hits);
        case["contact"]["friction"] = friction.clone();
        case["contact"]["cohesion"] = cohesion.clone();
        run(&case)
    });
    let (first, second) = (of_first_two(&with), of_first_two(&without));
    assert!(first.1 > 0 && first.1 == second.1, "they touch at the end");
    let met = |run: &Simulation<2>| run.summary().contacts.len();
    assert!(met(&with) > met(&without), "the others hit one another, or not");
    first.0.iter().zip(&second.0).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Symptom guarded against: all bodies in contact had one contact problem, one acceleration and the iterations of the slowest of them.
#[test]
fn what_collides_elsewhere_leaves_no_trace_in_an_island_to_the_last_bit() {
    let laws = [
        json!(0.3),
        json!({"static": 0.4, "kinetic": 0.2, "speed": 0.05}),
        json!({"formula": "0.2 + 0.1*exp(-10*s)"}),
    ];
    for friction in &laws {
        for cohesion in [Value::Null, json!({"force": 0.05, "lasting": true})] {
            assert_eq!(trace("gap", friction, &cohesion), 0.0, "{friction} {cohesion}");
        }
    }
    assert_eq!(trace("massless", &laws[0], &Value::Null), 0.0);
    // Impulses that give back what landing took are sought for all at once.
    let left = trace("midpoint", &laws[0], &Value::Null);
    assert!(left < 1e-12, "{left:e} m/s");
}

/// The contact problem that a run tells of, its residual and its books are those of all islands.
#[test]
fn the_contact_problem_of_a_step_and_its_books_are_those_of_all_islands() {
    for condition in ["gap", "midpoint", "massless"] {
        let mut simulation = Simulation::<2>::new(&parse(&two_islands(condition, true))).expect("valid");
        let nodes = simulation.model().bodies[1].nodes().end;
        let mut seen = 0;
        while simulation.step() < simulation.steps() {
            simulation.advance(f64::INFINITY, || true).expect("runs");
            let (near, far): (Vec<_>, Vec<_>) =
                simulation.state().reactions.iter().partition(|r| (r.node() as usize) < nodes);
            if near.is_empty() || far.is_empty() {
                continue;
            }
            seen += 1;
            let posed = simulation.posed_problem().expect("contacts");
            let (problem, count) = (posed.problem, posed.problem.len());
            assert!(count >= near.len() + far.len() && posed.guess.len() == count, "{condition}: {count}");
            let rows = (0..count).map(|i| problem.w.row(i).len()).max().expect("rows");
            assert!(rows < count, "{condition}: islands do not respond to one another");
        }
        assert!(seen > 3, "{condition}: {seen} steps with two islands in contact");
        let summary = simulation.summary();
        let residual = summary.certificate.max_residual;
        assert!(residual > 0.0 && residual <= 1e-12, "{condition}: {residual:e}");
        let books = simulation.books().total;
        let initial = summary.energy.initial;
        assert!(books.defect().abs() < 2e-11 * initial, "{condition}: {:e} of {initial} J", books.defect());
    }
}

#[test]
fn islands_are_the_same_with_any_number_of_threads_and_over_a_restart() {
    let mut case = two_islands("massless", true);
    case["analysis"]["end_time"] = json!(0.06);
    for body in case["bodies"].as_array_mut().expect("bodies") {
        // So many nodes that threads share the bodies of an island.
        body["mesh"]["divisions"] = json!(20);
    }
    let state = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| run(&case).state().clone())
    };
    let one = state(1);
    assert!(one.displacement.len() > 4000, "{}", one.displacement.len());
    assert_eq!(state(2), one);
    assert_eq!(state(3), one);
    goes_on_identically::<2>(&two_islands("massless", true), 4);
}
