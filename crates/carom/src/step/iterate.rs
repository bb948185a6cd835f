//! Newton's iterations of a step.

use carom_mesh::nodal;

use super::equilibrate::equilibrate;
use super::island::{Solve, iterate_bodies};
use super::iterating::Iterating;
use super::workspace::Workspace;
use crate::contact::Contacts;
use crate::error::StepError;
use crate::model::each_body::each_run;
use crate::model::given::Given;
use crate::model::state::State;

/// Newton's iterations of a step; returns how many the slowest body took. Writes u₊ to `next` and d to `work`.
///
/// Bodies of an island depend on one another and iterate together, every other one alone to its end.
pub(super) fn iterate<const D: usize>(
    given: &Given<'_, D>,
    next: &mut State<D>,
    work: &mut Workspace<D>,
) -> Result<usize, StepError> {
    let everyone = &given.assembly.everyone;
    let Workspace { iterating, side_by_side, resting, forecasts, .. } = work;
    let Iterating { contacts, newton, motion, .. } = &mut *iterating;
    let acceleration = forecasts.iter().map(|forecast| forecast.acceleration).fold(0.0, f64::max);
    let fall = acceleration * given.interval.map.dt;
    let Contacts { active, finder, .. } = &mut *contacts;
    active.select(given, (&finder.search, finder.needed()), &resting.who, fall);
    contacts.on_masses.begin(given);
    if !given.interval.map.is_static() {
        // The guess that softened contacts would go back to may be of other contacts, where the step is repeated.
        contacts.soften(everyone);
    }
    newton.begin(everyone, given.assembly, motion);
    let start = &given.state.displacement;
    each_run(given.assembly, &mut next.displacement, &|reached, nodes| {
        nodal::each(reached, [&start[nodes.clone()], &motion[nodes]], |u1, [u0, d]| *u1 = u0 + d);
    });
    let solve: Solve<D> = if given.interval.map.is_static() { equilibrate } else { iterate_bodies };
    let islands = contacts.divide(given);
    let rests = &resting.who.bodies;
    side_by_side.deal(islands, |i| !contacts.active.touched[i] && !rests[i], contacts, given);
    let made = side_by_side.iterate(solve, given, &mut next.displacement, iterating);
    let contacts = &mut iterating.contacts;
    match made {
        Err((island, error)) if island < islands => {
            contacts.give_up(island);
            Err(error)
        }
        made => {
            contacts.join(given);
            made.map_err(|(_, error)| error)
        }
    }
}
