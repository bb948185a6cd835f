//! One correction of the iterations of a step: residuals, and both halves of the solves for them.

use carom_mesh::{Vector, nodal};

use super::iterating::Iterating;
use super::newton::Newton;
use super::newton::control::CONTROL;
use crate::body::Outlook;
use crate::contact::Contacts;
use crate::error::StepError;
use crate::model::each_body::{PerBody, PerNode, each_body, try_each_body};
use crate::model::given::Given;

/// Residuals of the `bodies` without reactions, in this `iteration`.
pub(super) fn residuals<const D: usize>(
    bodies: &[usize],
    iteration: usize,
    given: &Given<'_, D>,
    reached: &[Vector<D>],
    work: &mut Iterating<D>,
) {
    let is_blended = given.interval.is_blended;
    let Contacts { on_masses, active, .. } = &mut work.contacts;
    on_masses.take(bodies, given, active);
    if is_blended {
        weigh_blend(bodies, iteration, given, reached, work);
    }
    let Iterating { bodies: all, newton, blend, motion, contacts, .. } = work;
    let all = (PerBody(all), PerNode(&mut newton.residual));
    each_body(given.assembly, bodies, all, &|i, (body, residual)| {
        let guess = given.guess(i, motion, reached);
        body.own().residual(&guess, is_blended.then_some(blend.weight[i]), residual.0);
    });
    contacts.on_masses.add_known(bodies, given, &blend.weight, &mut newton.residual);
}

/// The blend of start and end stresses at the guess of this `iteration`: none at the first, which is far from any balance, and in late ones that of
/// the last one before.
fn weigh_blend<const D: usize>(
    bodies: &[usize],
    iteration: usize,
    given: &Given<'_, D>,
    reached: &[Vector<D>],
    work: &mut Iterating<D>,
) {
    let Iterating { bodies: all, contacts, blend, motion, .. } = work;
    let each = (PerBody(&mut all[..]), PerBody(&mut blend.balances));
    let touched = bodies.iter().any(|&i| contacts.active.touched[i]);
    let outlook = match (iteration, touched) {
        (1, false) => Outlook::First,
        (_, false) => Outlook::Free,
        (_, true) => Outlook::Pressed,
    };
    each_body(given.assembly, bodies, each, &|i, (body, balance)| {
        *balance.own() = body.own().balance(&given.guess(i, motion, reached), outlook);
    });
    contacts.on_masses.weigh(bodies, given, motion, all.as_slice(), &mut blend.balances);
    if iteration > CONTROL.weighed {
        return blend.keep(bodies);
    }
    let contact_work = if touched { contacts.measure_work(given, motion) } else { &[] };
    blend.weigh(bodies, contact_work, &given.state.energy_debt, given.state.energies.total());
    if iteration == 1 {
        bodies.iter().for_each(|&i| blend.weight[i] = 0.0);
    }
}

/// Adds the reactions known so far, and what springs pull with, to the residuals of the `bodies`, and starts to solve for their corrections.
pub(super) fn begin_solves<const D: usize>(
    bodies: &[usize],
    given: &Given<'_, D>,
    reacts: bool,
    work: &mut Iterating<D>,
) {
    let residual = &mut work.newton.residual;
    if reacts {
        work.contacts.active.add_reactions(residual);
        for spring in &given.assembly.springs {
            let step = spring.in_step(given.interval, &given.state.displacement, &work.motion);
            spring.add_force(&step.pull(), residual);
        }
    }
    each_body(given.assembly, bodies, PerBody(&mut work.bodies), &|i, body| {
        body.own().begin_solve(&residual[given.assembly.nodes(i)]);
    });
}

/// Ends the solves for the corrections of the `bodies`.
pub(super) fn end_solves<const D: usize>(
    bodies: &[usize],
    given: &Given<'_, D>,
    work: &mut Iterating<D>,
) -> Result<(), StepError> {
    let Iterating { bodies: all, newton: Newton { correction, .. }, .. } = work;
    try_each_body(given.assembly, bodies, (PerBody(all), PerNode(correction)), &|i, (body, correction)| {
        body.own().end_solve(correction.0);
        // The largest size does not see what is not a number.
        let is_finite =
            given.assembly.stepped(i).iter().all(|run| nodal::is_finite(&correction.0[run.clone()]));
        if is_finite { Ok(()) } else { Err(StepError::NotFinite("displacement")) }
    })
}

/// Applies the corrections.
pub(super) fn correct<const D: usize>(
    bodies: &[usize],
    given: &Given<'_, D>,
    reached: &mut [Vector<D>],
    work: &mut Iterating<D>,
) {
    let Iterating { newton: Newton { correction, progress, .. }, motion, .. } = work;
    let all = (PerNode(motion), PerNode(reached), PerBody(progress));
    each_body(given.assembly, bodies, all, &|i, (motion, moved, progress)| {
        let [mut size, mut total] = [0.0_f64; 2];
        for run in given.assembly.stepped(i) {
            let nodes = given.assembly.numbered(i, run);
            let (motion, moved) = (&mut motion.0[run.clone()], &mut moved.0[run.clone()]);
            let (correction, start) = (&correction[nodes.clone()], &given.state.displacement[nodes]);
            size = size.max(nodal::largest(correction));
            nodal::each_of_two(motion, moved, [correction, start], |d, u1, [c, u0]| {
                *d += c;
                *u1 = u0 + *d;
            });
            total = total.max(nodal::largest(motion));
        }
        progress.own().note(size, total);
    });
}
