//! The contact problems that steps pose: a failed one is there to look at, and a second solver can check each.

use crate::common::{body, disc, parse, plane, scenario};
use carom::{RunError, Simulation, StepError};
use carom_friction::{Criterion, SolveStatus, SolverKind, StoppingRule};
use serde_json::{Value, json};

/// A disc that falls askew on a floor with friction, and another on the first.
fn scene() -> Value {
    let bodies = [
        body("low", disc([0.0, 1.01], 1.0, 6), [1.0, -2.0]),
        body("high", disc([0.9, 2.85], 1.0, 6), [0.0, -3.0]),
    ];
    let mut case = scenario(0.2, 1e-3, &bodies, &[plane("floor", [0.0, 0.0], [0.0, 1.0])]);
    case["contact"]["friction"] = json!(0.2);
    case
}

#[test]
fn the_problem_that_failed_can_be_solved_again_and_ends_the_same_way() {
    let mut case = scene();
    case["contact"]["solver"]["max_iterations"] = json!(1);
    let mut simulation = Simulation::<2>::new(&parse(&case)).expect("valid");
    let error = simulation.advance(f64::INFINITY, || false).expect_err("one sweep is not enough");
    let RunError { halvings: 8, reason: StepError::Friction { contacts, report }, .. } = error else {
        panic!("{error}");
    };
    let posed = simulation.posed_problem().expect("a contact problem failed");
    assert_eq!((posed.problem.len(), posed.guess.len()), (contacts, contacts));
    let rule = StoppingRule {
        tolerance: 1e-12,
        criterion: Criterion::Natural,
        max_iterations: 1,
        ..StoppingRule::default()
    };
    let mut r = posed.guess.to_vec();
    let replay = SolverKind::GaussSeidel.solver().solve(posed.problem, &mut r, &rule);
    assert_eq!(replay.status, SolveStatus::IterationLimit);
    assert_eq!((replay.status, replay.iterations), (report.status, report.iterations));
    assert_eq!(replay.measure, report.measure);
    // It was only the limit that was wrong.
    let mut r = posed.guess.to_vec();
    let enough = StoppingRule { max_iterations: 10_000, ..rule };
    assert!(SolverKind::GaussSeidel.solver().solve(posed.problem, &mut r, &enough).is_solved());
}

#[test]
fn there_is_no_contact_problem_before_the_first_contact() {
    let mut simulation = Simulation::<2>::new(&parse(&scene())).expect("valid");
    simulation.advance(1e-3, || false).expect("runs");
    assert!(simulation.posed_problem().is_none());
}

/// Symptom guarded against: a check that left its own reactions behind would start the next step from them.
#[test]
fn a_second_solver_agrees_and_changes_nothing() {
    let alone = scene();
    let mut checked = alone.clone();
    checked["contact"]["solver"]["cross_check"] = json!(true);
    let [mut alone, mut checked] = [alone, checked].map(|c| Simulation::<2>::new(&parse(&c)).expect("valid"));
    for simulation in [&mut alone, &mut checked] {
        simulation.advance(f64::INFINITY, || false).expect("runs");
    }
    assert_eq!(alone.state(), checked.state());
    assert_eq!(alone.take_history(), checked.take_history());
    let (alone, checked) = (alone.summary(), checked.summary());
    assert_eq!(alone.cross_check, None);
    let check = checked.cross_check.expect("was asked for");
    assert!(check.problems > 50, "{check:?}");
    assert_eq!((check.unsolved, check.disagreements), (0, 0), "{check:?}");
    assert!(check.max_difference > 0.0, "the same digits from two solvers: was it a second one?");
    assert!(check.max_difference < check.explained_difference);
    // Both answers are as far from Coulomb's law as their tolerance lets them be.
    assert!(check.max_certificate_joule < checked.certificate.tolerance_joule);
}
