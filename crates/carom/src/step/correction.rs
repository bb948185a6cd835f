//! One correction of the iterations of a step: residuals, both halves of the solves for them, and what Anderson makes of it.

use carom_mesh::nodal;

use super::newton::Newton;
use super::newton::acceleration::Last;
use super::workspace::Workspace;
use crate::error::StepError;
use crate::model::given::Given;
use crate::model::state::State;

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

/// Moves the `bodies` on to better guesses than the last correction led to; `is_first` in the step it was.
pub(super) fn accelerate<const D: usize>(
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
