//! Newton's iterations of a step.

use carom_mesh::nodal;

use super::equilibrate::equilibrate;
use super::newton::Newton;
use super::newton::acceleration::Last;
use super::newton::convergence::{BodyProgress, Convergence};
use super::workspace::Workspace;
use crate::error::StepError;
use crate::model::given::Given;
use crate::model::state::State;

/// How the iterations of some bodies go: see [`iterate_bodies`].
type Solve<const D: usize> =
    fn(&[usize], &Given<'_, D>, &mut State<D>, &mut Workspace<D>) -> Result<usize, StepError>;

/// Newton's iterations with a kept factor; returns how many the slowest body took. Writes u₊ to `next` and d to `work`.
///
/// Bodies in contact depend on one another and iterate together, every other one alone to its end.
pub(super) fn iterate<const D: usize>(
    given: &Given<'_, D>,
    next: &mut State<D>,
    work: &mut Workspace<D>,
) -> Result<usize, StepError> {
    let Workspace { contacts, newton, motion, .. } = work;
    contacts.active.select(given, &contacts.finder.search);
    for (i, progress) in newton.progress.iter_mut().enumerate() {
        *progress = BodyProgress::new(nodal::largest(&motion[given.assembly.nodes(i)]));
    }
    newton.acceleration.restart();
    nodal::each(&mut next.displacement, [&given.state.displacement, motion], |u1, [u0, d]| *u1 = u0 + d);
    let solve: Solve<D> = if given.interval.map.is_static() { equilibrate } else { iterate_bodies };
    let mut in_contact = std::mem::take(&mut newton.in_contact);
    in_contact.clear();
    in_contact.extend((0..work.bodies.len()).filter(|&i| contacts.active.touched[i]));
    let made = if in_contact.is_empty() { Ok(0) } else { solve(&in_contact, given, next, work) };
    work.newton.in_contact = in_contact;
    let mut iterations = made?;
    for i in 0..work.bodies.len() {
        if !work.contacts.active.touched[i] {
            iterations = iterations.max(solve(&[i], given, next, work)?);
        }
    }
    Ok(iterations)
}

/// [`iterate`] for some `bodies`: all that are in contact, or one that is not.
fn iterate_bodies<const D: usize>(
    bodies: &[usize],
    given: &Given<'_, D>,
    next: &mut State<D>,
    work: &mut Workspace<D>,
) -> Result<usize, StepError> {
    let mut convergence = Convergence::new(given);
    let touched = bodies.iter().any(|&i| work.contacts.active.touched[i]);
    let (mut renewed, mut nearly_settled) = (0, false);
    for iteration in 1.. {
        if touched {
            work.contacts.evaluate(given, &work.motion, &mut work.bodies);
        }
        residuals(bodies, given, next, work);
        let reacts = touched && !work.contacts.active.contacts.is_empty();
        begin_solves(bodies, given, reacts, work);
        let mut error = 0.0;
        if reacts {
            if !nearly_settled {
                let count = work.contacts.active.contacts.len();
                error = convergence.contact_error(count, bodies, &work.newton.progress);
            }
            convergence.left_by_contacts =
                work.contacts.solve(given, &work.motion, error, &mut work.bodies)?;
        }
        end_solves(bodies, given, work)?;
        correct(bodies, given, next, work);
        if convergence.settle(iteration, bodies, &work.newton.progress)? {
            if error == 0.0 {
                return Ok(iteration);
            }
            nearly_settled = true;
        }
        accelerate(bodies, given, iteration == 1, next, work);
        if convergence.is_slow(iteration, iteration - renewed, bodies, &work.newton.progress) {
            renew(bodies, given, next, renewed > 0, work)?;
            renewed = iteration;
        }
    }
    unreachable!("the loop ends at max_iterations")
}

/// Residuals of the `bodies` without reactions.
pub(super) fn residuals<const D: usize>(
    bodies: &[usize],
    given: &Given<'_, D>,
    next: &State<D>,
    work: &mut Workspace<D>,
) {
    let is_blended = given.interval.is_blended;
    if is_blended {
        weigh_blend(bodies, given, next, work);
    }
    let Workspace { bodies: all, newton, blend, motion, .. } = work;
    for &i in bodies {
        let guess = given.guess(i, motion, &next.displacement);
        let weight = is_blended.then_some(blend.weight[i]);
        all[i].residual(&guess, weight, &mut newton.residual[given.assembly.nodes(i)]);
    }
}

/// The blend of start and end stresses at the present guess.
fn weigh_blend<const D: usize>(
    bodies: &[usize],
    given: &Given<'_, D>,
    next: &State<D>,
    work: &mut Workspace<D>,
) {
    let Workspace { bodies: all, contacts, blend, motion, .. } = work;
    for &i in bodies {
        blend.balances[i] = all[i].balance(&given.guess(i, motion, &next.displacement));
    }
    let touched = bodies.iter().any(|&i| contacts.active.touched[i]);
    let contact_work = if touched { contacts.measure_work(given, motion) } else { &[] };
    blend.weigh(bodies, contact_work, &given.state.energy_debt, given.state.energies.total());
}

/// Adds the reactions known so far to the residuals of the `bodies`, and starts to solve for their corrections.
pub(super) fn begin_solves<const D: usize>(
    bodies: &[usize],
    given: &Given<'_, D>,
    reacts: bool,
    work: &mut Workspace<D>,
) {
    let residual = &mut work.newton.residual;
    if reacts {
        work.contacts.active.add_reactions(residual);
    }
    for &i in bodies {
        work.bodies[i].begin_solve(&residual[given.assembly.nodes(i)]);
    }
}

/// Ends the solves for the corrections of the `bodies`.
pub(super) fn end_solves<const D: usize>(
    bodies: &[usize],
    given: &Given<'_, D>,
    work: &mut Workspace<D>,
) -> Result<(), StepError> {
    let Workspace { bodies: all, newton: Newton { correction, .. }, .. } = work;
    for &i in bodies {
        let correction = &mut correction[given.assembly.nodes(i)];
        all[i].end_solve(correction);
        // The largest size does not see what is not a number.
        if !nodal::is_finite(correction) {
            return Err(StepError::NotFinite("displacement"));
        }
    }
    Ok(())
}

/// Applies the corrections.
pub(super) fn correct<const D: usize>(
    bodies: &[usize],
    given: &Given<'_, D>,
    next: &mut State<D>,
    work: &mut Workspace<D>,
) {
    let Workspace { newton: Newton { correction, progress, .. }, motion, .. } = work;
    for &i in bodies {
        let nodes = given.assembly.nodes(i);
        let correction = &correction[nodes.clone()];
        let size = nodal::largest(correction);
        let start = &given.state.displacement[nodes.clone()];
        let (motion, moved) = (&mut motion[nodes.clone()], &mut next.displacement[nodes]);
        nodal::each_of_two(motion, moved, [correction, start], |d, u1, [c, u0]| {
            *d += c;
            *u1 = u0 + *d;
        });
        progress[i].note(size, nodal::largest(motion));
    }
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

/// Renews K̄ of the `bodies`, at the present guess; once more if it has been `renewed` before.
fn renew<const D: usize>(
    bodies: &[usize],
    given: &Given<'_, D>,
    next: &State<D>,
    renewed: bool,
    work: &mut Workspace<D>,
) -> Result<(), StepError> {
    work.newton.acceleration.restart();
    for &i in bodies {
        work.bodies[i].renew(&given.guess(i, &work.motion, &next.displacement), renewed)?;
        work.factorisations += 1;
    }
    Ok(())
}
