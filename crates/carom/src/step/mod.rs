//! One step: predict, detect, then linearise, condense, solve and correct until converged, and commit.

pub(crate) mod blend;
pub(crate) mod commit;
pub(crate) mod newton;
pub(crate) mod workspace;

use carom_fem::sparse::Precision;
use carom_mesh::{nodal, tensor};

use crate::body::fe::drive::{load_body, prescribe};
use crate::body::fe::equation::{BodyStep, Pose, predicted_motion};
use crate::body::fe::operator::BodyOperator;
use crate::contact::active::{missed_a_contact, search, select_active};
use crate::contact::cross_check::cross_check;
use crate::contact::solve::{evaluate_contacts, measure_rubbing, prepare_contacts, react};
use crate::error::StepError;
use crate::model::state::State;
use crate::step::commit::commit;
use crate::step::newton::acceleration::accelerate;
use crate::step::newton::convergence::{BodyProgress, Convergence};
use crate::step::workspace::{StepReport, Workspace};
use crate::{Method, Model, StepMap};

/// Margin of the contact search, in largest predicted motions of a node in the step.
const SEARCH_MARGIN: f64 = 2.0;
/// The largest margin, in sizes of the model, where no body moves as a whole by half of that. More would make contacts of all that there are
/// where one node is very fast: two bodies whose 60 contacts a step was about had a dense problem of 1245.
const LARGEST_MARGIN: f64 = 0.1;
/// How often a step is repeated from where it led to, if a node came into contact unforeseen.
const MAX_SEARCHES: usize = 4;
/// The least margin of the contact search in a static analysis, where no velocity foretells the motion, in sizes of the model.
const STATIC_MARGIN: f64 = 1e-3;

/// Takes `state` one step of length `dt` [s] further and writes the result to `next`.
///
/// # Errors
/// If the iterations or the friction solver do not converge, a matrix is not positive definite, or a number is not finite.
/// `state` is never written; after an error `next` holds nothing of use.
pub fn step<const D: usize>(
    model: &Model<D>,
    method: &Method<D>,
    state: &State<D>,
    next: &mut State<D>,
    dt: f64,
    work: &mut Workspace<D>,
) -> Result<StepReport, StepError> {
    let map = method.scheme.step_map(dt);
    let driven = predict(model, method, state, &map, work)?;
    // In a static analysis nothing falls: its time says how far the loads have come, not how long they act.
    let free = if map.is_static() { 0.0 } else { predicted_motion(state, &model.gravity, dt) };
    let motion = free.max(driven);
    let mut margin = SEARCH_MARGIN * motion;
    let largest = LARGEST_MARGIN * model.size;
    if margin > largest {
        margin = margin.min(largest.max(SEARCH_MARGIN * driven.max(drift(model, state, dt))));
    }
    if map.is_static() {
        margin = margin.max(STATIC_MARGIN * model.size);
    }
    let mut iterations = 0;
    for repetition in 0..MAX_SEARCHES {
        search(model, state, margin, repetition, work);
        let made = iterate(model, method, state, next, &map, work);
        if made.is_err() {
            // A factor that was made on the way to nowhere would mislead the next attempt.
            work.operators.iter_mut().for_each(BodyOperator::forget);
        }
        iterations += made?;
        if !missed_a_contact(model, method, next, work) {
            let report = commit(model, method, state, next, &map, work, iterations)?;
            return Ok(StepReport { cross_check: cross_check(method, &map, work), ..report });
        }
    }
    Err(StepError::MissedContact { margin })
}

/// How far the fastest body moves as a whole in the step [m].
fn drift<const D: usize>(model: &Model<D>, state: &State<D>, dt: f64) -> f64 {
    let speeds = model.bodies.iter().map(|b| b.body.mean(&state.velocity[b.nodes()]).norm());
    speeds.fold(0.0, f64::max) * dt
}

