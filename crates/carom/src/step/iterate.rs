//! Newton's iterations of a step.

use carom_mesh::nodal;

use super::correction::{begin_solves, correct, end_solves, residuals};
use super::equilibrate::{equilibrate, follow, go_on};
use super::newton::Newton;
use super::newton::acceleration::Last;
use super::newton::control::CONTROL;
use super::newton::convergence::Convergence;
use super::workspace::Workspace;
use crate::contact::{Accuracy, Contacts};
use crate::error::StepError;
use crate::model::each_body::{PerBody, try_each_body};
use crate::model::given::Given;
use crate::model::state::State;

/// How the iterations of some bodies go: see [`iterate_bodies`].
type Solve<const D: usize> =
    fn(&[usize], &Given<'_, D>, &mut State<D>, &mut Workspace<D>) -> Result<usize, StepError>;

/// Newton's iterations with a kept factor; returns how many the slowest body took. Writes u₊ to `next` and d to `work`.
///
/// Bodies of an island depend on one another and iterate together, every other one alone to its end.
pub(super) fn iterate<const D: usize>(
    given: &Given<'_, D>,
    next: &mut State<D>,
    work: &mut Workspace<D>,
) -> Result<usize, StepError> {
    let everyone = &given.assembly.everyone;
    let Workspace { contacts, newton, motion, resting, forecasts, .. } = work;
    let acceleration = forecasts.iter().map(|forecast| forecast.acceleration).fold(0.0, f64::max);
    let fall = acceleration * given.interval.map.dt;
    let Contacts { active, finder, .. } = contacts;
    active.select(given, (&finder.search, finder.needed()), &resting.who, fall);
    contacts.on_masses.begin(given);
    if !given.interval.map.is_static() {
        // The guess that softened contacts would go back to may be of other contacts, where the step is repeated.
        contacts.soften(everyone);
    }
    newton.begin(everyone, given.assembly, motion);
    nodal::each(&mut next.displacement, [&given.state.displacement, motion], |u1, [u0, d]| *u1 = u0 + d);
    let solve: Solve<D> = if given.interval.map.is_static() { equilibrate } else { iterate_bodies };
    let mut iterations = 0;
    for island in 0..contacts.divide(given) {
        let bodies = work.contacts.enter(island);
        let made = iterate_touching(&bodies, solve, given, next, work);
        if !given.interval.map.is_static() {
            // The next island begins without.
            work.contacts.soften(&bodies);
        }
        work.contacts.leave(island, bodies);
        if made.is_err() {
            work.contacts.give_up(island);
        }
        iterations = iterations.max(made?);
    }
    work.contacts.join(given);
    for i in 0..work.bodies.len() {
        if !work.contacts.active.touched[i] && !work.resting.who.bodies[i] {
            iterations = iterations.max(solve(&[i], given, next, work)?);
        }
    }
    Ok(iterations)
}

/// [`iterate`] for the `bodies` of an island, again and again, until everything that opens has let go. It ends, as what lets go does so for good.
fn iterate_touching<const D: usize>(
    bodies: &[usize],
    solve: Solve<D>,
    given: &Given<'_, D>,
    next: &mut State<D>,
    work: &mut Workspace<D>,
) -> Result<usize, StepError> {
    let mut iterations = solve(bodies, given, next, work)?;
    while work.contacts.let_go() {
        work.newton.begin(bodies, given.assembly, &work.motion);
        iterations += solve(bodies, given, next, work)?;
    }
    Ok(iterations)
}

/// [`iterate`] for some `bodies`: those of an island, or one that nothing touches.
fn iterate_bodies<const D: usize>(
    bodies: &[usize],
    given: &Given<'_, D>,
    next: &mut State<D>,
    work: &mut Workspace<D>,
) -> Result<usize, StepError> {
    if given.interval.is_load_step {
        // A bridge leads through what is not stable, in steps as long as they may be.
        return go_on(bodies, 0, given, next, work);
    }
    let mut convergence = Convergence::new(bodies, given);
    let touched = bodies.iter().any(|&i| work.contacts.active.touched[i]);
    // What makes blended iterations slow is the blend, which no tangent knows of.
    let may_go_on = touched && !given.interval.is_blended;
    // Blended iterations take more, and get by without the stiffness of reactions.
    let enough = if given.interval.is_blended { CONTROL.blended_late } else { CONTROL.late };
    let (mut renewed, mut nearly_settled, mut may_stiffen) = (0, false, true);
    for iteration in 1.. {
        if touched {
            let Workspace { contacts, motion, bodies: all, newton, .. } = work;
            let late =
                (iteration > CONTROL.late).then(|| convergence.largest_correction(bodies, &newton.progress));
            contacts.evaluate(given, motion, late, bodies, all);
        }
        residuals(bodies, iteration, given, next, work);
        let reacts = touched && work.contacts.react(given.assembly);
        if reacts && (work.contacts.is_stiffened() || !given.assembly.springs.is_empty()) {
            let Workspace { contacts, motion, bodies, newton, .. } = work;
            contacts.stiffen(given, motion, bodies, &mut newton.residual);
        }
        begin_solves(bodies, given, reacts, work);
        let count = work.contacts.active.contacts.len();
        let accuracy = convergence.accuracy(count, nearly_settled, bodies, &work.newton.progress);
        if reacts {
            match work.contacts.solve(given, &work.motion, accuracy, &mut work.bodies) {
                Ok(left) => convergence.left_by_contacts = left,
                Err(StepError::Friction { .. }) if work.contacts.is_stiffened() => {
                    // With the stiffness of reactions a compliance may be indefinite.
                    soften(bodies, given, next, work);
                    may_stiffen = false;
                    continue;
                }
                Err(error) => return Err(error),
            }
        }
        end_solves(bodies, given, work)?;
        correct(bodies, given, next, work);
        let settled = convergence.settle(iteration, bodies, &work.newton.progress);
        if settled.is_err() && work.contacts.is_stiffened() && iteration < given.method.newton.max_iterations
        {
            soften(bodies, given, next, work);
            convergence.has_returned();
            may_stiffen = false;
            continue;
        }
        let may_go_on = may_go_on && reacts && iteration < given.method.newton.max_iterations;
        if may_go_on && matches!(settled, Err(StepError::Newton { .. })) {
            return go_on(bodies, iteration, given, next, work);
        }
        if settled? {
            if !reacts || matches!(accuracy, Accuracy::Last(_)) {
                return Ok(iteration);
            }
            nearly_settled = true;
        }
        accelerate(bodies, given, iteration == 1, next, work);
        if may_stiffen && reacts && iteration > enough && convergence.is_linear(bodies, &work.newton.progress)
        {
            work.newton.keep_guess(bodies, given.assembly, &work.motion, &work.contacts.active);
            may_stiffen = work.contacts.take_stiffness_of_reactions();
            work.newton.acceleration.restart(bodies);
        }
        if may_go_on && iteration >= CONTROL.endured && convergence.is_linear(bodies, &work.newton.progress) {
            return go_on(bodies, iteration, given, next, work);
        }
        if convergence.is_slow(iteration, iteration - renewed, bodies, &work.newton.progress) {
            renew(bodies, given, next, renewed > 0, work)?;
            renewed = iteration;
        }
    }
    unreachable!("the loop ends at max_iterations")
}

/// Goes back to where the reactions were given their stiffness, and on without it.
fn soften<const D: usize>(
    bodies: &[usize],
    given: &Given<'_, D>,
    next: &mut State<D>,
    work: &mut Workspace<D>,
) {
    work.newton.return_to_guess(bodies, given.assembly, &mut work.motion, &mut work.contacts.active);
    follow(bodies, given, next, work);
    work.contacts.soften(bodies);
    work.newton.acceleration.restart(bodies);
}

/// Moves the `bodies` on to better guesses.
fn accelerate<const D: usize>(
    bodies: &[usize],
    given: &Given<'_, D>,
    is_first: bool,
    next: &mut State<D>,
    work: &mut Workspace<D>,
) {
    let Workspace { contacts, newton: Newton { acceleration, correction, progress, .. }, motion, .. } = work;
    let touched = &contacts.active.touched;
    let last = Last { is_first, touched, progress, motion, correction };
    acceleration.take_note(bodies, &last, |i| given.assembly.nodes(i));
    acceleration.accelerate(bodies, touched, given, motion, next);
}

/// Renews K̄ of those of the `bodies` that converge slowly, at the present guess; once more if it has been `renewed` before.
fn renew<const D: usize>(
    bodies: &[usize],
    given: &Given<'_, D>,
    next: &State<D>,
    renewed: bool,
    work: &mut Workspace<D>,
) -> Result<(), StepError> {
    let Workspace { bodies: all, newton, motion, factorisations, .. } = work;
    newton.acceleration.restart(bodies);
    let Newton { slow, progress, .. } = newton;
    slow.clear();
    slow.extend(bodies.iter().filter(|&&i| progress[i].contraction > CONTROL.slow_contraction));
    *factorisations += slow.len() as u64;
    try_each_body(given.assembly, slow, PerBody(all), &|i, body| {
        body.own().renew(&given.guess(i, motion, &next.displacement), renewed)
    })
}
