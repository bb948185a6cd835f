use carom_friction::{Criterion, StoppingRule};

use super::values::number;
use crate::error::InputError;
use crate::model::method::{Method, NewtonRule};
use crate::scenario::{AnalysisKind, SLACK, Scenario, SolverSpec, Spin, Stabilisation};
use crate::{ContactCondition, Scheme};

/// How the scenario is taken through time.
pub(super) fn method<const D: usize>(scenario: &Scenario) -> Result<Method<D>, InputError> {
    let analysis = &scenario.analysis;
    let (dt, [start, end]) = (analysis.time_step, analysis.span());
    number("analysis.time_step", dt, dt > 0.0, "the time step must be greater than 0 s")?;
    number("analysis.start_time", start, start >= 0.0, "the start must not be before 0 s")?;
    let is_one = end >= start + dt * (1.0 - SLACK);
    number("analysis.end_time", end, is_one, "the end time must be at least one time step after the start")?;
    let scheme = match analysis.kind {
        AnalysisKind::Dynamic => analysis.scheme,
        AnalysisKind::Static => Scheme::Static,
    };
    match scheme {
        Scheme::Theta { theta, xi } => {
            let key = "analysis.scheme.theta";
            number(key, theta, theta > 0.0 && theta <= 1.0, "theta must be greater than 0 and at most 1")?;
            number("analysis.scheme.xi", xi, (0.0..=1.0).contains(&xi), "xi must be between 0 and 1")?;
        }
        Scheme::Conserving => {}
        Scheme::Static if analysis.kind == AnalysisKind::Static => {
            if scenario.contact.condition != ContactCondition::Gap {
                return Err(InputError::new(
                    "contact.condition",
                    "a static analysis rules the gap at the end of the step; write condition = \"gap\"",
                ));
            }
            refuse_velocities(scenario)?;
        }
        Scheme::Static => {
            return Err(InputError::new("analysis.scheme", "a dynamic analysis needs a time scheme"));
        }
    }
    let newton = analysis.newton;
    let key = "analysis.newton.tolerance";
    number(key, newton.tolerance, newton.tolerance > 0.0, "the tolerance must be greater than 0")?;
    let solver = scenario.contact.solver;
    check_solver(&solver)?;
    let (key, tolerance) = ("contact.certificate_tolerance", scenario.contact.certificate_tolerance);
    number(key, tolerance, tolerance > 0.0, "the tolerance must be greater than 0")?;
    let (key, tolerance) = ("contact.penetration_tolerance", scenario.contact.penetration_tolerance);
    number(key, tolerance, tolerance > 0.0, "the tolerance must be greater than 0")?;
    check_iterations("analysis.newton.max_iterations", newton.max_iterations)?;
    let key = "analysis.max_halvings";
    number(
        key,
        f64::from(analysis.max_halvings),
        analysis.max_halvings <= 30,
        "at most 30 halvings make sense",
    )?;
    Ok(Method {
        scheme,
        condition: scenario.contact.condition,
        solver: solver.kind.solver(),
        stopping: stopping(&solver),
        cross_check: solver.cross_check,
        newton: NewtonRule { tolerance: newton.tolerance, max_iterations: newton.max_iterations },
        max_halvings: analysis.max_halvings,
        bridges: analysis.stabilisation == Stabilisation::Dynamic,
        certificate_tolerance: scenario.contact.certificate_tolerance,
        penetration_tolerance: scenario.contact.penetration_tolerance,
    })
}

fn check_iterations(key: &str, count: usize) -> Result<(), InputError> {
    number(key, count as f64, count > 0, "at least 1 iteration is needed")
}

/// Refuses a friction solver that cannot stop, or cannot begin.
pub(crate) fn check_solver(solver: &SolverSpec) -> Result<(), InputError> {
    let key = "contact.solver.tolerance";
    number(key, solver.tolerance, solver.tolerance > 0.0, "the tolerance must be greater than 0")?;
    check_iterations("contact.solver.max_iterations", solver.max_iterations)
}

/// When the friction solver stops.
pub(crate) fn stopping(solver: &SolverSpec) -> StoppingRule {
    StoppingRule {
        tolerance: solver.tolerance,
        criterion: Criterion::Natural,
        max_iterations: solver.max_iterations,
        ..StoppingRule::default()
    }
}

/// Refuses initial velocities where there is no inertia.
fn refuse_velocities(scenario: &Scenario) -> Result<(), InputError> {
    for (i, body) in scenario.bodies.iter().enumerate() {
        let moves = body.velocity.iter().flatten().any(|v| *v != 0.0);
        let spins = match body.spin {
            Spin::None => false,
            Spin::InPlane(spin) => spin != 0.0,
            Spin::InSpace(spin) => spin != [0.0; 3],
        };
        for (name, given) in [("velocity", moves), ("spin", spins)] {
            if given {
                let message = "a static analysis knows no velocities; leave it out";
                return Err(InputError::new(format!("bodies.{i}.{name}"), message));
            }
        }
    }
    Ok(())
}