/// The start of the iterations: free flight, d = Δt v, but for what is prescribed; the frame of every body and a factor that fits
/// the step. Returns the largest prescribed motion [m].
fn predict<const D: usize>(
    model: &Model<D>,
    method: &Method<D>,
    state: &State<D>,
    map: &StepMap,
    work: &mut Workspace<D>,
) -> Result<f64, StepError> {
    nodal::each(&mut work.motion, [&state.velocity], |d, [v]| *d = v * map.dt);
    let driven = prescribe(model, state, map, work)?;
    for (i, b) in model.bodies.iter().enumerate() {
        let nodes = b.nodes();
        let middle = &mut work.correction[nodes.clone()];
        let (start, motion) = (&state.displacement[nodes.clone()], &work.motion[nodes]);
        nodal::each(middle, [start, motion], |m, [u, d]| *m = u + d * 0.5);
        work.poses[i] = Pose { frame: b.body.frame(middle), ..Pose::default() };
        // Only nodes without mass ask how the body would go on.
        if !b.body.massless().is_empty() {
            let (u, v) = (&state.displacement[b.nodes()], &state.velocity[b.nodes()]);
            let spin = if b.body.turns() { b.body.spin(u, v) } else { [0.0; 3] };
            work.poses[i].turn = tensor::rotation(&spin.map(|w| w * map.dt));
            work.poses[i].drift = b.body.mean(v);
        }
        if !work.operators[i].fits(map) {
            work.operators[i].factorize(
                &b.body.after(&state.history[i]),
                map,
                middle,
                &work.poses[i].frame,
                method.precision(),
            )?;
            work.factorisations += 1;
        }
        work.operators[i].turn_to(&work.poses[i].frame);
    }
    Ok(driven)
}

/// Newton's iterations with a kept factor; returns how many the slowest body took. Writes u₊ to `next` and d to `work`.
///
/// Bodies in contact depend on one another and iterate together, every other one alone to its end.
fn iterate<const D: usize>(
    model: &Model<D>,
    method: &Method<D>,
    state: &State<D>,
    next: &mut State<D>,
    map: &StepMap,
    work: &mut Workspace<D>,
) -> Result<usize, StepError> {
    select_active(model, method, state, map, work);
    for (progress, b) in work.progress.iter_mut().zip(&model.bodies) {
        *progress = BodyProgress::new(nodal::largest(&work.motion[b.nodes()]));
    }
    work.acceleration.restart();
    nodal::each(&mut next.displacement, [&state.displacement, &work.motion], |u1, [u0, d]| *u1 = u0 + d);
    let convergence = Convergence::new(model, method, state, map);
    let mut in_contact = std::mem::take(&mut work.in_contact);
    in_contact.clear();
    in_contact.extend((0..model.bodies.len()).filter(|&i| work.touched[i]));
    let made = if in_contact.is_empty() {
        Ok(0)
    } else {
        iterate_bodies(&in_contact, convergence, model, method, state, next, map, work)
    };
    work.in_contact = in_contact;
    let mut iterations = made?;
    for i in 0..model.bodies.len() {
        if !work.touched[i] {
            let made = iterate_bodies(&[i], convergence, model, method, state, next, map, work)?;
            iterations = iterations.max(made);
        }
    }
    Ok(iterations)
}

/// [`iterate`] for some `bodies`: all that are in contact, or one that is not.
fn iterate_bodies<const D: usize>(
    bodies: &[usize],
    mut convergence: Convergence,
    model: &Model<D>,
    method: &Method<D>,
    state: &State<D>,
    next: &mut State<D>,
    map: &StepMap,
    work: &mut Workspace<D>,
) -> Result<usize, StepError> {
    let touched = bodies.iter().any(|&i| work.touched[i]);
    let (mut renewed, mut nearly_settled) = (0, false);
    for iteration in 1.. {
        if touched {
            evaluate_contacts(model, method, state, work);
            prepare_contacts(model, map, work);
        }
        residuals(bodies, model, method, state, next, map, work);
        let reacts = touched && !work.contacts.is_empty();
        begin_solves(bodies, model, reacts, work);
        let mut error = 0.0;
        if reacts {
            if !nearly_settled {
                error = convergence.contact_error(work.contacts.len(), bodies, &work.progress);
            }
            react(model, method, state, map, error, work)?;
        }
        correct(bodies, model, state, next, work)?;
        if convergence.settle(iteration, bodies, model, work)? {
            if error == 0.0 {
                return Ok(iteration);
            }
            nearly_settled = true;
        }
        accelerate(bodies, model, state, next, iteration == 1, work);
        if convergence.is_slow(iteration, iteration - renewed, bodies, &work.progress) {
            refactorize(bodies, model, method, state, next, map, renewed > 0, work)?;
            renewed = iteration;
        }
    }
    unreachable!("the loop ends at max_iterations")
}

