//! Newton's iterations of one island of a step, or of a body that nothing touches.

use carom_mesh::Vector;

use super::correction::{begin_solves, correct, end_solves, residuals};
use super::equilibrate::{follow, go_on};
use super::iterating::Iterating;
use super::newton::Newton;
use super::newton::acceleration::Last;
use super::newton::control::CONTROL;
use super::newton::convergence::Convergence;
use crate::contact::Accuracy;
use crate::error::StepError;
use crate::model::each_body::{PerBody, try_each_body};
use crate::model::given::Given;

/// How the iterations of some bodies go, and how many there are: see [`iterate_bodies`].
pub(super) type Solve<const D: usize> =
    fn(&[usize], &Given<'_, D>, &mut [Vector<D>], &mut Iterating<D>) -> Result<usize, StepError>;

/// Iterates for the `bodies` of an island, again and again, until everything that opens has let go. It ends, as what lets go does so for good.
pub(super) fn iterate_touching<const D: usize>(
    bodies: &[usize],
    solve: Solve<D>,
    given: &Given<'_, D>,
    reached: &mut [Vector<D>],
    work: &mut Iterating<D>,
) -> Result<usize, StepError> {
    let mut iterations = solve(bodies, given, reached, work)?;
    while work.contacts.let_go() {
        work.newton.begin(bodies, given.assembly, &work.motion);
        iterations += solve(bodies, given, reached, work)?;
    }
    Ok(iterations)
}

/// Newton's iterations with a kept factor for some `bodies`: those of an island, or one that nothing touches. Returns how many there were, and leaves u₊ in
/// `reached` and d in `work`.
pub(super) fn iterate_bodies<const D: usize>(
    bodies: &[usize],
    given: &Given<'_, D>,
    reached: &mut [Vector<D>],
    work: &mut Iterating<D>,
) -> Result<usize, StepError> {
    if given.interval.is_load_step {
        // A bridge leads through what is not stable, in steps as long as they may be.
        return go_on(bodies, 0, given, reached, work);
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
            let Iterating { contacts, motion, bodies: all, newton, .. } = work;
            let late =
                (iteration > CONTROL.late).then(|| convergence.largest_correction(bodies, &newton.progress));
            contacts.evaluate(given, motion, late, bodies, all);
        }
        residuals(bodies, iteration, given, reached, work);
        let reacts = touched && work.contacts.react(given.assembly);
        if reacts && (work.contacts.is_stiffened() || !given.assembly.springs.is_empty()) {
            let Iterating { contacts, motion, bodies, newton, .. } = work;
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
                    soften(bodies, given, reached, work);
                    may_stiffen = false;
                    continue;
                }
                Err(error) => return Err(error),
            }
        }
        end_solves(bodies, given, work)?;
        correct(bodies, given, reached, work);
        let settled = convergence.settle(iteration, bodies, &work.newton.progress);
        if settled.is_err() && work.contacts.is_stiffened() && iteration < given.method.newton.max_iterations
        {
            soften(bodies, given, reached, work);
            convergence.has_returned();
            may_stiffen = false;
            continue;
        }
        let may_go_on = may_go_on && reacts && iteration < given.method.newton.max_iterations;
        if may_go_on && matches!(settled, Err(StepError::Newton { .. })) {
            return go_on(bodies, iteration, given, reached, work);
        }
        if settled? {
            if !reacts || matches!(accuracy, Accuracy::Last(_)) {
                return Ok(iteration);
            }
            nearly_settled = true;
        }
        accelerate(bodies, given, iteration == 1, reached, work);
        if may_stiffen && reacts && iteration > enough && convergence.is_linear(bodies, &work.newton.progress)
        {
            work.newton.keep_guess(bodies, given.assembly, &work.motion, &work.contacts.active);
            may_stiffen = work.contacts.take_stiffness_of_reactions();
            work.newton.acceleration.restart(bodies);
        }
        if may_go_on && iteration >= CONTROL.endured && convergence.is_linear(bodies, &work.newton.progress) {
            return go_on(bodies, iteration, given, reached, work);
        }
        if convergence.is_slow(iteration, iteration - renewed, bodies, &work.newton.progress) {
            renew(bodies, given, reached, renewed > 0, work)?;
            renewed = iteration;
        }
    }
    unreachable!("the loop ends at max_iterations")
}

/// Goes back to where the reactions were given their stiffness, and on without it.
fn soften<const D: usize>(
    bodies: &[usize],
    given: &Given<'_, D>,
    reached: &mut [Vector<D>],
    work: &mut Iterating<D>,
) {
    work.newton.return_to_guess(bodies, given.assembly, &mut work.motion, &mut work.contacts.active);
    follow(bodies, given, reached, work);
    work.contacts.soften(bodies);
    work.newton.acceleration.restart(bodies);
}

/// Moves the `bodies` on to better guesses.
fn accelerate<const D: usize>(
    bodies: &[usize],
    given: &Given<'_, D>,
    is_first: bool,
    reached: &mut [Vector<D>],
    work: &mut Iterating<D>,
) {
    let Iterating { contacts, newton: Newton { acceleration, correction, progress, .. }, motion, .. } = work;
    let touched = &contacts.active.touched;
    let last = Last { is_first, touched, progress, motion, correction };
    acceleration.take_note(bodies, given.assembly, &last);
    acceleration.accelerate(bodies, touched, given, motion, reached);
}

/// Renews K̄ of those of the `bodies` that converge slowly, at the present guess; once more if it has been `renewed` before.
fn renew<const D: usize>(
    bodies: &[usize],
    given: &Given<'_, D>,
    reached: &[Vector<D>],
    renewed: bool,
    work: &mut Iterating<D>,
) -> Result<(), StepError> {
    let Iterating { bodies: all, newton, motion, factorisations, .. } = work;
    newton.acceleration.restart(bodies);
    let Newton { slow, progress, .. } = newton;
    slow.clear();
    slow.extend(bodies.iter().filter(|&&i| progress[i].contraction > CONTROL.slow_contraction));
    *factorisations += slow.len() as u64;
    try_each_body(given.assembly, slow, PerBody(all), &|i, body| {
        body.own().renew(&given.guess(i, motion, reached), renewed)
    })
}
