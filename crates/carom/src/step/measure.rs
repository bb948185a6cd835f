//! What a step leaves of solids inside one another, and what goes through others on its way.

use carom_contact::{Penetration, Solid};

use super::iterating::Iterating;
use super::report::{Inside, PenetrationReport};
use super::resting::Resting;
use super::waking::wander;
use super::workspace::Workspace;
use crate::error::StepError;
use crate::model::given::Given;
use crate::model::state::State;

/// Measures all boundaries at the end of the step and, where nodes move by more than half a cell past what they may touch, on the way there. None
/// travels farther than `travel` [m] in a direction.
///
/// # Errors
/// If something is in the way. A shorter step finds the contact; one short enough is its own way.
pub(super) fn measure<const D: usize>(
    given: &Given<'_, D>,
    next: &State<D>,
    travel: f64,
    work: &mut Workspace<D>,
) -> Result<PenetrationReport, StepError> {
    let Given { assembly, method, state, interval } = *given;
    let end = |n: u32| assembly.reference[n as usize] + next.displacement[n as usize];
    // Not where the state has them: outlines of reduced bodies may have been completed in between.
    let Workspace { iterating: Iterating { motion, .. }, boundaries, resting, .. } = work;
    if resting.who.is_everything() {
        return Ok(PenetrationReport { depth: resting.depth(), worst: None });
    }
    let start = |n: u32| end(n) - motion[n as usize];
    let counts = |between: [Solid; 2]| between[0] != between[1] && assembly.must_not_overlap(between);
    let moves = |between: [Solid; 2]| counts(between) && !between.iter().all(|s| resting.who.is_still(*s));
    let obstacles = &assembly.contact.obstacles;
    let times = [state.time, interval.end];
    let parts = boundaries.parts(travel, obstacles, moves, &start, &end);
    for part in 1..parts {
        let share = part as f64 / parts as f64;
        let between = |n: u32| start(n) * (1.0 - share) + end(n) * share;
        let mut in_the_way = None;
        boundaries.measure(obstacles, moves, &between, |found| {
            let clearance =
                times.map(|t| assembly.clearance(found.between, t)).into_iter().fold(0.0, f64::max);
            if found.depth - clearance > method.allowed_penetration(found.cell, found.arcs, 0.0) {
                in_the_way = Some(found.between);
            }
        });
        if let Some(between) = in_the_way {
            let [first, second] = between.map(|solid| assembly.solid_name(solid).to_string());
            return Err(StepError::PassedThrough { first, second });
        }
    }
    let mut report = PenetrationReport::default();
    let mut largest = 0.0;
    wander(given, next, work);
    let Workspace { boundaries, since_look, in_itself, resting, .. } = work;
    in_itself.fill(false);
    report.depth = resting.depth();
    let Resting { who, watches, .. } = resting;
    let counts = |between: [Solid; 2]| match between {
        [Solid::Body(a), Solid::Body(b)] if a == b => since_look[a].is_due,
        between => counts(between) && !between.iter().all(|s| who.is_still(*s)),
    };
    boundaries.measure(obstacles, counts, &end, |found| {
        let Penetration { depth, cell, arcs, between, at } = found;
        let depth = depth - assembly.clearance(between, interval.end);
        if depth <= 0.0 {
            return;
        }
        report.depth = report.depth.max(depth);
        for solid in between {
            if let Solid::Body(i) = solid {
                watches[i].depth = watches[i].depth.max(depth);
            }
        }
        if let [Solid::Body(a), Solid::Body(b)] = between {
            in_itself[a] |= a == b;
        }
        if depth <= assembly.round_off() {
            // What is allowed may be less where a facet is crushed to nothing.
            return;
        }
        let excess = depth / method.allowed_penetration(cell, arcs, 0.0);
        if excess > largest {
            largest = excess;
            let mut place = [0.0; 3];
            place[..D].copy_from_slice(at.as_slice());
            report.worst = Some(Inside { between, depth, cell, arcs, at: place });
        }
    });
    Ok(report)
}
