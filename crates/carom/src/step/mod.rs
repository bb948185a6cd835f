//! One step: predict, find contacts, then iterate until converged, and commit.

pub(crate) mod blend;
mod commit;
pub(crate) mod control;
mod correction;
mod equilibrate;
pub(crate) mod free_motion;
pub(crate) mod giving_way;
mod hold;
pub(crate) mod impulse;
mod island;
mod iterate;
pub(crate) mod iterating;
pub(crate) mod landing;
mod measure;
pub(crate) mod newton;
mod outlines;
mod repaying;
pub(crate) mod report;
pub(crate) mod resting;
mod settling;
mod side_by_side;
mod since_look;
mod springs;
mod stability;
mod waking;
pub(crate) mod whereabouts;
pub(crate) mod workspace;

use std::time::Instant;

use carom_mesh::compiled;
use carom_mesh::{Vector, nodal};

use self::commit::commit;
use self::control::SEARCH;
use self::equilibrate::set_out;
use self::iterate::iterate;
use self::iterating::Iterating;
use self::measure::measure;
use self::outlines::place_outlines;
use self::report::{PenetrationReport, StepReport};
use self::stability::check_jump;
use self::waking::wake;
use self::workspace::Workspace;
use crate::body::{Forecast, Interval};
use crate::contact::Contacts;
use crate::contact::cross_check::cross_check;
use crate::error::StepError;
use crate::model::assembly::Assembly;
use crate::model::each_body::{PerBody, PerNode, each_run, try_each_body};
use crate::model::given::Given;
use crate::model::method::Method;
use crate::model::state::State;

/// Takes `state` one step of length `dt` [s] further and writes the result to `next`.
///
/// # Errors
/// If the iterations or the friction solver do not converge, a matrix is not positive definite, or a number is not finite.
/// `state` is never written; after an error `next` holds nothing of use.
pub fn step<const D: usize>(
    assembly: &Assembly<D>,
    method: &Method<D>,
    state: &State<D>,
    next: &mut State<D>,
    dt: f64,
    work: &mut Workspace<D>,
) -> Result<StepReport, StepError> {
    step_over(assembly, method, &method.interval(state.time, dt), state, next, work)
}

/// [`step`] over this `interval`.
pub(crate) fn step_over<const D: usize>(
    assembly: &Assembly<D>,
    method: &Method<D>,
    interval: &Interval,
    state: &State<D>,
    next: &mut State<D>,
    work: &mut Workspace<D>,
) -> Result<StepReport, StepError> {
    compiled!(D, make_step as MakeStep)(&Given { assembly, method, state, interval }, next, work)
}

