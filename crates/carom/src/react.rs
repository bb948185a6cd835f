//! The contacts at the present guess, and their reactions.

use carom_contact::Contact;
use carom_mesh::Vector;

use crate::blend::Rubbing;
use crate::condense::condense;
use crate::error::StepError;
use crate::state::State;
use crate::workspace::Workspace;
use crate::{Method, Model, StepMap};

/// Evaluates the contacts where the condition is written.
pub(crate) fn evaluate_contacts<const D: usize>(
    model: &Model<D>,
    method: &Method<D>,
    state: &State<D>,
    work: &mut Workspace<D>,
) {
    let weight = method.condition.evaluation_weight();
    let motion = &work.motion;
    let position = |n: u32| {
        let n = n as usize;
        model.reference[n] + state.displacement[n] + motion[n] * weight
    };
    model.contact.evaluate_all(&work.candidates, &position, &mut work.mortar, &mut work.contacts);
}

/// Work [J] that prescribed motion does through a contact with the reaction `r`: of an obstacle that moves, and of what supports
/// hold of the nodes around.
pub(crate) fn driven<const D: usize>(
    model: &Model<D>,
    contact: &Contact<D>,
    r: &Vector<D>,
    motion: &[Vector<D>],
) -> f64 {
    let travel = contact.stencil().fold(Vector::zeros(), |sum: Vector<D>, (node, weight)| {
        sum - model.prescribed_part(node, &motion[node]) * weight
    });
    r.dot(&(contact.frame * travel))
}

/// What the contacts mean for the balance of their bodies: those of the step, and those that it starts with and loses.
pub(crate) fn measure_rubbing<const D: usize>(
    model: &Model<D>,
    method: &Method<D>,
    state: &State<D>,
    map: &StepMap,
    work: &mut Workspace<D>,
) {
    let motion = &work.motion;
    let weight = method.condition.reaction_weight(map);
    let rubbing = |pair: u32, contact: &Contact<D>, start: Vector<D>, end: Vector<D>| {
        let pair = &model.contact.pairs[pair as usize];
        let w = contact.relative(|n| motion[n]);
        let driven = [start, end].map(|r| driven(model, contact, &r, motion));
        Rubbing {
            group: pair.group,
            source: pair.source,
            target: pair.target,
            friction: pair.friction,
            start: start[0],
            end: end[0],
            slip: (1..D).map(|t| w[t] * w[t]).sum::<f64>().sqrt(),
            driven,
        }
    };
    work.rubbing.clear();
    for (k, contact) in work.contacts.iter().enumerate() {
        let (start, end) = (work.start_forces[k], work.reactions[k] / weight);
        work.rubbing.push(rubbing(work.candidates[k].pair, contact, start, end));
    }
    for reaction in work.lost.iter().map(|&k| &state.reactions[k]) {
        work.rubbing.push(rubbing(reaction.pair, &reaction.contact, reaction.force, Vector::zeros()));
    }
}

/// Solves the reduced problem of the contacts and adds the effect of their reactions to the corrections.
pub(crate) fn react<const D: usize>(
    model: &Model<D>,
    method: &Method<D>,
    state: &State<D>,
    map: &StepMap,
    work: &mut Workspace<D>,
) -> Result<(), StepError> {
    if work.candidates.is_empty() {
        return Ok(());
    }
    // The bodies in contact settle together; while others still move, these keep their reactions.
    if work.progress.iter().zip(&work.touched).any(|(p, &touched)| touched && p.settled) {
        return Ok(());
    }
    let motion = &work.motion;
    work.offsets.clear();
    work.offsets.extend(work.contacts.iter().zip(&work.start_gaps).map(|(contact, &kept)| {
        method.condition.normal_offset(contact, kept, map, |n| motion[n], |n| state.velocity[n])
    }));
    // The motion without reactions is d plus the correction; `momentum` is free here and holds it.
    for ((free, d), c) in work.momentum.iter_mut().zip(&work.motion).zip(&work.correction) {
        *free = d + c;
    }
    condense(
        model,
        &mut work.operators,
        &mut work.compliances,
        &work.contacts,
        &work.friction,
        &work.offsets,
        &work.momentum,
        &mut work.problem,
    );
    work.guess.clone_from(&work.reactions);
    let report = method.solver.solve(&work.problem, &mut work.reactions, &method.stopping);
    work.solved_by = report.solver;
    work.friction_time += report.time;
    if !report.is_solved() {
        let q = &work.problem.q;
        return Err(if q.iter().all(|q| q.iter().all(|x| x.is_finite())) {
            StepError::Friction { contacts: q.len(), report }
        } else {
            StepError::NotFinite("free motion of the contacts")
        });
    }
    // r as an external load: a second solve for the bodies in contact.
    for (contact, r) in work.contacts.iter().zip(&work.reactions) {
        contact.add_force(r, &mut work.residual);
    }
    for (i, b) in model.bodies.iter().enumerate().filter(|&(i, _)| work.touched[i]) {
        let nodes = b.nodes();
        work.correction[nodes.clone()].copy_from_slice(&work.residual[nodes.clone()]);
        work.operators[i].solve(&mut work.correction[nodes]);
    }
    Ok(())
}