/// Residuals of the `bodies` without reactions.
fn residuals<const D: usize>(
    bodies: &[usize],
    model: &Model<D>,
    method: &Method<D>,
    state: &State<D>,
    next: &State<D>,
    map: &StepMap,
    work: &mut Workspace<D>,
) {
    if method.is_blended() {
        blend(bodies, model, method, state, next, map, work);
    }
    for &i in bodies {
        let nodes = model.bodies[i].nodes();
        if !method.is_blended() {
            load_body(model, state, next, map, work, i);
        }
        let (pose, drive) = (&work.poses[i], &work.drives[i]);
        let body_step = BodyStep::new(model, i, map, pose, drive, state, &work.motion, &next.displacement);
        let residual = &mut work.residual[nodes.clone()];
        if method.is_blended() {
            work.blend.residual(model, i, &body_step, &mut work.residual_scratch[i], residual);
        } else {
            body_step.residual(&mut work.residual_scratch[i], residual);
        }
    }
}

/// Adds the reactions known so far to the residuals of the `bodies`, and starts to solve for their corrections.
fn begin_solves<const D: usize>(bodies: &[usize], model: &Model<D>, reacts: bool, work: &mut Workspace<D>) {
    if reacts {
        for (contact, r) in work.contacts.iter().zip(&work.reactions) {
            contact.add_force(r, &mut work.residual);
        }
    }
    for &i in bodies {
        work.operators[i].begin(&work.residual[model.bodies[i].nodes()]);
    }
}

/// The blend of start and end stresses at the present guess.
fn blend<const D: usize>(
    bodies: &[usize],
    model: &Model<D>,
    method: &Method<D>,
    state: &State<D>,
    next: &State<D>,
    map: &StepMap,
    work: &mut Workspace<D>,
) {
    for &i in bodies {
        load_body(model, state, next, map, work, i);
        let (pose, drive) = (&work.poses[i], &work.drives[i]);
        let body_step = BodyStep::new(model, i, map, pose, drive, state, &work.motion, &next.displacement);
        work.blend.measure(model, i, &body_step, &mut work.residual_scratch[i]);
    }
    let touched = bodies.iter().any(|&i| work.touched[i]);
    if touched {
        measure_rubbing(model, method, state, map, work);
    }
    let rubbing = if touched { &work.rubbing[..] } else { &[] };
    work.blend.weigh(bodies, rubbing, &state.excess, state.energies.total());
}

/// Ends the solves and applies the corrections.
fn correct<const D: usize>(
    bodies: &[usize],
    model: &Model<D>,
    state: &State<D>,
    next: &mut State<D>,
    work: &mut Workspace<D>,
) -> Result<(), StepError> {
    for &i in bodies {
        let b = &model.bodies[i];
        let correction = &mut work.correction[b.nodes()];
        work.operators[i].end(correction);
        // The largest size does not see what is not a number.
        if !nodal::is_finite(correction) {
            return Err(StepError::NotFinite("displacement"));
        }
        let size = nodal::largest(correction);
        let (moved, start) = (&mut next.displacement[b.nodes()], &state.displacement[b.nodes()]);
        let corrections = &work.correction[b.nodes()];
        nodal::each_of_two(&mut work.motion[b.nodes()], moved, [corrections, start], |d, u1, [c, u0]| {
            *d += c;
            *u1 = u0 + *d;
        });
        let moved = nodal::largest(&work.motion[b.nodes()]);
        work.progress[i].note(size, moved);
    }
    Ok(())
}

/// Renews the factors of the `bodies`, at the present guess; once more if they have been `renewed` before.
fn refactorize<const D: usize>(
    bodies: &[usize],
    model: &Model<D>,
    method: &Method<D>,
    state: &State<D>,
    next: &State<D>,
    map: &StepMap,
    renewed: bool,
    work: &mut Workspace<D>,
) -> Result<(), StepError> {
    work.acceleration.restart();
    for &i in bodies {
        let b = &model.bodies[i];
        let nodes = b.nodes();
        let middle = &mut work.correction[nodes.clone()];
        let ends = [&state.displacement[nodes.clone()], &next.displacement[nodes]];
        nodal::each(middle, ends, |m, [u0, u1]| *m = (u0 + u1) * 0.5);
        // A fresh factor that is no better may lack digits. A polynomial has replaced one only where these do not matter.
        let lacks_digits = renewed && work.operators[i].is_exact();
        let precision = if lacks_digits { Precision::Double } else { method.precision() };
        work.operators[i].factorize(
            &b.body.after(&state.history[i]),
            map,
            middle,
            &work.poses[i].frame,
            precision,
        )?;
        work.factorisations += 1;
    }
    Ok(())
}