type MakeStep<const D: usize> =
    fn(&Given<'_, D>, &mut State<D>, &mut Workspace<D>) -> Result<StepReport, StepError>;

fn make_step<const D: usize>(
    given: &Given<'_, D>,
    next: &mut State<D>,
    work: &mut Workspace<D>,
) -> Result<StepReport, StepError> {
    let Given { assembly, interval, .. } = *given;
    let reach = assembly.reach(interval.start).max(assembly.reach(interval.end));
    let mut margin = predict(given, work)? + reach;
    let mut iterations = 0;
    for repetition in 0..SEARCH.repetitions {
        let since = Instant::now();
        while find(given, margin, repetition, work) {
            margin = margin.max(predict(given, work)? + reach);
        }
        work.detection_time += since.elapsed();
        let made = iterate(given, next, work);
        if made.is_err() {
            // A factor that was made on the way to nowhere would mislead the next attempt.
            work.iterating.bodies.iter_mut().for_each(|body| body.forget());
        }
        if let Err(StepError::NotHeld { .. } | StepError::Runaway { .. }) = made {
            if margin < assembly.size {
                // It may fall on something that is farther away than the loads foretold.
                margin = assembly.size.max(predict(given, work)?);
                continue;
            }
            if let Some(error) = work.iterating.newton.caught.take() {
                return Err(error);
            }
        }
        iterations += made?;
        place_outlines(given, next, work);
        let since = Instant::now();
        let travel = nodal::largest(&work.iterating.motion);
        let penetration = looked_at(given, next, travel, repetition, work);
        work.detection_time += since.elapsed();
        if let Some(penetration) = penetration? {
            let report = commit(given, next, work, iterations)?;
            if interval.map.is_static() {
                check_jump(given, &report, &work.iterating)?;
            }
            if wake(given, next, work) {
                continue;
            }
            let Workspace { iterating: Iterating { bodies, contacts, .. }, resting, .. } = work;
            resting.note(given, next, bodies, &contacts.finder.found);
            let cross_check = cross_check(given, &work.iterating.contacts);
            return Ok(StepReport { penetration, travel, cross_check, ..report });
        }
    }
    Err(StepError::MissedContact { margin })
}

/// Finds the contacts of a step. Returns whether there are some with bodies that were at rest and are no longer: they set out as the others did.
fn find<const D: usize>(
    given: &Given<'_, D>,
    margin: f64,
    repetition: usize,
    work: &mut Workspace<D>,
) -> bool {
    let Workspace { iterating: Iterating { contacts, motion, .. }, resting, .. } = work;
    contacts.finder.find(given, &resting.who, motion, (margin, repetition), &mut contacts.active);
    resting.rouse_found(given, &contacts.active.candidates)
}

/// Looks at where a step led to, in which no node travelled farther than `travel` [m] in a direction: what is inside what. None if a contact was missed, with which the step is to be repeated.
fn looked_at<const D: usize>(
    given: &Given<'_, D>,
    next: &State<D>,
    travel: f64,
    repetition: usize,
    work: &mut Workspace<D>,
) -> Result<Option<PenetrationReport>, StepError> {
    let Workspace { iterating: Iterating { contacts, motion, .. }, resting, .. } = work;
    let Contacts { finder, active, .. } = contacts;
    let may_be_repeated = repetition + 1 < SEARCH.repetitions;
    if finder.missed_one(given, &resting.who, (motion, next), active, may_be_repeated) {
        return Ok(None);
    }
    let penetration = measure(given, next, travel, work)?;
    let Workspace { iterating: Iterating { contacts, .. }, boundaries, .. } = work;
    let is_left = repetition >= SEARCH.measured;
    Ok((is_left || !contacts.finder.missed_by(given, next, boundaries.witnesses())).then_some(penetration))
}

/// The start of the iterations: free flight, d = Δt v, but for what is prescribed, and bodies that are ready for the step. Returns the margin of
/// the contact search [m].
fn predict<const D: usize>(given: &Given<'_, D>, work: &mut Workspace<D>) -> Result<f64, StepError> {
    let Given { assembly, state, interval, .. } = *given;
    let dt = interval.map.dt;
    let Workspace { iterating: Iterating { bodies, motion, factorisations, .. }, forecasts, resting, .. } =
        work;
    let flight = if interval.map.is_static() { 0.0 } else { dt };
    each_run(assembly, motion, &|motion, nodes| {
        nodal::each(motion, [&state.velocity[nodes]], |d, [v]| *d = v * flight);
    });
    let mut driven = given.move_obstacles(motion)?;
    let obstacles = state.velocity[assembly.node_count()..].iter();
    let mut speed = obstacles.map(Vector::norm_squared).fold(0.0, f64::max).sqrt();
    let mut acceleration: f64 = 0.0;
    resting.heed(given, motion, bodies);
    for i in resting.resting() {
        motion[assembly.nodes(i)].fill(Vector::zeros());
        forecasts[i] = Forecast::default();
    }
    let all = (PerBody(bodies), PerNode(motion), PerBody(forecasts));
    try_each_body(assembly, &resting.awake, all, &|i, (body, motion, forecast)| {
        *forecast.own() = body.own().begin_step(interval, &given.start(i), motion.0)?;
        Ok::<_, StepError>(())
    })?;
    for forecast in forecasts {
        driven = driven.max(forecast.driven);
        speed = speed.max(forecast.speed);
        acceleration = acceleration.max(forecast.acceleration);
        *factorisations += u64::from(forecast.is_factorised);
    }
    if interval.map.is_static() {
        set_out(given, &mut work.iterating)?;
    }
    let drift = || {
        let means = work.iterating.bodies.iter().enumerate().map(|(i, body)| {
            let velocity = &state.velocity[assembly.nodes(i)];
            body.mean_velocity(velocity).norm()
        });
        means.fold(0.0, f64::max) * dt
    };
    Ok(search_margin(given, (speed + acceleration * dt) * dt, driven, drift))
}

/// How far around the bodies contacts are looked for [m], where nodes fly as far as `free` [m] or are moved by `driven` [m] in the step, and bodies
/// as a whole by `drift` [m].
pub(crate) fn search_margin<const D: usize>(
    given: &Given<'_, D>,
    free: f64,
    driven: f64,
    drift: impl FnOnce() -> f64,
) -> f64 {
    let Given { assembly, interval, .. } = *given;
    // In a static analysis nothing falls: its time says how far the loads have come, not how long they act.
    if interval.map.is_static() {
        return (SEARCH.margin * driven).max(SEARCH.static_margin * assembly.size);
    }
    let margin = SEARCH.margin * free.max(driven);
    let largest = SEARCH.largest_margin * assembly.size;
    if margin <= largest {
        return margin;
    }
    margin.min(largest.max(SEARCH.margin * driven.max(drift())))
}
